"""How often the intervals of the estimates hold the truth, on synthetic landings whose laws are known.

    python benchmarks/estimate_coverage.py [--studies 400]

A row a setting and quantity: studies, truth, how often a nominal 90 % interval held it (or 1 less how often nothing was
found where there is nothing), mean error, mean half width. Rivals stand beside what is used: intervals of the next bed
by generalised pivots and by the plain variance of beds; wild bootstrap with Webb's weights where beds are few.
Writes estimate_coverage.csv and .json beside this file. Sources: [Webb-2014], [Krishnamoorthy-2009].
"""

import math
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from harness import ROOT, Row, command_line, rounded, write_made, write_rows
from scipy import special, stats

sys.path.insert(0, str(ROOT / "tests"))
from synthetic_landings import INPUTS, Truth, exact_share, random_soils, returns

from lithobrake.analysis import (
    Estimate,
    chaos_variance,
    mean_estimate,
    quantile_estimates,
    regression_terms,
    share_estimate,
    soil_total_effect,
    variance_shares,
)
from lithobrake.analysis.confidence import LEVEL, BedComponents, bed_components, t_quantile
from lithobrake.analysis.control_variate import control_variate
from lithobrake.analysis.share_estimate import standard_error
from lithobrake.chaos import sobol_sequence

TABLE = Path(__file__).with_suffix(".csv")
COLUMNS = (
    *("quantity", "runs", "beds", "rho", "soil", "rim", "rim_share", "rim_returns"),
    *("studies", "truth", "held", "bias", "half_width"),
)
DESIGNS = ((144, 12), (240, 24))
CORRELATIONS = (0.0, 0.05, 0.2)
PROBABILITIES = (0.05, 0.5, 0.95)
DRAW_COUNT = 400_000
# Beds in equal steps of probability stand for all beds there are.
BED_EFFECTS = special.ndtri((np.arange(200) + 0.5) / 200)
NODES = np.linspace(-3.5, 3.5, 15)


@lru_cache
def bed_means(truth: Truth) -> tuple[np.ndarray, np.ndarray]:
    """Share that returns and mean speed [m/s] on beds of each effect [200], places and soils averaged over."""
    rng = np.random.default_rng(11)
    table = []
    for effect in NODES:
        landings = truth.draw(random_soils(40_000, rng), np.full(40_000, effect), rng)
        chance = returns(landings.left, landings.outcome)
        table.append((chance.mean(), np.nanmean(landings.left[:, 0])))
    share, speed = np.array(table).T
    return np.interp(BED_EFFECTS, NODES, share), np.interp(BED_EFFECTS, NODES, speed)


@lru_cache
def exact_speed(truth: Truth) -> dict[str, float]:
    """Mean, quantiles, and the bed's and the soil's share of the variance, of the speed of landers that leave."""
    rng = np.random.default_rng(12)
    x, beds = random_soils(DRAW_COUNT, rng), rng.standard_normal((2, DRAW_COUNT))
    first, second = (truth.draw(x, effects, rng).left[:, 0] for effects in beds)
    both = np.isfinite(first) & np.isfinite(second)
    variance = float(np.nanvar(first))
    found = {"mean": float(np.nanmean(first))}
    found |= {f"quantile {p:g}": float(np.nanquantile(first, p)) for p in PROBABILITIES}
    # Two landings on one soil have nothing else in common.
    found["soil share"] = float(np.cov(first[both], second[both])[0, 1]) / variance
    return found | {"bed share": float(bed_means(truth)[1].var()) / variance if truth.rho > 0.0 else 0.0}


def held(estimate: Estimate, exact: float) -> tuple[float, float, float]:
    """Whether an interval holds, error, half width."""
    return (
        float(estimate.lower <= exact <= estimate.upper),
        estimate.value - exact,
        0.5 * (estimate.upper - estimate.lower),
    )


