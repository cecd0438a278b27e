"""How often intervals hold the truth where runs are lost, not at random, at each place that shows an interval.

    python benchmarks/missing_coverage.py [--studies 400]

Synthetic studies of 240 landings on 24 beds (rho 0.05) lose 3 or 10 % of those that leave: any of them, or the fastest.
First page: return fraction, mean and quantiles of the rebound speed. Sensitivity: parts of its variance that soil and
bed explain, of a strong soil. Limit state: a rebound faster than 0.12 m/s. Comparison: the same landings with a
sixth more speed, which lose more. Inference: one bounce of a soil, which may be one that the runs have lost. Aim: the
fraction of the best of twelve options, its difference to the second, and the set that holds the best; landers at rest
are lost at every second option, others at the rest. Beside each the coverage of the runs that are known alone.
Writes benchmarks/results/missing_coverage.csv, and .json beside it.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np
from best_choice_coverage import NODES, WEIGHTS, Setting, landers, logits
from estimate_coverage import DRAW_COUNT, exact_share, exact_speed
from harness import RESULTS, Row, command_line, rounded, write_made, write_rows
from inference_calibration import OBSERVED, fitted
from scipy import special
from synthetic_landings import INPUTS, OUTPUT_NAMES, SPEED_LIMIT, Truth, random_soils, returns

from lithobrake.analysis import (
    Estimate,
    Observation,
    best_choice,
    failure_probability,
    infer,
    mean_estimate,
    posterior,
    quantile_difference,
    quantile_estimate,
    share_difference,
    share_estimate,
    variance_shares,
)
from lithobrake.analysis.confidence import LEVEL
from lithobrake.chaos import sobol_sequence
from lithobrake.emulator import form_choice

TABLE = RESULTS / "missing_coverage.csv"
COLUMNS = ("place", "quantity", "lost", "which", "studies", "held", "held_by_known", "half_width")
RUNS, BEDS, SHARES, WHICH = 240, 24, (0.03, 0.1), ("random", "fast")
PROBABILITIES, FAST, FASTER = (0.05, 0.5, 0.95), 0.12, 7.0 / 6.0
LIMITS = (0.0, SPEED_LIMIT)
# Bounces for each emulator, and what an inference takes.
CASES_AN_EMULATOR, REFITS, POINTS = 25, 2, 1024
AIMS = (Setting("spread", 12, 24, 0.7), Setting("half", 12, 24, 0.7))

# What is found of each study: an estimate as it is used, the same of the runs that are known, and the truth.
Found = dict[tuple[str, str], tuple[Estimate, Estimate, float]]


@lru_cache
def exact(truth: Truth) -> dict[str, float]:
    """The truths of all landings, lost or not."""
    x, rng = random_soils(DRAW_COUNT, np.random.default_rng(31)), np.random.default_rng(32)
    whole = replace(truth, rim="none").draw(x, rng.standard_normal(DRAW_COUNT), rng)
    speed, faster = whole.left[:, 0], with_more_speed(whole.left)
    found = exact_speed(truth) | {"fraction": exact_share(truth), "event": float((speed > FAST).mean())}
    found["difference"] = float((returns(faster, whole.outcome) - returns(whole.left, whole.outcome)).mean())
    found["median"] = float(np.nanmedian(faster[:, 0]) - np.nanmedian(speed))
    return found


def with_more_speed(left: np.ndarray) -> np.ndarray:
    """The same landings with more speed, up to the limit."""
    faster = left.copy()
    faster[:, 0] = np.minimum(FASTER * left[:, 0], 0.99 * SPEED_LIMIT)
    return faster


def landings(truth: Truth, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Soils, beds, rebounds [run_count, 4] without a rim and outcomes, "clear" or "captured", of a study."""
    rng = np.random.default_rng([seed, 62])
    x, bed = sobol_sequence(INPUTS, RUNS, seed=seed), rng.permutation(np.arange(RUNS) % BEDS)
    found = replace(truth, rim="none").draw(x, rng.standard_normal(BEDS)[bed], rng)
    return x, bed, found.left, found.outcome


