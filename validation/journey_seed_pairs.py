"""Do two studies of journeys that differ in their seed alone say the same? Ten settings, two seeds each.

    python validation/journey_seed_pairs.py [--work FOLDER] [--settings 10]
    python validation/journey_seed_pairs.py --page    the tables of interval_coverage.md, from what was made

Each setting changes some keys of scenarios/one_ground.toml, with 32 journeys on 8 beds of 110 grains. No two studies
have a seed in common, so none has a bed of another. journey_seed_pairs.csv gets a row a study as it ends; a study
that stands in it is not made again, and one that was stopped goes on in its folder below --work. Then the .json
beside it counts the pairs that agree: those where the interval of the difference holds 0.
"""

import math
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import lithobrake
from lithobrake.analysis import LEVEL, share_estimate
from lithobrake.results import StudyResults

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, Row, add_row, between, command_line, origin, read_rows, study_tables, write_document
from page import table

TABLE = Path(__file__).with_suffix(".csv")
JOURNEYS, BEDS, FIRST_SEED = 32, 8, 201
# A little wider than the bed of one ground: among the grains of twenty studies some are longer than in one.
BED = {"bed_count": BEDS, "grain_count": 110, "width": [0.6, 0.6]}
WORDS = {
    "at_rest": "fraction at rest", "time_s": "time to rest, median", "contacts": "contacts, median",
    "distance_m": "distance from the aim point, median", "largest_side": "fraction on one of the largest sides",
}  # fmt: skip
PARTS = ("value", "lower", "upper")


def arrival(speed: tuple[float, float], incidence: tuple[float, float], **more: Any) -> dict[str, Row]:
    """Speeds [m/s] and incidences [deg] of a delivery."""
    return {"delivery": {"speed": between(*speed), "incidence_deg": between(*incidence), **more}}


# A softer soil takes longer steps.
SOFT = {"young_modulus": {"distribution": "log_uniform", "lower": 3e4, "upper": 3e5}}
FAST = arrival((0.08, 0.2), (0.0, 70.0))
SETTINGS: dict[str, dict[str, Row]] = {
    "8 to 20 cm/s": {**FAST, "grain": SOFT},
    "10 to 30 cm/s, 20 to 70 deg": {**arrival((0.1, 0.3), (20.0, 70.0)), "grain": SOFT},
    "6 to 14 cm/s, 50 to 85 deg": {**arrival((0.06, 0.14), (50.0, 85.0)), "grain": SOFT},
    "ball": {**FAST, "grain": SOFT, "lander": {"shape": "sphere", "edges": None, "diameter": 0.12}},
    "flat box, tumbling": {
        **arrival((0.08, 0.2), (0.0, 70.0), spin_x=between(-0.2, 0.2)), "grain": SOFT,
        "lander": {"edges": [0.16, 0.16, 0.08], "mass": 3.0},
    },
    "slippery soil": {**FAST, "grain": SOFT | {"friction": between(0.2, 0.4)}},
    "elastic soil": {**FAST, "grain": SOFT | {"restitution": between(0.8, 0.95)}},
    "equator, leading side": {
        **arrival((0.08, 0.2), (0.0, 70.0), latitude_deg=0.0, longitude_deg=90.0), "grain": SOFT,
    },
    "75 deg south": {**arrival((0.08, 0.2), (0.0, 70.0), latitude_deg=-75.0, longitude_deg=20.0), "grain": SOFT},
    "one ground": {},
}  # fmt: skip


def largest_side(edges: list[float] | None) -> str | None:
    """A side of a box with the largest area, as the table of journeys names it; None of a ball."""
    return None if edges is None else f"-{'xyz'[edges.index(min(edges))]}"


def found(study: StudyResults) -> Row:
    """Each quantity of a study with the ends of its interval; NaN where there is none."""
    results, journeys = study.results, study.journeys
    of = {name: getattr(results.rest, name).median for name in ("time_s", "contacts", "distance_m")}
    rests = journeys["end"] == "at_rest"
    of["at_rest"] = results.ends["at_rest"].share
    side = largest_side(study.study["lander"].get("edges"))
    if side is not None:
        lies = share_estimate((journeys["face"][rests] == side).astype(float), journeys["bed"][rests])
        of["largest_side"] = lies.share
    row = {}
    for name in WORDS:
        for part in PARTS:
            value = getattr(of.get(name), part, None)
            row[f"{name} {part}"] = math.nan if value is None else float(value)
    ends = {f"{name} count": one.count for name, one in results.ends.items()}
    return row | ends | {"touchdowns": results.touchdowns, "cpu_s": float(np.nansum(study.touchdowns["cpu_s"]))}