def one_study(truth: Truth, run_count: int, bed_count: int, seed: int) -> dict[str, tuple[float, float, float]]:
    """Held, error and half width of every estimate of a study, by quantity."""
    x, y, outcome, bed = truth.study(run_count, bed_count, seed)
    found = share_estimate(returns(y, outcome), bed, terms=regression_terms(INPUTS, x))
    share, beds = exact_share(truth), bed_means(truth)[0]
    result = {"share": held(found.share, share)}
    on_beds = np.mean((found.next_bed[0] <= beds) & (beds <= found.next_bed[1]))
    result["next bed"] = (float(on_beds), 0.0, 0.5 * (found.next_bed[1] - found.next_bed[0]))
    exact, speed = exact_speed(truth), y[:, 0]
    result["mean"] = held(mean_estimate(speed, bed), exact["mean"])
    quantiles = quantile_estimates(speed, bed, PROBABILITIES)
    result |= {
        f"quantile {p:g}": held(one, exact[f"quantile {p:g}"]) for p, one in zip(PROBABILITIES, quantiles, strict=True)
    }
    parts = variance_shares(INPUTS, x, speed, bed, soil=tuple(INPUTS))
    result["bed share"] = held(replace(parts.bed, value=parts.unbiased["bed"]), exact["bed share"])
    soil = replace(parts.soil, value=parts.unbiased["soil"])
    result["soil share"] = held(soil, max(exact["soil share"], 0.0) if truth.soil else 0.0)
    not_found = np.mean([one.lower <= 0.0 for one in parts.soil_by_input.values()])
    return result | {"inputs not found": (float(not_found), 0.0, 0.0)}


def missing(truth: Truth, seed: int) -> dict[str, tuple[float, float, float]]:
    """The share where landings are lost over the rim: as used, and by the landings with an outcome alone."""
    x, y, outcome, bed = truth.study(240, 24, seed)
    h, terms, exactly = returns(y, outcome), regression_terms(INPUTS, x), exact_share(truth)
    known = np.isfinite(h)
    found = {
        "share": share_estimate(h, bed, terms=terms),
        "share, those with an outcome alone": share_estimate(h[known], bed[known], terms=(terms[0][known], terms[1])),
    }
    return {name: held(one.share, exactly) for name, one in found.items()}


def like_missing(truth: Truth, seed: int) -> dict[str, tuple[float, float, float]]:
    """The share where every second landing over the rim has an outcome after all, and stands for the others or not."""
    rng = np.random.default_rng([seed, 7])
    x, bed = sobol_sequence(INPUTS, 240, seed=seed), rng.permutation(np.arange(240) % 24)
    landings = truth.draw(x, rng.standard_normal(24)[bed], rng)
    over = landings.outcome == "left_sideways"
    lost = over & (rng.random(240) < 0.5)
    h, terms = returns(np.where(lost[:, None], np.nan, landings.left), landings.outcome), regression_terms(INPUTS, x)
    found = {
        "share, half of the rim known": share_estimate(h, bed, terms=terms),
        "share, half of the rim known and like the other": share_estimate(h, bed, terms=terms, like_missing=over),
    }
    exactly = exact_share(truth)
    return {name: held(one.share, exactly) for name, one in found.items()}


def table(truth: Truth, run_count: int, bed_count: int, study_count: int, seed: int = 0) -> dict[str, Row]:
    """Coverage, bias and half width of every quantity in one setting."""
    studies = [one_study(truth, run_count, bed_count, seed + k) for k in range(study_count)]
    return {name: summed(studies, name) | {"truth": exact(truth, name)} for name in studies[0]}


def exact(truth: Truth, name: str) -> float | None:
    """The truth of a quantity, where it is one number."""
    return exact_share(truth) if name == "share" else exact_speed(truth).get(name)


def summed(studies: list[dict[str, tuple[float, float, float]]], name: str) -> Row:
    """Coverage, mean error and mean half width of one quantity over studies."""
    coverage, bias, half_width = np.mean([study[name] for study in studies], axis=0)
    return {"studies": len(studies), "held": float(coverage), "bias": float(bias), "half_width": float(half_width)}


def next_bed_rivals(truth: Truth, run_count: int, bed_count: int, seed: int) -> dict[str, tuple[float, float, float]]:
    """The next bed by generalised pivots, and by the plain variance of beds."""
    values, bed = adjusted(truth, run_count, bed_count, seed)
    components, error, beds = bed_components(values, bed), standard_error(values, bed), bed_means(truth)[0]
    plain = t_quantile(bed_count - 1) * math.sqrt(max(components.bed_variance, 0.0) + error**2)
    widths = {"next bed, pivots": pivot(components), "next bed, plain": plain}
    return {name: (float(np.mean(np.abs(beds - values.mean()) <= width)), 0.0, width) for name, width in widths.items()}


