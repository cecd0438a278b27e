"""Are delivery options as the emulator says? Options of scenarios/aim.toml, each followed again by landings of its own.

    python validation/delivery_options.py [--work FOLDER]

The study of the scenario compares 36 options by the emulator of its touchdowns. Three at which landers are lost are
then studies of their own, with 48 journeys, another seed and other beds, so that the two know nothing of each other.
Folders are below --work, where what was stopped goes on. Writes delivery_options.json.
"""

import argparse
import sys
import tomllib
from pathlib import Path
from typing import Any

import lithobrake
from lithobrake.results import StudyResults

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, origin, write_document

JOURNEYS = 48
# Speed [m/s], incidence and latitude [deg].
OPTIONS = ((0.15, 65.0, 0.0), (0.15, 35.0, 0.0), (0.11, 65.0, 0.0))
KEYS = ("speed", "incidence_deg", "latitude_deg")


def tables(number: int) -> dict[str, Any]:
    """The scenario with the delivery of one option alone."""
    study: dict[str, Any] = tomllib.loads((SCENARIOS / "aim.toml").read_text(encoding="utf-8"))
    study.pop("aim")
    study["delivery"] |= dict(zip(KEYS, OPTIONS[number], strict=True))
    study["journey"] |= {"count": JOURNEYS}
    # Pictures of a landing at 0.15 m/s want a little more width than the scenario has.
    study["bed"] |= {"width": [0.58, 0.58], "grain_count": 104}
    return {**study, "seed": 200 + number}


def compared(number: int, options: StudyResults, landings: StudyResults) -> dict[str, Any]:
    """The share at rest at one option, by the emulator of the scenario and by landings, each with its interval."""
    emulated = next(one.soil.settled for one in options.results.aim.aims if one.values == OPTIONS[number])
    ends = landings.results.ends
    numbers = [[one.value, one.lower, one.upper] for one in (emulated, ends["at_rest"].share)]
    return {
        **dict(zip(KEYS, OPTIONS[number], strict=True)),
        "by_emulator": numbers[0],
        "by_landings": numbers[1],
        "journeys": {name: one.count for name, one in ends.items() if one.count},
        "touchdowns": landings.results.touchdowns,
    }


def main() -> None:
    """Run the scenario and its three options, and write how they compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=Path, default=Path("delivery_options"))
    work = parser.parse_args().work
    options = lithobrake.run(SCENARIOS / "aim.toml", work / "aim", report=False)
    found = []
    for number in range(len(OPTIONS)):
        found.append(compared(number, options, lithobrake.run(tables(number), work / f"option_{number}", report=False)))
        print(found[-1], flush=True)
        document = {**origin("validation/delivery_options.py"), "options": found}
        write_document(Path(__file__).with_suffix(".json"), document)


if __name__ == "__main__":
    main()
