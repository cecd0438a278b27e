"""Who rebounds, slow or fast? A 2 cm ball on coarse grains, over the Froude number (Y1, Y2).

    python validation/experiments/who_rebounds.py --work FOLDER --out FOLDER [--drops 6] [--kinds NAME ...]

Froude number: speed at the first touch over sqrt(g D), D the ball's diameter. Where grains pull on each other, gravity
is a second number. Drops draw bed and place, the same in every cell. Rows that stand in who_rebounds.csv are not run
again. Sources: [Brisset-2018], [Colwell-2003], [Brisset-2020].
"""

import itertools
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Ball, touch_height

from lithobrake.dem import Material, Shape, Sphere, World
from lithobrake.touchdown import settling
from lithobrake.touchdown.grains import make_grain
from lithobrake.touchdown.pouring import rain

NAME = "who_rebounds.csv"
EARTH, DIAMETER = 9.81, 0.02  # m/s2; m, of the ball
FROUDE = (1.0, 3.0, 10.0, 30.0, 100.0)
BEDS = 3
# Contact parameters are ours: the sources have none. Rolling resistance stands for the edges of sand.
QUARTZ = Material(
    young_modulus=1e7, poisson_ratio=0.25, restitution=0.6, friction=0.5, density=2650.0, rolling_friction=0.1
)
# Modulus over density v^2 and over density g D, at least. At 2000 the ball, of the mass of many grains, presses one in
# by a quarter, and comes deeper.
STIFF = 20_000.0
PULLED = 9000.0  # modulus over surface energy over grain, at least: a pull then presses in by a hundredth of a grain
FALL_SPEED = 3.0  # sqrt(g d), the most at which grains fall while they are poured
LOCAL = 20.0  # steps of its own that each contact takes while grains fall
STEPS = 30.0  # in the shortest contact while the ball comes down
# A bed is at rest where all but a twentieth of its grains are below so much of the ball's speed.
CALM = 1e-3
PATIENCE = 2000  # looks
LOOKS = 100  # in the time in which the ball would go its diameter
# Stopped: for half of the time since its first touch the ball has been below this share of its speed.
STOPPED = 5e-3
LONGEST = 4.0  # diameters over speed, after which a ball is given up
FLOWN = 5e-4  # m that a ball has risen freely where it is let go


@dataclass(frozen=True, kw_only=True)
class Kind:
    grain: float = 0.004  # m, mean diameter; from .85 to 1.15 of it
    hulls: bool = False
    width: float = 0.06  # m, after which the ground repeats
    depth: float = 0.02  # m, if they fill 0.58 of it
    material: Material = QUARTZ
    ball_density: float = 2650.0  # kg/m3, quartz
    stiff: float = STIFF
    surface_energy: float = 0.0  # J/m2
    share: float = 1.0  # of Earth's gravity; of no account where nothing pulls
    steps: float = STEPS
    froude: tuple[float, ...] = FROUDE

    def scaled(self, froude: float) -> tuple[float, float, Material]:
        """Return the speed [m/s], gravity [m/s2] and material of the similar drop on grains of the given modulus."""
        gravity, stuff = EARTH * self.share, self.material
        speed = froude * math.sqrt(gravity * DIAMETER)
        needed = max(
            self.stiff * stuff.density * max(speed**2, gravity * DIAMETER), PULLED * self.surface_energy / self.grain
        )
        scale = stuff.young_modulus / needed
        return speed * math.sqrt(scale), gravity * scale, replace(stuff, surface_energy=self.surface_energy * scale)


OF_THE_POUR = ("grain", "hulls", "width", "depth", "material")
FEW = (3.0, 30.0)
LUNAR = 0.0029  # J/m2, of clean lunar soil [Perko-2001]
TEFLON = 2200.0  # kg/m3
COARSE = Kind(grain=0.006)
PULLING = replace(COARSE, surface_energy=LUNAR, steps=40.0)
PEBBLES = Kind(grain=0.01, hulls=True, width=0.09, depth=0.035, froude=(3.0, 30.0, 300.0))
ROCK = 0.83  # restitution of rock on rock [Durda-2011]
KINDS = {
    "4 mm": Kind(),
    "6 mm": COARSE,
    "3 mm": Kind(grain=0.003, froude=(30.0,)),
    "lunar, 1e-4 g": replace(PULLING, share=1e-4, froude=(3.0, 10.0, 30.0)),
    "lunar, 1e-3 g": replace(PULLING, share=1e-3, froude=(30.0,)),
    "lunar, 1e-3 g, teflon": replace(PULLING, share=1e-3, ball_density=TEFLON, froude=(1.0, 3.0, 10.0)),
    "lunar, 1e-2 g": replace(PULLING, share=1e-2, froude=FEW),
    "lunar, 4 mm, 1e-4 g": Kind(surface_energy=LUNAR, share=1e-4, steps=40.0, froude=(3.0, 10.0)),
    "lunar, 4 mm, 1e-3 g": Kind(surface_energy=LUNAR, share=1e-3, steps=40.0, froude=(30.0,)),
    "pebbles": PEBBLES,
    "pebbles, restitution 0.83": replace(PEBBLES, material=replace(QUARTZ, restitution=ROCK)),
}


