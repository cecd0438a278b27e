"""Released states: one state and its spread, of which each journey draws its own."""

import numpy as np

from lithobrake.study.delivered_states import DeliveredStates
from lithobrake.study.release_section import SIDE, ReleaseSection

Array = np.ndarray
# Coordinates of the sequence of a study beside the others.
RELEASE = tuple(f"release {number}" for number in range(1, SIDE + 1))
# Of a direction from the centre next to the pole, about which north is any.
POLAR = 1e-9


def released_states(release: ReleaseSection, uniforms: Array, first: int, pole: Array) -> DeliveredStates:
    """A state for each row of uniform numbers [count, 6], in the axes of the release, numbered from `first` on.

    pole: of the body in these axes, [3].
    """
    from scipy.special import ndtri

    mean = np.array([*release.position, *release.velocity])
    states = mean + spread(release, pole, ndtri(np.clip(uniforms, 2.0**-54, 1.0 - 2.0**-53)))
    source = [f"the release of journey {first + row}" for row in range(len(states))]
    return DeliveredStates(source, np.full(len(states), release.time), states[:, :3], states[:, 3:])


def spread(release: ReleaseSection, pole: Array, normal: Array) -> Array:
    """How far each state is off [m, m/s], [count, 6], by independent standard normal numbers [count, 6]."""
    root = spread_root(release, pole)
    # Not by a matrix product, whose rounding depends on how many rows there are.
    return np.stack([(normal * row).sum(axis=1) for row in root], axis=1)


def spread_root(release: ReleaseSection, pole: Array) -> Array:
    """A matrix whose product with its transpose is the covariance of the release, [6, 6]."""
    if release.covariance is not None:
        return _root(np.array(release.covariance))
    root = np.zeros((SIDE, SIDE))
    if release.position_std is not None and release.velocity_std is not None:
        axes = local_axes(np.array(release.position), pole).T
        root[:3, :3], root[3:, 3:] = axes * release.position_std, axes * release.velocity_std
    return root


def local_axes(position: Array, pole: Array) -> Array:
    """Up, north and east in rows, [3, 3]; up is away from the centre of the body."""
    size = np.linalg.norm(position)
    up = position / size if size > 0.0 else np.array([0.0, 0.0, 1.0])
    east = np.cross(pole, up)
    if np.linalg.norm(east) < POLAR:
        east = np.cross(np.eye(3)[np.argmin(np.abs(up))], up)
    east /= np.linalg.norm(east)
    return np.stack([up, np.cross(up, east), east])


def _root(covariance: Array) -> Array:
    """The symmetric root of a covariance, by that of its correlations: entries have different units."""
    variances = np.diag(covariance)
    scale = np.sqrt(np.where(variances > 0.0, variances, 1.0))
    values, vectors = np.linalg.eigh(0.5 * (covariance + covariance.T) / np.outer(scale, scale))
    root: Array = scale[:, None] * (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    return root
