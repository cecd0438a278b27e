"""Landers that the forecast leaves out: Hera itself on Dimorphos, and both CubeSats on Didymos, on unknown ground.

    python validation/forecast_hera/other_landers.py --work FOLDER [--journeys N] [--workers N]

Each is the study file of a lander (scenarios/milani.toml, juventas.toml) with the keys below changed, and the ground a
body of the preset `dimorphos` or `didymos`: gravel, stones larger than the lander or bare rock. Writes
other_landers.json: what each study answers, with its intervals over grounds. No part of the forecast and of its
editions. What is in --work is not followed again.
"""

import sys
import tomllib
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from answers import HERE
from branches import SCENARIOS, STUDY, changed
from harness import command_line, origin, write_document

import lithobrake
from lithobrake.results import StudyResults
from lithobrake.results.study_files import json_values

OUT = HERE / "other_landers.json"
JOURNEYS, BEDS = 48, 24


def uniform(lower: float, upper: float) -> STUDY:
    """A range of a study file."""
    return {"distribution": "uniform", "lower": lower, "upper": upper}


# Sizes of grains come from the ground, and so do width and number.
OPEN_GROUND = dict.fromkeys(("bed.grain_count", "bed.width", "bed.diameter"))
# The edges of its body are published [ESA-2026], the mass at the end of the mission is not: between half and three
# quarters of the 1214 kg at launch is ours. Without its wings of 11.5 m. A hop stays on the bed up to a diameter.
HERA = {
    "lander.edges": [1.6, 1.6, 1.6], "lander.mass": uniform(600.0, 900.0), "journey.hop_height": 2.8,
    **{f"lander.centre_of_mass.{axis}": uniform(-0.1, 0.1) for axis in "xyz"},
}  # fmt: skip
# North of the belt where the ground of Didymos holds nothing. The speed is ours: at least that of a fall from far.
DIDYMOS = {
    "site": {"body": "didymos"}, "delivery.latitude_deg": 60.0, "delivery.longitude_deg": 0.0,
    "delivery.speed": uniform(0.15, 0.3),
}  # fmt: skip
# By name: the file of the study, its ground, and keys that are changed.
STUDIES: dict[str, tuple[str, str, STUDY]] = {
    "Hera on Dimorphos": ("milani", "dimorphos", HERA),
    "Juventas on Didymos": ("juventas", "didymos", DIDYMOS),
    "Milani on Didymos": ("milani", "didymos", DIDYMOS),
}


def tables(name: str, journeys: int) -> STUDY:
    """The tables of a study."""
    lander, ground, changes = STUDIES[name]
    given = tomllib.loads((SCENARIOS / f"{lander}.toml").read_text(encoding="utf-8"))
    counts = {"bed.bed_count": BEDS, "journey.count": journeys, "journey.emulated_count": 0}
    return changed(given, {"title": name, "ground": ground, **OPEN_GROUND, **changes, **counts})


def answers(study: StudyResults) -> dict[str, Any]:
    """What a study says of its landers."""
    results, rest = study.results, study.results.rest
    found = {
        "answer": list(results.answer), "journeys": results.journeys, "touchdowns": results.touchdowns,
        "beds": results.runs.beds, "ends": json_values(results.ends), "over_grounds": json_values(results.over_grounds),
        "grounds": json_values(results.grounds), "cpu_s": study.summary.provenance.runs.cpu_s,
    }  # fmt: skip
    told = (
        {}
        if rest is None
        else {name: json_values(getattr(rest, name)) for name in ("time_s", "contacts", "distance_m")}
    )
    return found | told


def main() -> None:
    parser = command_line(__doc__, work=Path, journeys=JOURNEYS, workers=0)
    options = parser.parse_args()
    made = {}
    for name in STUDIES:
        folder = options.work / name.replace(" ", "_").lower()
        study = lithobrake.run(tables(name, options.journeys), folder, workers=options.workers or None)
        made[name] = answers(study)
        print(name, *study.results.answer, sep="\n  ", flush=True)
        write_document(OUT, {"studies": made} | origin("validation/forecast_hera/other_landers.py --work FOLDER"))


if __name__ == "__main__":
    main()
