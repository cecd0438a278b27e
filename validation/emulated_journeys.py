"""Do journeys by the emulator end as journeys of landings do? Ten small studies, each followed in both ways.

    python validation/emulated_journeys.py [--work FOLDER] [--cases NAME ...]

Each case changes some keys of scenarios/one_ground.toml: lander, soil, arrival, site. It has 32 journeys on 8 beds,
in a folder below --work, where a case that was stopped goes on. Writes emulated_journeys.json, a row a finished case.
"""

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import lithobrake
from lithobrake.results import StudyResults
from lithobrake.results.run_results import CountedShare

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, between, command_line, origin, read_document, study_tables, write_document

JOURNEYS, BEDS = 32, 8


CASES: dict[str, dict[str, Any]] = {
    "on one ground": {},
    "8 to 12 cm/s": {"delivery": {"speed": between(0.08, 0.12)}},
    "12 to 20 cm/s": {"delivery": {"speed": between(0.12, 0.20)}},
    "stiff soil": {
        "grain": {"young_modulus": between(1e6, 1e7, "log_uniform")}, "delivery": {"speed": between(0.06, 0.10)},
    },
    "flat arrival": {"delivery": {"speed": between(0.06, 0.10), "incidence_deg": between(50.0, 80.0)}},
    "heavy lander": {"lander": {"mass": 5.0}, "delivery": {"speed": between(0.05, 0.10)}},
    "cube of 1 kg": {
        "lander": {"edges": [0.1, 0.1, 0.1], "mass": 1.0}, "delivery": {"speed": between(0.05, 0.10)},
    },
    "ball": {
        "lander": {"shape": "sphere", "edges": None, "diameter": 0.12}, "delivery": {"speed": between(0.05, 0.10)},
    },
    "elastic grains at 60 deg north": {
        "grain": {"restitution": between(0.7, 0.9)},
        "delivery": {"latitude_deg": 60.0, "speed": between(0.06, 0.12)},
    },
    "Didymos at 65 deg north": {
        "site": {"body": "didymos"}, "delivery": {"latitude_deg": 65.0, "speed": between(0.05, 0.30)},
    },
}  # fmt: skip


def compared(study: StudyResults) -> dict[str, Any]:
    """How the journeys of a case ended, by landings and by the emulator.

    agrees: within both intervals together; is_inside: all shares of the emulator in the intervals of the landings.
    """
    results = study.results
    emulated, ends = results.emulated, results.ends

    def numbers(shares: Mapping[str, CountedShare]) -> dict[str, list[float | None]]:
        known = {name: one.share for name, one in shares.items() if one.count}
        return {name: [one.value, one.lower, one.upper] for name, one in known.items()}

    return {
        "journeys": results.journeys,
        "touchdowns": results.touchdowns,
        "by_landings": numbers(ends),
        "why_no_emulator": emulated.why,
        "by_emulator": numbers(emulated.ends),
        "unknown": emulated.unknown,
        "landings_between": emulated.landings,
        "agrees": emulated.agrees,
        "is_inside": all(
            ends[end].share.lower <= one.share.value <= ends[end].share.upper for end, one in emulated.ends.items()
        ),
        "control": emulated.control and vars(emulated.control),
    }


def main() -> None:
    given = command_line(__doc__, work=Path("emulated_journeys"), cases=list(CASES)).parse_args()
    few = {"journey": {"count": JOURNEYS}, "bed": {"bed_count": BEDS}}
    path = Path(__file__).with_suffix(".json")
    found = read_document(path, {"cases": {}})["cases"]
    for number, (name, changes) in enumerate(CASES.items()):
        if name in given.cases:
            folder = given.work / "".join(letter if letter.isalnum() else "_" for letter in name)
            tables = study_tables(SCENARIOS / "one_ground.toml", few, changes, seed=100 + number)
            found[name] = compared(lithobrake.run(tables, folder, report=False))
            print(name, found[name], flush=True)
            in_order = {one: found[one] for one in CASES if one in found}
            counts = {key: sum(bool(one[key]) for one in in_order.values()) for key in ("agrees", "is_inside")}
            write_document(path, {**origin("validation/emulated_journeys.py"), **counts, "cases": in_order})


if __name__ == "__main__":
    main()
