"""Keep the first edition of the forecast in showcase/forecast_hera: its answers, figures and hashes.

python validation/forecast_hera/showcase.py
"""

import shutil
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from answers import FIRST_EDITION, FORECAST
from harness import ROOT, read_document, write_document
from landers import RUNS

FOLDER = ROOT / "showcase" / "forecast_hera"
FIGURES = ("forecast_hera_shares.png", "forecast_hera_map.png")


def without_outlines(of: dict[str, Any]) -> dict[str, Any]:
    """The answers of a lander on a ground, without the edges of its regions, which are long."""
    regions = [{key: value for key, value in one.items() if key != "outlines"} for one in of["regions"]]
    return {**of, "regions": regions}


def keep(out: Path, docs: Path, folder: Path) -> None:
    document, runs = (read_document(out / name) for name in (FORECAST, RUNS))
    (folder / "figures").mkdir(parents=True, exist_ok=True)
    for name in FIGURES:
        shutil.copy(docs / name, folder / "figures" / name)
    landers = {
        name: {ground: without_outlines(of) for ground, of in grounds.items()}
        for name, grounds in document["landers"].items()
    }
    write_document(folder / "answers.json", {"made": document["made"], "bins": document["bins"], "landers": landers})
    write_document(folder / "origin.json", {**runs, "sha256": document["sha256"]})


def main() -> None:
    keep(FIRST_EDITION, ROOT / "docs", FOLDER)


if __name__ == "__main__":
    main()
