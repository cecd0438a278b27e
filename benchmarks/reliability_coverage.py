"""How often the intervals of failure probabilities hold the truth, on limit states of closed form under noise.

    python benchmarks/reliability_coverage.py [--studies 200] [--subset]

A strength R and a load S are the inputs of a stochastic model that gives S - R and scatter on top, normal or skewed
(exponential), a twentieth of it the bed's: the probability that a limit is passed is known in closed form. Rows: what
`failure_probability` says from 240 runs on 24 beds at 0.1, 0.02 and 0.005; what the runs and the emulator say alone;
and `subset_simulation` on limit states of 2 to 100 inputs, beside OpenTURNS where that is installed.
Writes benchmarks/results/reliability_coverage.csv, and .json beside it; with --subset the rows of
`subset_simulation` alone are made anew, and the others stay as they stand there.
"""

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import chain
from typing import Any

import numpy as np
from harness import RESULTS, Row, command_line, origin, read_document, read_rows, rounded, write_document, write_rows
from scipy import stats

from lithobrake import emulator
from lithobrake.analysis import (
    LEVEL,
    drawn_counts,
    failure_probability,
    regression_terms,
    sample_inputs,
    subset_simulation,
)
from lithobrake.chaos import Normal, sobol_sequence

TABLE = RESULTS / "reliability_coverage.csv"
COLUMNS = ("quantity", "scatter", "probability", "repeats", "held", "too_high", "bias", "width", "by_emulator", "cost")
INPUTS = {"strength": Normal(0.0, 1.0), "load": Normal(0.0, 1.0)}
PROBABILITIES = (0.1, 0.02, 0.005)
COMMON = (0.1, 0.05, 0.02, 0.01, 0.005, 1e-3)
RUNS, BEDS, REFITS, DRAWS = 240, 24, 50, 2000
# Of the variance of the response that is the inputs', and of the rest that is the bed's.
EXPLAINED, BED = 0.3, 0.05


