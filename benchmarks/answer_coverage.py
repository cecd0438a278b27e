"""How often intervals of single answers hold, where no other script counts it: studies whose truth is known.

    python benchmarks/answer_coverage.py [--studies 300]

240 runs on 24 beds, or grounds, that differ. Mean direction and resultant length of an angle; the mean miss over
grounds and on one further ground; fraction and median as curves of the size of the grains; the distance of an input
among the runs that meet a limit state; the parts of the variance of soil, arrival, attitude, bed and all else; and the
interval of a number of independent landers, by the binomial law. Writes benchmarks/results/answer_coverage.csv, .json.
"""

import math
from collections.abc import Iterator

import numpy as np
from harness import RESULTS, Row, command_line, rounded, write_made, write_rows
from scipy import special, stats

from lithobrake.analysis import Estimate, direction_estimate, failure_inputs, variance_shares, wilson_interval
from lithobrake.analysis.confidence import LEVEL, normal_quantile
from lithobrake.analysis.mean_over_grounds import mean_over_beds, mean_over_grounds
from lithobrake.analysis.smooth_curve import curve_sizes, median_curve, share_curve
from lithobrake.chaos import Uniform, sobol_sequence

TABLE = RESULTS / "answer_coverage.csv"
COLUMNS = ("quantity", "runs", "beds", "studies", "held", "half_width")
RUNS, BEDS, LANDERS = 240, 24, (100, 1000, 5000)
# Standard deviations of beds and within them of the angle [rad], and of places [m].
ANGLE, PLACE = (0.3, 0.9), (4.0, 15.0)
# Of the logit of the fraction by the logarithm of the size, and of the beds; of the logarithm of the time.
SLOPE, OF_BED, TIME = 0.8, 0.5, (0.4, 0.3, 0.6)
SIZES, NODES = (0.02, 0.2), np.polynomial.hermite_e.hermegauss(40)
INPUTS = {name: Uniform(0.0, 1.0) for name in ("friction", "speed")}
# Variances of the parts of an output; the attitude is a normal number of its own.
PARTS = {"soil": 0.2, "arrival": 0.1, "attitude": 0.1, "bed": 0.1, "place": 0.5}
# Probability of a limit state at either end of the first input.
FAILS = (0.1, 0.5)

# Whether an interval held, or how often, and half its width.
Held = dict[str, tuple[float, float]]


def held(one: Estimate, true: float) -> tuple[float, float]:
    return float(one.lower <= true <= one.upper), one.half_width or math.nan


def of_beds(random: np.random.Generator, deviations: tuple[float, float], bed: np.ndarray) -> np.ndarray:
    """Normal numbers of runs that share an effect of their bed."""
    between, within = deviations
    return between * random.standard_normal(BEDS)[bed] + within * random.standard_normal(RUNS)


def directions(random: np.random.Generator, bed: np.ndarray) -> Held:
    angle = of_beds(random, ANGLE, bed)
    found = direction_estimate(np.angle(np.exp(1j * angle)), bed)
    length = math.exp(-0.5 * (ANGLE[0] ** 2 + ANGLE[1] ** 2))
    return {"mean direction": held(found.mean_direction, 0.0), "resultant length": held(found.resultant_length, length)}


def misses(random: np.random.Generator, bed: np.ndarray) -> Held:
    """One ground is held as often as its mean, normal over the grounds, lies within the bounds."""
    places = of_beds(random, PLACE, bed)
    mean, one = mean_over_beds(places, bed), mean_over_grounds(places, bed)
    lower, upper = (special.ndtr(end / PLACE[0]) for end in one.bounds or (0.0, 0.0))
    return {"mean miss": held(mean, 0.0), "mean miss on one ground": (float(upper - lower), one.half_width or 0.0)}


