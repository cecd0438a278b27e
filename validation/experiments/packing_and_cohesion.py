"""How much looser grains that pull on each other lie: volumes settled under less gravity (X4).

    python validation/experiments/packing_and_cohesion.py --work FOLDER --out FOLDER [--kinds NAME ...]

By similarity one curve of volume against pull over weight stands for every gravity. Rows that stand in
packing_and_cohesion.csv are not run again. Source: [Keulen-2026].
"""

import itertools
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from result_rows import note, options_of, read_rows
from sphere_bed import LOOKS, PATIENCE, POUR_STEPS, Floats, add_box

from lithobrake.dem import ConvexHull, Material, Shape, Sphere, World
from lithobrake.touchdown import settling
from lithobrake.touchdown.grains import make_grain
from lithobrake.touchdown.pouring import rain

NAME = "packing_and_cohesion.csv"
PULLS = (0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0)  # of a contact, over the weight of the mean grain
GRAVITY = 9.81
# Filled to where a heap fills 0.58 of its box, in mean grains.
WIDTH, DEPTH = 9.0, 14.0
# sqrt(g d), the most at which grains fall.
FALL_SPEED = 3.0
# Times of free fall through the column for which contacts take steps of their own.
FALLING = 3
LOST = 2.0  # mean grains below the surface and above the floor that are not counted


@dataclass(frozen=True)
class Kind:
    """Grains of an experiment."""

    diameters: tuple[float, float]  # m, smallest and largest; volumes spread evenly between
    density: float  # kg/m3
    hulls: bool
    restitution: float
    friction: float
    pulls: tuple[float, ...] = PULLS

    @property
    def mean(self) -> float:
        """Mean diameter [m]."""
        return 0.5 * sum(self.diameters)


# Sizes are the source's; the rest is ours. Glass is beads, basalt is broken.
KINDS = {
    "glass": Kind((0.75e-3, 1e-3), 2500.0, False, 0.8, 0.4),
    "coarse basalt": Kind((2e-3, 5e-3), 2900.0, True, 0.6, 0.6, PULLS[:-1]),
}
SEEDS = (1,)


def material_of(kind: Kind, pull: float) -> Material:
    """Return the material: as stiff as makes the lowest grains sink in by some thousandth of a grain."""
    weight = kind.density * math.pi / 6.0 * kind.mean**3 * GRAVITY
    return Material(
        young_modulus=2e4 * kind.density * GRAVITY * kind.mean, poisson_ratio=0.25, restitution=kind.restitution,
        friction=kind.friction, density=kind.density, cohesion_force=pull * weight,
    )  # fmt: skip


def shapes(kind: Kind, generator: np.random.Generator) -> list[Shape]:
    count = round(0.58 * WIDTH**2 * DEPTH / (math.pi / 6.0))
    sizes = generator.uniform(*kind.diameters, count)
    if kind.hulls:
        return [make_grain(generator, 14, float(size)) for size in sizes]
    return [Sphere(0.5 * float(size)) for size in sizes]


def filled(kind: Kind, pull: float, seed: int) -> tuple[World, Floats]:
    """Return grains at rest that fell as a loose column under a drag, and their volumes [m3]."""
    generator = np.random.default_rng([seed, 7])
    grains, stuff = shapes(kind, generator), material_of(kind, pull)
    world = World((0.0, 0.0, -GRAVITY), None)
    width = WIDTH * kind.mean
    for grain, place, turn in zip(grains, *rain(generator, grains, (width, width)), strict=True):
        world.add_body(grain, stuff, place, orientation=tuple(turn))
    add_box(world, width, 0.0, stuff)
    world.drag = math.sqrt(GRAVITY / kind.mean) / FALL_SPEED
    fall(world, kind)
    return world, np.array([volume(grain) for grain in grains])


def volume(grain: Shape) -> float:
    """Return the volume of a grain [m3]."""
    if isinstance(grain, Sphere):
        return 4.0 / 3.0 * math.pi * grain.radius**3
    assert isinstance(grain, ConvexHull)
    return grain.volume


def fall(world: World, kind: Kind) -> None:
    """Let all come to rest: what is left of the energy lifts them by less than 1e-5 of a grain, and forces balance.

    Raises ValueError where they are not at rest after their patience.
    """
    duration = math.sqrt(2.0 * float(world.position[:, 2].max()) / GRAVITY)
    world.time_step = world.shortest_contact(2.0 * GRAVITY / world.drag) / POUR_STEPS
    for look in range(PATIENCE * LOOKS):
        # What falls is stepped by what it meets; forces balance only at a common step.
        if look < FALLING * LOOKS:
            world.run_locally(duration / LOOKS, POUR_STEPS)
            continue
        world.run(duration=duration / LOOKS)
        at_rest = settling.kinetic_ratio(world, kind.mean, GRAVITY) < settling.KINETIC_RATIO
        if at_rest and settling.unbalanced_force(world) < settling.UNBALANCED_FORCE:
            return
    raise ValueError(f"grains were not at rest after {world.time:.3g} s: raise PATIENCE")


def solid_fraction(world: World, volumes: Floats, kind: Kind) -> float:
    """Return the share of space that grains fill, between two grains above the floor and two below the surface.

    Counted as the volume of the grains whose centroids lie in that layer, over the layer.
    """
    height = world.position[:, 2]
    low, high = LOST * kind.mean, float(np.quantile(height, 0.98)) - LOST * kind.mean
    inside = (height > low) & (height < high)
    return float(volumes[inside].sum() / ((WIDTH * kind.mean) ** 2 * (high - low)))


def missing(kinds: list[str], table: Path) -> Iterator[tuple[str, float, int]]:
    ran = {(row["kind"], row["pull"], row["seed"]) for row in read_rows(table)}
    for seed, name in itertools.product(SEEDS, kinds):
        yield from ((name, pull, seed) for pull in KINDS[name].pulls if (name, pull, seed) not in ran)


def main() -> None:
    given = options_of(__doc__, kinds=tuple(KINDS))
    for name, pull, seed in missing(given.kinds, given.out / NAME):
        start = time.process_time()
        world, volumes = filled(KINDS[name], pull, seed)
        row = {
            "kind": name, "pull": pull, "seed": seed, "grains": len(volumes),
            "solid_fraction": solid_fraction(world, volumes, KINDS[name]),
            "coordination": 2.0 * float((world.contacts()["body_b"] >= 0).sum()) / len(volumes),
            "cpu_s": time.process_time() - start,
        }  # fmt: skip
        note(given.out / NAME, row)


if __name__ == "__main__":
    main()