def empty_world(kind: Kind, gravity: float, stuff: Material) -> World:
    """Return ground of a material that repeats, under a gravity [m/s2], without grains."""
    world = World((0.0, 0.0, -gravity), None, period=(kind.width, kind.width))
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    return world


def poured(kind: Kind, seed: int) -> World:
    """Return grains at rest under Earth's gravity."""
    generator = np.random.default_rng([seed, 29])
    count = round(0.58 * kind.width**2 * kind.depth / (math.pi / 6.0 * kind.grain**3))
    sizes = kind.grain * generator.uniform(0.85, 1.15, count)
    grains: list[Shape] = [make_grain(generator, 14, d) if kind.hulls else Sphere(0.5 * d) for d in map(float, sizes)]
    world, width = empty_world(kind, EARTH, kind.material), (kind.width, kind.width)
    world.add_bodies(grains, kind.material, *rain(generator, grains, width, width))
    world.drag = math.sqrt(EARTH / kind.grain) / FALL_SPEED
    world.run_locally(3.0 * math.sqrt(2.0 * float(world.position[:, 2].max()) / EARTH), LOCAL)
    unit = math.sqrt(kind.grain / EARTH)
    for _ in range(PATIENCE):
        settling.run_quietly(world, 0.1 * unit)
        calm = settling.kinetic_ratio(world, kind.grain, EARTH) < settling.KINETIC_RATIO
        if calm and settling.unbalanced_force(world) < settling.UNBALANCED_FORCE:
            return world
    raise ValueError(f"{count} grains were not at rest after {world.time:.3g} s: raise PATIENCE")


def bed(work: Path, name: str, froude: float, seed: int) -> World:
    """Return a bed at rest under the gravity of a Froude number, from the work folder where it is there."""
    kind = KINDS[name]
    path = work / f"rebounds_{name}_{froude:g}_{seed}.h5"
    if not path.exists():
        own = next(key for key, other in KINDS.items() if like(other, kind))
        under_earth = work / f"rebounds_{own}_{seed}.h5"
        if not under_earth.exists():
            poured(kind, seed).save(under_earth)
        brought(World.load(under_earth), kind, froude).save(path)
    return World.load(path)


def like(one: Kind, other: Kind) -> bool:
    """Return whether two kinds are poured alike."""
    return all(getattr(one, key) == getattr(other, key) for key in OF_THE_POUR)


def brought(pressed: World, kind: Kind, froude: float) -> World:
    """Return a bed that was at rest under Earth's gravity, at rest under that of a Froude number."""
    speed, gravity, stuff = kind.scaled(froude)
    period = settling.rest_period(stuff, kind.grain, gravity)
    pressed.drag = settling.contact_drag(period)
    settling.ramp(pressed, np.array([0.0, 0.0, -gravity]), period)
    world, look = pressed, 0.25 * period
    if stuff != kind.material:
        world = of_material(pressed, kind, stuff)
        # A pull of 4 pi R* surface energy, R* of two grains, is a heavier grain.
        pull = math.pi * kind.grain * stuff.surface_energy
        weight = gravity + pull / (math.pi / 6.0 * stuff.density * kind.grain**3)
        period = settling.rest_period(stuff, kind.grain, weight)
        look = 0.05 * period  # overlaps grow at once: steps must keep up
    world.drag = settling.contact_drag(period)
    for _ in range(PATIENCE):
        settling.run_quietly(world, look)
        if np.quantile(np.linalg.norm(world.velocity, axis=1), 0.95) < CALM * speed:
            world.drag = 0.0
            return world
    raise ValueError(f"grains were not at rest at a Froude number of {froude:g}: raise PATIENCE")


def of_material(world: World, kind: Kind, stuff: Material) -> World:
    """Return the same grains at their places, of another material."""
    other = empty_world(kind, -float(world.gravity[2]), stuff)
    other.add_bodies([body.shape for body in world.bodies], stuff, world.position, world.orientation)
    return other


def aimed(world: World, kind: Kind, place: tuple[float, float], speed: float) -> int:
    """Put the ball where it touches the first grain below it, or its bounding sphere; return its number."""
    height = touch_height(world, Ball(DIAMETER, kind.ball_density, place)) + 0.5 * DIAMETER
    stuff = replace(world.bodies[0].material, density=kind.ball_density)
    return world.add_body(Sphere(0.5 * DIAMETER), stuff, (*place, height), velocity=(0.0, 0.0, -speed))


