"""Does the scrambled Sobol sequence make the return fraction scatter less than its interval says?

    python validation/sequence_gain.py --repeats 30 --large 20 [--work FOLDER]    real studies, then synthetic ones
    python validation/sequence_gain.py --repeats 0 --large 0                      synthetic ones alone
    python validation/sequence_gain.py --page    the tables of docs/validation/interval_coverage.md

Real: the study of scenarios/first_bounce.toml with 60 landings on 12 beds, one repeat a seed. Each repeat is made twice
on the same beds: with inputs, impact points, azimuths and attitudes from the sequence, and from independent random
numbers. Then so many repeats with 142 landings on 15 beds, from the sequence. sequence_gain.csv gets a row a study as
it ends; one that stands in it is not made again. What smooth functions of the numbers of the sequence explain of single
landings is what it can gain: `explained` has it, from all landings of the folder.

Synthetic: outcomes of a known law at points of the same coordinates. Soil explains a part of their variance by a
straight line and a square, the attitude another by the square of the direction of gravity along the lander's long axis,
beds a third; the rest is chance. sequence_gain_synthetic.csv has them.

For all: variance of the estimate over the repeats, over the mean of the variances that the intervals imply; with the
90 % interval of that ratio for real studies.
"""

import math
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from scipy import stats

from lithobrake.analysis import LEVEL, regression_terms, share_estimate
from lithobrake.analysis.confidence import bed_components, numbered_beds, t_quantile
from lithobrake.analysis.share_estimate import standard_error
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.bed_order import beds_of_runs
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.run_flights import RunFlights
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import StudySource, check_tables

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import (
    SCENARIOS,
    Row,
    add_row,
    command_line,
    origin,
    read_document,
    read_rows,
    rounded,
    study_tables,
    write_document,
    write_rows,
)
from page import table

TABLE = Path(__file__).with_suffix(".csv")
SYNTHETIC = TABLE.with_stem("sequence_gain_synthetic")
RUNS, BEDS, FIRST_SEED = 60, 12, 301
LARGE_RUNS, LARGE_BEDS, FIRST_LARGE = 142, 15, 401
POINTS = ("sequence", "random")


def tables(seed: int, runs: int = RUNS, beds: int = BEDS) -> Row:
    changes = {"bed": {"bed_count": beds}, "design": {"run_count": runs}}
    return study_tables(SCENARIOS / "first_bounce.toml", changes, seed=seed)


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
    found = share_estimate(values, bed, terms=regression_terms(design.inputs, x)).share
    known = np.isfinite(values)
    y, beds = values[known], numbered_beds(bed[known], int(known.sum()))
    assert found.lower is not None
    assert found.upper is not None
    implied = (found.upper - found.lower) / 2.0 / t_quantile(int(beds.max()))
    return {
        "share": found.value, "implied_se": implied, "mean": float(y.mean()),
        "mean_se": standard_error(y, beds), "independent_se": float(y.std(ddof=1) / math.sqrt(len(y))),
        "missing": int((~known).sum()),
    }  # fmt: skip


def make(work: Path, runs: int, beds: int, seeds: range, kinds: tuple[str, ...]) -> None:
    """Make the real studies that are missing, kinds of points in turn."""
    for seed in seeds:
        for kind in kinds:
            if any((row["seed"], row["points"]) == (seed, kind) for row in kept_rows()):
                continue
            out, wanted = work / f"{seed}_{kind}", tables(seed, runs, beds)
            with with_points(kind):
                run_study(StudySource.of_tables(wanted), out, until="fly_runs", worker_count=1)
                bed = DesignRuns.load(StudyFolder(out), "drawn").inputs["bed"].astype(int)
                values = RunFlights.load(StudyFolder(out), "drawn").returns
                design = DrawnDesign(check_tables(wanted, SCENARIOS))
                row = {"seed": seed, "points": kind, "runs": runs, "beds": beds, **estimate(design, values, bed)}
                np.savez(out / "gain.npz", x=design._points(runs), y=values, bed=bed)
            add_row(TABLE, row, digits=6)


def kept_rows() -> list[Row]:
    """The table of real studies as it stands."""
    return read_rows(TABLE, {"seed": int, "points": str, "runs": int, "beds": int, "missing": int})