def lost_of(truth: Truth, left: np.ndarray, seed: int) -> np.ndarray:
    """Which of these landings are lost; of two studies by the same chance."""
    chance = truth._rim_chance(np.nan_to_num(left))
    return np.isfinite(left[:, 0]) & (np.random.default_rng([seed, 63]).random(len(left)) < chance)


def one_study(truth: Truth, seed: int) -> Found:
    """First page, limit state and comparison of a study."""
    _, bed, left, outcome = landings(truth, seed)
    lost, true = lost_of(truth, left, seed), exact(truth)
    speed, h = np.where(lost, np.nan, left[:, 0]), np.where(lost, np.nan, returns(left, outcome))
    known = ~lost
    found: Found = {
        ("first page", "return fraction"): (
            share_estimate(h, bed).share,
            share_estimate(h[known], bed[known]).share,
            true["fraction"],
        ),
        ("first page", "mean speed"): (
            mean_estimate(speed, bed, missing=lost, limits=LIMITS), mean_estimate(speed, bed), true["mean"],
        ),
    }  # fmt: skip
    for p in PROBABILITIES:
        both = quantile_estimate(speed, bed, p, missing=lost), quantile_estimate(speed, bed, p)
        found["first page", f"{p:g} quantile of the speed"] = (*both, true[f"quantile {p:g}"])
    met = np.where(lost, np.nan, (left[:, 0] > FAST).astype(float))
    states = (
        failure_probability(met, bed),
        failure_probability(met[known], bed[known]),
    )
    found["limit state", "probability"] = (*(one.probability for one in states), true["event"])
    return found | compared(truth, seed, (h, speed, lost))


def split(truth: Truth, seed: int) -> Found:
    """Parts of the variance of the speed of a study."""
    x, bed, left, _ = landings(truth, seed)
    lost, true = lost_of(truth, left, seed), exact(truth)
    speed = np.where(lost, np.nan, left[:, 0])
    parts = [
        variance_shares(INPUTS, x, speed, bed, soil=tuple(INPUTS), missing=one, limits=LIMITS) for one in (lost, None)
    ]
    return {
        ("sensitivity", f"part of the {name}"): (
            *(getattr(one, name) for one in parts),
            max(true[f"{name} share"], 0.0),
        )
        for name in ("soil", "bed")
    }


def compared(truth: Truth, seed: int, first: tuple[np.ndarray, np.ndarray, np.ndarray]) -> Found:
    """The same landings with more speed, less these: return fraction, median speed and lost runs of `first`."""
    _, bed, left, outcome = landings(truth, seed)
    faster, true, (h, speed, lost) = with_more_speed(left), exact(truth), first
    gone = lost_of(truth, faster, seed)
    other, other_speed = np.where(gone, np.nan, returns(faster, outcome)), np.where(gone, np.nan, faster[:, 0])
    both = ~lost & ~gone
    shares = share_difference(h, other, bed), share_difference(h[both], other[both], bed[both])
    medians = (
        quantile_difference(speed, other_speed, bed, 0.5, missing=(lost, gone)),
        quantile_difference(speed, other_speed, bed, 0.5),
    )
    return {
        ("comparison", "return fraction"): (*(one.difference for one in shares), true["difference"]),
        ("comparison", "median speed"): (*(one.difference for one in medians), true["median"]),
    }


def inferred(truth: Truth, cases: int) -> Iterator[Found]:
    """One bounce of each of some soils, as it would be without a rim, by emulators of studies with one."""
    random = np.random.default_rng(64)
    for case, soil in enumerate(random_soils(cases, random)):
        if case % CASES_AN_EMULATOR == 0:
            model = fitted(truth, 100 + case)
        left = replace(truth, rim="none", capture=0.0).draw(soil[None], random.standard_normal(1), random).left[0]
        bounce = dict(zip(OUTPUT_NAMES, left.tolist(), strict=True))
        seen = [Observation({name: bounce[name] for name in OBSERVED})]
        found = infer(model, seen, refit_count=REFITS, point_count=POINTS, seed=case, missing=["left_sideways"])
        of_all, of_known = (one.learnt() for one in (found, replace(found, open_weight=None)))
        yield {
            ("inference", name): (of_all[name].after, of_known[name].after, float(value))
            for name, value in zip(INPUTS, soil, strict=True)
        }


