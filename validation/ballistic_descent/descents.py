"""Ballistic descents to the moon of a binary that meet the ground along the local vertical, by flight back in time.

The model of [Celik-2019]: the circular restricted three-body problem. Both bodies are point masses, the moon turns with
its orbit, and its surface is a ball. The frame is body-fixed to the moon: +x points to the primary, +z along the spin.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody import Body, Partner, Shape, didymos, dimorphos
from lithobrake.smallbody.built_in_bodies import top_shape

Floats = NDArray[np.float64]

STEP = 20.0  # s, of the Runge-Kutta method of fourth order; half of it moves no state by more than 1e-3 m
LONGEST = 12.0 * 3600.0  # s, of a descent


def balls() -> Body:
    """The built-in Dimorphos and Didymos as balls of their volumes, masses and orbit."""
    moon, primary = dimorphos(), didymos(partner=False)
    assert moon.partner is not None
    round_primary = Body(_ball(primary), primary.mass, primary.spin_period, "ball of Didymos")
    partner = Partner(round_primary, period=moon.partner.period, longitude_deg=0.0)
    return Body(_ball(moon), moon.mass, moon.spin_period, "ball of Dimorphos", partner)


def radius(body: Body) -> float:
    """Radius of the ball of a body's volume [m]."""
    return float(np.cbrt(0.75 * body.shape.volume / math.pi))


def _ball(body: Body) -> Shape:
    return top_shape((2.0 * radius(body),) * 3, ridge_height=0.0, name=f"ball of {body.name}")


@dataclass(frozen=True)
class Descents:
    """States at the release [m, m/s], [count, 6], nan where a descent comes from nowhere; flight times [s], [count]."""

    states: Floats
    times: Floats


def primary_share(body: Body) -> float:
    """The primary's part of the mass of both; the moon is that part of their distance off the barycentre."""
    assert body.partner is not None
    return body.partner.body.mass / (body.mass + body.partner.body.mass)


def acceleration(body: Body, place: Floats, velocity: Floats, sense: float) -> Floats:
    """Acceleration [m/s2] in the turning frame, [count, 3]; sense -1: of the flight back in time."""
    assert body.partner is not None
    apart, rate, share = body.orbit.distance, body.spin_rate, primary_share(body)
    to_primary = place - [apart, 0.0, 0.0]
    total = -body.gravitational_parameter * place / np.linalg.norm(place, axis=1)[:, None] ** 3
    total -= body.partner.body.gravitational_parameter * to_primary / np.linalg.norm(to_primary, axis=1)[:, None] ** 3
    total += rate**2 * (place - [share * apart, 0.0, 0.0]) * [1.0, 1.0, 0.0]
    turned = np.stack([-velocity[:, 1], velocity[:, 0], np.zeros(len(velocity))], axis=1)
    return np.asarray(total - 2.0 * sense * rate * turned)


def back_in_time(
    body: Body, up: Floats, speed: Floats, distances: tuple[float, ...], outside: bool = False
) -> dict[float, Descents]:
    """Descents that end at the ground below directions [count, 3] with vertical speeds [m/s], [count].

    distances [m]: from the moon's centre, at which the lander is released; each has its own states. outside: no release
    is nearer to the barycentre than the moon. A descent that would come out of a body, or lasts longer than LONGEST,
    has none.
    """
    assert body.partner is not None
    place, velocity = radius(body) * up, speed[:, None] * up
    ground, primary = radius(body), radius(body.partner.body)
    apart, orbit = body.orbit.distance, primary_share(body) * body.orbit.distance
    found = {one: Descents(np.full((len(up), 6), np.nan), np.full(len(up), np.nan)) for one in distances}
    is_aloft = np.ones(len(up), dtype=bool)
    for number in range(1, round(LONGEST / STEP) + 1):
        there, going = step(body, place[is_aloft], velocity[is_aloft], -1.0)
        place[is_aloft], velocity[is_aloft] = there, going
        height = np.linalg.norm(place, axis=1)
        is_aloft &= (height > ground) & (np.linalg.norm(place - [apart, 0.0, 0.0], axis=1) > primary)
        from_centre = np.hypot(place[:, 0] - orbit, place[:, 1])
        is_free = is_aloft & (not outside or from_centre > orbit)
        for distance, descents in found.items():
            new = is_free & (height > distance) & np.isnan(descents.times)
            descents.times[new] = number * STEP
            descents.states[new] = np.hstack([place[new], -velocity[new]])
        if all(np.isfinite(descents.times[is_aloft]).all() for descents in found.values()):
            break
    return found


def step(body: Body, place: Floats, velocity: Floats, sense: float) -> tuple[Floats, Floats]:
    """One step of the Runge-Kutta method of fourth order; sense -1: back in time, with the velocity of that flight."""
    rates = [(velocity, acceleration(body, place, velocity, sense))]
    for part in (0.5, 0.5, 1.0):
        going = velocity + part * STEP * rates[-1][1]
        rates.append((going, acceleration(body, place + part * STEP * rates[-1][0], going, sense)))
    weights = (1.0, 2.0, 2.0, 1.0)
    moved = [sum(w * rate[which] for w, rate in zip(weights, rates, strict=True)) for which in (0, 1)]
    return place + STEP / 6.0 * moved[0], velocity + STEP / 6.0 * moved[1]
