"""Bulk checks of the soft-surface engine, too long for the tests: what many grains do together.

    python validation/bulk.py [CHECK ...] [--out validation]

CHECK is any of compression, friction, repose, froude, packing (none: all). Each writes bulk_CHECK.json with its
numbers, date, command and machine, anew after every row; bulk_figures.py draws them.
"""

import itertools
import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from bulk_shapes import PLATONIC
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lithobrake.dem import ConvexHull, Material, Shape, Sphere, World
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, pour_bed
from lithobrake.touchdown.bed import rotation_matrix
from lithobrake.touchdown.grains import make_grain
from lithobrake.touchdown.pouring import rain
from lithobrake.touchdown.simulation import relax, release

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row as Result
from harness import command_line, origin, write_document

Floats = NDArray[np.float64]


def rock(**changes: float) -> Material:
    """A soft, dissipative rock."""
    values = {"young_modulus": 1e7, "poisson_ratio": 0.25, "restitution": 0.5, "friction": 0.5, "density": 2500.0}
    return Material(**{**values, **changes})


def lattice(count: int, pitch: float, width: float, generator: np.random.Generator) -> Floats:
    """Places on a cubic lattice above a square floor of a width, moved a little at random."""
    row = int(width / pitch * (1.0 + 1e-9))  # a width of whole pitches may come out a bit short
    index = np.arange(count)
    places = np.stack([index % row, index // row % row, index // row**2], axis=1) + 0.5
    return places * pitch - [0.5 * width, 0.5 * width, 0.0] + 0.02 * pitch * generator.uniform(-1, 1, (count, 3))


def add_walls(world: World, low: Floats, high: Floats, material: Material, top: bool) -> None:
    """Add the inner walls of a box; with or without its lid."""
    for axis in range(3):
        for sign, corner in ((1.0, low), (-1.0, high)):
            if axis == 2 and sign < 0 and not top:
                continue
            normal = np.zeros(3)
            normal[axis] = sign
            world.add_plane(corner, normal, material)


def inside_share(position: Floats, radius: float, low: Floats, high: Floats) -> float:
    """Solid fraction of equal spheres in a box, by points on a fine grid."""
    axes = [np.linspace(a, b, 60, endpoint=False) + 0.5 * (b - a) / 60 for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    nearest, _ = cKDTree(position).query(grid)
    return float((nearest < radius).mean())


def rattle_free(world: World, inner: NDArray[np.bool_], least: int) -> float:
    """Mean contacts of the inner spheres that have so many at least: four hold a sphere, with friction two."""
    contacts = world.contacts()
    a, b = contacts["body_a"], contacts["body_b"]
    keep = np.ones(len(world.bodies), dtype=bool)
    while True:
        alive = keep[a] & ((b < 0) | keep[np.maximum(b, 0)])
        number = np.bincount(a[alive], minlength=len(keep)) + np.bincount(b[alive & (b >= 0)], minlength=len(keep))
        fallen = keep & (number < least)
        if not fallen.any():
            return float(number[keep & inner].mean())
        keep &= ~fallen


def compress(friction: float, seed: int, count: int = 1500) -> Result:
    """Press spheres together from all six sides up to a small pressure; return what they look like inside.

    Source: Agnolin and Roux (2007), Phys. Rev. E 76, 061302: solid fraction 0.639 and 0.593, coordination 6 and 4.5.
    """
    generator = np.random.default_rng(seed)
    radius, pressure = 0.005, 20.0
    stuff, wall = (rock(young_modulus=1e7, restitution=0.3, friction=value) for value in (friction, 0.0))
    width = count ** (1 / 3) * 2.15 * radius
    width = math.ceil(width / (2.15 * radius)) * 2.15 * radius
    world = World((0.0, 0.0, 0.0), 2e-5)
    ball = Sphere(radius)
    for place in lattice(count, 2.15 * radius, width, generator):
        world.add_body(ball, stuff, place, velocity=0.1 * generator.normal(size=3))
    low, high = np.array([-0.5 * width, -0.5 * width, 0.0]), np.array([0.5 * width, 0.5 * width, width])
    add_walls(world, low, high, wall, top=True)
    world.run(steps=5000)
    inertial = 1e-3 / (2.0 * radius * math.sqrt(2500.0 / pressure))  # strain rate at inertial number 1e-3
    block, calm = 50, 0
    for _ in range(40_000):
        contacts = world.contacts()
        on_wall = contacts["body_b"] < 0
        force = np.array(
            [contacts["normal_force"][on_wall & (contacts["body_b"] == -1 - k)].sum() for k in range(6)]
        )  # fmt: skip
        side = high - low
        area = np.array([side[1] * side[2], side[0] * side[2], side[0] * side[1]])
        load = (force[0::2] + force[1::2]) / (2.0 * area) / pressure
        rate = 10.0 * inertial * np.clip(1.0 - load, -1.0, 1.0) if load.max() < 0.1 else inertial * np.clip(
            1.0 - load, -1.0, 1.0
        )  # fmt: skip
        move = 0.5 * side * rate * block * world.time_step
        low, high = low + move, high - move
        for axis in range(3):
            world.move_plane(2 * axis, low)
            world.move_plane(2 * axis + 1, high)
        world.run(steps=block)
        calm = calm + 1 if np.abs(load - 1.0).max() < 0.02 else 0
        if calm > 200:
            break
    margin = 4.0 * radius
    inner = np.all((world.position > low + margin) & (world.position < high - margin), axis=1)
    return {
        "friction": friction, "seed": seed, "count": count, "settled": calm > 200,
        "pressure_over_modulus": pressure / (1e7 / (1 - 0.25**2)),
        "solid_fraction": inside_share(world.position, radius, low + margin, high - margin),
        "coordination_without_rattlers": rattle_free(world, inner, 2 if friction > 0.0 else 4),
        "time_s": world.time,
    }  # fmt: skip


def compression() -> Iterator[Result]:
    """Isotropic compression, with and without friction."""
    for seed in (1, 2):
        for friction in (0.0, 0.3):
            yield compress(friction, seed)


def bed_of(friction: float, seed: int, count: int = 150, size: float = 0.09) -> Any:
    """A bed of hulls poured and settled under a milligravity."""
    sizes = GrainSizes(distribution="constant", lower=size, upper=size)
    return pour_bed(
        BedRecipe(
            grain_count=count, sizes=sizes, cloud_point_count=14, width=(0.7, 0.7),
            material=rock(young_modulus=2e6, friction=friction), gravity=(0.0, 0.0, -1e-3), pour_gravity=0.1, seed=seed,
            contact=ContactModel(steps_per_contact=30.0),
        )
    )  # fmt: skip


def friction() -> Iterator[Result]:
    """Solid fraction and coordination of poured beds of hulls against friction."""
    for value in (0.1, 0.3, 0.5, 0.9):
        for seed in (1, 2, 3):
            bed = bed_of(value, seed)
            yield {"friction": value, "seed": seed, "solid_fraction": bed.solid_fraction,
                   "coordination": bed.coordination_number}  # fmt: skip


def slope_of(position: Floats, radius: float, length: float) -> float:
    """Angle [deg] of the free surface: a line through the highest grain of each slice."""
    edges = np.arange(0.0, length, 2.0 * radius)
    middle, top = [], []
    for low in edges[1:-1]:
        here = position[(position[:, 0] >= low) & (position[:, 0] < low + 2.0 * radius)]
        if len(here):
            middle.append(low + radius)
            top.append(here[:, 2].max())
    return math.degrees(math.atan(-np.polyfit(middle, top, 1)[0]))


def drained(corners: int, friction: float, seed: int, count: int = 600) -> Result:
    """Fill a narrow box with hulls of so many points (0: spheres), open one end above its lowest two layers, and
    measure the slope of what stays on them. It is filled high enough for 45 deg: where height_left is 1 the slope
    does not reach the back, and the angle is too small.
    """
    generator = np.random.default_rng(seed)
    radius, length, depth = 0.01, 0.2, 0.08
    stuff, smooth = rock(young_modulus=1e8, friction=friction), rock(young_modulus=1e8, friction=0.0)
    world = World((0.0, 0.0, -9.81), None)
    sphere = Sphere(radius)
    middle = np.array([0.5 * length, 0.0, 0.0])
    grains: list[Shape] = [make_grain(generator, corners, 2.0 * radius) if corners else sphere for _ in range(count)]
    for grain, place, turn in zip(grains, *rain(generator, grains, (length, depth)), strict=True):
        world.add_body(grain, stuff, place + middle, orientation=turn)
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    world.add_plane((0, 0, 0), (1, 0, 0), stuff)
    for sign in (-1.0, 1.0):
        world.add_plane((0, 0.5 * sign * depth, 0), (0, -sign, 0), smooth)
    # What falls over the ledge is caught below: a body in free fall for ever would wear out the neighbour list.
    world.add_plane((0, 0, -12.0 * radius), (0, 0, 1), stuff)
    gate = world.add_plane((length, 0, 0), (-1, 0, 0), stuff)
    world.time_step = world.shortest_contact(3.0) / 50.0
    world.drag = 2.0
    world.run(duration=1.0)
    while np.abs(world.velocity).max() > 0.2:  # the rain of angular grains is high, and takes longer to fall
        world.run(duration=0.2)
    world.drag = 0.0
    world.run(duration=0.3)
    filled = float(world.position[:, 2].max())
    # What lies at the bottom stays behind the gate: a floor of grains, as rough as the heap.
    world.move_plane(gate, bodies=[int(k) for k in np.flatnonzero(world.position[:, 2] < 4.0 * radius)])
    staying: NDArray[np.intp] = np.arange(count)
    for _ in range(40):
        world.run(duration=0.05)
        staying = np.flatnonzero((world.position[:, 0] < length) & (world.position[:, 2] > 0.0))
        world.move_plane(0, bodies=[int(k) for k in staying])
        if np.abs(world.velocity[staying]).max() < 5e-3:
            break
    left = world.position[staying]
    kind = f"{corners}-point hull" if corners else "sphere"
    return {"kind": f"{kind}, friction {friction}", "seed": seed, "grains": count, "stayed": len(staying),
            "time_s": world.time, "height_left": float(left[:, 2].max()) / filled,
            "angle_deg": slope_of(left, radius, length)}  # fmt: skip


def repose() -> Iterator[Result]:
    """Angle of repose of spheres and of hulls. Expected: about 25 deg rounded, 40 deg angular (Kleinhans 2011)."""
    for seed in (1, 2):
        for corners, friction in ((0, 0.6), (14, 0.6), (6, 0.9)):
            yield drained(corners, friction, seed)


def dropped(bed: Bed, ball: Lander, place: Floats, gravity: float, number: float) -> Result:
    """Drop a ball at a Froude number v / sqrt(g D) and follow it for four times sqrt(D / g).

    Returns how deep it comes, and how long it takes to nine tenths of that.
    """
    size = 2.0 * ball.shape.bounding_radius
    speed = number * math.sqrt(gravity * size)
    landing = Landing(
        grain=ball.material, speed=speed, incidence=0.0, azimuth=0.0, place=tuple(place),
        orientation=(1.0, 0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0), gravity=(0.0, 0.0, -gravity), time_limit=1.0,
        contact=ContactModel(steps_per_contact=30.0),
    )  # fmt: skip
    world = bed.world(landing.grain, bed.gravity, landing.contact)
    relax(world, bed, landing)
    body = release(world, bed, ball, landing)
    world.time_step = world.shortest_contact(speed) / landing.contact.steps_per_contact
    world.watch(body)
    path = []
    end = world.time + 4.0 * math.sqrt(size / gravity)
    while world.time < end:
        height = float(world.position[body, 2])
        world.run(steps=20)
        if world.first_touch is not None:
            path.append((height, world.time))
    heights, times = np.array(path).T
    depths = heights[0] - heights
    most = int(np.argmax(depths >= 0.9 * depths.max()))
    return {
        "gravity": gravity, "froude": number, "penetration_over_diameter": float(depths.max()) / size,
        "duration_scaled": (times[most] - times[0]) * math.sqrt(gravity / size),
        "peak_over_v2_per_diameter": world.watched["peak_force"] / ball.mass * size / speed**2,
    }  # fmt: skip


def froude() -> Iterator[Result]:
    """A heavy sphere dropped into beds at three gravities, at equal Froude numbers v / sqrt(g D).

    Low ones: at 1 m/s2 the fastest would press these soft grains together by a tenth of their size.
    Source of the scaling: Sunday et al. (2022), Planetary and Space Science.
    """
    stuff = rock(young_modulus=2e6, friction=0.6)
    size = 0.2
    ball = Lander(shape=Sphere(0.5 * size), mass=2500.0 * math.pi / 6 * size**3, inertia=None, material=stuff)
    for seed in (1, 2):
        bed = bed_of(0.6, seed, count=450, size=0.07)
        generator = np.random.default_rng(seed)
        for place in generator.uniform(-0.1, 0.1, size=(2, 2)):
            for gravity, number in itertools.product((1e-3, 1e-2, 1e-1), (1.0, 2.0, 4.0)):
                yield {"seed": seed} | dropped(bed, ball, place, gravity, number)


def packed(name: str, seed: int, count: int = 800) -> Result:
    """Rain solids of one shape into a box and measure what they fill amid it, away from walls, floor and top.

    At random places: from a lattice cubes pile up in columns, and fill 0.45 where rain fills 0.55.
    Source: Baker and Kudrolli (2010), Phys. Rev. E 82, 061304: loose 0.51, 0.54, 0.52, 0.51, 0.50, +-0.01.
    """
    generator = np.random.default_rng(seed)
    size, width = 0.05, 0.4
    corners = PLATONIC[name]
    shape = ConvexHull(corners * (math.pi / 6 / ConvexHull(corners).volume) ** (1 / 3) * size)
    stuff = rock(young_modulus=5e7, friction=0.5, restitution=0.3)
    world = World((0.0, 0.0, -9.81), None)
    for place, turn in zip(*rain(generator, [shape] * count, (width, width)), strict=True):
        world.add_body(shape, stuff, place, orientation=turn)
    big = np.array([0.5 * width, 0.5 * width, 0.0])
    add_walls(world, -big, big, stuff, top=False)
    world.time_step = world.shortest_contact(2.0) / 60.0
    for drag, duration in ((5.0, 5.0), (0.0, 0.5)):  # it falls at 2 m/s, from up to 9 m
        world.drag = drag
        world.run(duration=duration)
    top = np.quantile(world.position[:, 2], 0.7)
    points = generator.uniform([-0.3 * width, -0.3 * width, size], [0.3 * width, 0.3 * width, top], (100_000, 3))
    filled = np.zeros(len(points), dtype=bool)
    equations = shape.core_polyhedron  # faces of the core stand a rounding radius behind those of the solid
    for place, turn in zip(world.position, world.orientation, strict=True):
        near = np.flatnonzero(np.linalg.norm(points - place, axis=1) < shape.bounding_radius)
        seen = (points[near] - place) @ rotation_matrix(turn)
        filled[near] |= np.all(seen @ equations.face_normals.T <= equations.face_offsets + shape.rounding, axis=1)
    contacts = world.contacts()
    return {"shape": name, "seed": seed, "count": count, "solid_fraction": float(filled.mean()),
            "coordination": 2.0 * int((contacts["body_b"] >= 0).sum()) / count,
            "fastest_m_s": float(np.abs(world.velocity).max())}  # fmt: skip


def packing() -> Iterator[Result]:
    """Loose packings of the Platonic solids, by pouring."""
    for seed in (1, 2):
        for name in PLATONIC:
            yield packed(name, seed)


CHECKS: dict[str, Callable[[], Iterator[Result]]] = {
    "repose": repose, "compression": compression, "friction": friction, "packing": packing, "froude": froude,
}  # fmt: skip


def main() -> None:
    parser = command_line(__doc__, out=Path(__file__).parent)
    parser.add_argument("check", nargs="*", default=[*CHECKS])
    chosen = parser.parse_args()
    for name in chosen.check:
        start = time.process_time()
        rows: list[Result] = []
        for row in CHECKS[name]():
            rows.append(row)
            document = {
                "check": name, **origin(f"validation/bulk.py {name}"),
                "cpu_s": round(time.process_time() - start), "rows": rows,
            }  # fmt: skip
            write_document(chosen.out / f"bulk_{name}.json", document)
            print(f"{name}: {document['cpu_s']} s of CPU time, {row}", flush=True)


if __name__ == "__main__":
    main()
