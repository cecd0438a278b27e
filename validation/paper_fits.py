"""Whether the runs or the fit make the errors of the paper's study: other fits of its own runs, and of fewer.

    python validation/paper_fits.py

Fits the kept runs (showcase/paper/runs) in several ways and scores each on the test runs of all inputs that it has not
seen; writes paper_fits.json, of which paper_study_figures.py makes a table.
"""

import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos import fit
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.study import read_study

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import ROOT, origin, read_rows, timed, write_document

RUNS = ROOT / "showcase" / "paper" / "runs"
INPUTS = DrawnDesign(read_study(RUNS.parent / "study.toml")).inputs
OUTPUTS = ("speed_out", "elevation_out", "spin_out")
HELD_BACK = 50  # test runs that every fit is scored on
WAYS: dict[str, dict[str, Any]] = {
    "least squares, order 3": {"degree": 3, "method": "ols"},
    "least angles, order 8": {"degree": 8, "method": "lars"},
    "Gaussian process": {"method": "gaussian_process"},
}
Runs = tuple[NDArray[np.float64], NDArray[np.float64]]


def runs(design: str) -> Runs:
    rows = read_rows(RUNS / f"{design}.csv", {}, str)

    def column(name: str) -> list[float]:
        title = next(title for title in rows[0] if title.startswith(f"{name} ["))
        return [float(row[title]) for row in rows]

    x = np.array([column(f"input:{name}") for name in INPUTS]).T
    return x, np.array([column(f"output:{name}") for name in OUTPUTS]).T


def together(*parts: Runs) -> Runs:
    x, y = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    _, first = np.unique(x, axis=0, return_index=True)
    return x[first], y[first]


def scored(training: Runs, fresh: Runs, options: dict[str, Any]) -> dict[str, dict[str, float]]:
    found = fit(INPUTS, *training, output_names=OUTPUTS, **options).score(*fresh)
    return {output: {key: found[output][key] for key in ("mape", "q2", "rmse")} for output in OUTPUTS}


def main() -> None:
    x, y = runs("test_all")
    seen, fresh = (x[:HELD_BACK], y[:HELD_BACK]), (x[HELD_BACK:], y[HELD_BACK:])
    grid = together(runs("screening"), runs("refined"))
    drawn = together(runs("test_kept"), seen)
    rows = []
    for name, training in {"both grids": grid, "drawn": drawn, "grids and drawn": together(grid, drawn)}.items():
        for way, options in WAYS.items():
            scores, cost = timed(partial(scored, training, fresh, options))
            rows.append({"runs": name, "count": len(training[0]), "fit": way, "cpu_s": cost, "scores": scores})
            print(rows[-1], flush=True)
    content = {**origin("validation/paper_fits.py"), "fresh_runs": len(fresh[0]), "fits": rows}
    write_document(Path(__file__).with_suffix(".json"), content)


if __name__ == "__main__":
    main()