def make(work: Path, setting_count: int) -> None:
    """Make the studies that are missing."""
    done = {(row["setting"], row["seed"]) for row in kept_rows()}
    for number, (name, changes) in enumerate(list(SETTINGS.items())[:setting_count]):
        for seed in (FIRST_SEED + 2 * number, FIRST_SEED + 2 * number + 1):
            if (name, seed) in done:
                continue
            few = {"journey": {"count": JOURNEYS}, "bed": BED}
            tables = study_tables(SCENARIOS / "one_ground.toml", few, changes, seed=seed)
            results = lithobrake.run(tables, work / str(seed), workers=1, report=False)
            row = {"setting": name, "seed": seed, "journeys": JOURNEYS, "beds": BEDS, **found(results)}
            add_row(TABLE, row, digits=5)
            print(name, seed, row["at_rest value"], flush=True)


def kept_rows() -> list[Row]:
    return read_rows(TABLE, {"setting": str, "seed": int, "journeys": int, "beds": int})


def pairs() -> Iterator[tuple[Row, Row]]:
    """Both studies of each setting that has two."""
    rows = kept_rows()
    for name in SETTINGS:
        both = [row for row in rows if row["setting"] == name]
        if len(both) == 2:
            yield both[0], both[1]


def agree(one: Row, other: Row, name: str) -> bool | None:
    """Whether the interval of the difference holds 0; None where a study has no interval.

    The half width of the difference is the root of the sum of squares of those that face each other.
    Source: [Zou-2008], Eq 2.
    """
    low, high = sorted((one, other), key=lambda row: float(row[f"{name} value"]))
    up = high[f"{name} value"] - high[f"{name} lower"]
    down = low[f"{name} upper"] - low[f"{name} value"]
    if math.isnan(up + down):
        return None
    return bool(high[f"{name} value"] - low[f"{name} value"] <= math.hypot(up, down))


def counted() -> dict[str, Row]:
    """How many pairs agree, by quantity."""
    judged = {name: [agree(*both, name) for both in pairs()] for name in WORDS}
    return {
        name: {"agree": found.count(True), "pairs": len(found) - found.count(None)} for name, found in judged.items()
    }


def cell(pair: tuple[Row, Row], name: str) -> str:
    """Both values of a quantity, and a mark where they do not agree."""
    size, digits = {"at_rest": (0.01, 0), "largest_side": (0.01, 0), "time_s": (60.0, 0)}.get(name, (1.0, 0))
    if math.isnan(pair[0][f"{name} value"]):
        return "-"
    said = "; ".join(f"{row[f'{name} value'] / size:.{digits}f}" for row in pair)
    return said if agree(*pair, name) else f"**{said}**"


def page_table() -> str:
    """All pairs, as a table in Markdown."""
    heads = ("seeds", "setting", "at rest [%]", "time to rest [min]", "contacts", "distance [m]",
             "on one of the largest sides [%]")  # fmt: skip
    lines = [
        (", ".join(str(row["seed"]) for row in pair), pair[0]["setting"], *(cell(pair, name) for name in WORDS))
        for pair in pairs()
    ]
    totals = " | ".join(f"{one['agree']} of {one['pairs']}" for one in counted().values())
    return "\n".join([table(heads, lines), f"| | pairs that agree | {totals} |"]) + "\n"


def main() -> None:
    work = Path(tempfile.gettempdir()) / "lithobrake_journey_seed_pairs"
    options = command_line(__doc__, work=work, settings=len(SETTINGS), page=False).parse_args()
    if not options.page:
        make(options.work, options.settings)
        command = f"validation/journey_seed_pairs.py --settings {options.settings}"
        document = {**origin(command), "level": LEVEL, "quantities": counted()}
        write_document(TABLE.with_suffix(".json"), document)
    print(page_table())


if __name__ == "__main__":
    main()
