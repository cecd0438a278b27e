"""Grains of regolith in a size distribution, and boulders among them."""

import math
from dataclasses import dataclass

import numpy as np

from lithobrake.dem import ConvexHull, folded, period_of
from lithobrake.geometry.bed_limits import BOULDER_REACH, LARGEST_COVERAGE
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.field_errors import FieldError

SIZE_DISTRIBUTIONS = ("constant", "uniform", "normal", "power_law")


# Of which a mean is made.
QUANTILES = 10_000
# A mean so many standard deviations beyond the limits is no normal distribution between them.
FARTHEST_MEAN = 100.0
# Points of the cloud whose envelope is a boulder, at least: of fewer hardly an envelope keeps to BOULDER_REACH.
BOULDER_POINTS = 30
# Part of the volume that poured grains fill: where the surface will lie is not known before the bed is poured.
SOLID_FRACTION = 0.6
PLACES_TRIED = 1000
SURFACE_STEPS = 40
# Of its height, that a boulder reaches above the floor at least.
LEAST_HEIGHT = 0.05
# Of its height, by which it stands over the floor before it is let go.
CLEARANCE = 1e-6


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
            raise FieldError("GrainSizes.distribution", kind, f"are {', '.join(SIZE_DISTRIBUTIONS)}", "choose one")
        if not 0.0 < self.lower <= self.upper < math.inf or (kind == "constant") != (self.lower == self.upper):
            raise FieldError(
                "GrainSizes.lower", self.lower,
                f"with upper {self.upper!r} m is 0 < lower < upper (lower = upper for a constant size)",
                "change them", "m",
            )  # fmt: skip
        if kind == "normal" and not self._is_normal():
            raise FieldError(
                "GrainSizes.mean", self.mean,
                f"with std {self.std!r} m, above 0, is within {FARTHEST_MEAN:g} of it from {self.lower!r} to "
                f"{self.upper!r} m", "change them", "m",
            )  # fmt: skip
        if kind == "power_law" and not (self.exponent is not None and 0.0 <= self.exponent < math.inf):
            raise FieldError(
                "GrainSizes.exponent", self.exponent, "is at least 0, as the number of grains falls with "
                "diameter**-exponent", "leave the sign of a slope out",
            )  # fmt: skip

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
    # A ball holds points in proportion to the cube of its radius.
    cloud = directions * np.cbrt(generator.random(point_count))[:, None]
    hull = ConvexHull(cloud)
    scale = np.cbrt(math.pi / 6.0 * diameter**3 / hull.volume)
    return ConvexHull((hull.vertices - hull.centroid) * scale)


def random_orientation(generator: np.random.Generator) -> Floats:
    """Return a unit quaternion (w, x, y, z) drawn evenly over all rotations."""
    # Four normal numbers have no preferred direction, so their quaternion is even on the sphere of unit quaternions.
    quaternion = generator.normal(size=4)
    return quaternion / np.linalg.norm(quaternion)


@dataclass(frozen=True, kw_only=True)
class Boulders:
    """Boulders of a bed. Raises ValueError for a coverage or a cover that no bed has.

    sizes: of their diameters, of the spheres of equal volume. coverage: part of the ground that discs of these
    diameters cover, in the mean over beds. cover: limits [m] between which the depth of a boulder's top under the mean
    surface of the grains is drawn; below 0 it stands out. What would reach below the floor is cut off there.
    """

    sizes: GrainSizes
    coverage: float
    cover: tuple[float, float]

    def __post_init__(self) -> None:
        if not 0.0 < self.coverage <= LARGEST_COVERAGE:
            raise FieldError("Boulders.coverage", self.coverage, f"is 0 < value <= {LARGEST_COVERAGE:g}")
        low, high = self.cover
        if not -math.inf < low <= high < math.inf:
            raise FieldError("Boulders.cover", self.cover, "are two finite lengths, the smaller first", unit="m")

    @property
    def longest(self) -> float:
        """How far a boulder reaches from its centroid at most [m]."""
        return BOULDER_REACH * self.sizes.upper

    def mean_count(self, area: float) -> float:
        """How many boulders ground of an area [m2] has in the mean."""
        # The coverage is one of areas, so the count follows from the mean square of the diameters, and not from the
        # mean diameter.
        square = float(np.mean(self.sizes.draw((np.arange(1000) + 0.5) / 1000) ** 2))
        return self.coverage * area / (0.25 * math.pi * square)

    def count(self, area: float, uniform: float) -> int:
        """How many boulders a bed of an area [m2] has: as in the mean, or one more, by a number from 0 to 1."""
        return int(self.mean_count(area) + uniform)


def place_boulders(
    boulders: Boulders, generator: np.random.Generator, point_count: int, grain_volume: float,
    width: tuple[float, float], period: tuple[float, float] | None,
) -> tuple[list[ConvexHull], Floats]:  # fmt: skip
    """Return the boulders of one bed, as they lie, and their centroids [m], shape [count, 3].

    generator: of the bed; grain_volume [m3]: of all its grains; width and period: see Bed. Raises ValueError where they
    find no room beside each other.
    """
    count = boulders.count(width[0] * width[1], float(generator.random()))
    hulls = [_whole_boulder(boulders, generator, max(point_count, BOULDER_POINTS)) for _ in range(count)]
    # The largest find their places first.
    hulls.sort(key=_across, reverse=True)
    cover = generator.uniform(*boulders.cover, size=count)
    places = free_places(generator, [_across(hull) for hull in hulls], width, period)
    surface = surface_among(hulls, cover, grain_volume, width[0] * width[1])
    cut = [lowered(hull, surface - depth) for hull, depth in zip(hulls, cover, strict=True)]
    position = [[x + hull.centroid[0], y + hull.centroid[1], hull.centroid[2]]
                for hull, (x, y) in zip(cut, places, strict=True)]  # fmt: skip
    return [ConvexHull(hull.vertices - hull.centroid) for hull in cut], np.array(position).reshape(-1, 3)


