"""The acceleration of what rests on the ground: gravity, rotation and the partner's tide."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from lithobrake.smallbody import Body


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
