"""Do the points of the scrambled Sobol sequence make the return fraction scatter less than its interval says?

    python validation/sequence_gain.py --repeats 40 [--work FOLDER]    real studies, then synthetic ones
    python validation/sequence_gain.py --repeats 0                     synthetic ones alone

Real: the study of scenarios/first_bounce.toml with 60 landings on 12 beds, one repeat a seed. Each repeat is made
twice on the same beds: with inputs, impact points, azimuths and attitudes from the sequence, and from independent
random numbers. sequence_gain.csv gets a row a study as it ends; one that stands in it is not made again.

Synthetic: outcomes of a known law at the very points of these studies, from 60 to 240 landings, by how much of the
variance a smooth function of the coordinates explains, and a function of the attitude as it is turned into it.

For both: variance of the estimate over the repeats, over the variance that the intervals imply on average; and the
same for the plain mean with the standard error of independent landings, whose square has no bias for random points.
"""

import math
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from scipy import special

from lithobrake.analysis import LEVEL, regression_terms, share_estimate
from lithobrake.analysis.confidence import numbered_beds, t_quantile
from lithobrake.analysis.share_estimate import standard_error
from lithobrake.files.hashing import hashed_seed
from lithobrake.geometry.attitude import uniform_attitude
from lithobrake.pipeline.design.drawn_design import DRAWN, DrawnDesign
from lithobrake.pipeline.fly.run_flights import RunFlights
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import Study, StudySource, check_tables

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, Row, add_row, command_line, origin, read_rows, rounded, write_document

TABLE = Path(__file__).with_suffix(".csv")
RUNS, BEDS, FIRST_SEED = 60, 12, 301
POINTS = ("sequence", "random")


def tables(seed: int, runs: int = RUNS, beds: int = BEDS) -> Row:
    """The study of the first bounce with so many landings."""
    study: Row = tomllib.loads((SCENARIOS / "first_bounce.toml").read_text(encoding="utf-8")) | {"seed": seed}
    study["bed"] |= {"bed_count": beds}
    study["design"] |= {"run_count": runs}
    return study


def random_points(design: DrawnDesign, count: int, skip: int = 0) -> np.ndarray:
    """Independent random points in the place of those of the sequence, [count, coordinate_count]."""
    generator = np.random.default_rng(hashed_seed(design.study.seed, "random points"))
    uniforms = generator.random((skip + count, len(design.coordinates)))[skip:]
    laws = design.coordinates.values()
    return np.column_stack([law.ppf(column) for law, column in zip(laws, uniforms.T, strict=True)])


def with_points(kind: str) -> Any:
    """Designs that take these points."""
    return patch.object(DrawnDesign, "_points", random_points if kind == "random" else DrawnDesign._points)


def estimate(design: DrawnDesign, values: np.ndarray, bed: np.ndarray) -> Row:
    """What a study says of its fraction, and what its plain mean does."""
    x = design._points(len(values))[:, : len(design.inputs)]
    found = share_estimate(values, bed, terms=regression_terms(design.inputs, x))
    known = np.isfinite(values)
    y, beds = values[known], numbered_beds(bed[known], int(known.sum()))
    assert found.lower is not None
    assert found.upper is not None
    implied = (found.upper - found.lower) / 2.0 / t_quantile(int(beds.max()))
    return {
        "share": found.share, "implied_se": implied, "mean": float(y.mean()),
        "mean_se": standard_error(y, beds), "independent_se": float(y.std(ddof=1) / math.sqrt(len(y))),
        "missing": int((~known).sum()),
    }  # fmt: skip


def make(work: Path, repeats: int) -> None:
    """Make the real studies that are missing, both kinds of points in turn."""
    done = {(row["seed"], row["points"]) for row in kept_rows()}
    for seed in range(FIRST_SEED, FIRST_SEED + repeats):
        for kind in POINTS:
            if (seed, kind) in done:
                continue
            start, out = time.process_time(), work / f"{seed}_{kind}"
            with with_points(kind):
                run_study(StudySource.of_tables(tables(seed)), out, until="fly_runs", worker_count=1)
                folder = StudyFolder(out)
                runs, flights = DesignRuns.load(folder, "drawn"), RunFlights.load(folder, "drawn")
                design = DrawnDesign(check_tables(tables(seed), SCENARIOS))
                row = estimate(design, flights.returns, runs.inputs["bed"].astype(int))
                np.savez(out / "gain.npz", x=design._points(RUNS), y=flights.returns, bed=runs.inputs["bed"])
            add_row(TABLE, {"seed": seed, "points": kind, **row, "cpu_s": time.process_time() - start}, digits=6)


def kept_rows() -> list[Row]:
    """The table as it stands."""
    return read_rows(TABLE, {"seed": int, "points": str})


if __name__ == "__main__":
    make(Path(sys.argv[1]), int(sys.argv[2]))
