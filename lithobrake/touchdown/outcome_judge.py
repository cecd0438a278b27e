"""Watching one landing, and judging it: when it is over, how it ended, and when a lander rests."""

import math

import numpy as np

from lithobrake.dem import BodyMotion, World
from lithobrake.touchdown.bed import Bed, rotation_matrix
from lithobrake.touchdown.lander import Lander
from lithobrake.touchdown.lander_bodies import LanderBodies
from lithobrake.touchdown.landing import LEAVING, Landing, Outcome, outgoing, turned, turned_attitude
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, PERIODS_TRAVELLED, TO_REST

# A lander that stands on an edge topples with the time constant sqrt(size / gravity), in which its tilt grows by a
# factor of e: what moves by less than REST_WAY meanwhile was within 0.6 % of its size of balance, or rests.
TOPPLING_TIMES = 1.0
REST_WAY = 0.015  # of the smallest edge, by any point of the lander
CAPTURED_ENERGY = 1e-4  # of the energy of impact
CAPTURED_APEX = 0.5  # of the lander's smallest edge; the apex if all of its energy lifted it
# A lander that turns round passes through rest: only rest that lasts for so many of the shortest contacts is capture.
CAPTURED_CONTACTS = 10.0
# Of the lander's smallest edge: deeper in the floor an overlap is no contact, and nothing that follows is a landing.
SUNK_FRACTION = 0.5
# Where a boulder is looked for under the main shape of a lander, in its bounding radii: its centre, and eight points
# around it.
FOOTPRINT = np.array([[0.0, 0.0]] + [[math.cos(k * math.pi / 4.0), math.sin(k * math.pi / 4.0)] for k in range(8)])


class RestWatch:
    """Watches a lander until no point of it has moved by more than REST_WAY for long enough."""

    def __init__(self, lander: Lander, inward_gravity: float) -> None:
        """Begin; inward_gravity: of the site [m/s2]. Where it does not point inward nothing rests."""
        self.way = REST_WAY * lander.smallest_edge
        self.reaches = (lander.reach, *(part.shape.bounding_radius for part in lander.hinged))
        self.patience = rest_time(lander, inward_gravity)
        self.since = math.inf
        self.anchor: tuple[BodyMotion, ...] = ()

    def is_over(self, time: float, *motions: BodyMotion) -> bool:
        """Look at the lander, and at its parts on hinges, at a time [s], and return whether all of it rests."""
        # zip ends with the shortest, so nothing has moved from no anchor.
        moved = [moved_by(*three) for three in zip(self.anchor, motions, self.reaches, strict=False)]
        if max(moved, default=math.inf) > self.way:
            self.since, self.anchor = time, motions
        return time - self.since > self.patience


def moved_by(before: BodyMotion, now: BodyMotion, reach: float) -> float:
    """Return a bound on how far a point of a body within a reach [m] has moved [m]."""
    between = abs(float(np.dot(before.orientation, now.orientation)))
    turn = 2.0 * math.acos(min(between, 1.0))
    return float(np.linalg.norm(now.position - before.position)) + turn * reach


def rest_time(lander: Lander, inward_gravity: float) -> float:
    """Return how long [s] a lander has to stay where it is until it rests; infinite where gravity points outward."""
    if inward_gravity <= 0.0:
        return math.inf
    return TOPPLING_TIMES * math.sqrt(lander.smallest_edge / inward_gravity)


def capture_lift(lander: Lander, gravity: float) -> float:
    """Return the energy per mass [J/kg] below which a lander in flight is captured; gravity: inward [m/s2]."""
    return gravity * CAPTURED_APEX * lander.smallest_edge


