"""One landing: a lander meets a bed, and what becomes of it."""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import count

import numpy as np

from lithobrake.dem import BodyMotion, Material, World, folded, pair_law, period_of
from lithobrake.touchdown import settling
from lithobrake.touchdown.bed import Bed, rotation_matrix
from lithobrake.touchdown.lander import Lander, smallest_bed
from lithobrake.touchdown.lander_bodies import add_lander
from lithobrake.touchdown.landing import Landing, Outcome
from lithobrake.touchdown.outcome_judge import OutcomeJudge, capture_lift, rest_time
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.field_errors import FieldError

RELAX_FADING = 5.0  # periods in which the damping of contacts falls by a factor of e: what has to slide must be free to
CHECKS_PER_CONTACT = 5  # looks at the lander in the time of the shortest contact
# Where contacts step for themselves, looks are farther apart: until the lander moves by this part of its smallest edge,
# and never farther than this part of the time limit.
LOOK_WAY, LOOK_TIME = 0.05, 1e-3
# Where a lander does not feel how grains come to rest, those are held that are slower than this part of the speed with
# which a blow lets them go: at a held_speed of 0.03 that is 0.15 of the lander's.
CALM_AT_REST = 5.0
# An impact is over once the lander has gone this part of a grain diameter since its last touch.
IMPACT_OVER = 0.5
# Looks in the time that a lander has to stay where it is until it rests.
LOOKS_AT_REST = 50
# Motion of the grains that a landing does not feel, over its impact speed: a bed takes on another soil at once where
# all that this frees would not set them in such motion, and is relaxed until they have less.
CALM_SPEED = 1e-3


def land(
    bed: Bed,
    lander: Lander,
    landing: Landing,
    frame_count: int = 0,
    progress: Progress = silent,
) -> Outcome:
    """Let a lander meet a bed whose grains have taken on the landing's material, until its outcome is known.

    progress: called with the fraction that is done of what is being done; a landing may end long before its time limit.
    Raises ValueError where bed and landing do not fit and where the lander goes through the floor, FloatingPointError
    where the motion diverged.
    """
    if bed.period is None and max(abs(at) / across for at, across in zip(landing.place, bed.width, strict=True)) >= 0.5:
        raise FieldError("Landing.place", landing.place, f"is inside the box of {bed.width} m", "move it", "m")
    if 2.0 * lander.reach >= min(bed.width):
        raise FieldError(
            "Bed.width", bed.width, f"is more than the {2.0 * lander.reach:.3g} m that the lander is across",
            "make the bed wider", "m",
        )  # fmt: skip
    locally = landing.contact.stepping == "local"
    if lander.hinged and not locally:
        raise FieldError(
            "ContactModel.stepping", landing.contact.stepping, 'is "local" for a lander with parts on hinges'
        )
    world = bed.world(landing.grain, bed.gravity, landing.contact, landing.gravity)
    if locally and released_speed(bed, landing.grain) < CALM_SPEED * landing.speed:
        world.gravity = np.array(landing.gravity)
    else:
        relax(world, bed, landing, lambda fraction: progress(fraction, "bed taking on the soil of the landing"))
    world.rotation = np.array(landing.rotation)
    number = release(world, bed, lander, landing)
    world.time_step = world.shortest_contact(landing.speed) / landing.contact.steps_per_contact
    world.watch(number)
    judge = OutcomeJudge(bed, lander, landing, world, number, frame_count)
    reach = moving_reach(bed.grain_diameter, lander, landing)
    while judge.ended is None:
        if locally:
            run_until_looked_at(world, judge.motion, lander, landing, bed.grain_diameter, reach)
        else:
            world.run(steps=max(1, int(landing.contact.steps_per_contact / CHECKS_PER_CONTACT)))
        judge.look()
        progress(min((world.time - judge.start_time) / landing.time_limit, 1.0), "landing, up to its time limit")
    return judge.outcome()


def released_speed(bed: Bed, material: Material) -> float:
    """Return the speed [m/s] of a bed's grains if all that is freed as they take on a material set them in motion.

    Either all that their contacts then hold, which friction may have to find again, or, where the grains become softer,
    what they lose as they sink to the overlaps of a soil k times as stiff: k - 5/2 + 3/2 k^(-2/3) of what they held,
    from Hertz' law for a constant load.
    """
    # Relaxing a bed can take twenty times the CPU time of the landing, so it is left out where the landing would not
    # feel what it removes.
    rest = replace(material, young_modulus=bed.young_modulus, poisson_ratio=bed.poisson_ratio)
    held, stiffness = (pair_law(one, one).young_modulus for one in (rest, material))
    k = stiffness / held
    freed = bed.elastic_energy_per_modulus * held * max(k, k - 2.5 + 1.5 * k ** (-2.0 / 3.0))
    mass = material.density * sum(grain.volume for grain in bed.grains)
    return math.sqrt(2.0 * freed / mass)


