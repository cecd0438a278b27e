"""Making a bed: grains rain into an open box under a strong gravity, which is then lowered to the local one."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from lithobrake.dem import ConvexHull, Material, World
from lithobrake.touchdown import settling
from lithobrake.touchdown.bed import Bed, ContactModel, Floats, boxed_world
from lithobrake.touchdown.grains import GrainSizes, make_grain, random_orientation
from lithobrake.touchdown.surface import height_map

Progress = Callable[[float, str], None]
FREE_FALL_DAMPING = 2.0  # drag while a bed comes to rest, in units of sqrt(gravity / diameter)
FALLEN = 1e-3  # kinetic ratio below which the grains lie, and only have to settle


@dataclass(frozen=True, kw_only=True)
class BedRecipe:
    """Everything a bed follows from. Raises ValueError where no bed can come of it."""

    grain_count: int
    sizes: GrainSizes
    cloud_point_count: int
    width: tuple[float, float]  # m, inner width of the box along x and y
    material: Material
    gravity: tuple[float, float, float]  # m/s2, it settles under this; z up is normal to the mean surface
    pour_gravity: float  # m/s2, it falls under this, along -z
    seed: int
    contact: ContactModel = field(default_factory=ContactModel)

    def __post_init__(self) -> None:
        strength = math.sqrt(sum(g * g for g in self.gravity))
        for name, fine, allowed in (
            ("grain_count", self.grain_count >= 1, "at least 1"),
            ("cloud_point_count", self.cloud_point_count >= 4, "at least 4"),
            ("width", min(self.width) >= 2.0 * self.sizes.upper, f"at least two grains, {2.0 * self.sizes.upper:g} m"),
            ("gravity", self.gravity[2] < 0.0 < strength < math.inf, "a finite vector that points down (z < 0)"),
            ("pour_gravity", strength <= self.pour_gravity < math.inf, f"at least the local one, {strength:g} m/s2"),
        ):
            if not fine:
                raise ValueError(f"BedRecipe.{name} is {getattr(self, name)!r}; allowed is {allowed}: change it")


class Recorder:
    """Notes history and a few frames while a bed is made."""

    def __init__(self, diameter: float) -> None:
        self.diameter = diameter
        self.rows: list[tuple[float, float, float, float]] = []
        self.frames: list[tuple[float, Floats, Floats]] = []

    def note(self, world: World) -> None:
        """Note the state of rest."""
        gravity = float(np.linalg.norm(world.gravity))
        ratio = settling.kinetic_ratio(world, self.diameter, gravity)
        self.rows.append((world.time, ratio, settling.unbalanced_force(world), gravity))

    def frame(self, world: World) -> None:
        """Note where every grain is."""
        self.frames.append((world.time, world.position, world.orientation))

    @property
    def at_rest(self) -> bool:
        """Whether the last note meets both criteria."""
        return self.rows[-1][1] < settling.KINETIC_RATIO and self.rows[-1][2] < settling.UNBALANCED_FORCE


def pour_bed(recipe: BedRecipe, progress: Progress | None = None) -> Bed:
    """Pour grains into a box and let them settle under the local gravity.

    Raises ValueError where the bed does not come to rest.
    """
    tell = progress or (lambda fraction, what: None)
    generator = np.random.default_rng(recipe.seed)
    diameter = recipe.sizes.draw(generator.random(recipe.grain_count))
    grains = [make_grain(generator, recipe.cloud_point_count, d) for d in diameter]
    position, orientation = rain(generator, grains, recipe.width)
    down = (0.0, 0.0, -recipe.pour_gravity)
    world = boxed_world(grains, position, orientation, recipe.width, recipe.material, down, recipe.contact)
    recorder = Recorder(float(diameter.mean()))
    fall(world, recorder, recipe, tell)
    # Faces pressed together deeper than their rounding may hop for ever: such a bed need only rest under less gravity.
    patience = settling.PERIODS_PRESSED
    settle(world, recorder, recipe, lambda share: tell(0.4 + 0.2 * share, "settling under the pour gravity"), patience)
    lower_gravity(world, recorder, recipe, tell)
    if not settle(world, recorder, recipe, lambda share: tell(0.8 + 0.2 * share, "settling under the local gravity")):
        raise ValueError(settling.restless(world))
    return finished(world, recorder, recipe, grains, diameter)


def rain(generator: np.random.Generator, grains: list[ConvexHull], width: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return positions and orientations of grains spread at random in a column above the box, none touching."""
    reach = np.array([grain.bounding_radius for grain in grains])
    cell = 2.1 * float(reach.max())
    per_row = [max(1, int(w / cell)) for w in width]
    cells = np.arange(len(grains))
    index = np.stack([cells % per_row[0], cells // per_row[0] % per_row[1], cells // (per_row[0] * per_row[1])], axis=1)
    pitch = np.array([width[0] / per_row[0], width[1] / per_row[1], cell])
    centre = (index + 0.5) * pitch - np.array([0.5 * width[0], 0.5 * width[1], 0.0])
    slack = np.maximum(0.5 * pitch - reach[:, None], 0.0)
    position = centre + slack * generator.uniform(-1.0, 1.0, size=(len(grains), 3))
    return position, np.array([random_orientation(generator) for _ in grains])


def fall(world: World, recorder: Recorder, recipe: BedRecipe, tell: Progress) -> None:
    """Let the grains fall and come to a first rest under the pour gravity."""
    height = float(world.position[:, 2].max())
    fall_time = math.sqrt(2.0 * height / recipe.pour_gravity)
    speed = math.sqrt(2.0 * height * recipe.pour_gravity)
    chunk = fall_time / 40.0
    world.time_step = chunk / math.ceil(chunk * recipe.contact.steps_per_contact / world.shortest_contact(speed))
    recorder.frame(world)
    calm = 0
    for check in range(40 * 25):
        world.run(chunk)
        recorder.note(world)
        if check < 40 and check % 8 == 7:
            recorder.frame(world)
        calm = calm + 1 if check >= 40 and recorder.rows[-1][1] < FALLEN else 0
        tell(0.4 * (1.0 - math.exp(-check / 60.0)), "pouring grains")
        if calm >= 4:
            return
    raise ValueError(
        f"the poured grains were not calm after {25 * fall_time:.3g} s: raise grain.friction or lower grain.restitution"
    )


def lower_gravity(world: World, recorder: Recorder, recipe: BedRecipe, tell: Progress) -> None:
    """Lower the gravity exponentially from the pour's to the local one, slowly against the contacts."""
    period = settling.rest_period(recipe.material, recorder.diameter, float(np.linalg.norm(recipe.gravity)))

    def note(done: float) -> None:
        recorder.note(world)
        tell(0.6 + 0.2 * done, "lowering gravity")

    settling.ramp(world, np.array(recipe.gravity), period, note)
    recorder.frame(world)


def settle(
    world: World, recorder: Recorder, recipe: BedRecipe, tell: Callable[[float], None],
    patience: float = settling.PERIODS_PATIENCE,
) -> bool:  # fmt: skip
    """Wait until the bed has been at rest, undamped, for long enough under the gravity at hand; tell whether it was.

    A loose grain rocks and rolls on for minutes. Till the bed first rests, motion is damped at a few times the rate of
    free fall through a grain: what nothing holds up still falls fast enough to be seen by the criteria.
    """
    strength = float(np.linalg.norm(world.gravity))
    period = settling.rest_period(recipe.material, recorder.diameter, strength)
    checks = 0

    def check() -> None:
        nonlocal checks
        checks += 1
        recorder.note(world)
        tell(1.0 - math.exp(-checks / (settling.PERIODS_HELD * settling.CHECKS_PER_PERIOD)))

    world.drag = FREE_FALL_DAMPING * math.sqrt(strength / recorder.diameter)
    calm = settling.rests(world, period, settling.PERIODS_RELAXED, lambda: recorder.at_rest, check, patience)
    world.drag = 0.0
    calm = calm and settling.rests(world, period, settling.PERIODS_HELD, lambda: recorder.at_rest, check, patience)
    recorder.frame(world)
    tell(1.0)
    return calm


def finished(world: World, recorder: Recorder, recipe: BedRecipe, grains: list[ConvexHull], diameter: Floats) -> Bed:
    """Return the bed at rest."""
    heights = height_map(grains, world.position, world.orientation, recipe.width)
    contacts = world.contacts()
    area = recipe.width[0] * recipe.width[1]
    frames = {
        "time": np.array([frame[0] for frame in recorder.frames]),
        "position": np.array([frame[1] for frame in recorder.frames]),
        "orientation": np.array([frame[2] for frame in recorder.frames]),
    }
    names = ("time", "kinetic_ratio", "unbalanced_force", "gravity")
    return Bed(
        grains=grains, position=world.position, orientation=world.orientation, diameter=diameter, width=recipe.width,
        gravity=recipe.gravity, density=recipe.material.density, seed=recipe.seed,
        surface_height=float(heights.mean()), surface_top=float(heights.max()),
        solid_fraction=sum(grain.volume for grain in grains) / (area * float(heights.mean())),
        coordination_number=2.0 * int((contacts["body_b"] >= 0).sum()) / len(grains),
        frames=frames, history=dict(zip(names, np.array(recorder.rows).T, strict=True)),
    )  # fmt: skip
