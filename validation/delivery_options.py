"""Are delivery options as the emulator says? Options of scenarios/aim.toml, each followed again by landings of its own.

    python validation/delivery_options.py [--work FOLDER]

The study of the scenario compares 36 options by the emulator of its touchdowns. Three at which landers are lost are
then studies of their own, with 48 journeys, another seed and other beds, so that the two know nothing of each other.
Folders are below --work, where what was stopped goes on. Writes delivery_options.json.
"""

import sys
from pathlib import Path
from typing import Any

import lithobrake
from lithobrake.results import StudyResults

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, command_line, origin, study_tables, write_document

JOURNEYS = 48
# Speed [m/s], incidence and latitude [deg].
OPTIONS = ((0.15, 65.0, 0.0), (0.15, 35.0, 0.0), (0.11, 65.0, 0.0))
KEYS = ("speed", "incidence_deg", "latitude_deg")


def tables(number: int) -> dict[str, Any]:
    # Pictures of a landing at 0.15 m/s want a little more width than the scenario has.
    changes = {
        "delivery": dict(zip(KEYS, OPTIONS[number], strict=True)), "journey": {"count": JOURNEYS},
        "bed": {"width": [0.58, 0.58], "grain_count": 104},
    }  # fmt: skip
    study = study_tables(SCENARIOS / "aim.toml", changes, seed=200 + number)
    return {name: keys for name, keys in study.items() if name != "aim"}


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
    work = command_line(__doc__, work=Path("delivery_options")).parse_args().work
    options = lithobrake.run(SCENARIOS / "aim.toml", work / "aim", report=False)
    found = []
    for number in range(len(OPTIONS)):
        found.append(compared(number, options, lithobrake.run(tables(number), work / f"option_{number}", report=False)))
        print(found[-1], flush=True)
        document = {**origin("validation/delivery_options.py"), "options": found}
        write_document(Path(__file__).with_suffix(".json"), document)


if __name__ == "__main__":
    main()
