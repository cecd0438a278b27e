"""Grains of regolith: convex envelopes of random clouds of points, in a size distribution."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import ConvexHull

Floats = NDArray[np.float64]
SIZE_DISTRIBUTIONS = ("constant", "uniform", "normal", "power_law")


# Of which a mean is made.
QUANTILES = 10_000
# A mean so many standard deviations beyond the limits is no normal distribution between them.
FARTHEST_MEAN = 100.0


@dataclass(frozen=True, kw_only=True)
class GrainSizes:
    """Distribution of grain diameters [m] (of the sphere of equal volume), between lower and upper limits.

    "constant" has lower = upper; "normal" takes mean and std and is cut at the limits; "power_law" has a number of
    grains per diameter proportional to diameter to the power of minus `exponent`, which is positive where small grains
    outnumber large ones, and 1 more than the exponent of the number of grains larger than a diameter. Raises
    ValueError for other values.
    """

    distribution: str
    lower: float
    upper: float
    mean: float | None = None
    std: float | None = None
    exponent: float | None = None

    def __post_init__(self) -> None:
        kind = self.distribution
        if kind not in SIZE_DISTRIBUTIONS:
            raise ValueError(f"grain size distribution is {kind!r}; allowed are {', '.join(SIZE_DISTRIBUTIONS)}")
        if not 0.0 < self.lower <= self.upper < math.inf or (kind == "constant") != (self.lower == self.upper):
            raise ValueError(
                f"grain diameters run from {self.lower!r} to {self.upper!r} m; allowed is 0 < lower < upper "
                "(lower = upper for a constant size): change them"
            )
        if kind == "normal" and not self._is_normal():
            raise ValueError(
                f"normal grain sizes have mean {self.mean!r} and std {self.std!r} m; allowed: std above 0, and a mean "
                f"within {FARTHEST_MEAN:g} of it from {self.lower!r} to {self.upper!r} m: change them"
            )
        if kind == "power_law" and not (self.exponent is not None and 0.0 <= self.exponent < math.inf):
            raise ValueError(
                f"power-law grain sizes have exponent {self.exponent!r}; allowed: at least 0, as their number falls "
                "with diameter**-exponent: leave the sign of a slope out"
            )

    def _is_normal(self) -> bool:
        """Whether mean and standard deviation are those of a normal distribution that has grains in the limits."""
        if self.mean is None or self.std is None or not 0.0 < self.std < math.inf:
            return False
        beyond = max(self.lower - self.mean, self.mean - self.upper)
        # An infinite ratio or NaN is not within anything.
        return beyond / self.std <= FARTHEST_MEAN

    @property
    def mean_diameter(self) -> float:
        """Mean of the diameters [m]."""
        return float(np.mean(self.draw((np.arange(QUANTILES) + 0.5) / QUANTILES)))

    def draw(self, uniforms: Floats) -> Floats:
        """Return diameters [m] for uniform random numbers in [0, 1), by inversion of the distribution."""
        lower, upper = self.lower, self.upper
        if self.distribution == "power_law":
            assert self.exponent is not None
            power, decades = 1.0 - self.exponent, math.log(upper) - math.log(lower)
            if power == 0.0:
                return lower * (upper / lower) ** uniforms
            # In logarithms, and from the end where most grains are: nothing overflows, and near 1 no digit is lost.
            end, part = (lower, uniforms) if power < 0.0 else (upper, 1.0 - uniforms)
            return np.clip(end * np.exp(np.log1p(part * math.expm1(-abs(power) * decades)) / power), lower, upper)
        if self.distribution == "normal":
            from scipy.stats import truncnorm

            mean, std = self.mean, self.std
            assert mean is not None
            assert std is not None
            return truncnorm.ppf(uniforms, (lower - mean) / std, (upper - mean) / std, loc=mean, scale=std)
        return lower + uniforms * (upper - lower)


def make_grain_within(
    generator: np.random.Generator, point_count: int, diameter: float, longest: float
) -> ConvexHull:  # fmt: skip
    """As make_grain, drawn anew until it reaches no farther from its centroid than `longest` diameters."""
    while True:
        grain = make_grain(generator, point_count, diameter)
        if grain.bounding_radius <= longest * diameter:
            return grain


def make_grain(generator: np.random.Generator, point_count: int, diameter: float) -> ConvexHull:
    """Return the envelope of points drawn evenly in a ball, scaled to the volume of a sphere of a diameter [m]."""
    directions = generator.normal(size=(point_count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    cloud = directions * np.cbrt(generator.random(point_count))[:, None]
    hull = ConvexHull(cloud)
    scale = np.cbrt(math.pi / 6.0 * diameter**3 / hull.volume)
    return ConvexHull((hull.vertices - hull.centroid) * scale)


def random_orientation(generator: np.random.Generator) -> Floats:
    """Return a unit quaternion (w, x, y, z) drawn evenly over all rotations."""
    quaternion = generator.normal(size=4)
    return quaternion / np.linalg.norm(quaternion)
