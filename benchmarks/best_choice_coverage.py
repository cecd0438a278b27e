"""Whether the best of several delivery options is said rightly: the set that holds it, and its own fraction.

    python benchmarks/best_choice_coverage.py [--studies 200]

Beds have fractions of their own at each option (a normal effect on the logit, half of it common to all options); a
study has 12 or 24 of them, fifty refits to beds drawn with replacement and ten landers of each, the same at all
options. Options are alike, spread evenly, half of them near the best, or all near 1. Counted: how often the set of
those that cannot be distinguished from the best held the best, how many it has, and how often the interval of the
option that was chosen held its fraction: `own` of `best_choice`; the plain mean of the refits; and two halves of the
beds, of which one chooses and the other says, then swapped, which takes as many refits again.
Writes benchmarks/results/best_choice_coverage.csv, and .json beside it.
"""

import math
from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
from harness import RESULTS, Row, command_line, rounded, write_made, write_rows
from scipy import special

from lithobrake.analysis import LEVEL, Estimate, best_choice, refit_interval

TABLE = RESULTS / "best_choice_coverage.csv"
COLUMNS = ("kind", "options", "beds", "bed_spread", "studies", "set_held", "set_size", "own_held", "own_bias",
           "own_half_width", "plain_held", "plain_bias", "plain_half_width", "halves_held", "halves_bias",
           "halves_half_width")  # fmt: skip
REFITS, LANDERS, COMMON = 50, 10, 0.5
KINDS, OPTIONS, BEDS = ("alike", "spread", "half", "high"), (4, 12, 36), (12, 24)
# Of the effect of a bed on the logit of the fraction: at a fraction of 0.8 beds scatter by 0.11, 0.18 and 0.24.
BED_SPREADS = (0.7, 1.3, 2.0)
NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(40)


class Setting(NamedTuple):
    """Kind of the options, how many, on how many beds, and how much beds differ."""

    kind: str
    options: int
    beds: int
    bed_spread: float


def logits(setting: Setting, random: np.random.Generator) -> np.ndarray:
    """Of the middle bed at each option [option_count]."""
    count = setting.options
    fractions = {
        "alike": 0.8 + 0.002 * random.standard_normal(count),
        "spread": random.permutation(np.linspace(0.5, 0.9, count)),
        "half": np.where(np.arange(count) < count // 2, 0.85, 0.6) + 0.01 * random.random(count),
        "high": 0.97 + 0.002 * random.standard_normal(count),
    }[setting.kind]
    # A mean over beds is nearer to a half than the middle bed; this about gives it back.
    middle: np.ndarray = special.logit(fractions) * math.sqrt(1.0 + setting.bed_spread**2 / 2.9)
    return middle


def landers(beds: np.ndarray, refit_count: int, random: np.random.Generator) -> np.ndarray:
    """Whether landers of refits are at rest [option_count, refit_count, LANDERS], of beds [bed_count, option_count]."""
    drawn = random.integers(len(beds), size=(refit_count, len(beds)))
    fractions = beds[drawn].mean(axis=1)[:, None]
    own, common = random.standard_normal((refit_count, LANDERS, beds.shape[1] + 1)), slice(-1, None)
    uniform = special.ndtr(math.sqrt(0.5) * (own[:, :, :-1] + own[:, :, common]))
    return (uniform < fractions).transpose(2, 0, 1).astype(float)


def plain(met: np.ndarray, bed_count: int) -> Estimate:
    """The mean of one option with its interval over refits, met [refit_count, LANDERS]."""
    return refit_interval(met.sum(axis=1), np.full(len(met), LANDERS), bed_count)


def of_halves(beds: np.ndarray, random: np.random.Generator) -> Estimate:
    """What each half of the beds says of the option that the other half chooses, the mean of both."""
    halves = np.array_split(random.permutation(len(beds)), 2)
    met = [landers(beds[half], REFITS // 2, random) for half in halves]
    chosen = [int(one.mean(axis=(1, 2)).argmax()) for one in met]
    said = [plain(met[1 - place][one], len(halves[1 - place])) for place, one in enumerate(chosen)]
    value, half_width = np.mean([one.value for one in said]), 0.5 * math.hypot(*(width(one) for one in said))
    return Estimate(float(value), float(value) - half_width, float(value) + half_width)


def width(one: Estimate) -> float:
    return 0.5 * (one.upper - one.lower)


def row(setting: Setting, studies: int) -> Row:
    kind, options, beds, spread = setting
    random = np.random.default_rng([KINDS.index(kind), options, beds, round(10 * spread)])
    found: dict[str, list[float]] = {}
    for _ in range(studies):
        middle = logits(setting, random)
        truth = special.expit(middle[:, None] + spread * NODES) @ WEIGHTS / WEIGHTS.sum()
        effects = np.sqrt(COMMON) * random.standard_normal((beds, 1)) + np.sqrt(1.0 - COMMON) * random.standard_normal(
            (beds, options)
        )
        of_beds = special.expit(middle + spread * effects)
        met = landers(of_beds, REFITS, random)
        best = best_choice(met, beds, [True] * options)
        said = {"own": best.own, "plain": plain(met[best.best], beds), "halves": of_halves(of_beds, random)}
        numbers = {"set_held": int(truth.argmax()) in best.not_worse, "set_size": len(best.not_worse)}
        for name, one in said.items():
            fraction = truth[best.best]
            numbers |= {f"{name}_held": one.lower <= fraction <= one.upper, f"{name}_bias": one.value - fraction}
            numbers |= {f"{name}_half_width": width(one)}
        for name, value in numbers.items():
            found.setdefault(name, []).append(float(value))
    return {**setting._asdict(), "studies": studies} | {name: float(np.mean(one)) for name, one in found.items()}


def rows(studies: int) -> Iterator[Row]:
    for given in product(KINDS, OPTIONS, BEDS, BED_SPREADS):
        yield rounded(row(Setting(*given), studies))


def main() -> None:
    studies = command_line(__doc__, studies=200).parse_args().studies
    write_rows(TABLE, COLUMNS, rows(studies))
    write_made(TABLE, f"benchmarks/best_choice_coverage.py --studies {studies}", studies=studies, level=LEVEL)


if __name__ == "__main__":
    main()