def compared(rows: list[Row]) -> Row:
    """Scatter of repeats beside what their intervals imply [points], and the ratio of variances with its interval."""
    shares = np.array([row["share"] for row in rows])
    implied = math.sqrt(np.mean([row["implied_se"] ** 2 for row in rows]))
    independent = math.sqrt(np.mean([row["independent_se"] ** 2 for row in rows]))
    freedom, scatter = len(rows) - 1, float(shares.std(ddof=1))
    ratio = (scatter / implied) ** 2
    bounds = [ratio * freedom / float(stats.chi2.ppf(tail, freedom)) for tail in (0.5 + LEVEL / 2, 0.5 - LEVEL / 2)]
    return {
        "repeats": len(rows), "mean": float(shares.mean()), "scatter_points": 100 * scatter,
        "implied_points": 100 * implied, "independent_points": 100 * independent, "ratio": ratio,
        "ratio_interval": bounds, "chance_of_less": float(stats.chi2.cdf(ratio * freedom, freedom)),
    }  # fmt: skip


def explained(work: Path) -> Row:
    """Parts of the variance of single landings by smooth functions of one coordinate, and by beds; with its errors."""
    design = DrawnDesign(check_tables(tables(FIRST_SEED), SCENARIOS))
    files = [np.load(path) for path in sorted(work.glob("*/gain.npz"))]
    y = np.concatenate([one["y"] for one in files])
    points = np.concatenate([one["x"] for one in files])
    beds = np.concatenate([one["bed"] + 100 * number for number, one in enumerate(files)])
    found = {}
    for (name, law), column in zip(design.coordinates.items(), points.T, strict=True):
        waves = np.cos(np.pi * np.outer(law.cdf(column), np.arange(7)))
        left = y - waves @ np.linalg.lstsq(waves, y, rcond=None)[0]
        found[name] = 1.0 - float(left @ left) / (len(y) - waves.shape[1]) / float(y.var(ddof=1))
    correlation = bed_components(y, numbered_beds(beds, len(y))).correlation
    return {
        "landings": len(y), "standard_deviation": float(y.std(ddof=1)), "by_coordinate": found,
        "bed": {"value": correlation.value, "lower": correlation.lower, "upper": correlation.upper},
        "half_width_with_attitude": {runs: with_attitude(design, files, runs) for runs in (RUNS, LARGE_RUNS)},
    }  # fmt: skip


def with_attitude(design: DrawnDesign, files: list[Any], runs: int) -> float:
    """Mean half width of studies of so many landings by a regression on soil and attitude over that on soil alone."""
    widths = []
    for one in (one for one in files if len(one["y"]) == runs):
        terms = regressions(design, one["x"])
        found = [share_estimate(one["y"], one["bed"], terms=two).share for two in terms]
        widths.append([(two.upper or 1.0) - (two.lower or 0.0) for two in found])
    soil, attitude = np.mean(widths, axis=0)
    return float(attitude / soil)


