"""What the quick study says over the grounds that it allows, and on each kind of them.

    python validation/unknown_ground.py FOLDER

FOLDER: of the finished study, made by `lithobrake run scenarios/quick.toml --out FOLDER`. Writes unknown_ground.json
and the two figures of the README, docs/unknown_ground.png and docs/unknown_ground_map.png.
"""

import sys
from pathlib import Path

from lithobrake.report.figures.style import figure_style
from lithobrake.report.pages.study_page import study_content
from lithobrake.results import StudyResults, open_study
from lithobrake.results.page_data import page_results
from lithobrake.results.study_files import json_values

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import command_line, origin, write_document

DOCS = Path(__file__).parents[1] / "docs"
FIGURES = {"grounds": DOCS / "unknown_ground.png", "ends": DOCS / "unknown_ground_map.png"}
REGION = ("share", "area_m2", "largest_extent_m")


def draw(study: StudyResults) -> None:
    """Write the figures as the report has them."""
    plots = study_content(page_results(study)).plots
    with figure_style():
        for plot in plots:
            if plot.name in FIGURES:
                figure = plot.draw()
                assert figure is not None
                figure.savefig(FIGURES[plot.name], dpi=120)


def main() -> None:
    study = open_study(command_line(__doc__, "folder").parse_args().folder)
    results, rest = study.results, study.results.rest
    assert rest is not None
    runs = study.summary.provenance.runs
    document = {
        **origin("validation/unknown_ground.py FOLDER"),
        "answer": list(results.answer),
        "journeys": results.journeys,
        "touchdowns": results.touchdowns,
        "beds": results.runs.beds,
        "cpu_s": runs.cpu_s,
        "at_rest": json_values(results.ends["at_rest"]),
        "time_s": json_values(rest.time_s),
        "contacts": json_values(rest.contacts),
        "distance_m": json_values(rest.distance_m),
        "regions": [{key: getattr(one, key) for key in REGION} for one in rest.regions],
        "over_grounds": json_values(results.over_grounds),
        "kinds": {name: json_values(kind) for name, kind in results.grounds.items()},
        "finer_ground": json_values(results.finer_ground),
        "curve": json_values(results.ground_curve),
        "seconds_by_stage": dict(study.summary.provenance.wall_s),
    }
    write_document(Path(__file__).with_suffix(".json"), document)
    draw(study)


if __name__ == "__main__":
    main()
