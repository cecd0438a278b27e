"""Weights of landers that were simulated under one set of assumptions, for another: ratios of probability densities.

A lander that drew x from the density q stands for p(x) / q(x) landers of the density p. Inputs are drawn independently,
so ratios of several multiply. Source: [Owen-2000].
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from assumptions import kind_weights
from branches import Branch
from harness import Row
from measured_branches import BALLISTIC, DELIVERY, GROUND, measured_branches
from measurements import DRAWN, QUANTITIES, Measurement, Quantity
from samples import Sample, sample

from lithobrake.study.quantity import Uncertain
from lithobrake.vocabulary.array_types import Floats

# Of an edition: from fewer, in seven branches, the even prior of the shares moves them by 5 percentage points and more.
FEWEST = 100.0
# Share of a measured law that may lie where no lander was simulated.
MOST_OUTSIDE = 0.01
# Of a value that all landers have: the difference that weights nothing, beside the error of the measurement.
NEAR = 0.02
STEP = 1e-4  # of the width of a law, over which its density is averaged
REMEDY = (
    "simulate fresh landers by validation/forecast_hera/forecast.py --work FOLDER --measurements FILE, and give "
    "FOLDER/forecast as --landers"
)


def weighted(
    rows: Sequence[Row], lander: str, measurements: Sequence[Measurement], drawn: Sequence[Measurement] = ()
) -> list[Row]:
    """The rows of a lander with its `factor` and `branch_weight` by measurements, of landers simulated with others.

    drawn: measurements that the landers were simulated with. Raises ValueError where no weights can do it.
    """
    new = {one.name: one for one in measured_branches(lander, measurements)}
    old = {one.name: one for one in measured_branches(lander, drawn)}
    kinds = kind_factors(measurements, drawn)
    if any(one.quantity == GROUND for one in measurements) and not any(row.get("kind") for row in rows):
        raise ValueError("ground has no part in these landers, which have one ground; take landers of unknown ground")
    found = []
    for name, branch in new.items():
        own = [row for row in rows if (row["lander"], row["branch"]) == (lander, name)]
        factors = branch_factors(own, branch, old[name]) if branch.weight > 0.0 else np.zeros(len(own))
        factors *= [kinds.get(row.get("kind", ""), 1.0) for row in own]
        found += [
            {**row, "factor": float(factor), "branch_weight": branch.weight}
            for row, factor in zip(own, factors, strict=True)
        ]
    return found


def kind_factors(measurements: Sequence[Measurement], drawn: Sequence[Measurement]) -> dict[str, float]:
    """So many landers each one on a kind of ground stands for, where the weights of the kinds are others than drawn."""
    after, before = kind_weights(measurements), kind_weights(drawn)
    for name, weight in after.items():
        if weight > 0.0 and before[name] == 0.0:
            raise ValueError(f"ground has {name}, on which no lander was simulated; {REMEDY}")
    return {name: weight / before[name] for name, weight in after.items() if before[name] > 0.0}


def branch_factors(rows: Sequence[Row], new: Branch, old: Branch) -> Floats:
    """So many landers of a branch each row stands for, [count]."""
    factors = np.ones(len(rows))
    after, before = new.tables(1), old.tables(1)
    for name, of in QUANTITIES.items():
        # A ballistic descent draws neither speed nor angle.
        if not of.key or (of.key.startswith(DELIVERY) and new.descent == BALLISTIC):
            continue
        p, q = (value_at(tables, of.key) for tables in (after, before))
        if p == q:
            continue
        if of.column is None:
            _refuse_other_value(name, of, p, q)
            continue
        _refuse_outside(name, of, p, q)
        is_met = np.array([not of.of_soil or row["ground"] == "soil" for row in rows], dtype=bool)
        values = np.array([row[of.column] for row in rows])
        # One that missed drew a value that had no part in it: it stands for itself.
        known = is_met & np.isfinite(values)
        drawn = density(q, values[known])
        if not drawn.all():
            raise ValueError(
                f"a lander has {name} {values[known][drawn == 0.0][0] / of.factor:g} {of.unit}, which it cannot have "
                f"drawn from its distribution; restore {DRAWN} beside the landers"
            )
        factors[known] *= density(p, values[known]) / drawn
    return factors


def value_at(tables: Row, key: str) -> Any:
    """The value of a dotted key of a study, or of a list by its number."""
    value: Any = tables
    for part in key.split("."):
        value = value[int(part)] if isinstance(value, list) else value[part]
    return value


def law_of(table: Row) -> Any:
    """The distribution that a table of a study file stands for."""
    return _law(table["distribution"], *((key, one) for key, one in table.items() if key != "distribution"))


@cache
def _law(kind: str, *parameters: tuple[str, float]) -> Any:
    return Uncertain(kind, dict(parameters)).to_chaos()


def density(table: Row, values: Floats) -> Floats:
    """Probability density of a law at values [count], averaged over a small part of its width; 0 outside."""
    law = law_of(table)
    lower, upper = law.support
    half = 0.5 * STEP * float(law.ppf(0.84) - law.ppf(0.16))
    # Tables of landers have six digits, and an end of a range may lie between two of them.
    inside = (values > lower - half) & (values < upper + half)
    below, above = (np.clip(values + shift, lower, upper) for shift in (-half, half))
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (law.cdf(above) - law.cdf(below)) / (above - below)
    found: Floats = np.where(inside & (above > below), mean, 0.0)
    return found


def _refuse_other_value(name: str, of: Quantity, p: float, q: float) -> None:
    if abs(p - q) > NEAR * q:
        raise ValueError(
            f"{name} is {p / of.factor:g} {of.unit} in the measurements and {q / of.factor:g} for all "
            f"landers, more than {100 * NEAR:g} % away; {REMEDY}"
        )


def _refuse_outside(name: str, of: Quantity, p: Row, q: Row) -> None:
    lower, upper = law_of(q).support
    law = law_of(p)
    inside = float(np.diff(law.cdf(np.clip([lower, upper], *law.support)))[0])
    if 1.0 - inside > MOST_OUTSIDE:
        raise ValueError(
            f"{name} lies outside {lower / of.factor:g} to {upper / of.factor:g} {of.unit}, where the landers are, "
            f"with a probability of {100 * (1.0 - inside):.3g} %, more than {100 * MOST_OUTSIDE:g} %; {REMEDY}"
        )


def effective_number(of: Sample) -> float:
    """So many landers of even weights would scatter as little."""
    return float(of.weight.sum() ** 2 / (of.weight @ of.weight))


def effective_numbers(rows: Sequence[Row], lander: str) -> dict[str, float]:
    """Those on each ground."""
    return {ground: effective_number(sample(list(rows), lander, ground)) for ground in ("soil", "hard")}


def refuse_few(effective: dict[str, float], lander: str) -> None:
    """Raise ValueError where the landers on soil or hard ground stand for too few."""
    for ground, number in effective.items():
        if not number >= FEWEST:
            words = "soil" if ground == "soil" else "hard ground"
            raise ValueError(
                f"the landers of {lander.capitalize()} on {words} stand for {number:.3g} even ones under the "
                f"measurements; allowed: at least {FEWEST:g}; {REMEDY}"
            )