def regressions(design: DrawnDesign, x: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Terms and indices at points [run_count, coordinate_count]: of soil, and of soil and attitude."""
    soil, indices = regression_terms(design.inputs, x[:, : len(design.inputs)])
    # Its one term counts as linear.
    one = np.eye(1, indices.shape[1], dtype=indices.dtype)
    return [(soil, indices), (np.column_stack([soil, long_axis(x[:, -3])]), np.vstack([indices, one]))]


def long_axis(uniforms: np.ndarray) -> np.ndarray:
    """Square of the part of gravity along the lander's z axis less its mean, of variance 1, from "attitude 1"."""
    along = 2.0 * uniforms - 1.0
    return (along**2 - 1.0 / 3.0) / math.sqrt(4.0 / 45.0)


def outcomes(uniforms: np.ndarray, bed: np.ndarray, parts: tuple[float, float, float], random: Any) -> np.ndarray:
    """Outcomes of mean 0.5 and standard deviation 0.1 [run_count] at points [run_count, coordinate_count] of 0 to 1.

    parts: of the variance, by soil (the first two coordinates), attitude (the third from the end), and beds.
    """
    line, square = (math.sqrt(12.0) * (uniforms[:, k] - 0.5) for k in (0, 1))
    soil = math.sqrt(0.7) * line + math.sqrt(0.3) * (square**2 - 1.0) / math.sqrt(0.8)
    even = math.sqrt(12.0) * (random.random((2, len(bed))) - 0.5)
    of_bed = even[1][bed]
    sums = (soil, long_axis(uniforms[:, -3]), of_bed, even[0])
    weights = np.sqrt([*parts, 1.0 - sum(parts)])
    return np.clip(0.5 + 0.1 * sum(weight * one for weight, one in zip(weights, sums, strict=True)), 0.0, 1.0)


def synthetic(runs: int, beds: int, parts: tuple[float, float, float], kind: str, count: int) -> Iterator[Row]:
    """Many studies of one setting, their regression with soil alone, and with the attitude."""
    bed, shares, implied, held = np.empty(0), [[], []], [[], []], [[], []]
    for seed in range(count):
        design = DrawnDesign(check_tables(tables(seed, runs, beds), SCENARIOS))
        with with_points(kind):
            x = design._points(runs)
        laws = design.coordinates.values()
        uniforms = np.column_stack([law.cdf(column) for law, column in zip(laws, x.T, strict=True)])
        bed = np.array(beds_of_runs(design.study, runs))
        y = outcomes(uniforms, bed, parts, np.random.default_rng([seed, runs]))
        for way, terms in enumerate(regressions(design, x)):
            found = share_estimate(y, bed, terms=terms).share
            assert found.lower is not None
            assert found.upper is not None
            shares[way].append(found.value)
            implied[way].append((found.upper - found.lower) / 2.0 / t_quantile(beds - 1))
            held[way].append(found.lower <= 0.5 <= found.upper)
    for way, name in enumerate(("soil", "soil and attitude")):
        square = float(np.mean(np.square(implied[way])))
        yield {
            "runs": runs, "beds": beds, "soil": parts[0], "attitude": parts[1], "bed": parts[2], "points": kind,
            "regression": name, "studies": count, "ratio": float(np.var(shares[way], ddof=1)) / square,
            "held": float(np.mean(held[way])), "implied_over_independent": square / (0.01 / runs),
        }  # fmt: skip


def synthetic_rows(count: int) -> Iterator[Row]:
    """All settings: as measured, more of either, and beds with an effect."""
    settings = ((0.0, 0.0, 0.0), (0.015, 0.065, 0.0), (0.06, 0.09, 0.05), (0.3, 0.0, 0.0), (0.0, 0.3, 0.0))
    for runs, beds in ((RUNS, BEDS), (LARGE_RUNS, LARGE_BEDS)):
        for parts in settings:
            for kind in POINTS:
                yield from map(rounded, synthetic(runs, beds, parts, kind, count))
                print(runs, beds, parts, kind, flush=True)


def page_tables() -> str:
    """Both tables in Markdown: real studies, then synthetic ones."""
    lines = []
    for name, one in read_document(TABLE.with_suffix(".json"))["real"].items():
        low, high = one["ratio_interval"]
        widths = f"{one['scatter_points']:.2f}", f"{one['implied_points']:.2f}"
        lines.append((*name.split(", "), str(one["repeats"]), *widths, f"{one['ratio']:.2f} ({low:.2f}-{high:.2f})"))
    heads = ("landings, beds", "design points", "repeats", "scatter [points]", "implied [points]",
             "ratio of variances")  # fmt: skip
    found: dict[tuple[str, str], dict[tuple[str, str], str]] = {}
    for row in read_rows(SYNTHETIC, {}, others=str):
        of = (row["runs"], f"{float(row['soil']):g}, {float(row['attitude']):g}, {float(row['bed']):g}")
        said = f"{float(row['ratio']):.2f} ({float(row['held']):.2f})"
        found.setdefault(of, {})[row["points"], row["regression"]] = said
    ways = (("random", "soil"), ("sequence", "soil"), ("sequence", "soil and attitude"))
    columns = ("landings", "parts of soil, attitude, beds", "random points", "sequence",
               "sequence, attitude in the regression")  # fmt: skip
    synthetic = table(columns, ((*of, *(row[way] for way in ways)) for of, row in found.items()))
    return f"{table(heads, lines)}\n\n{synthetic}\n"


def main() -> None:
    work = Path(tempfile.gettempdir()) / "lithobrake_sequence_gain"
    options = command_line(__doc__, work=work, repeats=30, large=20, studies=400, page=False).parse_args()
    if options.page:
        print(page_tables())
        return
    make(options.work, RUNS, BEDS, range(FIRST_SEED, FIRST_SEED + options.repeats), POINTS)
    make(options.work, LARGE_RUNS, LARGE_BEDS, range(FIRST_LARGE, FIRST_LARGE + options.large), POINTS[:1])
    command = f"validation/sequence_gain.py --repeats {options.repeats} --large {options.large}"
    groups = {
        f"{runs} landings on {beds} beds, {kind}": [
            row for row in kept_rows() if (row["runs"], row["points"]) == (runs, kind)
        ]
        for runs, beds, kind in ((RUNS, BEDS, "sequence"), (RUNS, BEDS, "random"), (LARGE_RUNS, LARGE_BEDS, "sequence"))
    }
    real = {name: compared(rows) for name, rows in groups.items() if len(rows) > 1}
    if any(options.work.glob("*/gain.npz")):
        document = {**origin(command), "level": LEVEL, "real": real, "explained": explained(options.work)}
        write_document(TABLE.with_suffix(".json"), document)
    if options.studies:
        columns = ("runs", "beds", "soil", "attitude", "bed", "points", "regression", "studies", "ratio", "held")
        write_rows(SYNTHETIC, (*columns, "implied_over_independent"), synthetic_rows(options.studies))


if __name__ == "__main__":
    main()
