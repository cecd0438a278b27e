"""Landers that move along the ground, from facet to facet over their edges, until they rest or leave it."""

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.body import Body
from lithobrake.smallbody.rotation import ground_spin
from lithobrake.smallbody.shape import Shape
from lithobrake.vocabulary.array_types import Array, Integers

CROSSINGS = 8  # edges that one way may go over
# The way across a slope is then right to half a percent.
TURN = 0.05  # rad by which the velocity may turn in a step
FACET_STEP = 0.25  # of a facet's size: how far a step may go
NEAR = 1e-3  # m; a lander that comes to a stop within this does so in one step
# A trough between facets is entered and left ever faster: what so many steps do not carry ten times NEAR rests there.
TRAPPED = 64
# Over mass and squared radius, of a ball: what rolls is slower to gain and to lose speed by this and one.
ROLLING_INERTIA = 0.4


def unit(vectors: Array) -> Array:
    """Vectors [count, 3] over their lengths; zero where they are."""
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)


def over_edges(
    shape: Shape, facet: Integers, position: Array, way: Array, velocity: Array, press: Array, braking: Array
) -> tuple[Array, Array, Integers, NDArray[np.bool_]]:
    """Fold ways [m] and velocities that leave their facets over the edges: position, velocity, facet, and who leaves.

    Round an outward edge the lander's own motion takes some of its weight off, which saves friction, or all of it, and
    it flies on; in an inward edge it adds to it (the rope round a post, with either sign). press: what presses it on
    the ground over its mass [m/s2], and braking, what friction takes of the speed over that, [count].
    """
    start, way, velocity, facet = position.copy(), way.copy(), velocity.copy(), facet.copy()
    lifted = np.zeros(len(position), dtype=bool)
    on = np.arange(len(position))
    for _ in range(CROSSINGS):
        edge, part = first_edge(shape, facet[on], start[on], way[on])
        on, edge, part = on[edge >= 0], edge[edge >= 0], part[edge >= 0]
        if not len(on):
            break
        start[on] += part[:, None] * way[on]
        fold = Fold.of(shape, facet[on], edge)
        across, speed = -np.einsum("ni,ni->n", velocity[on], fold.inward), np.linalg.norm(velocity[on], axis=1)
        # The bend counts over the way from middle to middle of both facets, so that the fineness of a mesh does not
        # decide who leaves the ground.
        off = (across > 0.0) & (across**2 * fold.angle > press[on] * fold.spread)
        lifted[on[off]], way[on[off]] = True, 0.0
        on, fold, across, speed = on[~off], fold.of_some(~off), across[~off], speed[~off]
        share = np.divide(across, speed, out=np.zeros_like(speed), where=speed > 0.0)
        # The capstan equation, with the sign of the bend.
        kept = np.exp(braking[on] * fold.angle * np.abs(share))
        way[on] = fold((1.0 - part[~off])[:, None] * way[on])
        velocity[on] = kept[:, None] * fold(velocity[on])
        facet[on] = fold.beyond
    # A way that turns about a corner for longer ends there.
    way[on] = 0.0
    return start + way, velocity, facet, lifted


def first_edge(shape: Shape, facet: Integers, start: Array, way: Array) -> tuple[Integers, Array]:
    """Number of the edge through which each way leaves its facet, -1: none, and the part of the way before it."""
    corner, inward = shape.corners[facet], shape.inward[facet]
    # A start that rounding has put beyond an edge counts as on it.
    before = np.maximum(np.einsum("nei,nei->ne", inward, start[:, None] - corner), 0.0)
    change = np.einsum("nei,ni->ne", inward, way)
    out = before + change < -1e-12 * shape.radius
    part = np.divide(before, -change, out=np.full_like(before, np.inf), where=out)
    edge = part.argmin(axis=1)
    return np.where(out.any(axis=1), edge, -1), part[np.arange(len(part)), edge]