class OutcomeJudge:
    def __init__(self, bed: Bed, lander: Lander, landing: Landing, world: World, number: int, frame_count: int) -> None:
        self.bed, self.lander, self.landing, self.world = bed, lander, landing, world
        self.start_time = world.time
        self.bodies = LanderBodies(world, lander, number)
        self.motion = self.bodies.motion()
        self.start_energy = self.motion.kinetic_energy
        self.clear_height = bed.surface_height + bed.grain_diameter
        self.ended: TouchdownOutcome | None = None
        self.over_rim = False
        self.height_at_contact: float | None = None
        self.lowest = self.last_height = self.height()
        self.last_time = world.time
        self.still_since: float | None = None
        self.start = self.motion.position
        self.contacts, self.is_aloft = 0, True
        self.rest = None if landing.hop_height is None else RestWatch(lander, -float(landing.gravity[2]))
        self.path = self.path_in_contact = 0.0  # m, horizontal, since the first touch and until the last
        self.frame_count, self.stride, self.looks = frame_count, 1, 0
        self.frames: list[dict[str, Floats]] = []
        self.keep_frame()

    def height(self) -> float:
        """Return the height of the lander's lowest point [m]."""
        return self.bodies.lowest(self.motion)

    def look(self) -> None:
        """Take note of the lander, and tell its outcome once it can be told.

        Raises ValueError for a lander that went through the floor: no outcome is to be told of that.
        """
        before, self.motion = self.motion, self.bodies.motion()
        height, first_touch = self.height(), self.world.first_touch
        if height < -SUNK_FRACTION * self.lander.smallest_edge:
            raise ValueError(
                f"the lander went through the floor: it is {-height:.3g} m below it, of {self.lander.mass:.3g} kg and "
                f"come with {self.landing.speed:.3g} m/s, for which these grains are too soft or too few; raise "
                "grain.young_modulus or bed.grain_count, or lower lander.mass or impact.speed"
            )
        if first_touch is not None and self.height_at_contact is None:
            # It flew freely since the last look.
            self.height_at_contact = self.last_height + float(before.velocity[2]) * (first_touch - self.last_time)
        self.follow(before.position)
        self.count_contact(height)
        self.lowest, self.last_height, self.last_time = min(self.lowest, height), height, self.world.time
        self.looks += 1
        self.keep_frame()
        self.ended = self.judge(height, first_touch is not None)

    def follow(self, before: Floats) -> None:
        """Follow the horizontal path on ground that repeats: since the first touch, and as far as the last.

        before: position at the last look [m].
        """
        if self.bed.period is None or self.world.first_touch is None:
            return
        self.path += math.hypot(*(self.motion.position - before)[:2])
        # The path between touches in flight stirs no ground, so it counts only once another touch has followed.
        if self.world.watched["last_contact"] > self.last_time:
            self.path_in_contact = self.path

    def count_contact(self, height: float) -> None:
        """Count a contact each time that the lander touches after it was clear of all grains."""
        if self.world.is_touched:
            self.contacts += self.is_aloft
            self.is_aloft = False
        elif height > self.ground()[1]:
            self.is_aloft = True

    def ground(self) -> tuple[float, float]:
        """Return the height of the ground under the lander, and that above which it is clear of it [m].

        Both are those of the mean surface, or of the highest point of a boulder under it where that is higher.
        """
        ground, clear = self.bed.surface_height, self.clear_height
        if self.bed.boulder_count == 0:
            return ground, clear
        main = self.lander.shape.bounding_radius * FOOTPRINT
        across = np.concatenate([main, self.lander.footprint(rotation_matrix(self.motion.orientation))])
        boulder = float(self.bed.boulder_height(*(self.motion.position[:2] + across).T).max())
        return max(ground, boulder), max(clear, boulder)

    def judge(self, height: float, has_touched: bool) -> TouchdownOutcome | None:
        if self.rest is not None:
            return self.judge_to_rest(self.rest, height, has_touched)
        world, position, velocity = self.world, self.motion.position, self.motion.velocity
        free, energy = not world.is_touched, self.motion.kinetic_energy if has_touched else math.inf
        flies, outward = has_touched and free, bool(velocity[2] > 0.0)
        held = energy < self.lander.mass * capture_lift(self.lander, -world.gravity[2])
        width = self.bed.width
        if self.bed.period is None and (abs(position[0]) > 0.5 * width[0] or abs(position[1]) > 0.5 * width[1]):
            # Soil as it lies in the bed would go on there: what flies up has left it, of anything else nobody knows.
            self.over_rim = flies and outward and not held
            return TouchdownOutcome.CLEAR if self.over_rim else TouchdownOutcome.LEFT_SIDEWAYS
        if flies and outward and height > self.ground()[1]:
            return TouchdownOutcome.CLEAR
        if flies and held:
            return TouchdownOutcome.CAPTURED
        if has_touched and energy < CAPTURED_ENERGY * self.start_energy:
            self.still_since = world.time if self.still_since is None else self.still_since
            patience = CAPTURED_CONTACTS * self.landing.contact.steps_per_contact * world.time_step
            if world.time - self.still_since > patience:
                return TouchdownOutcome.CAPTURED
        else:
            self.still_since = None
        over = world.time - self.start_time >= self.landing.time_limit
        return TouchdownOutcome.TIME_LIMIT if over else None

    def judge_to_rest(self, rest: RestWatch, height: float, has_touched: bool) -> TouchdownOutcome | None:
        """Return how a touchdown ended that goes on until the lander rests or leaves for a high hop; None: it is open.

        Hops that rise less than Landing.hop_height are part of the touchdown.
        """
        assert self.landing.hop_height is not None
        speed, inward = float(self.motion.velocity[2]), -float(self.world.gravity[2])
        ground, clear = self.ground()
        if has_touched and speed > 0.0 and height > clear and not self.world.is_touched:
            apex = height - ground + (0.5 * speed**2 / inward if inward > 0.0 else math.inf)
            if apex > self.landing.hop_height:
                return TouchdownOutcome.CLEAR
        if rest.is_over(self.world.time, self.motion, *self.bodies.part_motions()):
            return TouchdownOutcome.CAPTURED
        over = self.world.time - self.start_time >= self.landing.time_limit
        return TouchdownOutcome.TIME_LIMIT if over else None

    def keep_frame(self) -> None:
        """Keep a frame now and then: never more than twice those asked for, evenly spread over the whole landing."""
        if self.frame_count == 0 or self.looks % self.stride:
            return
        time = np.array(self.world.time - self.start_time)
        self.frames.append({"time": time, **self.bodies.frame(self.motion)})
        # How long a landing lasts is not known, so every second frame goes as it gets longer: memory stays bounded and
        # frames even.
        if len(self.frames) == 2 * self.frame_count:
            self.frames, self.stride = self.frames[::2], 2 * self.stride

    def outcome(self) -> Outcome:
        world, motion = self.world, self.motion
        assert self.ended is not None
        left = self.ended == TouchdownOutcome.CLEAR
        outputs = dict.fromkeys(LEAVING, math.nan)
        if left:
            state = motion.velocity, motion.spin, motion.orientation
            outputs = outgoing(*state, self.landing.azimuth, over_rim=self.over_rim)
        outputs["contact_duration"] = world.touch_duration or 0.0
        outputs["penetration"] = 0.0 if self.height_at_contact is None else self.height_at_contact - self.lowest
        outputs["peak_acceleration"] = world.watched["peak_force"] / self.lander.mass
        outputs["energy_lost"] = self.start_energy - motion.kinetic_energy
        if self.rest is not None:
            outputs |= self.outputs_to_rest()
        if self.bed.period is not None:
            outputs[PERIODS_TRAVELLED] = self.path_in_contact / min(self.bed.period)
        frames = None
        if self.frame_count:
            frames = {name: np.array([frame[name] for frame in self.frames]) for name in self.frames[0]}
        if not all(math.isfinite(value) for value in outputs.values()) and left:
            raise FloatingPointError(f"the landing gave values that are not finite: {outputs}")
        orientation = tuple(motion.orientation.tolist())
        return Outcome(self.ended, outputs, world.time - self.start_time, orientation, frames)

    def outputs_to_rest(self) -> dict[str, float]:
        """Return what else there is to tell of a touchdown that goes on to rest, in the local frame of `outgoing`."""
        x, y, z = turned(self.motion.position - self.start, -self.landing.azimuth)
        attitude = turned_attitude(self.motion.orientation, -self.landing.azimuth)
        values = x, y, self.world.time - self.start_time, float(self.contacts), z
        return dict(zip((*TO_REST, *ORIENTATION_OUT), (*values, *attitude), strict=True))