def curves(random: np.random.Generator, bed: np.ndarray) -> Held:
    """How much of the curves is held, over sizes from the smallest to the largest."""
    size = np.exp(random.uniform(*np.log(SIZES), BEDS))[bed]
    effect = random.standard_normal((2, BEDS))[:, bed]
    middle = 0.5 * np.log(SIZES).sum()
    chance = special.expit(1.0 + SLOPE * (np.log(size) - middle) + OF_BED * effect[0])
    time = np.exp(TIME[0] * (np.log(size) - middle) + TIME[1] * effect[1] + TIME[2] * random.standard_normal(RUNS))
    at = np.log(curve_sizes(size)) - middle
    nodes, weights = NODES
    share = special.expit(1.0 + SLOPE * at[:, None] + OF_BED * nodes) @ weights / weights.sum()
    found = {
        "curve of the fraction": (share_curve((random.random(RUNS) < chance).astype(float), size, bed, 1), share),
        "curve of the median": (median_curve(time, size, bed, 1), np.exp(TIME[0] * at)),
    }
    kept = {name: np.array([held(one, y) for one, y in zip(*both, strict=True)]) for name, both in found.items()}
    return {name: (float(one[:, 0].mean()), float(np.nanmean(one[:, 1]))) for name, one in kept.items()}


def inputs_and_parts(random: np.random.Generator, bed: np.ndarray, seed: int) -> Held:
    """Distance of the first input among the runs that meet a limit state, and parts of the variance of an output."""
    x, low, high = sobol_sequence(INPUTS, RUNS, seed=seed), *FAILS
    failing = (random.random(RUNS) < low + (high - low) * x[:, 0]).astype(float)
    at = np.linspace(0.0, 1.0, 1001)
    distance = float(np.abs((low * at + 0.5 * (high - low) * at**2) / (low + 0.5 * (high - low)) - at).max())
    found = {"distance of an input": held(failure_inputs(INPUTS, x, failing, bed, seed)["friction"].distance, distance)}
    attitude = random.standard_normal((RUNS, 1))
    of_inputs = math.sqrt(12.0) * (x - 0.5)
    y = np.column_stack([of_inputs, attitude]) @ np.sqrt([PARTS[name] for name in ("soil", "arrival", "attitude")])
    y += of_beds(random, (math.sqrt(PARTS["bed"]), math.sqrt(PARTS["place"])), bed)
    parts = variance_shares(INPUTS, x, y, bed, soil=["friction"], attitude=attitude)
    return found | {f"part of {name}": held(getattr(parts, name), share) for name, share in PARTS.items()}


def independent() -> Iterator[Row]:
    """The interval of a number of landers, over all numbers by the binomial law and fractions from 0.01 to 0.99."""
    for total in LANDERS:
        ends = np.array([wilson_interval(count, total, normal_quantile()) for count in range(total + 1)])
        for fraction in (0.01, 0.1, 0.5, 0.9, 0.99):
            chance = stats.binom.pmf(np.arange(total + 1), total, fraction)
            is_held = (ends[:, 0] <= fraction) & (fraction <= ends[:, 1])
            half = 0.5 * float(chance @ (ends[:, 1] - ends[:, 0]))
            told = {"quantity": f"number of landers, fraction {fraction:g}", "runs": total}
            yield told | {"held": float(chance @ is_held), "half_width": half}


def rows(studies: int) -> Iterator[Row]:
    found: dict[str, list[tuple[float, float]]] = {}
    for seed in range(studies):
        random = np.random.default_rng([66, seed])
        bed = random.permutation(np.arange(RUNS) % BEDS)
        every = (
            directions(random, bed) | misses(random, bed) | curves(random, bed) | inputs_and_parts(random, bed, seed)
        )
        for name, one in every.items():
            found.setdefault(name, []).append(one)
    for name, ones in found.items():
        share, half = np.nanmean(ones, axis=0)
        told = {"quantity": name, "runs": RUNS, "beds": BEDS, "studies": studies}
        yield told | {"held": float(share), "half_width": float(half)}
    yield from independent()


def main() -> None:
    studies = command_line(__doc__, studies=300).parse_args().studies
    write_rows(TABLE, COLUMNS, map(rounded, rows(studies)))
    write_made(TABLE, f"benchmarks/answer_coverage.py --studies {studies}", studies=studies, level=LEVEL)


if __name__ == "__main__":
    main()