def pivot(components: BedComponents) -> float:
    """Half width for the next bed by draws of both mean squares (generalised pivots)."""
    points = stats.qmc.Sobol(3, rng=np.random.default_rng(0)).random_base2(12)
    freedom, on_each = len(components.squares), float(components.counts.mean())
    between = components.squares.sum() / stats.chi2.ppf(points[:, 0], freedom)
    within = components.within * components.within_freedom / stats.chi2.ppf(points[:, 1], components.within_freedom)
    bed = np.maximum(between - within, 0.0) / on_each
    mean = np.maximum(between, within) / (on_each * (freedom + 1))
    return float(np.quantile(np.abs(special.ndtri(points[:, 2])) * np.sqrt(bed + mean), LEVEL))


def adjusted(truth: Truth, run_count: int, bed_count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Shares of runs less what the inputs say of them, and the beds."""
    x, y, outcome, bed = truth.study(run_count, bed_count, seed)
    h, (terms, indices) = returns(y, outcome), regression_terms(INPUTS, x)
    return h - control_variate(terms, indices.sum(axis=1), h, bed), bed


def few_beds(truth: Truth, run_count: int, bed_count: int, seed: int) -> dict[str, tuple[float, float, float]]:
    """The share by Student's t, as used, and by the wild bootstrap of beds with Webb's six weights."""
    values, bed = adjusted(truth, run_count, bed_count, seed)
    share, mean = exact_share(truth), float(values.mean())
    sums, counts = np.bincount(bed, weights=values - mean), np.bincount(bed)
    weights = np.random.default_rng(seed).choice(np.sqrt([0.5, 1.0, 1.5]), (999, bed_count))
    weights = weights * np.random.default_rng(seed + 1).choice([-1.0, 1.0], weights.shape)
    shift = weights @ sums / len(values)
    spread = weights * sums - shift[:, None] * counts
    factor = math.sqrt(bed_count / (bed_count - 1)) / len(values)
    ratios = np.abs(shift) / (factor * np.sqrt(np.sum(spread**2, axis=1)))
    widths = {
        "share, t": t_quantile(bed_count - 1) * standard_error(values, bed),
        "share, Webb": float(np.quantile(ratios, LEVEL)) * factor * math.sqrt(float(np.sum(sums**2))),
    }
    return {name: (float(abs(mean - share) <= width), mean - share, width) for name, width in widths.items()}


def side_runs(truth: Truth, pair_count: int, seed: int) -> dict[str, tuple[float, float, float]]:
    """Chaos from twins whose scatter is normal, and the soil's total effect from pairs on one place."""
    rng = np.random.default_rng(seed)
    found = {"chaos, 12 twins": held(chaos_variance(math.sqrt(2.0) * 0.3 * rng.standard_normal(12)), 0.09)}
    first, second = (speeds_of_place(truth, pair_count, seed, soil) for soil in (1, 2))
    y = truth.study(240, 24, seed)[1][:, 0]
    return found | {f"soil, {pair_count} pairs": held(soil_total_effect(first - second, y), exact_total(truth))}


def speeds_of_place(truth: Truth, count: int, seed: int, soil: int) -> np.ndarray:
    """Speeds on the beds and places of a seed with soils of their own."""
    x = random_soils(count, np.random.default_rng([seed, soil]))
    rng = np.random.default_rng(seed)
    return truth._leaving(x, rng.standard_normal(count), rng)[:, 0]


@lru_cache
def exact_total(truth: Truth) -> float:
    """Total effect of the soil on the speed."""
    first, second = (speeds_of_place(truth, DRAW_COUNT, 13, soil) for soil in (1, 2))
    return float(np.mean((first - second) ** 2) / (2.0 * first.var()))


def flights(truth: Truth, seed: int, systematic: bool) -> float:
    """Ratio of half widths with 210 and with 21 flights a run; headings in equal steps, or drawn one by one."""
    x, y, outcome, bed = truth.study(240, 24, seed)
    h, terms, rng = returns(y, outcome), regression_terms(INPUTS, x), np.random.default_rng(seed)
    widths = []
    for count in (21, 210):
        flown = np.floor(count * h + rng.random(len(h))) if systematic else rng.binomial(count, h)
        found = share_estimate(np.minimum(flown / count, 1.0), bed, terms=terms)
        widths.append(found.share.half_width)
    return widths[1] / widths[0]


def no_event(run_count: int, study_count: int) -> float:
    """How often the upper end covers a chance of 1 / run_count: that of independent runs, or the share's own."""
    counts = np.random.default_rng(run_count).binomial(run_count, 1.0 / run_count, size=study_count)
    covered = []
    for count in counts:
        stay = (np.arange(run_count) < count).astype(float)
        found = share_estimate(stay, np.arange(run_count)).share.upper
        covered.append(found is not None and found >= 1.0 / run_count)
    return float(np.mean(covered))


def rows(count: int) -> Iterator[Row]:
    for runs, beds in DESIGNS:
        for rho in CORRELATIONS:
            truth = Truth(rho=rho)
            for name, row in table(truth, runs, beds, count).items():
                yield setting(truth, runs, beds) | {"quantity": name} | row
            rivals = [next_bed_rivals(truth, runs, beds, k) for k in range(count)]
            yield from (setting(truth, runs, beds) | {"quantity": n} | summed(rivals, n) for n in rivals[0])
    for truth in (Truth(rim="random"), Truth(rim="fast_flat"), Truth(soil=0.0), Truth(soil=2.7), Truth(soil=3.0)):
        for name, row in table(truth, 240, 24, count).items():
            yield setting(truth, 240, 24) | {"quantity": name} | row
    yield from rows_of_missing(count)
    for beds, rho in ((4, 0.05), (4, 0.2), (6, 0.0), (6, 0.05), (6, 0.2), (8, 0.05), (8, 0.2)):
        few = [few_beds(Truth(rho=rho), 240, beds, k) for k in range(count)]
        yield from (setting(Truth(rho=rho), 240, beds) | {"quantity": n} | summed(few, n) for n in few[0])
    for truth in (Truth(), Truth(soil=3.0)):
        pairs = [side_runs(truth, 20, k) for k in range(count)]
        yield from (setting(truth, 240, 24) | {"quantity": n} | summed(pairs, n) for n in pairs[0])
    for systematic in (True, False):
        ratio = float(np.mean([flights(Truth(), k, systematic) for k in range(40)]))
        name = f"half width, 210 over 21 flights a run, {'equal steps' if systematic else 'drawn one by one'}"
        yield setting(Truth(), 240, 24) | {"quantity": name, "studies": 40, "half_width": ratio}
    for runs in (20, 60, 300):
        yield {
            "runs": runs,
            "beds": runs,
            "quantity": "capture of 1 / n",
            "studies": count,
            "held": no_event(runs, count),
        }


def rows_of_missing(count: int) -> Iterator[Row]:
    """The share where 0, 3 and 10 % of the landings are lost: any, the fast, or the fast of which none returns."""
    cells = [(missing, Truth(rim_share=0.0))]
    for rim_share in (0.03, 0.1):
        cells += [
            (missing, Truth(rim="random", rim_share=rim_share)),
            (missing, Truth(rim="fast", rim_share=rim_share)),
            (missing, Truth(rim="fast", rim_share=rim_share, rim_returns=False)),
            (like_missing, Truth(rim="fast", rim_share=2.0 * rim_share)),
        ]
    for study, truth in cells:
        found = [study(truth, k) for k in range(count)]
        extra = {"rim_share": truth.rim_share, "rim_returns": truth.rim_returns, "truth": exact_share(truth)}
        yield from (setting(truth, 240, 24) | extra | {"quantity": n} | summed(found, n) for n in found[0])


def setting(truth: Truth, runs: int, beds: int) -> Row:
    """What a row was measured with."""
    return {"runs": runs, "beds": beds, "rho": truth.rho, "soil": truth.soil, "rim": truth.rim}


def main() -> None:
    count = command_line(__doc__, studies=400).parse_args().studies
    write_rows(TABLE, COLUMNS, map(rounded, rows(count)))
    write_made(TABLE, f"benchmarks/estimate_coverage.py --studies {count}", studies=count, level=LEVEL)


if __name__ == "__main__":
    main()
