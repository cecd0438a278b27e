"""A ball that falls into a bed of beads, followed until it stops."""

import math
from typing import NamedTuple

import numpy as np
from result_rows import Row
from sphere_bed import Floats, column_tops, places_of, radii_of, steps_for

from lithobrake.dem import Material, Sphere, World

DROP_STEPS = 15.0  # in the shortest contact while the ball comes down
FOLLOWED = 1.05  # times the stopping time


class Ball(NamedTuple):
    """A ball and how it meets the bed: diameter [m], density [kg/m3], place [m] over the bed."""

    diameter: float
    density: float
    place: tuple[float, float] = (0.0, 0.0)

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.density * math.pi / 6.0 * self.diameter**3


def touch_height(world: World, ball: Ball) -> float:
    """Return the height [m] of a ball's lowest point where it first touches a bead on its way down."""
    reach = 0.5 * ball.diameter + radii_of(world)
    places = places_of(world, ball.place)
    span = reach**2 - (places[:, :2] ** 2).sum(axis=1)
    centre = float((places[:, 2] + np.sqrt(np.maximum(span, 0.0)))[span > 0.0].max()) * (1.0 + 1e-9)
    return centre - 0.5 * ball.diameter


def dropped(
    world: World, ball: Ball, material: Material, fall: float, pace: float, *, touch_speed: float | None = None,
    steps: float = DROP_STEPS,
) -> tuple[Row, Floats]:  # fmt: skip
    """Let a ball fall from a height [m] of its lowest point above the mean surface, and follow it until it stops.

    touch_speed [m/s]: with which it first touches a bead, instead of what the fall gives. pace [s] is the time between
    two looks. steps: in the shortest contact.
    Returns the row of results and the path: time since the first touch [s], depth of the lowest point below the mean
    surface [m], speed downwards [m/s], deceleration [m/s2], shape [looks, 4].
    """
    gravity, radius = -float(world.gravity[2]), 0.5 * ball.diameter
    level = float(column_tops(world, 1.2 * radius, 0.1 * radius, ball.place).mean())
    start = touch_height(world, ball)
    speed = math.sqrt(max(2.0 * gravity * (fall - (start - level)), 0.0)) if touch_speed is None else touch_speed
    body = world.add_body(
        Sphere(radius), material, (*ball.place, start + radius), velocity=(0.0, 0.0, -speed), mass=ball.mass,
        inertia=0.4 * ball.mass * radius**2 * np.eye(3),
    )  # fmt: skip
    # Ball and beads are of about the same modulus: the lightest pair of beads has the shortest contact.
    fastest = max(speed, math.sqrt(gravity * radius))
    world.time_step = world.shortest_contact(fastest) / steps_for(material, steps)
    looks = followed(world, body, level + radius, max(round(pace / world.time_step), 1) * world.time_step)
    stopped = float(looks[np.argmax(looks[:, 2] <= 0.0), 0])
    return {
        "impact_speed": math.sqrt(2.0 * gravity * fall), "level": level, "touch_height": start - level,
        "deepest": float(looks[:, 1].max()), "depth": float(looks[-1, 1]), "stopping_time": stopped,
        "peak_deceleration": float(looks[:, 3].max()),
    }, looks  # fmt: skip


def followed(world: World, body: int, zero: float, pace: float) -> Floats:
    """Return the path of a body, a look every pace [s], until it has stood still; depth counts from zero [m]."""
    begun, stopped = world.time, math.inf
    path: list[tuple[float, float, float, float]] = []
    while world.time - begun < FOLLOWED * stopped:
        before = float(world.velocity[body, 2])
        world.run(duration=pace)
        now = float(world.velocity[body, 2])
        path.append((world.time - begun, zero - float(world.position[body, 2]), -now, (now - before) / pace))
        if stopped == math.inf and now >= 0.0:
            stopped = world.time - begun
    return np.array(path)
