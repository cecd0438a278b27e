"""The ground of MASCOT's landers: beds of the size law of blocks on Ryugu, some with one boulder of 1 to 3 m.

Facts: [Michikami-2019] (size law, number of boulders), [Michikami-2021] (its index).
"""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lithobrake.dem import Material
from lithobrake.geometry.bed_limits import BOULDER_REACH
from lithobrake.touchdown import Bed, BedRecipe, GrainSizes, pour_bed, stored_or_poured
from lithobrake.touchdown.bed import heights_at
from lithobrake.touchdown.grains import Boulders

# Cumulative index of the number of blocks larger than D: of those above 5 m, and the flattest of smaller ones.
INDEX, FLATTEST = 2.65, 1.65
LARGE, LARGE_NUMBER, AREA = 5.0, 4400, 2.7e6  # m, boulders larger than that, m2 of Ryugu
BOULDER = (1.0, 3.0)  # m
GRAIN, DEPTH = (0.13, 0.32), 0.45  # m
GRAVITY = 1.565e-4  # m/s2
LANDER_REACH = 0.223  # m, half the diagonal of MASCOT
BOULDER_BEDS, GRAIN_BEDS, GRAIN_WIDTH = 6, 6, 1.6
# Depth of a boulder's top under the mean surface of the grains [m]; below 0 it stands out.
COVER = {"at the surface": (-0.5, 0.0), "below the surface": (0.1, 0.2)}
# Which part of a boulder is under a place: where it stands out of the grains, or is no deeper than this [m].
DEEPEST = {"at the surface": 0.0, "below the surface": 0.2}
ROCK = Material(density=2000.0, young_modulus=math.sqrt(5e5 * 5e6), poisson_ratio=0.25, restitution=0.55, friction=0.7)


@dataclass(frozen=True, eq=False)
class Ground:
    """A bed and the height of its grains [m]; boulder: diameter of its boulder [m], 0: none."""

    bed: Bed
    boulder: float
    surface: float

    def place(self, generator: np.random.Generator, deepest: float) -> tuple[tuple[float, float], float]:
        """A random place [m], over the boulder where there is one, and how far that stands out there [m, NaN: none]."""
        while True:
            x, y = generator.uniform(-0.5, 0.5, size=2) * self.bed.width
            if self.boulder == 0.0:
                return (float(x), float(y)), math.nan
            out = float(self.bed.boulder_height(np.array([x]), np.array([y]))[0]) - self.surface
            if out >= -deepest:
                return (float(x), float(y)), out


def coverage(index: float) -> float:
    """Part of the ground under boulders of 1 to 3 m, if the law goes on with this cumulative index below 5 m."""
    number, power = LARGE_NUMBER / AREA * LARGE**index, 2.0 - index
    return 0.25 * math.pi * number * index * (BOULDER[1] ** power - BOULDER[0] ** power) / power


def hit_diameter(part: float) -> float:
    """Diameter [m] below which are so many of the boulders that a lander hits, each as often as it is wide in area."""
    power = 2.0 - 0.5 * (INDEX + FLATTEST)
    low, high = (end**power for end in BOULDER)
    return float((low + part * (high - low)) ** (1.0 / power))


def recipe(kind: str, number: int) -> tuple[BedRecipe, float]:
    """What a bed of a kind follows from, and the diameter of its boulder [m]."""
    boulders, diameter, width = None, 0.0, GRAIN_WIDTH
    if kind in COVER:
        diameter = hit_diameter((number + 0.5) / BOULDER_BEDS)
        width = 2.0 * 1.05 * (BOULDER_REACH * diameter + LANDER_REACH)
        low, high = COVER[kind]
        # All depths with all diameters: each number takes another part of the range.
        cover = low + (high - low) * ((5 * number + 2) % BOULDER_BEDS + 0.5) / BOULDER_BEDS
        size = GrainSizes(distribution="constant", lower=diameter, upper=diameter)
        boulders = Boulders(sizes=size, coverage=0.25 * math.pi * (diameter / width) ** 2, cover=(cover, cover))
    sizes = GrainSizes(
        distribution="power_law", lower=GRAIN[0], upper=GRAIN[1], exponent=1.0 + 0.5 * (INDEX + FLATTEST)
    )
    volume = math.pi / 6.0 * float(np.mean(sizes.draw((np.arange(1000) + 0.5) / 1000) ** 3))
    free = width**2 - (0.7 * 0.25 * math.pi * diameter**2)
    return BedRecipe(
        grain_count=round(0.6 * free * DEPTH / volume), sizes=sizes, cloud_point_count=14, width=(width, width),
        material=ROCK, gravity=(0.0, 0.0, -GRAVITY), pour_gravity=0.5, seed=1000 + number, sides="periodic",
        boulders=boulders,
    ), diameter  # fmt: skip


def beds(work: Path, kind: str) -> list[Ground]:
    """The beds of a kind, poured into a folder or taken from the library."""
    count = BOULDER_BEDS if kind in COVER else GRAIN_BEDS
    return [ground(work, kind, number) for number in range(count)]


def ground(work: Path, kind: str, number: int) -> Ground:
    """A bed, poured into a folder unless it is there."""
    of, diameter = recipe(kind, number)
    path = work / f"{kind.replace(' ', '_')}_{number}.h5"
    if not path.exists():
        stored_or_poured(of, path, lambda: pour_bed(of))
    bed = Bed.load(path)
    return Ground(bed, diameter, grain_surface(bed))


def grain_surface(bed: Bed) -> float:
    """Mean height [m] of the grains where no boulder stands out of them."""
    x, y = np.meshgrid(*((np.arange(60) + 0.5) / 60 * width - 0.5 * width for width in bed.width), indexing="ij")
    first = bed.boulder_count
    grains = heights_at(x, y, bed.grains[first:], bed.position[first:], bed.orientation[first:], bed.period)
    beside = grains > bed.boulder_height(x, y) if first else np.isfinite(grains)
    return float(grains[beside].mean())
