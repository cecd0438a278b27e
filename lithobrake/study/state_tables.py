"""States of landers out of a table (CSV) with units in its titles."""

import csv
import math
from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.study.delivery_sections import LARGEST
from lithobrake.study.state_paths import DeliveredStates
from lithobrake.study.units import conversion
from lithobrake.vocabulary.plain_text import closest, show

AXES = ("x", "y", "z")
VELOCITY, ATTITUDE = ("vx", "vy", "vz"), ("q_w", "q_x", "q_y", "q_z")
RATES = ("rate_x", "rate_y", "rate_z")
# Units of the columns; quaternions have none.
UNITS = {"time": "s", **dict.fromkeys(AXES, "m"), **dict.fromkeys(VELOCITY, "m/s"), **dict.fromkeys(RATES, "rad/s")}
EXAMPLES = ("time_s", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", *ATTITUDE, *(f"{one}_rad_s" for one in RATES))
NEEDED = ("time", *AXES, *VELOCITY)
SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab"}
# A quaternion is scaled to length 1; one so far off is a slip.
LENGTH_ERROR = 0.01


def table_states(name: str, text: str) -> DeliveredStates:
    """The states of a table, one a line, of a file of this name.

    Raises ValueError with file, line and remedy for a table without states, titles and cells that are none, and numbers
    beyond what a state may have.
    """
    given = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    separator = _separator(f"{name}, line {given[0][0]}", given[0][1]) if given else ","
    # Line by line: quoted cells with line breaks would put the line numbers of later errors off.
    lines = [
        (number, cells)
        for number, line in given
        for cells in csv.reader([line], delimiter=separator, skipinitialspace=True)
    ]
    if len(lines) < 2:
        raise ValueError(f"{name} has no states; give a line of titles, {', '.join(EXAMPLES[:7])}, and one a lander")
    columns = _columns(f"{name}, line {lines[0][0]}", [cell.strip() for cell in lines[0][1]])
    table = np.array([_numbers(f"{name}, line {number}", cells, columns) for number, cells in lines[1:]])
    values = dict(zip(columns, table.T, strict=True))

    def stacked(names: Sequence[str]) -> np.ndarray | None:
        return np.column_stack([values[one] for one in names]) if names[0] in values else None

    source = [f"{name}, line {number}" for number, _ in lines[1:]]
    attitude = stacked(ATTITUDE)
    if attitude is not None:
        attitude = _unit(attitude, source)
    place, velocity = (np.column_stack([values[one] for one in names]) for names in (AXES, VELOCITY))
    return DeliveredStates(source, values["time"], place, velocity, attitude, stacked(RATES))


def _columns(where: str, titles: list[str]) -> dict[str, float]:
    """The quantity of each column, and the factor from its unit to SI."""
    columns: dict[str, float] = {}
    for title in titles:
        quantity, factor = (title, 1.0) if title in ATTITUDE else _quantity(where, title)
        if quantity in columns:
            raise ValueError(f"{where}: {quantity} has two columns; keep one")
        columns[quantity] = factor
    # An attitude without rates cannot be propagated to the touchdown, so either requires the other.
    wanted = (*NEEDED, *((*ATTITUDE, *RATES) if columns.keys() & {*ATTITUDE, *RATES} else ()))
    lacking = [example for example in EXAMPLES if _stem(example) in wanted and _stem(example) not in columns]
    if lacking:
        why = " (an attitude goes with all of q_w to q_z and rate_x to rate_z)" if len(wanted) > len(NEEDED) else ""
        raise ValueError(f"{where}: the column {', '.join(lacking)} is missing{why}; add it with its unit in the title")
    return columns


def _stem(title: str) -> str:
    """The quantity of a title: what stands before its unit."""
    return next((one for one in (*ATTITUDE, *UNITS) if title == one or title.startswith(f"{one}_")), "")


def _quantity(where: str, title: str) -> tuple[str, float]:
    quantity = _stem(title)
    unit = title.removeprefix(quantity).removeprefix("_").replace("_", "/")
    if quantity not in UNITS:
        near = closest(title, EXAMPLES)
        raise ValueError(f"{where}: {show(title)} is no column{near}; allowed: {', '.join(EXAMPLES)}; take it out")
    if not unit:
        example = next(one for one in EXAMPLES if _stem(one) == quantity)
        raise ValueError(f"{where}: {title} has no unit; write it into the title, as {example}")
    try:
        return quantity, conversion(unit, UNITS[quantity])
    except ValueError as error:
        raise ValueError(f"{where}: {title} has the {error}; write another unit behind {quantity}_") from error


def _separator(where: str, titles: str) -> str:
    """What separates the cells of a table, by its line of titles."""
    found = [one for one in SEPARATORS if one in titles]
    if len(found) == 1:
        return found[0]
    said = " and ".join(SEPARATORS[one] for one in found) or "no separator"
    raise ValueError(
        f"{where}: {show(titles)} has {said}; allowed: titles such as {', '.join(EXAMPLES[:7])}, separated by one of "
        f"{', '.join(SEPARATORS.values())}; write them so"
    )


def _numbers(where: str, cells: list[str], columns: Mapping[str, float]) -> list[float]:
    """The numbers of a line in SI; columns: factor from the unit of each to SI."""
    if len(cells) != len(columns):
        raise ValueError(f"{where} has {len(cells)} cells; allowed: {len(columns)}, as many as titles; mend the line")
    numbers = []
    for cell, (column, factor) in zip(cells, columns.items(), strict=True):
        try:
            number = factor * float(cell)
        except ValueError:
            number = math.nan
        # Of its own unit: what is finite there may be infinite in SI.
        if not abs(number) <= (largest := LARGEST.get(UNITS.get(column, ""), 1.0 + LENGTH_ERROR)):
            unit = UNITS.get(column, "")
            comma = ", with a decimal point" if "," in cell else ""
            raise ValueError(
                f"{where}: {column} is {show(cell)}{f', which is {number:g} {unit}' * (factor != 1.0)}; allowed: a "
                f"finite number{comma}, at most {f'{largest:g} {unit}'.rstrip()} in size; mend the cell"
            )
        numbers.append(number)
    return numbers


def _unit(attitude: np.ndarray, source: Sequence[str]) -> np.ndarray:
    """Quaternions of length 1 [count, 4]. Raises ValueError for one that is far from that."""
    length = np.linalg.norm(attitude, axis=1)
    wrong = np.flatnonzero(np.abs(length - 1.0) > LENGTH_ERROR)
    if len(wrong):
        row = int(wrong[0])
        raise ValueError(
            f"{source[row]}: q_w to q_z have the length {length[row]:.4g}; allowed: 1 within {LENGTH_ERROR:g}; write a "
            "unit quaternion, its scalar in q_w"
        )
    unit: np.ndarray = attitude / length[:, None]
    return unit