def _whole_boulder(boulders: Boulders, generator: np.random.Generator, point_count: int) -> ConvexHull:
    """Return a boulder about its centroid, on the face nearest to that, on which it lies most firmly."""
    diameter = float(boulders.sizes.draw(generator.random(1))[0])
    hull = make_grain_within(generator, point_count, diameter, BOULDER_REACH)
    surface, turn = hull.polyhedron, 2.0 * math.pi * float(generator.random())
    down = surface.face_normals[np.argmin(surface.face_offsets - surface.face_normals @ hull.centroid)]
    # Any direction that is not along the normal makes a frame with it.
    aside = np.cross(down, np.eye(3)[np.argmin(np.abs(down))])
    aside /= np.linalg.norm(aside)
    along = np.cross(down, aside)
    level = math.cos(turn) * along + math.sin(turn) * aside, math.cos(turn) * aside - math.sin(turn) * along
    return ConvexHull((hull.vertices - hull.centroid) @ np.stack([*level, -down], axis=1))


def _across(hull: ConvexHull) -> float:
    """Return how far a hull about its centroid reaches along x and y [m]."""
    return float(np.linalg.norm(hull.vertices[:, :2], axis=1).max())


def free_places(
    generator: np.random.Generator, reach: list[float], width: tuple[float, float], period: tuple[float, float] | None
) -> list[Floats]:  # fmt: skip
    """Return places [m] along x and y at which discs of these radii are apart from each other, and from walls.

    Raises ValueError where there is no room.
    """
    places: list[Floats] = []
    for radius in reach:
        # Where the ground repeats a boulder may lie across a side: its image fills what is missing on the other one.
        slack = np.maximum(0.5 * np.array(width) - (0.0 if period else radius), 0.0)
        for _ in range(PLACES_TRIED):
            place = slack * generator.uniform(-1.0, 1.0, size=2)
            ways = [np.linalg.norm(folded((place - other)[None], period_of(period))) for other in places]
            if all(way > radius + other for way, other in zip(ways, reach, strict=False)):
                places.append(place)
                break
        else:
            raise ValueError(
                f"the {len(reach)} boulders of a bed find no room beside each other on {width[0]:g} x {width[1]:g} m: "
                "lower bed.boulders.coverage or bed.boulders.diameter, or widen the bed"
            )
    return places


def surface_among(hulls: list[ConvexHull], cover: Floats, grain_volume: float, area: float) -> float:
    """Return the height [m] to which grains fill the ground around boulders with so much cover [m] over them.

    By bisection: the grains with their pores, and what of the boulders is between the floor and the surface, fill it.
    """
    pores = grain_volume / SOLID_FRACTION
    low, high = 0.0, (pores + sum(hull.volume for hull in hulls)) / area
    for _ in range(SURFACE_STEPS):
        middle = 0.5 * (low + high)
        buried = sum(_volume_below(lowered(h, middle - c), middle) for h, c in zip(hulls, cover, strict=True))
        low, high = (middle, high) if pores + buried > middle * area else (low, middle)
    return low


def lowered(hull: ConvexHull, top: float) -> ConvexHull:
    """Return a hull moved along z so that its highest point is at a height [m], or lower where it would float there.

    What reaches below the floor is cut off.
    """
    lowest, highest = float(hull.vertices[:, 2].min()), float(hull.vertices[:, 2].max())
    shift = min(max(top, LEAST_HEIGHT * (highest - lowest)) - highest, -lowest)
    cut = cut_below(ConvexHull(hull.vertices + np.array([0.0, 0.0, shift])), 0.0)
    # An overlap within rounding would be followed at steps without end.
    return ConvexHull(cut.vertices + np.array([0.0, 0.0, CLEARANCE * (highest - lowest)]))


def cut_below(hull: ConvexHull, height: float) -> ConvexHull:
    """Return what of a hull is above a height [m]."""
    above = hull.vertices[:, 2] >= height
    if above.all():
        return hull
    ends = hull.polyhedron.lines
    low, high = ends[:, 0, 2] - height, ends[:, 1, 2] - height
    crosses = low * high < 0.0
    part = (low / np.where(crosses, low - high, 1.0))[crosses, None]
    corners = ends[crosses, 0] + part * (ends[crosses, 1] - ends[crosses, 0])
    # To the last bit on the plane.
    corners[:, 2] = height
    return ConvexHull(np.concatenate([hull.vertices[above], corners]))


def _volume_below(hull: ConvexHull, height: float) -> float:
    """Return the volume [m3] of what of a hull is below a height [m]."""
    if hull.vertices[:, 2].max() <= height:
        return hull.volume
    return hull.volume - cut_below(hull, height).volume
