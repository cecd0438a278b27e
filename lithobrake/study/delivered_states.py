"""States of landers from another tool: a table with units in its titles, or an ephemeris message."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.oem_reader import MessageState, is_message, message_states
from lithobrake.study.impact_sections import SiteSection
from lithobrake.study.units import conversion
from lithobrake.vocabulary.clock import Epoch, named_system
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES
from lithobrake.vocabulary.plain_text import closest, program_name, show

if TYPE_CHECKING:
    from lithobrake.study.study import Study

AXES = ("x", "y", "z")
VELOCITY, ATTITUDE = ("vx", "vy", "vz"), ("q_w", "q_x", "q_y", "q_z")
RATES = ("rate_x", "rate_y", "rate_z")
# Units of the columns; quaternions have none.
UNITS = {"time": "s", **dict.fromkeys(AXES, "m"), **dict.fromkeys(VELOCITY, "m/s"), **dict.fromkeys(RATES, "rad/s")}
EXAMPLES = ("time_s", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", *ATTITUDE, *(f"{one}_rad_s" for one in RATES))
NEEDED = ("time", *AXES, *VELOCITY)
# A quaternion is scaled to length 1; one so far off is a slip.
LENGTH_ERROR = 0.01
# Frames of messages whose axes do not turn: the first two are those of ICRF within a tenth of an arc second.
ICRF_NAMES, OTHER_INERTIAL = ("ICRF", "EME2000", "J2000", "GCRF"), ("TOD", "TEME", "MOD", "GTOD", "TDR", "B1950")


@dataclass(frozen=True)
class DeliveredStates:
    """States of landers, one row each, in one frame.

    source     where each stands, in words
    time       [s], [count]
    position   [m] and velocity [m/s], [count, 3]
    attitude   quaternions w, x, y, z that turn the lander's axes into those of the frame, [count, 4]; None: not known
    rates      angular velocity about the lander's own axes, against axes that do not turn [rad/s], [count, 3]
    """

    source: Sequence[str]
    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    attitude: np.ndarray | None = None
    rates: np.ndarray | None = None

    def rows(self, first: int, count: int) -> "DeliveredStates":
        part = slice(first, first + count)
        own = (None if one is None else one[part] for one in (self.attitude, self.rates))
        return DeliveredStates(self.source[part], self.time[part], self.position[part], self.velocity[part], *own)


def read_states(path: Path, frame: str, epoch: str | None, centres: Sequence[str]) -> DeliveredStates:
    """The states of a file, in its order.

    frame: as the study names it. epoch: when their time is 0; None: of a message, its earliest state. centres: names
    of the body, which a message must name as its centre; none: any name will do.
    Raises ValueError with file, line and remedy.
    """
    try:
        # Spreadsheets begin a CSV file with a byte order mark.
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise ValueError(f"{path.name} cannot be read ({why}); give the path of a CSV or OEM file in UTF-8") from error
    if is_message(text):
        return _of_message(list(message_states(Path(path.name), text)), path.name, frame, epoch, centres)
    # CCSDS defines the same message in XML, too; as a table its first line would be refused for its titles.
    if text.lstrip().startswith("<"):
        raise ValueError(f"{path.name} is XML; allowed: a message as keyword = value text, or a CSV table; convert it")
    return _of_table(path.name, text)


def states_of(study: "Study") -> DeliveredStates:
    """The states that a study names. Raises ValueError as read_states does."""
    delivery, site = study.delivery, study.site
    assert delivery is not None
    assert delivery.states is not None
    assert delivery.frame is not None
    return read_states(Path(delivery.states), delivery.frame, delivery.epoch, _names(site))


def orbiter_states(study: "Study") -> DeliveredStates:
    """The body-fixed states of the orbiter that a study names, in time. Raises ValueError as read_states does."""
    orbiter = study.sky.orbiter
    assert orbiter is not None
    assert orbiter.states is not None
    found = read_states(Path(orbiter.states), "body_fixed", None, _names(study.site))
    order = np.argsort(found.time, kind="stable")
    columns = (found.time, found.position, found.velocity)
    return DeliveredStates([found.source[row] for row in order], *(one[order] for one in columns))


def _names(site: SiteSection) -> list[str]:
    """Names of the body as a message may have them."""
    own = site.body if site.body in BUILT_IN_BODIES else site.name
    return [program_name(name) for name in (own, site.kernel_body) if name]


def _of_message(
    states: list[MessageState], name: str, frame: str, epoch: str | None, centres: Sequence[str]
) -> DeliveredStates:
    if not states:
        raise ValueError(f"{name} has no states; give a file with one line a lander")
    for state in states:
        _refuse_segment(state, name, frame, centres)
    start = min(state.epoch for state in states) if epoch is None else _start(epoch, states)
    # An OEM is in km and km/s [CCSDS-2009].
    numbers = 1e3 * np.array([state.numbers for state in states])
    if not np.isfinite(numbers).all():
        line = states[int(np.flatnonzero(~np.isfinite(numbers).all(axis=1))[0])].line
        raise ValueError(f"{name}, line {line}: a number is not finite; mend the line")
    return DeliveredStates(
        [f"{name}, line {state.line}" for state in states],
        np.array([state.epoch.since(start) for state in states]),
        numbers[:, :3],
        numbers[:, 3:],
    )


def _start(epoch: str, states: list[MessageState]) -> Epoch:
    """When the time is 0. Raises ValueError where that may be meant in the time system of the message, not in UTC."""
    systems = sorted({state.segment["TIME_SYSTEM"].upper() for state in states} - {"UTC"})
    start = Epoch.of(epoch)
    if systems and named_system(epoch) is None:
        raise ValueError(
            f"delivery.epoch is {epoch}, and the states count in {systems[0]}; say in which time system it is: write "
            f'"{epoch} {systems[0]}" or "{epoch} UTC"'
        )
    return start


def _refuse_segment(state: MessageState, name: str, frame: str, centres: Sequence[str]) -> None:
    """Raise ValueError where a segment says that its states are in other axes, or from another centre."""
    given, centre = state.segment["REF_FRAME"].upper(), state.segment["CENTER_NAME"].upper()
    where = f"{name}, line {state.line}"
    if frame == "icrf" and given not in ICRF_NAMES:
        allowed = ", ".join(ICRF_NAMES)
        raise ValueError(
            f'{where}: REF_FRAME is {given} and delivery.frame "icrf"; allowed with it: {allowed}; convert the states, '
            'or write delivery.frame = "body_fixed"'
        )
    if frame == "body_fixed" and (given in (*ICRF_NAMES, *OTHER_INERTIAL) or given.endswith("INERTIAL")):
        raise ValueError(
            f'{where}: REF_FRAME is {given}, which does not turn, and delivery.frame "body_fixed"; convert the states, '
            'or write delivery.frame = "icrf" for axes of that'
        )
    if centres and program_name(centre) not in centres:
        raise ValueError(
            f"{where}: CENTER_NAME is {centre}; allowed: {' or '.join(centres)}, as states count from the centre of "
            "the study's body; convert them"
        )


def _of_table(name: str, text: str) -> DeliveredStates:
    lines = [
        (number, cells)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
        # Line by line: quoted cells with line breaks would put the line numbers of later errors off.
        for cells in csv.reader([line], skipinitialspace=True)
    ]
    if len(lines) < 2:
        raise ValueError(f"{name} has no states; give a line of titles, {', '.join(EXAMPLES[:7])}, and one a lander")
    columns = _columns(f"{name}, line {lines[0][0]}", [cell.strip() for cell in lines[0][1]])
    factors = list(columns.values())
    table = np.array([_numbers(f"{name}, line {number}", cells, list(columns)) for number, cells in lines[1:]])
    values = dict(zip(columns, (table * factors).T, strict=True))

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


def _numbers(where: str, cells: list[str], columns: list[str]) -> list[float]:
    if len(cells) != len(columns):
        raise ValueError(f"{where} has {len(cells)} cells; allowed: {len(columns)}, as many as titles; mend the line")
    numbers = []
    for cell, column in zip(cells, columns, strict=True):
        try:
            number = float(cell)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise ValueError(f"{where}: {column} is {show(cell)}; allowed: a finite number; mend the cell")
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