@dataclass(frozen=True)
class Truth:
    """A response of variance 1 and mean 0: load less strength, an effect of the bed, and scatter, skewed or normal."""

    skewed: bool

    def study(self, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Inputs [RUNS, 2], response and bed [RUNS] of a study."""
        random = np.random.default_rng(seed)
        x = sobol_sequence(INPUTS, RUNS, seed=seed)
        bed = np.concatenate([random.permutation(BEDS) for _ in range(RUNS // BEDS)])
        scatter = random.exponential(size=RUNS) - 1.0 if self.skewed else random.standard_normal(RUNS)
        rest = math.sqrt(BED) * random.standard_normal(BEDS)[bed] + math.sqrt(1.0 - BED) * scatter
        return x, math.sqrt(EXPLAINED / 2.0) * (x[:, 1] - x[:, 0]) + math.sqrt(1.0 - EXPLAINED) * rest, bed

    def limit(self, probability: float) -> float:
        """What the response passes with this probability."""
        if not self.skewed:
            return float(stats.norm.isf(probability))
        tail, middle = (1.0 - EXPLAINED) * (1.0 - BED), EXPLAINED + (1.0 - EXPLAINED) * BED
        ratio = math.sqrt(tail / middle)
        return float(stats.exponnorm(ratio, loc=-math.sqrt(tail), scale=math.sqrt(middle)).isf(probability))


def one_study(truth: Truth, seed: int) -> dict[str, tuple[float, ...]]:
    """Held, too high, error, width and whether the emulator answered, of each quantity and probability."""
    x, y, bed = truth.study(seed)
    model, refit = emulator.fit(INPUTS, x, y, groups=bed), np.repeat(np.arange(REFITS), DRAWS)
    drawn = np.concatenate(
        [
            one.draw(sample_inputs(INPUTS, DRAWS, 1000 * seed + number), 1, number).y[:, 0, 0]
            for number, one in enumerate(model.refits(REFITS, seed))
        ]
    )
    terms, result = regression_terms(INPUTS, x), {}
    for exact in PROBABILITIES:
        limit = truth.limit(exact)
        found = failure_probability(y > limit, bed, terms=terms, drawn=drawn_counts(drawn > limit, refit, REFITS))
        for name, one in (
            ("failure_probability", found.probability),
            ("runs alone", found.by_runs.share),
            ("emulator alone", found.by_emulator),
        ):
            low, high = one.bounds
            held = (float(low <= exact <= high), float(low > exact), one.value - exact, high - low)
            result[name, exact] = (*held, float(found.source == "emulator"))
    return result


def study_rows(truth: Truth, count: int) -> Iterator[Row]:
    begin = time.process_time()
    studies = [one_study(truth, seed) for seed in range(count)]
    cost = (time.process_time() - begin) / count
    for name, exact in studies[0]:
        mean = np.mean([one[name, exact] for one in studies], axis=0).tolist()
        row = dict(zip(("held", "too_high", "bias", "width", "by_emulator"), mean, strict=True))
        scatter = "skewed" if truth.skewed else "normal"
        yield {"quantity": name, "scatter": scatter, "probability": exact, "repeats": count, "cost": cost} | row


def _linear(points: np.ndarray, exact: float) -> np.ndarray:
    return stats.norm.isf(exact) - points.sum(axis=1) / math.sqrt(points.shape[1])


def _noisy(points: np.ndarray) -> np.ndarray:
    """Strength less load in seven inputs, with scatter of three inputs of its own: normal in all."""
    return stats.norm.isf(1e-3) * math.sqrt(10.0) - points[:, :7].sum(axis=1) - points[:, 7:].sum(axis=1)


# Margin, dimension and probability of limit states of closed form.
LIMIT_STATES: dict[str, tuple[Callable[[np.ndarray], np.ndarray], int, float]] = {
    "linear, 2 inputs": (lambda u: _linear(u, 1e-3), 2, 1e-3),
    "linear, 100 inputs": (lambda u: _linear(u, 1e-4), 100, 1e-4),
    "R - S with noise, 10 inputs": (_noisy, 10, 1e-3),
    "outside a sphere, 3 inputs": (lambda u: math.sqrt(stats.chi2.isf(1e-3, 3)) - np.linalg.norm(u, axis=1), 3, 1e-3),
    "either of two, 5 inputs": (lambda u: stats.norm.isf(1e-4) - np.abs(u[:, 0]), 5, 2e-4),
    # How common a failure may be for levels to gain anything.
    **{f"linear, 12 inputs, {exact:g}": (partial(_linear, exact=exact), 12, exact) for exact in COMMON},
}


def subset_rows(count: int) -> Iterator[Row]:
    for name, (margin, dimension, exact) in LIMIT_STATES.items():
        for points in (500, 1000):
            found = [subset_simulation(margin, dimension, points_per_level=points, seed=seed) for seed in range(count)]
            told = [one.probability for one in found]
            yield {
                "quantity": f"subset simulation, {name}, {points} a level",
                "probability": exact,
                "repeats": count,
                "held": float(np.mean([one.lower <= exact <= one.upper for one in told])),
                "too_high": float(np.mean([one.lower > exact for one in told])),
                "bias": float(np.mean([one.value for one in told])) - exact,
                "width": float(np.std([one.value for one in told])) / exact,
                "cost": float(np.mean([one.evaluation_count for one in found])),
            }


def openturns_rows(count: int) -> Iterator[Row]:
    """The same limit states by OpenTURNS' SubsetSampling, where it is installed; width: over the exact probability."""
    for name, (margin, dimension, exact) in list(LIMIT_STATES.items())[: -len(COMMON)]:
        if openturns() is None:
            return
        found, calls = zip(*(openturns_subset(margin, dimension, 1000, seed) for seed in range(count)), strict=True)
        yield {
            "quantity": f"OpenTURNS SubsetSampling, {name}, 1000 a level", "probability": exact, "repeats": count,
            "bias": float(np.mean(found)) - exact, "width": float(np.std(found)) / exact, "cost": float(np.mean(calls)),
        }  # fmt: skip


@lru_cache
def openturns() -> Any:
    """OpenTURNS, or None."""
    try:
        import openturns as found
    except ImportError:
        return None
    return found


def openturns_subset(
    margin: Callable[[np.ndarray], np.ndarray], dimension: int, points: int, seed: int
) -> tuple[float, int]:
    """Probability that a margin is at most 0, and how many were asked for, by OpenTURNS."""
    ot = openturns()
    ot.RandomGenerator.SetSeed(seed)
    asked = 0

    def margins(sample: Any) -> np.ndarray:
        nonlocal asked
        asked += len(sample)
        return margin(np.array(sample))[:, None]

    law = ot.Normal(dimension)
    output = ot.CompositeRandomVector(ot.PythonFunction(dimension, 1, func_sample=margins), ot.RandomVector(law))
    algorithm = ot.SubsetSampling(ot.ThresholdEvent(output, ot.LessOrEqual(), 0.0))
    algorithm.setMaximumOuterSampling(points)
    algorithm.setBlockSize(1)
    algorithm.run()
    return algorithm.getResult().getProbabilityEstimate(), asked


def main() -> None:
    parser = command_line(__doc__, studies=200)
    parser.add_argument("--subset", action="store_true", help="only the rows of subset_simulation")
    chosen, begin = parser.parse_args(), time.process_time()
    count, facts = chosen.studies, {"studies": chosen.studies, "level": LEVEL, "table": TABLE.name}
    parts = [
        *(study_rows(Truth(skewed), count) for skewed in (False, True)),
        *(subset_rows(count), openturns_rows(max(count // 10, 2))),
    ]
    command = f"benchmarks/reliability_coverage.py --studies {count}"
    if chosen.subset:
        kept = read_rows(TABLE, {}, str)
        before, after = (
            [row for row in kept if row["quantity"].startswith("OpenTURNS") == is_last] for is_last in (False, True)
        )
        before = [row for row in before if not row["quantity"].startswith("subset simulation")]
        parts = [iter(before), subset_rows(count), iter(after)]
    write_rows(TABLE, COLUMNS, map(rounded, chain.from_iterable(parts)))
    measured = {"cpu_s": round(time.process_time() - begin)}
    if chosen.subset:
        facts = read_document(TABLE.with_suffix(".json"))
        facts["subset"] = measured | origin(f"{command} --subset")
    else:
        facts |= measured | origin(command) | {"openturns": getattr(openturns(), "__version__", None)}
    write_document(TABLE.with_suffix(".json"), facts)


if __name__ == "__main__":
    main()
