"""Distributions by name: what a study file or a saved expansion calls them."""

from dataclasses import fields
from typing import Any

from lithobrake.chaos.abstract_distribution import NO_CHOICES, Distribution
from lithobrake.chaos.bounded_distributions import Beta, LogUniform, Uniform
from lithobrake.chaos.numerical_distributions import Empirical, TruncatedNormal
from lithobrake.chaos.unbounded_distributions import Exponential, Gamma, LogNormal, Normal

KINDS: dict[str, type[Distribution]] = {
    entry.kind: entry
    for entry in (Uniform, LogUniform, Normal, LogNormal, TruncatedNormal, Beta, Gamma, Exponential, Empirical)
}


def distribution(kind: str, **parameters: Any) -> Distribution:
    """Build a distribution from its name, for instance distribution("uniform", lower=0, upper=1).

    Raises ValueError for an unknown name, a missing, a surplus or a wrong parameter.
    """
    if kind not in KINDS:
        raise ValueError(f"distribution is {kind!r}, but must be one of {', '.join(KINDS)}; {NO_CHOICES}")
    maker = KINDS[kind]
    allowed = [field.name for field in fields(maker)]  # type: ignore[arg-type]
    surplus = sorted(set(parameters) - set(allowed))
    if surplus:
        raise ValueError(f"distribution {kind!r} has no parameter {', '.join(surplus)}: it takes {', '.join(allowed)}")
    try:
        return maker(**parameters)
    except TypeError:
        missing = [name for name in allowed if name not in parameters]
        raise ValueError(f"distribution {kind!r} lacks {', '.join(missing)}: it takes {', '.join(allowed)}") from None
