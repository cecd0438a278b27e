"""Which numbers of a study change on periodic ground? Reads finished studies side by side.

    python validation/periodic_studies.py FOLDER ...

Each folder was made by `lithobrake run` of a study of the first bounce (scenarios/first_bounce.toml and
studies/drawn_170.toml), as it is or with the keys of [bed] that periodic_studies.json then tells. Writes
periodic_studies.json.
"""

import sys
from pathlib import Path

import numpy as np
from periodic_ground import over_beds

from lithobrake.results import StudyResults, open_study
from lithobrake.vocabulary.estimate import Estimate

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, command_line, origin, write_document

OUTPUTS = ("speed_out", "elevation_out", "spin_out", "penetration")


def bounded(one: Estimate) -> Row:
    """A share with its bounds."""
    return {"share": one.value, "lower": one.lower, "upper": one.upper}


def numbers(study: StudyResults) -> Row:
    """Beds, outcomes, what comes down again, and how landers leave."""
    results, bed, runs = study.results, study.study["bed"], study.runs
    drawn = runs.where((runs["design"] == "drawn") & (runs["outcome"] == "clear"))
    rows = [{key: float(drawn[key][row]) for key in ("bed", *OUTPUTS)} for row in range(drawn.row_count)]
    shares = {name: results.shares.outcomes[name].share for name in ("escaped", "flying")}
    return {
        "title": study.study["title"],
        "bed": {key: bed[key] for key in ("sides", "grain_count", "width")},
        "solid_fraction": float(np.mean([one.solid_fraction for one in results.beds])),
        "coordination_number": float(np.mean([one.coordination_number for one in results.beds])),
        "beds": results.runs.beds,
        "outcomes": results.runs.outcomes,
        "farther_than_period": results.runs.farther_than_period,
        "returns": bounded(results.returns.share),
        "shares": {name: bounded(one) for name, one in shares.items()},
        **{key: over_beds(rows, key) for key in OUTPUTS},
    }


def main() -> None:
    studies = [numbers(open_study(folder)) for folder in command_line(__doc__, "folders...").parse_args().folders]
    document = {**origin("validation/periodic_studies.py FOLDER ..."), "studies": studies}
    write_document(Path(__file__).with_suffix(".json"), document)


if __name__ == "__main__":
    main()
