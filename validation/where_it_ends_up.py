"""Where does the CubeSat of one ground end up: after the first bounce and at rest, on soil and on hard ground?

    python validation/where_it_ends_up.py FOLDER

FOLDER: of the finished study, made by `lithobrake run scenarios/one_ground.toml --out FOLDER`. The same deliveries on
hard ground with restitutions of hard_ground.py are followed in a folder of their own, within seconds. Writes
where_it_ends_up.json and the figure of docs/where_it_ends_up.md, and prints its table.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

from hard_ground import HardGround

import lithobrake
from lithobrake.report.figures.style import figure_style
from lithobrake.report.pages.study_page import study_content
from lithobrake.results import StudyResults, open_study
from lithobrake.results.page_data import page_results
from lithobrake.results.study_files import json_values
from lithobrake.vocabulary.estimate import Estimate

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import command_line, origin, write_document
from page import two_digits

SCENARIO = Path(__file__).parents[1] / "scenarios" / "one_ground.toml"
RESTITUTIONS = (0.1, 0.3, 0.6, 0.9)
FIGURE = Path(__file__).parents[1] / "docs" / "where_it_ends_up.png"
REGION = ("share", "area_m2", "largest_extent_m")
ENDS = ("at_rest", "escaped", "partner", "under_way", "failed")


def numbers(name: str, study: StudyResults) -> dict[str, Any]:
    results, rest = study.results, study.results.rest

    def bounded(one: Estimate) -> dict[str, float | None]:
        return {"share": one.value, "lower": one.lower, "upper": one.upper}

    return {
        "ground": name,
        "journeys": results.journeys,
        "touchdowns": results.touchdowns,
        "stay_at_first_touchdown": results.runs.outcomes.get("captured", 0),
        "returns": bounded(results.returns.share),
        "ends": {end: bounded(results.ends[end].share) for end in ENDS},
        "time_s": json_values(rest.time_s),
        "contacts": json_values(rest.contacts),
        "distance_m": json_values(rest.distance_m),
        "regions": [{key: getattr(one, key) for key in REGION} for one in rest.regions],
    }


def row(found: dict[str, Any]) -> str:
    def share(one: dict[str, Any]) -> str:
        return f"{100 * one['share']:.0f} ({100 * one['lower']:.0f}-{100 * one['upper']:.0f})"

    def value(one: dict[str, Any], size: float) -> str:
        return "-" if one["value"] is None else two_digits(one["value"] / size)

    region = found["regions"][-1] if found["regions"] else None
    cells = [
        found["ground"],
        f"{found['stay_at_first_touchdown']} of {found['journeys']}",
        share(found["returns"]),
        share(found["ends"]["at_rest"]),
        *(f"{100 * found['ends'][end]['share']:.0f}" for end in ("escaped", "partner", "under_way")),
        value(found["time_s"]["median"], 60.0),
        value(found["contacts"]["median"], 1.0),
        value(found["distance_m"]["median"], 1.0),
        two_digits(region["area_m2"]) if region else "-",
    ]
    return f"| {' | '.join(cells)} |"


def draw(study: StudyResults) -> None:
    """Write the map of the places of rest as the report has it."""
    page = page_results(study)
    with figure_style():
        figure = next(plot.draw() for plot in study_content(page).plots if plot.name == "ends")
        assert figure is not None
        figure.savefig(FIGURE, dpi=120)


def main() -> None:
    soil = open_study(command_line(__doc__, "folder").parse_args().folder)
    found = [numbers("soil", soil)]
    for restitution in RESTITUTIONS:
        model = HardGround(restitution, restitution)
        with tempfile.TemporaryDirectory() as folder:
            study = lithobrake.run(SCENARIO, Path(folder) / "out", model=model, report=False)
            found.append(numbers(f"hard, restitution {restitution:g}", study))
    print("\n".join(row(one) for one in found))
    draw(soil)
    document = {**origin("validation/where_it_ends_up.py FOLDER"), "grounds": found}
    write_document(Path(__file__).with_suffix(".json"), document)


if __name__ == "__main__":
    main()