def run_until_looked_at(
    world: World, motion: BodyMotion, lander: Lander, landing: Landing, diameter: float, reach: float
) -> None:
    """Move a world on, each contact by steps of its own, until a lander in motion is to be looked at again.

    diameter: of the grains [m]; reach: from the lander's centre of mass [m], within which no grain is held before the
    end of an impact after which it may leave.
    """
    contact, speed = landing.contact, surface_speed(motion, lander)
    # A lander slower than that cannot leave: grains count as slow beside this speed at least.
    leaving = math.sqrt(2.0 * max(0.0, capture_lift(lander, -landing.gravity[2])))
    telling = max(speed, leaving)
    held = contact.held_speed * telling
    # Once an impact is over, and too slow to leave, it does not feel how grains come to rest; a blow lets them go.
    comes_to_rest = world.first_touch is not None and (
        speed < leaving or speed * (world.time - world.watched["last_contact"]) > IMPACT_OVER * diameter
    )
    world.run_locally(
        look_interval(world, speed, lander, landing), contact.steps_per_contact,
        resolved_speed=contact.resolved_speed * telling, held_speed=held,
        calm_speed=CALM_AT_REST * held if comes_to_rest else None, reach=0.0 if comes_to_rest else reach,
    )  # fmt: skip


def surface_speed(motion: BodyMotion, lander: Lander) -> float:
    """Return a bound on the speed of a lander's surface [m/s]."""
    turning = float(np.linalg.norm(motion.spin)) * lander.reach
    return float(np.linalg.norm(motion.velocity)) + turning


def look_interval(world: World, speed: float, lander: Lander, landing: Landing) -> float:
    """Return the time [s] until a lander whose surface moves at a speed [m/s] is to be looked at again, where contacts
    step for themselves.
    """
    shortest = world.time_step * landing.contact.steps_per_contact / CHECKS_PER_CONTACT
    longest = LOOK_TIME * landing.time_limit
    if landing.hop_height is not None:
        longest = min(landing.time_limit, rest_time(lander, -landing.gravity[2])) / LOOKS_AT_REST
    way = LOOK_WAY * lander.smallest_edge
    return max(shortest, min(way / speed, longest) if speed > 0.0 else longest)


def moving_reach(diameter: float, lander: Lander, landing: Landing) -> float:
    """Return the distance [m] from the lander's centre of mass within which no grain of a diameter [m] is held."""
    return lander.reach + smallest_bed(lander, landing.grain, diameter, landing.speed)[1]


def relax(
    world: World, bed: Bed, landing: Landing, tell: Callable[[float], None] = lambda fraction: None
) -> None:  # fmt: skip
    """Let the stored bed take on the landing's material and gravity, under damping that fades.

    It ends once the motion that is left is small against the impact, and stays so for some periods of a grain. Where
    the site's acceleration vanishes or points outward nothing settles: the bed rests under the gravity it was made
    with, and the site's acts from the touchdown on.
    """
    gravity = np.array(landing.gravity)
    rests_under = gravity if gravity[2] < 0.0 else np.array(bed.gravity)
    strength = float(np.linalg.norm(rests_under))
    period = settling.rest_period(landing.grain, bed.grain_diameter, strength)
    lasting = settling.free_fall_drag(strength, bed.grain_diameter)
    world.drag = settling.contact_drag(period)
    tell(0.0)
    settling.ramp(world, rests_under, period)
    checks = count(1)

    def fade(_: float) -> None:
        # How long it takes is not known before: the fraction grows ever slower.
        tell(1.0 - math.exp(-next(checks) / (settling.PERIODS_HELD * settling.CHECKS_PER_PERIOD)))
        world.drag = max(lasting, world.drag * math.exp(-1.0 / (RELAX_FADING * settling.CHECKS_PER_PERIOD)))

    def is_calm() -> bool:
        return grain_speed(world) < CALM_SPEED * landing.speed

    if not settling.rests(world, period, settling.PERIODS_RELAXED, is_calm, fade):
        raise ValueError(settling.restless(world))
    world.drag = 0.0
    world.gravity = gravity


def grain_speed(world: World) -> float:
    """Return the speed [m/s] at which all bodies would have the kinetic energy that they have."""
    return math.sqrt(2.0 * float(world.kinetic_energy.sum()) / float(world.mass.sum()))


def release(world: World, bed: Bed, lander: Lander, landing: Landing) -> int:
    """Put the lander just above every grain under its bounding circle, and return the number of its main body."""
    reach = lander.reach
    place = np.array([*landing.place, 0.0])
    below = np.linalg.norm(folded(world.position[:, :2] - place[:2], period_of(bed.period)), axis=1)
    top = 0.0
    for k, grain in enumerate(bed.grains):
        if below[k] < reach + grain.bounding_radius:
            height = (grain.vertices - grain.centroid) @ rotation_matrix(world.orientation[k])[2]
            top = max(top, float(world.position[k, 2] + height.max()))
    rotation = rotation_matrix(np.array(landing.orientation) / np.linalg.norm(landing.orientation))
    place[2] = top - lander.lowest(np.zeros(3), rotation)
    return add_lander(world, lander, place, landing.velocity, landing.orientation, landing.spin)
