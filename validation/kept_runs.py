"""Fill the ledger of a study's folder with its kept landings, so that `lithobrake run` makes only what follows them.

    python validation/kept_runs.py showcase/drawn_700 runs/drawn_700
    lithobrake run showcase/drawn_700/study.toml --out runs/drawn_700

For a change of what comes after the landings: their outputs are taken as they are kept, under the key of today's code,
so whoever changes the engine makes them anew instead. The inputs of each landing are compared with those that today's
code draws; they may differ by rounding, since machines round sines differently. Beds are poured by today's code: what
the summary has of them, and the landing that it shows, are of these.
"""

import argparse
import csv
import json
import math
import shutil
from collections.abc import Iterator
from pathlib import Path

from lithobrake.campaign import Ledger
from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.design.dependencies import touchdown_keys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.expansion.expansions import points
from lithobrake.pipeline.runs.landings import drawn_rows
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import Study, read_study
from lithobrake.touchdown.touchdown_model import touchdown_version
from lithobrake.vocabulary.quantities import DRAWN_DESIGNS, PAPER_DESIGNS

ROUNDING = 1e-12
Numbers = dict[str, float]


def rows_of(study: Study, kept: Path) -> Iterator[tuple[str, list[Numbers]]]:
    """Each kept design of a study with the inputs of its landings as today's code draws them."""
    if study.expansion is not None:
        refined = json.loads((kept / "refined.json").read_text(encoding="utf-8"))
        drawn, chosen = DrawnDesign(study), [one["name"] for one in refined["inputs"]]
        for design in PAPER_DESIGNS:
            yield design, drawn_rows(drawn, points(drawn, design, chosen), 0)
    for design in DRAWN_DESIGNS:
        if (kept / "runs" / f"{design}.csv").is_file():
            yield design, DrawnDesign(study).rows_of(design)


def kept_landings(path: Path) -> Iterator[tuple[str, Numbers, Numbers]]:
    """Outcome, inputs and outputs of each landing of a kept table."""
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            parts: dict[str, Numbers] = {"input": {}, "output": {}}
            for title, value in row.items():
                part, _, name = title.partition(":")
                if part in parts and value:
                    parts[part][name.partition(" [")[0]] = float(value)
            yield row["outcome"], parts["input"], parts["output"]


def fill(ledger: Ledger, study: Study, rows: list[Numbers], landings: list[tuple[str, Numbers, Numbers]]) -> None:
    """Enter landings as ended runs. Raises ValueError for those of another study."""
    keys = touchdown_keys(study, rows, 0)
    ledger.queue([(key, row, study.seed, 0) for key, row in zip(keys, rows, strict=True)], touchdown_version())
    for key, row, (outcome, inputs, outputs) in zip(keys, rows, landings, strict=True):
        near = (math.isclose(inputs.get(name, math.nan), row[name], rel_tol=ROUNDING, abs_tol=ROUNDING) for name in row)
        if not outcome or inputs.keys() != row.keys() or not all(near):
            raise ValueError(f"the landing {key} is kept with other inputs than the study draws, or failed")
        ledger.start([key])
        ledger.finish(key, {"status": "done", "outcome": outcome, "outputs": outputs})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kept", type=Path)
    parser.add_argument("out", type=Path)
    given = parser.parse_args()
    source = given.kept / "study.toml"
    study = with_site_gravity(read_study(source))
    # The lock and the copy of the study file make the folder one of this study.
    with StudyFolder(given.out).alone(), Ledger(given.out / "runs.sqlite") as ledger:
        shutil.copy(source, given.out / "study.toml")
        for design, rows in rows_of(study, given.kept):
            fill(ledger, study, rows, list(kept_landings(given.kept / "runs" / f"{design}.csv")))
            print(f"{design}: {len(rows)} landings")


if __name__ == "__main__":
    main()