@dataclass(frozen=True)
class Fold:
    """Edges that are gone over: vectors along one facet become the same along the next, as paper is folded.

    along, inward, onward   unit vectors along the edge, and across it along either facet, [count, 3]
    angle      by which the ground bends, below 0 where it rises [rad], and spread: the way over which it does so [m]
    beyond     the facet beyond
    """

    along: Array
    inward: Array
    onward: Array
    angle: Array
    spread: Array
    beyond: Integers

    @classmethod
    def of(cls, shape: Shape, facet: Integers, edge: Integers) -> "Fold":
        row, beyond = np.arange(len(facet)), shape.neighbours[facet, edge]
        corner, up, next_up = shape.corners[facet], shape.normals[facet], shape.normals[beyond]
        side = corner[row, (edge + 1) % 3] - corner[row, edge]
        along = unit(side)
        inward, onward = np.cross(up, along), np.cross(along, next_up)
        # An arc cosine would lose the sign of the bend, and the digits of small ones.
        angle = np.arctan2(-np.einsum("ni,ni->n", onward, up), np.einsum("ni,ni->n", up, next_up))
        # A facet's middle lies a third of its height off its edge.
        far = [
            np.einsum("nci,ni->nc", shape.corners[one] - corner[row, edge][:, None], to).max(axis=1)
            for one, to in ((facet, inward), (beyond, onward))
        ]
        return cls(along, inward, onward, angle, (far[0] + far[1]) / 3.0, beyond)

    def of_some(self, some: NDArray[np.bool_]) -> "Fold":
        return Fold(**{field.name: getattr(self, field.name)[some] for field in fields(self)})

    def __call__(self, vectors: Array) -> Array:
        """Turn vectors [count, 3] from one facet onto the next."""
        level = np.einsum("ni,ni->n", vectors, self.along)[:, None] * self.along
        folded: Array = level - np.einsum("ni,ni->n", vectors, self.inward)[:, None] * self.onward
        return folded


@dataclass(frozen=True)
class Slides:
    """Where landers are that moved along the ground; one entry or row a lander.

    position   body-fixed [m], and velocity [m/s], [count, 3]
    time       that it took [s], and length of the way along the ground [m], [count]
    rests      it has come to rest where the ground holds it, [count]
    leaves     it is no longer pressed on the ground, or the ground falls away; neither: the time was over, [count]
    """

    position: Array
    velocity: Array
    time: Array
    length: Array
    rests: NDArray[np.bool_]
    leaves: NDArray[np.bool_]


@dataclass(frozen=True)
class OnGround:
    """Landers on the ground: facet that each lies on, friction, mass [kg] and spin_period [s] of the body, [count].

    time: at which the body turns as it does all the while [s], [count]. rolls: the friction is a resistance to rolling,
    as a ball rolls.
    """

    body: Body
    facet: NDArray[np.int64]
    friction: Array
    mass: Array
    spin_period: Array
    time: Array
    rolls: bool = False

    def of(self, some: NDArray[np.int64]) -> "OnGround":
        names = ("facet", "friction", "mass", "spin_period", "time")
        return replace(self, **{name: getattr(self, name)[some] for name in names})

    @property
    def up(self) -> Array:
        """Outward normals of the facets, [count, 3]."""
        return self.body.shape.normals[self.facet]

    def along(self, vectors: Array) -> Array:
        """Parts of vectors [count, 3] along the facets."""
        part: Array = vectors - np.einsum("ni,ni->n", vectors, self.up)[:, None] * self.up
        return part

    @property
    def braking(self) -> Array:
        """What friction takes of the speed over what presses, [count]."""
        return self.friction / self.inertia

    @property
    def inertia(self) -> float:
        """What moves over the mass: more than one where the lander turns as it goes."""
        return 1.0 + ROLLING_INERTIA if self.rolls else 1.0

    def forces(self, position: Array, velocity: Array) -> tuple[Array, Array]:
        """Force over mass [m/s2] that presses on the facet, [count], and the one along it without friction."""
        here = {"mass": self.mass, "spin_period": self.spin_period, "time": self.time}
        felt = self.body.effective_acceleration(position, **here)
        felt -= 2.0 * np.cross(ground_spin(self.body.rotation, self.time, self.spin_period), velocity)
        press = -np.einsum("ni,ni->n", felt, self.up)
        return press, felt + press[:, None] * self.up

    def acceleration(self, velocity: Array, press: Array, along: Array) -> tuple[Array, Array]:
        """Acceleration along the facet [m/s2] and unit vector of the motion, which begins downhill, [count, 3]."""
        heading = unit(np.where(np.any(velocity, axis=1, keepdims=True), velocity, along))
        return along / self.inertia - (self.braking * np.maximum(press, 0.0))[:, None] * heading, heading

    def holds(self, velocity: Array, press: Array, along: Array) -> NDArray[np.bool_]:
        """Which landers lie still so that friction holds them, [count]."""
        pressed = press > 0.0
        grip = self.friction * np.where(pressed, press, 1.0)
        held: NDArray[np.bool_] = pressed & ~velocity.any(axis=1) & (np.linalg.norm(along, axis=1) <= grip)
        return held


