"""The one list of distributions: by the names that study files and saved expansions use, and as inputs."""

from dataclasses import fields
from typing import Any

from lithobrake.chaos.abstract_distribution import NO_CHOICES, Distribution
from lithobrake.chaos.distributions import Beta, Exponential, Gamma, LogNormal, LogUniform, Normal, Uniform
from lithobrake.chaos.numerical_distributions import Empirical, TruncatedNormal

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


def checked_inputs(inputs: Any) -> dict[str, Distribution]:
    """Check a mapping of input names to distributions and give it back as an ordered dict."""
    if not hasattr(inputs, "items") or not inputs:
        raise ValueError("inputs must be a dict of at least one name with its distribution, for instance Uniform(0, 1)")
    for name, entry in inputs.items():
        if not isinstance(entry, Distribution):
            raise ValueError(
                f"input {name!r} is {entry!r}, but must be a distribution "
                f"({', '.join(known.__name__ for known in KINDS.values())}); {NO_CHOICES}"
            )
    return dict(inputs)