def touching(world: World) -> np.ndarray:
    """Return of each body whether it touches another or a wall, shape [bodies]."""
    contacts = world.contacts()
    found = np.zeros(len(world.bodies), dtype=bool)
    found[contacts["body_a"]] = True
    found[contacts["body_b"][contacts["body_b"] >= 0]] = True
    return found


class Ejecta:
    """How high grains fly above where they lay, once nothing touches them."""

    def __init__(self, world: World) -> None:
        self.lay, self.gravity = world.position[:, 2], -float(world.gravity[2])

    def told(self, world: World, grain: float, speed: float) -> Row:
        """Return how many grains rise by more than their mean diameter [m], and how fast, over a speed [m/s]."""
        count = len(self.lay)
        free, velocity = ~touching(world)[:count], world.velocity[:count]
        up = np.maximum(velocity[:, 2], 0.0)
        high = world.position[:count, 2] - self.lay + up**2 / (2.0 * self.gravity)
        fast = np.linalg.norm(velocity[free & (high > grain)], axis=1) / speed
        return {
            "ejecta": len(fast), "ejecta_speed": float(fast.mean()) if len(fast) else 0.0,
            "fastest": float(fast.max()) if len(fast) else 0.0,
        }  # fmt: skip


def followed(world: World, ball: int, speed: float, steps: float) -> Row:
    """Follow a ball until it flies off, or stops; return how deep it comes and how high and fast it leaves.

    Its rise is that above its deepest place, by free flight to its end where nothing touches it. Its speed out is the
    one at which it goes up fastest.
    """
    gravity, begun = -float(world.gravity[2]), world.time
    # Not local steps: they keep a bed at rest jittering, at a rate that a slow ball would feel.
    world.time_step = world.shortest_contact(max(speed, math.sqrt(gravity * DIAMETER))) / steps
    pace = max(round(DIAMETER / (LOOKS * speed) / world.time_step), 1) * world.time_step
    start = deepest = float(world.position[ball, 2])
    struck, slow_since, top, out, status = False, math.inf, deepest, np.zeros(3), "longest"
    while world.time - begun < LONGEST * DIAMETER / speed:
        world.run(duration=pace)
        now, height, velocity = world.time - begun, float(world.position[ball, 2]), world.velocity[ball]
        free = not touching(world)[ball]
        struck = struck or not free
        if height < deepest:
            deepest, top, out = height, height, np.zeros(3)
        if struck and velocity[2] > 0.0:
            out = velocity if velocity[2] > out[2] else out
            top = max(top, height + (float(velocity[2]) ** 2 / (2.0 * gravity) if free else 0.0))
            if free and height - deepest > FLOWN:
                status = "left"
                break
        slow_since = min(slow_since, now) if struck and np.linalg.norm(velocity) < STOPPED * speed else math.inf
        if now - slow_since > 0.5 * now:
            status = "stopped"
            break
    return {
        "status": status, "depth": start - deepest, "rise": top - deepest,
        "speed_out": float(np.linalg.norm(out)) / speed,
        "upward_out": float(out[2]) / speed, "time": (world.time - begun) * speed / DIAMETER,
    }  # fmt: skip


def drop(work: Path, name: str, froude: float, number: int) -> Row:
    """Let one ball meet a bed and return its row: lengths as they are, speeds over the ball's at its first touch."""
    kind, seed = KINDS[name], number % BEDS + 1
    start = time.process_time()
    speed = kind.scaled(froude)[0]
    world = bed(work, name, froude, seed)
    x, y = (float(at) for at in np.random.default_rng([7, number]).uniform(0.0, kind.width, 2))
    ejecta = Ejecta(world)
    ball = aimed(world, kind, (x, y), speed)
    row = followed(world, ball, speed, kind.steps)
    return {
        "kind": name, "froude": froude, "drop": number, "bed": seed, "grains": ball, **row,
        **ejecta.told(world, kind.grain, speed), "cpu_s": time.process_time() - start,
    }  # fmt: skip


def missing(names: list[str], drops: int, table: Path) -> Iterator[tuple[str, float, int]]:
    """Yield kind, Froude number and number of the drops that have no row; cells fill evenly."""
    ran = {(row["kind"], row["froude"], row["drop"]) for row in read_rows(table)}
    for number, name in itertools.product(range(drops), names):
        for froude in KINDS[name].froude:
            if (name, froude, number) not in ran:
                yield name, froude, number


def main() -> None:
    given = options_of(__doc__, drops=6, kinds=tuple(KINDS))
    for cell in missing(given.kinds, given.drops, given.out / NAME):
        note(given.out / NAME, drop(given.work, *cell))


if __name__ == "__main__":
    main()
