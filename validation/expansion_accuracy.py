"""Where an order-5 expansion is accurate: one bed, one impact point, one attitude, by range of inputs and grain size.

    python validation/expansion_accuracy.py [--grounds NAME ...] [--kept NAME ...] [--work FOLDER] [--out validation]

docs/validation/expansion_accuracy.md has the set-up; grounds and beds are those of grain_size.py. Writes
expansion_accuracy.csv, a line for each landing, as they end, and expansion_accuracy_beds.csv. What stands there already
is not done again: delete both to start anew.
"""

import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from grain_size import GROUNDS, INPUTS, MEDIANS, OUTPUTS, SCENARIOS, TWIN, Ground, bed, landing, soil
from numpy.typing import NDArray

from lithobrake.chaos import Uniform, latin_hypercube, smolyak
from lithobrake.study import read_study
from lithobrake.touchdown import Bed, land

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, add_row, command_line, origin, read_rows, timed, write_document

Floats = NDArray[np.float64]
PLACE = read_study(SCENARIOS / "one_place.toml").impact
# Those that showcase/paper keeps, two of them, and those of the paper.
KEPT = {
    "ours": ("grain.friction", "grain.restitution", "lander.restitution"),
    "two": ("grain.friction", "grain.restitution"),
    "paper's": ("grain.young_modulus", "grain.restitution", "grain.poisson_ratio"),
}
RANGES = {"5 %": 0.05, "10 %": 0.1, "25 %": 0.25, "full": None}
SWEPT = ("friction", "restitution")
TESTS, TWINS, STEPS = 50, 0.4, 100  # twins: part of the tests
EXTRA = {"hulls 1.2": Ground("hull", 1.2, 0.38, 4, {})}
HOW = EXTRA | GROUNDS


class Cell(NamedTuple):
    """Ground and number of its bed, inputs that vary, range; level of the grid, None for a sweep; tests, or steps."""

    ground: str
    bed: int
    kept: str
    range: str
    level: int | None
    tests: int = TESTS
    steps: int = STEPS


def cells(name: str, number: int, kept: str, level: int, tests: int = TESTS) -> list[Cell]:
    return [Cell(name, number, kept, one, level, tests) for one in RANGES]


def sweep(name: str, number: int = 0, of: str = "friction", steps: int = STEPS) -> Cell:
    return Cell(name, number, of, "full", None, steps=steps)


# Where landings are cheap, grids have 441 points, else 177; where they are dear, two inputs vary, on 65 points.
CELLS = [
    *(sweep("hulls 1.2", number, of) for number in range(4) for of in SWEPT),
    *(sweep("spheres 5", number, of) for number in range(2) for of in SWEPT),
    *cells("hulls 1.2", 0, "ours", 5),
    *cells("spheres 5", 0, "ours", 5),
    sweep("hulls 5"),
    *(Cell("hulls 5", 0, "two", one, 4, 30) for one in RANGES),
    *cells("hulls 1.2", 1, "ours", 4),
    *cells("hulls 1.2", 2, "ours", 4),
    *cells("hulls 1.2", 3, "paper's", 4),
    *cells("hulls 1.2", 3, "ours", 4),
    sweep("hulls 10", steps=40),
    Cell("hulls 10", 0, "two", "5 %", 4, 30),
    sweep("spheres 10"),
]  # fmt: skip
KINDS = dict.fromkeys(("ground", "kept", "range", "design", "status"), str) | dict.fromkeys(("bed", "number"), int)


def laws(cell: Cell) -> dict[str, Uniform]:
    """Distributions of the inputs that vary in a cell."""
    names, part = KEPT.get(cell.kept, (f"grain.{cell.kept}",)), RANGES[cell.range]
    if part is None:
        return {name: INPUTS[name] for name in names}
    return {name: Uniform((1.0 - part) * MEDIANS[name], (1.0 + part) * MEDIANS[name]) for name in names}


def designs(cell: Cell) -> dict[str, Floats]:
    """Points [count, input_count] of the designs of a cell."""
    varied = laws(cell)
    if cell.level is None:
        (law,) = varied.values()
        return {"sweep": law.ppf(np.linspace(0.0, 1.0, cell.steps + 1))[:, None]}
    tests = latin_hypercube(varied, cell.tests, 41)
    return {"grid": smolyak(varied, cell.level), "test": tests, "twin": tests[: round(TWINS * cell.tests)]}


def landed(cell: Cell, ground: Bed, design: str, point: Floats) -> Row:
    """Return inputs and outputs of a landing at a point [input_count] of a design."""
    values = MEDIANS | dict(zip(laws(cell), point.tolist(), strict=True))
    rock, lander = soil(values, HOW[cell.ground].grain)
    x = TWIN if design == "twin" else 0.0
    given = landing(HOW[cell.ground], "steep", rock, (x, 0.0), PLACE.orientation)
    outcome, cpu = timed(lambda: land(ground, lander, given))
    outputs = {name: outcome.outputs[name] for name in OUTPUTS}
    return {**values, "status": outcome.status.value, **outputs, "time": outcome.simulated_time, "cpu_s": cpu}


def main() -> None:
    here, work = Path(__file__).parent, Path(tempfile.gettempdir()) / "lithobrake_grain_size"
    names = tuple(dict.fromkeys(cell.ground for cell in CELLS))
    given = command_line(__doc__, grounds=names, kept=(*KEPT, *SWEPT), work=work, out=here).parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    table, keys = given.out / "expansion_accuracy.csv", ("ground", "bed", "kept", "range", "design", "number")
    for cell in (one for one in CELLS if one.ground in given.grounds and one.kept in given.kept):
        done = {tuple(row[key] for key in keys) for row in read_rows(table, KINDS)}
        missing = {
            key: point
            for design, points in designs(cell).items() for number, point in enumerate(points)
            if (key := (cell.ground, cell.bed, cell.kept, cell.range, design, number)) not in done
        }  # fmt: skip
        if not missing:
            continue
        beds = given.out / "expansion_accuracy_beds.csv"
        ground = bed(cell.ground, HOW[cell.ground], cell.bed, given.work, beds)
        for key, point in missing.items():
            add_row(table, dict(zip(keys, key, strict=True)) | landed(cell, ground, str(key[4]), point), 8)
        spent = sum(row["cpu_s"] for row in read_rows(table, KINDS))
        document = {**origin("validation/expansion_accuracy.py"), "cpu_s_of_rows": spent}
        write_document(given.out / "expansion_accuracy.json", document)
        print(*cell, flush=True)


if __name__ == "__main__":
    main()