def aimed(setting: Setting, share: float, studies: int) -> Iterator[Found]:
    """The best of some options where landers are lost: of those at rest at every second one, of the others at the rest.

    The set that holds the best is an estimate of 1 whose interval is either point.
    """
    random = np.random.default_rng([65, round(100 * share), setting.options])
    for _ in range(studies):
        middle = logits(setting, random)
        truth = special.expit(middle[:, None] + setting.bed_spread * NODES) @ WEIGHTS / WEIGHTS.sum()
        common = math.sqrt(0.5) * random.standard_normal((setting.beds, 1))
        effects = common + math.sqrt(0.5) * random.standard_normal((setting.beds, setting.options))
        met = landers(special.expit(middle + setting.bed_spread * effects), 50, random)
        is_rest = (np.arange(setting.options) % 2 == 0)[:, None, None]
        may = np.where(is_rest, met, 1.0 - met)
        part = share / np.maximum(may.mean(axis=(1, 2), keepdims=True), share)
        lost = (may == 1.0) & (random.random(met.shape) < part)
        known = np.where(lost, np.nan, met), np.where(lost, 0.0, met)
        found = [best_choice(one, setting.beds, [True] * setting.options) for one in known]
        row: Found = {}
        for name, words in (("own", "fraction of the best"), ("difference", "best less second")):
            ones = [getattr(one, name) for one in found]
            trues = [truth[one.best] - (truth[one.runner_up] if name == "difference" else 0.0) for one in found]
            # With lost ones as not at rest another option may be chosen, which has a truth of its own.
            moved = float(trues[0] - trues[1])
            of_known = replace(ones[1], lower=ones[1].lower + moved, upper=ones[1].upper + moved)
            row["aim", words] = ones[0], of_known, float(trues[0])
        sets = [float(int(truth.argmax()) in one.not_worse) for one in found]
        row["aim", "set that holds the best"] = (Estimate(1.0, sets[0], sets[0]), Estimate(1.0, sets[1], sets[1]), 1.0)
        yield row


def summed(studies: list[Found], told: Row) -> Iterator[Row]:
    """A row for each quantity: how often the intervals held, and how wide they are where they have both ends."""
    for place, quantity in studies[0]:
        found = [one[place, quantity] for one in studies]
        widths = [one.half_width for one, _, _ in found if one.half_width is not None]
        yield (
            {"place": place, "quantity": quantity}
            | told
            | {
                "studies": len(found),
                "held": float(np.mean([holds(one, true) for one, _, true in found])),
                "held_by_known": float(np.mean([holds(one, true) for _, one, true in found])),
                "half_width": float(np.mean(widths)) if widths else "",
            }
        )


def holds(one: Estimate, true: float) -> bool:
    """Whether an interval holds; an end that is not bounded holds all beyond."""
    return (one.lower is None or one.lower <= true) and (one.upper is None or true <= one.upper)


def rows(studies: int) -> Iterator[Row]:
    for share in SHARES:
        for which in WHICH:
            told = {"lost": share, "which": which}
            truths = Truth(rim=which, rim_share=share), Truth(rim=which, rim_share=share, soil=3.0)
            yield from summed([one_study(truths[0], seed) for seed in range(studies)], told)
            yield from summed([split(truths[1], seed) for seed in range(studies // 4)], told)
        yield from summed(list(inferred(truths[1], studies // 4)), told | {"which": "fast"})
        for setting in AIMS:
            name = {"which": f"at rest or not, {setting.kind}"}
            yield from summed(list(aimed(setting, share, studies // 2)), told | name)


def main() -> None:
    studies = command_line(__doc__, studies=400).parse_args().studies
    # Of hundreds of posteriors some would take minutes each.
    posterior.can_walk = lambda: False
    # An emulator chooses its form by fewer folds than it would.
    form_choice.MOST_FOLDS = 4
    write_rows(TABLE, COLUMNS, map(rounded, rows(studies)))
    write_made(TABLE, f"benchmarks/missing_coverage.py --studies {studies}", studies=studies, level=LEVEL)


if __name__ == "__main__":
    main()
