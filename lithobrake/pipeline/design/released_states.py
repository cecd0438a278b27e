"""States at which landers are released: samples of a covariance, and the offsets of a delivery."""

from dataclasses import replace

import numpy as np

from lithobrake.study.delivery_sections import SIDE, DeliverySection, ReleaseSection
from lithobrake.study.state_paths import DeliveredStates
from lithobrake.vocabulary.array_types import Array

# Of a direction from the centre next to the pole, about which north is any.
POLAR = 1e-9


def released_states(release: ReleaseSection, uniforms: Array, first: int, pole: Array) -> DeliveredStates:
    """A state for each row of uniform numbers [count, 6], in the axes of the release, numbered from `first` on.

    pole: of the body in these axes, [3].
    """
    from scipy.special import ndtri

    mean = np.array([*release.position, *release.velocity])
    # Clipped, as ndtri is infinite at 0 and 1, where a point of the sequence may lie.
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
    # Made symmetric, as what was written may differ by rounding, and eigh reads one half only.
    values, vectors = np.linalg.eigh(0.5 * (covariance + covariance.T) / np.outer(scale, scale))
    # Rounding takes an eigenvalue of 0 below it.
    root: Array = scale[:, None] * (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    return root


def with_offsets(delivery: DeliverySection, states: DeliveredStates, pole: Array) -> DeliveredStates:
    """The states with the offsets of a delivery; pole: of the body in their axes, [3].

    Directions are those at the mean position of a release, and at the position of each state of a file.
    """
    along, velocity = (np.array(one) for one in delivery.offsets)
    if not (along.any() or velocity.any()):
        return states
    release = delivery.release
    if release is None:
        axes = np.stack([local_axes(position, pole) for position in states.position])
    else:
        axes = np.broadcast_to(local_axes(np.array(release.position), pole), (len(states.time), 3, 3))
    moved = (np.einsum("k,nkj->nj", one, axes) for one in (along, velocity))
    return replace(states, position=states.position + next(moved), velocity=states.velocity + next(moved))
