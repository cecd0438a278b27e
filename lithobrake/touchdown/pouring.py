"""Making a bed: grains rain on a floor under a strong gravity, which is then lowered to the local one."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lithobrake.dem import ConvexHull, Material, Shape, World, folded, period_of
from lithobrake.geometry.bed_limits import longest_reach
from lithobrake.touchdown import settling
from lithobrake.touchdown.bed import SIDES, Bed, ContactModel, Floats, boxed_world, height_map
from lithobrake.touchdown.grains import Boulders, GrainSizes, make_grain_within, place_boulders, random_orientation
from lithobrake.vocabulary.array_types import Vector
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.field_errors import FieldError

RAIN_PLACES = 100  # tried for each grain
RAIN_DEPTH = 4.0  # of the largest bounding radius, below which no place is looked for at first
FALL_STEPS = 6.0  # at most, in each contact: the bed does not remember how its grains bounced
FALL_CHECKS = 40  # looks at the grains in the time that the highest falls
FALLS_PATIENCE = 25  # after so many times of that the pour is given up
LYING = 1e-3  # kinetic ratio below which the grains lie, and only have to settle
LYING_CHECKS = 4  # in a row
LYING_STEPS = 40.0  # at least, in a grain's small oscillation at its rest overlap under the pour gravity
# Of grains that settle: the dashpots of pairs that bounce less bound the step of a bed, and it comes to lie no sooner.
SETTLING_RESTITUTION = 0.9
PERIODS_LOOSENED = 10.0  # of a grain's small oscillation at its rest overlap under the local gravity
TOPPLING_TIMES = 3.0  # sqrt(diameter / gravity), for which a bed must rest before its gravity is lowered
# A bed in which a grain creeps on, at a hundredth of its weight against the drag, is poured anew, so often in all.
POURS = 3
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
BOULDERS = 1  # word of the seed of a bed's boulders
RUNG = 100.0  # gravity under which loosened grains fall, over the local one: they fall ten times as fast


@dataclass(frozen=True, kw_only=True)
class BedRecipe:
    """Everything a bed follows from. Raises ValueError where no bed can come of it."""

    grain_count: int
    sizes: GrainSizes
    cloud_point_count: int
    width: tuple[float, float]  # m, along x and y, between the walls or until the ground repeats
    material: Material
    gravity: tuple[float, float, float]  # m/s2, it settles under this; z up is normal to the mean surface
    pour_gravity: float  # m/s2, it falls under this, along -z
    seed: int
    contact: ContactModel = field(default_factory=ContactModel)
    sides: str = "walls"  # or "periodic", see Bed
    boulders: Boulders | None = None  # among the grains

    @property
    def period(self) -> tuple[float, float] | None:
        """Lengths after which the ground repeats along x and y [m]; None in a box."""
        return self.width if self.sides == "periodic" else None

    def __post_init__(self) -> None:
        strength = math.sqrt(sum(g * g for g in self.gravity))
        for name, fine, allowed in (
            ("grain_count", self.grain_count >= 1, "at least 1"),
            ("sides", self.sides in SIDES, " or ".join(f'"{word}"' for word in SIDES)),
            ("cloud_point_count", self.cloud_point_count >= 4, "at least 4"),
            ("width", min(self.width) >= 2.0 * self.sizes.upper, f"at least two grains, {2.0 * self.sizes.upper:g} m"),
            ("gravity", self.gravity[2] < 0.0 < strength < math.inf, "a finite vector that points down (z < 0)"),
            ("pour_gravity", strength <= self.pour_gravity < math.inf, f"at least the local one, {strength:g} m/s2"),
        ):
            if not fine:
                raise FieldError(f"BedRecipe.{name}", getattr(self, name), f"is {allowed}")


class Recorder:
    """Notes history and a few frames while a bed is made."""

    def __init__(self, diameter: float) -> None:
        self.diameter = diameter
        self.rows: list[tuple[float, float, float, float]] = []
        self.frames: list[tuple[float, Floats, Floats]] = []

    def note(self, world: World) -> None:
        gravity = float(np.linalg.norm(world.gravity))
        ratio = settling.kinetic_ratio(world, self.diameter, gravity)
        self.rows.append((world.time, ratio, settling.unbalanced_force(world), gravity))

    def frame(self, world: World) -> None:
        self.frames.append((world.time, world.position, world.orientation))

    @property
    def at_rest(self) -> bool:
        return self.rows[-1][1] < settling.KINETIC_RATIO and self.rows[-1][2] < settling.UNBALANCED_FORCE


def pour_bed(recipe: BedRecipe, progress: Progress = silent) -> Bed:
    """Pour grains on a floor and let them settle under the local gravity; pour others where one of them creeps on.

    Raises ValueError where the bed does not come to rest.
    """
    pour = 0
    while True:
        try:
            return _poured(recipe, np.random.default_rng([recipe.seed, pour] if pour else recipe.seed), progress)
        except settling.CreepingBedError:
            pour += 1
            if pour == POURS:
                raise
            progress(0.0, "pouring grains anew")


def _poured(recipe: BedRecipe, generator: np.random.Generator, tell: Progress) -> Bed:
    diameter = recipe.sizes.draw(generator.random(recipe.grain_count))
    count = recipe.cloud_point_count
    # Without walls the width must exceed that of the longest grain several times, so how long one may be is bounded
    # beforehand.
    longest = math.inf if recipe.period is None else longest_reach(count)
    grains = [make_grain_within(generator, count, d, longest) for d in diameter]
    boulders, lying = boulders_of(recipe, grains)
    position, orientation = rain(generator, grains, recipe.width, recipe.period, boulders, lying)
    grains = boulders + grains
    down = (0.0, 0.0, -recipe.pour_gravity)
    frame = recipe.width, recipe.material, down, recipe.contact, recipe.sides
    world = boxed_world(grains, position, orientation, *frame)
    recorder = Recorder(float(diameter.mean()))
    settling_material = replace(recipe.material, restitution=max(SETTLING_RESTITUTION, recipe.material.restitution))

    def at_rest(material: Material, gravity: Vector) -> World:
        frame = recipe.width, material, gravity, recipe.contact, recipe.sides
        other = boxed_world(grains, world.position, world.orientation, *frame)
        other.time = world.time
        return other

    fall(world, recorder, recipe, tell)
    world = at_rest(settling_material, down)
    lie(world, recorder, recipe, tell)
    # Without friction and walls, nothing would hold a bed on a slope.
    inward = (0.0, 0.0, recipe.gravity[2])
    world = at_rest(replace(settling_material, friction=0.0), recipe.gravity if recipe.period is None else inward)
    loosen(world, recorder, recipe, tell)
    world = at_rest(settling_material, recipe.gravity)
    lower(world, recorder, recipe, lambda done: tell(0.7 + 0.15 * done, "letting loose grains fall"))
    settle(world, recorder, recipe, True, lambda done: tell(0.85 + 0.15 * done, "settling under the local gravity"))
    diameter = np.append([2.0 * one.contact_radius for one in boulders], diameter)
    return finished(world, recorder, recipe, grains, diameter)


def boulders_of(recipe: BedRecipe, grains: Sequence[Shape]) -> tuple[list[ConvexHull], Floats]:
    """Return the boulders of a bed, as they are turned, and their centroids [m], shape [count, 3]; mostly none."""
    if recipe.boulders is None:
        return [], np.zeros((0, 3))
    # Numbers of their own: a bed without boulders keeps its grains to the last bit.
    generator = np.random.default_rng([recipe.seed, BOULDERS])
    volume = sum(grain.volume for grain in grains)
    return place_boulders(recipe.boulders, generator, recipe.cloud_point_count, volume, recipe.width, recipe.period)


def rain(
    generator: np.random.Generator, grains: Sequence[Shape], width: tuple[float, float],
    period: tuple[float, float] | None = None, boulders: Sequence[Shape] = (), lying: Floats | None = None,
) -> tuple[Floats, Floats]:  # fmt: skip
    """Return positions and orientations of boulders and then of grains in a column above them, no grain touching.

    Each grain comes to lie as deep as its bounding sphere gets, over those before it, at the best of a few random
    places. period [m]: after which the ground repeats; None: in a box, which holds the bounding spheres. lying: where
    boulders are [m], shape [count, 3], as they are turned.
    """
    first = len(boulders)
    reach = np.array([grain.bounding_radius for grain in (*boulders, *grains)])
    largest = float(reach.max())
    position = np.zeros((len(reach), 3))
    if lying is not None:
        position[:first] = lying
    for k, radius in enumerate(reach[first:], first):
        slack = np.maximum(0.5 * np.array(width) - (radius if period is None else 0.0), 0.0)
        places = slack * generator.uniform(-1.0, 1.0, size=(RAIN_PLACES, 2))
        ground = position[:k, 2].max(initial=0.0) - RAIN_DEPTH * largest
        upper = position[:k, 2] > ground
        heights = lying_heights(places, radius, position[:k][upper], reach[:k][upper], period)
        if heights.min() < ground + 2.0 * largest:
            # So low that those below the ground might count.
            heights = lying_heights(places, radius, position[:k], reach[:k], period)
        best = int(heights.argmin())
        position[k] = *places[best], heights[best]
    turned = [UPRIGHT] * first + [random_orientation(generator) for _ in grains]
    return position, np.array(turned)


def lying_heights(
    places: Floats, radius: float, position: Floats, reach: Floats, period: tuple[float, float] | None = None
) -> Floats:
    """Return how high [m] a sphere comes to lie at places [count, 2], on the floor or on the first sphere below it."""
    touching = radius + reach
    beside = (folded(places[:, None, :] - position[:, :2], period_of(period)) ** 2).sum(axis=2)
    over = np.sqrt(np.maximum(touching**2 - beside, 0.0))
    heights: Floats = np.where(beside < touching**2, position[:, 2] + over, radius).max(axis=1, initial=radius)
    return heights


def fall(world: World, recorder: Recorder, recipe: BedRecipe, tell: Progress) -> None:
    """Let the grains fall, for as long as the highest takes to, each contact at steps of its own."""
    chunk = math.sqrt(2.0 * float(world.position[:, 2].max()) / recipe.pour_gravity) / FALL_CHECKS
    steps = min(FALL_STEPS, recipe.contact.steps_per_contact)
    recorder.frame(world)
    for check in range(FALL_CHECKS):
        world.run_locally(chunk, steps)
        recorder.note(world)
        if check % 8 == 7:
            recorder.frame(world)
        tell(0.4 * check / FALL_CHECKS, "pouring grains")


def lie(world: World, recorder: Recorder, recipe: BedRecipe, tell: Progress) -> None:
    """Let grains that have fallen come to lie still as far as the pour gravity is concerned."""
    fall_time = world.time
    longest = settling.rest_period(recipe.material, recorder.diameter, recipe.pour_gravity) / LYING_STEPS
    # So weak that what nothing holds up still falls, and fast enough for the kinetic criterion to notice.
    world.drag = settling.free_fall_drag(recipe.pour_gravity, recorder.diameter)
    calm = 0
    for check in range((FALLS_PATIENCE - 1) * FALL_CHECKS):
        settling.run_quietly(world, fall_time / FALL_CHECKS, longest)
        recorder.note(world)
        calm = calm + 1 if recorder.rows[-1][1] < LYING else 0
        tell(0.6 - 0.2 * math.exp(-check / FALL_CHECKS), "pouring grains")
        if calm == LYING_CHECKS:
            return
    raise ValueError(
        f"the poured grains were not calm after {FALLS_PATIENCE * fall_time:.3g} s: raise grain.friction or lower "
        "grain.restitution"
    )


def loosen(world: World, recorder: Recorder, recipe: BedRecipe, tell: Progress) -> None:
    """Rid grains under the local gravity, without friction, of what the pour pressed into them.

    A grain that friction wedges keeps the compression of the pour, and would throw up its neighbours when it slips: its
    energy then counts by the local gravity. So the compression is let out at once, under a drag at the frequency of a
    contact of the pour. Nothing moves on by more than about the overlap of that contact.
    """
    pressed = settling.rest_period(recipe.material, recorder.diameter, recipe.pour_gravity)
    loose = settling.rest_period(recipe.material, recorder.diameter, float(np.linalg.norm(recipe.gravity)))
    start = world.time
    world.drag = 2.0 * math.pi / pressed
    while world.time < start + PERIODS_LOOSENED * loose:
        settling.run_quietly(world, loose / settling.CHECKS_PER_PERIOD)
        recorder.note(world)
        tell(0.6 + 0.1 * (world.time - start) / (PERIODS_LOOSENED * loose), "letting out the pressure")
    recorder.frame(world)


def lower(world: World, recorder: Recorder, recipe: BedRecipe, tell: Callable[[float], None]) -> None:
    """Let loosened grains fall into place under more than the local gravity, and bring it down to that.

    Falling under the local gravity would take most of the time that a bed takes to make. Slips while it comes down give
    kicks that a grain on top would fly on for long under the local gravity: they are damped as contacts oscillate.
    """
    local = np.array(recipe.gravity)
    strength = float(np.linalg.norm(local))
    world.gravity = local * min(RUNG, recipe.pour_gravity / strength)
    settle(world, recorder, recipe, False, tell)
    period = settling.rest_period(recipe.material, recorder.diameter, strength)
    world.drag = settling.contact_drag(period)
    settling.ramp(world, local, period)


def settle(
    world: World, recorder: Recorder, recipe: BedRecipe, last: bool, tell: Callable[[float], None]
) -> None:  # fmt: skip
    """Wait until the bed has been at rest for long enough: at last for some periods under drag, then undamped ones.

    Before that under drag alone, for as long as grains take to topple that stand on an edge: under less gravity they
    would take longer.
    """
    strength = float(np.linalg.norm(world.gravity))
    period = settling.rest_period(recipe.material, recorder.diameter, strength)
    drag = settling.free_fall_drag(strength, recorder.diameter)
    first = len(recorder.rows)
    toppling = TOPPLING_TIMES * math.sqrt(recorder.diameter / strength) / period
    damped = settling.PERIODS_RELAXED if last else max(settling.PERIODS_RELAXED, toppling)
    undamped = settling.PERIODS_HELD if last else 0.0

    def at_rest() -> bool:
        recorder.note(world)
        return recorder.at_rest

    def check(held: float) -> None:
        world.drag = drag if held < damped else 0.0
        checks = len(recorder.rows) - first
        tell(1.0 - math.exp(-checks / (settling.PERIODS_HELD * settling.CHECKS_PER_PERIOD)))

    world.drag = drag
    if not settling.rests(world, period, damped + undamped, at_rest, check):
        raise settling.CreepingBedError(settling.restless(world))
    recorder.frame(world)
    tell(1.0)


def finished(world: World, recorder: Recorder, recipe: BedRecipe, grains: list[ConvexHull], diameter: Floats) -> Bed:
    """Return the bed at rest, the first of its grains the boulders."""
    position = folded(world.position, period_of(recipe.period))
    heights = height_map(grains, position, world.orientation, recipe.width, recipe.period)
    contacts = world.contacts()
    area = recipe.width[0] * recipe.width[1]
    frames = {
        "time": np.array([frame[0] for frame in recorder.frames]),
        "position": np.array([frame[1] for frame in recorder.frames]),
        "orientation": np.array([frame[2] for frame in recorder.frames]),
    }
    names = ("time", "kinetic_ratio", "unbalanced_force", "gravity")
    return Bed(
        grains=grains, position=position, orientation=world.orientation, diameter=diameter, width=recipe.width,
        gravity=recipe.gravity, density=recipe.material.density, young_modulus=recipe.material.young_modulus,
        poisson_ratio=recipe.material.poisson_ratio, seed=recipe.seed,
        surface_height=float(heights.mean()), surface_top=float(heights.max()),
        solid_fraction=sum(grain.volume for grain in grains) / (area * float(heights.mean())),
        coordination_number=2.0 * int((contacts["body_b"] >= 0).sum()) / len(grains), sides=recipe.sides,
        boulder_count=len(grains) - recipe.grain_count,
        frames=frames, history=dict(zip(names, np.array(recorder.rows).T, strict=True)),
    )  # fmt: skip