def slide(ground: OnGround, position: Array, velocity: Array, duration: Array) -> Slides:
    """Follow landers along the ground for at most a duration [s] each, [count].

    position [m] and velocity [m/s]: body-fixed, [count, 3]; what of either is not along the facet is dropped. Infinite
    friction stops a lander where it is.
    """
    count, corner = len(position), ground.body.shape.corners[ground.facet, 0]
    position, velocity = corner + ground.along(position - corner), ground.along(velocity)
    # Stopped here, since in the equations infinite friction times a press of 0 is not a number.
    velocity[np.isinf(ground.friction)] = 0.0
    facet, time, length = ground.facet.copy(), np.zeros(count), np.zeros(count)
    rests, leaves = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    going, seen, number = np.arange(count), position.copy(), 0
    while len(going):
        here = replace(ground.of(going), facet=facet[going])
        press, along = here.forces(position[going], velocity[going])
        leaves[going], held = press <= 0.0, here.holds(velocity[going], press, along)
        if number % TRAPPED == 0 and number:
            held |= (press > 0.0) & (np.linalg.norm(position[going] - seen[going], axis=1) < 10.0 * NEAR)
            seen[going] = position[going]
        rests[going] = held
        on = np.flatnonzero((press > 0.0) & ~held & (time[going] < duration[going]))
        going, here, press, along = going[on], here.of(on), press[on], along[on]
        step, way, after = _step(here, position[going], velocity[going], press, along, duration[going] - time[going])
        ends = over_edges(here.body.shape, here.facet, position[going], way, after, press, here.braking)
        position[going], velocity[going], facet[going], leaves[going] = ends
        time[going] += step
        length[going] += np.linalg.norm(way, axis=1)
        going, number = going[~leaves[going]], number + 1
    velocity[rests] = 0.0
    return Slides(position, velocity, time, length, rests, leaves)


def _step(
    ground: OnGround, position: Array, velocity: Array, press: Array, along: Array, left: Array
) -> tuple[Array, Array, Array]:
    """Time of a step [s], [count], the way on the facet's plane [m] and the velocity after it, [count, 3].

    A step by the middle: exact on a plane under a constant force along the way. press, along: the forces at its start;
    left: time that may pass [s].
    """
    push, heading = ground.acceleration(velocity, press, along)
    speed, slowing = np.linalg.norm(velocity, axis=1), -np.einsum("ni,ni->n", push, heading)
    across = np.linalg.norm(push + slowing[:, None] * heading, axis=1)
    shape, facet = ground.body.shape, ground.facet
    with np.errstate(divide="ignore", invalid="ignore"):
        # fmax and fmin pass over NaN, which stands where nothing turns the way or slows it down.
        turning = np.fmax(TURN * speed / across, _time_to_go(np.full_like(speed, NEAR), speed, slowing))
        stop = np.where((slowing > 0.0) & (speed > 0.0), speed / slowing, np.inf)
    step = np.fmin(turning, _time_to_go(FACET_STEP * shape.facet_sizes[facet], speed, slowing))
    step = np.minimum(np.minimum(step, stop), left)
    # Beyond its edge a facet is not the ground any more: a step ends right behind it.
    way = step[:, None] * velocity + 0.5 * step[:, None] ** 2 * push
    before = first_edge(shape, facet, position, way)[1] * np.linalg.norm(way, axis=1)
    step = np.minimum(step, _time_to_go(before + NEAR, speed, slowing))
    half = 0.5 * step[:, None]
    middle = velocity + half * push
    push, _ = ground.acceleration(middle, *ground.forces(position + half * velocity, middle))
    way = step[:, None] * velocity + 0.5 * step[:, None] ** 2 * push
    # At a stop the velocity is 0 to the last bit, as only then the ground can hold the lander.
    return step, way, np.where((step == stop)[:, None], 0.0, velocity + step[:, None] * push)


def _time_to_go(distance: Array, speed: Array, slowing: Array) -> Array:
    """Time [s] in which landers go a distance [m]; more than they have until they stop where they do not get there."""
    with np.errstate(divide="ignore", invalid="ignore"):
        # The root in the denominator: in the other form all digits cancel where friction takes little of the speed.
        time: Array = 2.0 * distance / (speed + np.sqrt(np.maximum(speed**2 - 2.0 * slowing * distance, 0.0)))
    return np.where(np.isnan(time), np.inf, time)
