"""Scores of the simulated landings here against the landings of the archive that they predict.

    python validation/past_landings.py [--out FOLDER]

Takes MASCOT's simulated landers from validation/mascot/mascot.csv, one prediction a setting, writes each as a table
that `lithobrake score` reads, scores it, and keeps the scores in past_landings.json and their table in docs/scoring.md.
The other landings of the archive have no simulated landers here.
"""

import csv
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path

from lithobrake.scoring.landing_scores import LandingScore, scores
from lithobrake.scoring.observed_landing import past_landing
from lithobrake.scoring.predicted_landings import read_prediction

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import command_line, origin, write_document

HERE = Path(__file__).parent

ENDS = {"at rest": "at_rest", "escaped": "escaped", "time limit": "under_way"}
# As the settings are named on the page of MASCOT.
WORDS = {
    "at the surface": "first contact with a boulder at the surface",
    "below the surface": "first contact with a boulder below the surface",
    "grains alone": "first contact with grains alone",
    "at the surface, hard": "boulder at the surface, hard ground",
}
COLUMNS = {"bed": "bed", "time_s": "time_s", "contacts": "contacts", "path_length": "path_m"}
BEGIN, PAGE = "<!-- scores of past landings", HERE.parent / "docs" / "scoring.md"


def predictions(folder: Path) -> dict[str, Path]:
    """Write MASCOT's simulated landers as predictions; the path of each by its setting."""
    with open(HERE / "mascot" / "mascot.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    paths = {}
    for setting in WORDS:
        paths[setting] = folder / f"{setting}.csv"
        with open(paths[setting], "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["end", *COLUMNS])
            for row in rows:
                if row["setting"] == setting:
                    writer.writerow([ENDS.get(row["end"], "failed"), *(row[name] for name in COLUMNS.values())])
    return paths


def page_table(found: dict[str, list[LandingScore]]) -> str:
    """The scores of MASCOT as a table."""
    names = {"end": "end [bit]", "time_s": "time [s]", "contacts": "contacts", "path_length": "path [m]"}
    lines = [f"| prediction | landers | {' | '.join(names.values())} |", f"|---|---|{'---|' * len(names)}"]
    for setting, of_setting in found.items():
        by_name = {one.quantity: one for one in of_setting}
        cells = []
        for name in names:
            score = by_name[name].score
            cells.append(f"{score.value:.3g} ({score.lower:.3g}-{score.upper:.3g})")
        lines.append(f"| {WORDS[setting]} | {by_name['end'].sample_count} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main() -> None:
    given = command_line(__doc__, out=HERE).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        paths = predictions(Path(folder))
        found = {setting: scores(read_prediction(path), past_landing("mascot")) for setting, path in paths.items()}
    told = {setting: [asdict(one) | {"prediction": setting} for one in of] for setting, of in found.items()}
    write_document(given.out / "past_landings.json", {"mascot": told, **origin("validation/past_landings.py")})
    text = PAGE.read_text(encoding="utf-8").partition(BEGIN)[0]
    PAGE.write_text(
        f"{text}{BEGIN}: validation/past_landings.py writes this part -->\n\n## MASCOT's landing on Ryugu, scored\n\n"
        "Scores of the [simulated landers](validation/mascot.md) against the observed landing; lower is\nbetter, "
        f"intervals are 90 %.\n\n{page_table(found)}\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
