"""States in axes that turn with the body, from states in axes that do not."""

import numpy as np

from lithobrake.geometry.body_axes import axes_in_icrf
from lithobrake.study.flight_sections import SiteSection

Array = np.ndarray


def icrf_to_body(site: SiteSection, time: Array, spin_period: Array) -> Array:
    """Rotations that turn components along ICRF into those along axes fixed to the body, [count, 3, 3].

    time [s] since site.meridian_deg held and spin_period [s], both [count].
    """
    right_ascension, declination, meridian = (
        site.pole_right_ascension_deg, site.pole_declination_deg, site.meridian_deg
    )  # fmt: skip
    assert right_ascension is not None
    assert declination is not None
    assert meridian is not None
    return axes_in_icrf(right_ascension, declination, np.radians(meridian) + 2.0 * np.pi * time / spin_period)


def turned(rotations: Array, vectors: Array) -> Array:
    """Vectors [count, 3] turned by rotations [count, 3, 3]; a row depends on no other."""
    found: Array = (rotations * vectors[:, None, :]).sum(axis=2)
    return found


def against_ground(position: Array, velocity: Array, spin_period: Array) -> Array:
    """Velocities [m/s] against axes that turn about z, from those against axes that do not, all [count, 3]."""
    rate = 2.0 * np.pi / spin_period
    ground = np.stack([-rate * position[:, 1], rate * position[:, 0], np.zeros_like(rate)], axis=1)
    found: Array = velocity - ground
    return found
