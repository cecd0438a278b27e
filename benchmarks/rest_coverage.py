"""How often intervals of a fraction near 1 hold it where landers on one bed end alike, on beds whose law is known.

    python benchmarks/rest_coverage.py [--studies 2000]

A row a setting: the true fraction at rest, the correlation of two landers on one bed, beds, landers on each. The
fraction of a bed follows a beta law; or one bed in 8, or in 30, is wholly bad and on all others each lander rests
(correlation 1); or one bed in 20 is of a kind on which half of the landers rest. Told: how often all rest, how often
the interval holds the fraction, how often it lies below it and above it, how often the interval of one ground holds
the fraction of one bed more, and the lower end where all rest. Writes results/rest_coverage.csv and .json.
"""

from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
from harness import RESULTS, Row, command_line, rounded, timed, write_made, write_rows

from lithobrake.analysis.confidence import LEVEL, Bounds
from lithobrake.analysis.ground_spread import share_over_grounds
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.analysis.unseen_event import unseen_limit
from lithobrake.vocabulary.constants import LARGEST_CORRELATION

TABLE = RESULTS / "rest_coverage.csv"
FRACTIONS = (0.9, 0.95, 0.98, 0.99, 0.998, 0.999)
CORRELATIONS = (0.0, 0.07, 0.3, 0.5)
BEDS, LANDERS = (8, 12, 24, 30), (2, 3, 4)
# Share of beds that differ, and the fraction at rest on each of them.
TWO_KINDS = {"one bed in 8 wholly bad": (1 / 8, 0.0), "one bed in 30 wholly bad": (1 / 30, 0.0),
             "one bed in 20 of another kind": (1 / 20, 0.5)}  # fmt: skip
# Fractions of so many beds.
BedLaw = Callable[[np.random.Generator, int], np.ndarray]


def beta_law(fraction: float, correlation: float) -> BedLaw:
    """Beds on which the fraction follows a beta law; one for all without a correlation."""
    if correlation == 0.0:
        return lambda random, count: np.full(count, fraction)
    size = 1.0 / correlation - 1.0
    return lambda random, count: random.beta(fraction * size, (1.0 - fraction) * size, count)


def two_kinds(weight: float, there: float) -> BedLaw:
    """Beds of which a share has this fraction at rest; on all others each lander rests."""
    return lambda random, count: np.where(random.random(count) < weight, there, 1.0)


def laws() -> Iterator[tuple[Row, BedLaw]]:
    for fraction in FRACTIONS:
        for correlation in CORRELATIONS:
            told = {"beds_differ": "beta law", "fraction": fraction, "correlation": correlation}
            yield told, beta_law(fraction, correlation)
    for name, (weight, there) in TWO_KINDS.items():
        mean, variance = 1.0 - weight * (1.0 - there), weight * (1.0 - weight) * (1.0 - there) ** 2
        told = {"beds_differ": name, "fraction": mean, "correlation": variance / (mean * (1.0 - mean))}
        yield told, two_kinds(weight, there)


@cache
def intervals(at_rest: tuple[int, ...], landers: int) -> tuple[Bounds, Bounds]:
    """The intervals of the mean and of one ground with so many landers at rest, by bed, of the same number on each."""
    rests = (np.arange(landers) < np.array(at_rest)[:, None]).astype(float).ravel()
    bed = np.repeat(np.arange(len(at_rest)), landers)
    mean, ground = share_estimate(rests, bed).share.bounds, share_over_grounds(rests, bed).bounds
    assert mean is not None
    assert ground is not None
    return mean, ground


def row(told: Row, law: BedLaw, beds: int, landers: int, studies: int) -> Row:
    """How often the intervals of one setting hold, over so many studies."""
    random, truth, found = np.random.default_rng([beds, landers, int(1e6 * told["fraction"])]), told["fraction"], []
    for _ in range(studies):
        of_beds = law(random, beds + 1)
        at_rest = np.sort(random.binomial(landers, of_beds[:-1]))
        mean, ground = intervals(tuple(at_rest.tolist()), landers)
        below, above = mean[1] < truth, mean[0] > truth
        on_one = ground[0] <= of_beds[-1] <= ground[1]
        found.append((at_rest.min() == landers, not (below or above), below, above, on_one))
    names = ("all_rest", "held", "too_low", "too_high", "one_ground_held")
    shares = dict(zip(names, np.mean(found, axis=0).tolist(), strict=True))
    sizes = {"beds": beds, "landers_each": landers, "studies": studies}
    return told | sizes | shares | {"lower": intervals((landers,) * beds, landers)[0][0]}


def main() -> None:
    studies = command_line(__doc__, studies=2000).parse_args().studies
    rows = [row(told, law, beds, landers, studies) for told, law in laws() for beds in BEDS for landers in LANDERS]
    write_rows(TABLE, rows[0], map(rounded, rows))
    least = {name: min(one["held"] for one in rows if one["beds_differ"] == name) for name in ("beta law", *TWO_KINDS)}
    seconds = timed(lambda: [unseen_limit(np.arange(96) % 24) for _ in range(100)])[1]
    facts = {
        "level": LEVEL,
        "limits_hold_up_to": LARGEST_CORRELATION,
        "least_held": least,
        "cpu_ms_of_a_limit": 10.0 * seconds,
    }
    write_made(TABLE, f"benchmarks/rest_coverage.py --studies {studies}", **facts)


if __name__ == "__main__":
    main()
