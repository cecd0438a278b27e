"""The acceleration of a touchdown where it is: gravity, rotation and the partner's tide, against the normal there."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.design.rough_ground import first_axes, on_rough_ground
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.study.period_checks import LEAST_FRICTION
from lithobrake.vocabulary.quantities import GROUND

if TYPE_CHECKING:
    from lithobrake.smallbody import Body

Row = dict[str, float]
AZIMUTH = "impact.azimuth_deg"
# The steepest bed of hulls that was seen to hold (docs/decisions/touchdown.md). Soil lies on no steeper ground: what
# was there has run down, so the bed of a touchdown is tilted no farther.
STEEPEST_DEG = 35.0


def felt(
    body: "Body", points: np.ndarray, time: np.ndarray, mass: np.ndarray, spin_period: np.ndarray
) -> np.ndarray:  # fmt: skip
    """Acceleration [m/s2] of what rests on the ground, [count, 3], all body-fixed, at points [count, 3] and times [s].

    The partner acts by its tide: as a point, less what it does to the body as a whole. Rotation and tide are those at
    the times, where the body does not turn uniformly, too.
    """
    own: np.ndarray = body.effective_acceleration(points, mass=mass, spin_period=spin_period, time=time)
    if body.partner is None:
        return own
    from lithobrake.smallbody.body import GRAVITATIONAL_CONSTANT

    orbit = body.orbit_with(GRAVITATIONAL_CONSTANT * mass, 2.0 * np.pi / spin_period)
    if not np.any(orbit.distance):
        return own
    angle = orbit.angle + orbit.rate * time
    centre = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
    centre *= np.reshape(orbit.distance, (-1, 1))
    if body.rotation is not None:
        centre = body.rotation.at(time).out_of_frame(centre)
    way = centre - points
    strength = body.partner.body.gravitational_parameter
    near, mean = (one / np.linalg.norm(one, axis=1, keepdims=True) ** 3 for one in (way, centre))
    return own + strength * (near - mean)


def ground_inputs(acceleration: Sequence[float], azimuth_deg: float, friction: float) -> Row:
    """The acceleration of a touchdown as inputs of its bed, in whose frame the incoming velocity has an azimuth.

    acceleration: along the incoming horizontal velocity, to its left, outward [m/s2]. friction: of the grains, which
    bounds the tilt of the bed.
    """
    along, aside, outward = (float(one) for one in acceleration)
    strength, sign = math.hypot(along, aside, outward), -1.0 if outward > 0.0 else 1.0
    slope = math.atan2(math.hypot(along, aside), abs(outward))
    downhill = math.degrees(math.atan2(sign * aside, sign * along)) + azimuth_deg
    tilt = min(slope, math.radians(STEEPEST_DEG), math.atan(friction / LEAST_FRICTION))
    return dict(zip(GROUND, (sign * strength, math.degrees(tilt), downhill % 360.0), strict=True))


def on_local_ground(study: Study, rows: Sequence[Row], first: int) -> list[Row]:
    """The first touchdowns of journeys, numbered from `first` on, each under the acceleration of where it is."""
    site = Site(study)
    columns = {key: values[first:] for key, values in site.sampled(first + len(rows)).items()}
    origin, axes = site.frames(columns)
    met = first_axes(study, axes, rows)
    arriving = on_rough_ground(study, rows, axes, met)
    return on_ground(site.body, arriving, origin, met, site.clock(columns), columns["mass"], columns["spin_period"])


def on_ground(
    body: "Body",
    rows: Sequence[Row],
    origin: np.ndarray,
    axes: np.ndarray,
    time: np.ndarray,
    mass: np.ndarray,
    spin_period: np.ndarray,
) -> list[Row]:
    """Touchdowns under the acceleration at their origins [m], [count, 3], in frames with these axes, [count, 3, 3]."""
    local = np.einsum("nij,nj->ni", axes, felt(body, origin, time, mass, spin_period))
    return [row | ground_inputs(one, row[AZIMUTH], friction_of(row)) for row, one in zip(rows, local, strict=True)]


def friction_of(row: Mapping[str, float]) -> float:
    """Friction of grains on each other and on their floor."""
    return row["grain.friction"]
