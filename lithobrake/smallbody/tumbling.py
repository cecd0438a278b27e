"""Rotation without torque over any duration at once: of a body, and of a lander in flight."""

import math
from functools import reduce
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from lithobrake.geometry.attitude import about_z, quaternion, quaternion_products
from lithobrake.smallbody.rotation import AttitudeHistory
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.given_numbers import numbers

# Principal moments nearer than this part of the largest differ by the rounding of eigenvalues.
SAME_MOMENT = 8.0 * float(np.finfo(float).eps)
# Of the arithmetic-geometric mean: enough from the smallest complement that a float holds.
MEAN_STEPS = 14
BACK = np.array([1.0, -1.0, -1.0, -1.0])


class _Cycle(NamedTuple):
    """How an angular momentum of 1 circles an axis of the body; each of shape [count], moments over the largest.

    a, b, c     principal moments: c of the axis that it circles, b the middle one
    ab, bc, ac  how far apart these are
    complement  1 - k^2 of the elliptic functions; 0: the motion never comes round
    rate        of their argument; above 0 about the axis of the largest moment
    amplitudes  of the angular momentum along a, b and c
    sn, cn, dn  the elliptic functions at the start: the angular momentum is amplitudes times cn, sn and dn
    """

    a: Floats
    b: Floats
    c: Floats
    ab: Floats
    bc: Floats
    ac: Floats
    complement: Floats
    rate: Floats
    amplitudes: tuple[Floats, Floats, Floats]
    sn: Floats
    cn: Floats
    dn: Floats


def tumble(inertia: ArrayLike, attitude: ArrayLike, spin: ArrayLike, duration: ArrayLike) -> tuple[Floats, Floats]:
    """Turn rigid bodies of one inertia without torque, each for its duration; return their attitudes and spins.

    inertia [3, 3]       about the centroid in the body's axes [kg m2], symmetric and positive definite
    attitude [count, 4]  quaternions w, x, y, z that turn the body's axes into axes that do not turn
    spin [count, 3]      angular velocity in the axes that do not turn [rad/s]
    duration [count]     [s]; below 0: back in time

    The spin in the body's axes is that of Jacobi's elliptic functions. The attitude follows from the direction of the
    angular momentum, which does not turn, and from the precession about it, an elliptic integral of the third kind.
    The cost does not depend on the duration. Angular momentum and energy are kept to rounding. The attitude errs by the
    rounding of the angle turned: by 2e-11 in the median and 2e-10 at most after 12 h at 5 rad/s, against 40 digits
    (validation/tumbling_accuracy.json). Near the separatrix, where a spin about the middle axis turns over, rounding of
    the spin given grows by the reciprocal of how near it is.
    Raises ValueError for an inertia that no body has, and for arrays that do not fit.
    Source: [Landau-1976], section 37 (Euler's equations); [Carlson-1995] (elliptic integrals).
    """
    moments, axes = _principal(inertia)
    start, omega, time = _checked(attitude, spin, duration)
    # Squares of the slowest spins would be 0.
    scale = np.max(np.abs(omega), axis=1, keepdims=True, initial=0.0)
    scale[scale == 0.0] = 1.0
    if moments[0] == moments[2]:
        rate = np.linalg.norm(omega / scale, axis=1, keepdims=True)
        axis = omega / scale / np.where(rate > 0.0, rate, 1.0)
        half = 0.5 * (rate * scale)[:, 0] * time
        return _unit(
            quaternion_products(np.column_stack([np.cos(half), np.sin(half)[:, None] * axis]), start)
        ), omega.copy()
    momentum = moments * _combined(_turned(start * BACK, omega / scale), axes[None])
    size = np.linalg.norm(momentum, axis=1, keepdims=True)
    momentum /= np.where(size > 0.0, size, 1.0)
    order, signs = _circled(moments, momentum)
    frame = axes.T[order] * signs[:, :, None]
    there = moments[order]
    turn, after = _moved(_cycle(there, np.take_along_axis(momentum, order, 1) * signs), (size * scale)[:, 0] * time)
    turn[:, 1:] = _combined(turn[:, 1:], frame)
    moved = _unit(quaternion_products(start, turn))
    return moved, _turned(moved, _combined(after / there * size * scale, frame))


def _principal(inertia: ArrayLike) -> tuple[Floats, Floats]:
    """Principal moments, ascending, over the largest, and their axes as right-handed columns [3, 3]."""
    matrix = numbers("inertia", inertia)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise ValueError(f"inertia has shape {matrix.shape}, but must be [3, 3] of finite numbers in kg m2")
    largest = np.abs(matrix).max()
    if largest == 0.0 or np.abs(matrix - matrix.T).max() > 1e-9 * largest:
        raise ValueError("inertia is 0 or not symmetric; give the tensor about the centroid in kg m2")
    # Over the largest moment, so that inertias of any unit neither overflow nor underflow in their products.
    moments, axes = np.linalg.eigh(0.5 * (matrix + matrix.T) / largest)
    if moments[0] <= 0.0:
        raise ValueError(f"inertia has the principal moment {moments[0] * largest:g}, but each must be above 0")
    moments = moments / moments[2]
    moments[1] = 1.0 if 1.0 - moments[1] <= SAME_MOMENT else moments[1]
    moments[0] = moments[1] if moments[1] - moments[0] <= SAME_MOMENT else moments[0]
    # Eigenvectors may be left-handed, and no quaternion mirrors.
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return moments, axes


def _checked(attitude: ArrayLike, spin: ArrayLike, duration: ArrayLike) -> tuple[Floats, Floats, Floats]:
    """Unit quaternions [count, 4], spins [count, 3] and durations [count]."""
    start, omega, time = numbers("attitude", attitude), numbers("spin", spin), numbers("duration", duration)
    count = len(start) if start.ndim else 0
    if (start.shape, omega.shape, time.shape) != ((count, 4), (count, 3), (count,)):
        raise ValueError(
            f"attitude has shape {start.shape}, spin {omega.shape} and duration {time.shape}, but they must be "
            "[count, 4], [count, 3] and [count]"
        )
    if not (np.isfinite(start).all() and np.isfinite(omega).all() and np.isfinite(time).all()):
        raise ValueError("attitude, spin and duration hold NaN or infinity; give finite numbers for each body")
    if not np.any(start, axis=1).all():
        raise ValueError("attitude holds a quaternion of four zeros; give unit quaternions w, x, y, z")
    return _unit(start), omega, time


def _circled(moments: Floats, momentum: Floats) -> tuple[np.ndarray, Floats]:
    """Which principal axis is a, b and c of each body, and the signs that make them right-handed with c forward."""
    low, high = moments[1] - moments[0], moments[2] - moments[1]
    toward_largest = momentum[:, 2] ** 2 * high / moments[2]
    toward_smallest = momentum[:, 0] ** 2 * low / moments[0]
    # Where neither wins, the axis of which no other has the moment.
    largest = (toward_largest > toward_smallest) | ((toward_largest == toward_smallest) & (high >= low))
    order = np.where(largest[:, None], [0, 1, 2], [2, 1, 0])
    forward = np.where(np.take_along_axis(momentum, order[:, 2:], 1)[:, 0] < 0.0, -1.0, 1.0)
    return order, np.stack([np.ones_like(forward), np.where(largest, forward, -forward), forward], axis=1)


def _cycle(moments: Floats, momentum: Floats) -> _Cycle:
    """The cycle of unit angular momenta [count, 3] along axes a, b and c of these moments [count, 3]."""
    (a, b, c), (x, y, z) = moments.T, momentum.T
    ab, bc, ac = np.abs(a - b), np.abs(b - c), np.abs(a - c)
    # What energy and angular momentum leave of x and y, of y and z, and the excess over the separatrix.
    across, along = x**2 * ac / a + y**2 * bc / b, y**2 * ab / b + z**2 * ac / c
    excess = z**2 * bc / c - x**2 * ab / a
    complement = np.divide(ac * excess, along * bc, out=np.ones_like(along), where=along * bc > 0.0)
    complement = np.clip(complement, 0.0, 1.0)
    rate = np.where(c > a, 1.0, -1.0) * np.sqrt(along * bc / (a * b * c))
    phase = np.arctan2(y * np.sqrt(bc / b), x * np.sqrt(ac / a))
    sn, cn = np.sin(phase), np.where(x == 0.0, np.where(y == 0.0, 1.0, 0.0), np.cos(phase))
    amplitudes = np.sqrt(across * a / ac), np.sqrt(across * b / bc), np.sqrt(along * c / ac)
    return _Cycle(a, b, c, ab, bc, ac, complement, rate, amplitudes, sn, cn, np.sqrt(cn**2 + complement * sn**2))


def _moved(cycle: _Cycle, time: Floats) -> tuple[Floats, Floats]:
    """Rotation since the start, as quaternions in the axes a, b, c, and the angular momentum there, [count, 3].

    Euler's angles between the axes and the direction of the angular momentum: node, tilt and precession.
    """
    sn, cn, dn, integral = _elliptic(cycle, cycle.rate * time)
    rate = np.abs(cycle.rate)
    shift = np.divide(cycle.ab * integral, cycle.a * cycle.b * rate, out=np.zeros_like(rate), where=rate > 0.0)
    ends = []
    for s, c, d in ((cycle.sn, cycle.cn, cycle.dn), (sn, cn, dn)):
        x, y, z = (size * part for size, part in zip(cycle.amplitudes, (c, s, d), strict=True))
        # The node has its place even where the angular momentum lies along c.
        node = np.arctan2(c * np.sqrt(cycle.a * cycle.bc), s * np.sqrt(cycle.b * cycle.ac))
        ends.append((node, np.arctan2(np.hypot(x, y), z)))
    (node, tilt), (node_after, tilt_after) = ends
    precession = time / cycle.b + shift
    turns = (_about(2, -node), _about(0, -tilt), _about(2, precession), _about(0, tilt_after), _about(2, node_after))
    return reduce(quaternion_products, turns), np.stack([x, y, z], axis=1)


def _elliptic(cycle: _Cycle, advance: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Jacobi's sn, cn and dn after an advance of their argument, and the integral of cn^2 / (1 + n sn^2) over it."""
    from scipy.special import ellipkm1

    n = cycle.c * cycle.ab / (cycle.a * cycle.bc)
    still = cycle.complement == 0.0
    # Any other complement will do where the closed form of the separatrix takes over.
    complement = np.where(still, 1.0, cycle.complement)
    half_period = 2.0 * ellipkm1(complement)
    whole = 2.0 * _integrals(np.ones_like(n), np.zeros_like(n), complement, n)[1]
    side = np.where(cycle.cn < 0.0, -1.0, 1.0)
    argument, before = _integrals(side * cycle.sn, np.abs(cycle.cn), complement, n)
    turns = np.round((argument + advance) / half_period)
    sn, cn, dn = _jacobi(argument + advance - turns * half_period, complement, 0.5 * half_period)
    integral = whole * turns + _integrals(sn, cn, complement, n)[1] - before
    side = side * (1.0 - 2.0 * np.abs(turns % 2.0))
    found, hovering = (side * sn, side * cn, dn, integral), _separatrix(cycle, advance, n)
    sn, cn, dn, integral = (np.where(still, one, other) for one, other in zip(hovering, found, strict=True))
    return sn, cn, dn, integral


def _integrals(sn: Floats, cn: Floats, complement: Floats, n: Floats) -> tuple[Floats, Floats]:
    """Argument of sn and cn >= 0, and the integral of cn^2 / (1 + n sn^2) from 0 to there. Source: [Carlson-1995]."""
    from scipy.special import elliprf, elliprj

    x, y, z = cn**2, cn**2 + complement * sn**2, np.ones_like(sn)
    argument = sn * elliprf(x, y, z)
    return argument, argument - (1.0 + n) * sn**3 / 3.0 * elliprj(x, y, z, 1.0 + n * sn**2)


def _jacobi(argument: Floats, complement: Floats, quarter: Floats) -> tuple[Floats, Floats, Floats]:
    """Jacobi's sn, cn and dn of an argument within a quarter period of 0, by the arithmetic-geometric mean.

    From the complement, which keeps its digits near the separatrix; beyond half a quarter by reflection, likewise.
    Source: [Abramowitz-1964], sections 16.4 and 16.8.
    """
    size = np.abs(argument)
    reflected = size > 0.5 * quarter
    size = np.where(reflected, quarter - size, size)
    mean, other, ratios = np.ones_like(size), np.sqrt(complement), []
    for _ in range(MEAN_STEPS):
        half_gap = 0.5 * (mean - other)
        mean, other = 0.5 * (mean + other), np.sqrt(mean * other)
        ratios.append(half_gap / mean)
    phase = 2.0**MEAN_STEPS * mean * size
    for ratio in reversed(ratios):
        phase = 0.5 * (phase + np.arcsin(ratio * np.sin(phase)))
    sn, cn = np.sin(phase), np.cos(phase)
    dn, root = np.sqrt(cn**2 + complement * sn**2), np.sqrt(complement)
    sn, cn, dn = (
        np.where(reflected, there, here)
        for there, here in zip((cn / dn, root * sn / dn, root / dn), (sn, cn, dn), strict=True)
    )
    return np.copysign(sn, argument), cn, dn


def _separatrix(cycle: _Cycle, advance: Floats, n: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """What `_elliptic` gives where the motion takes for ever to reach the middle axis, or hovers there."""
    side, root = np.where(cycle.cn < 0.0, -1.0, 1.0), np.sqrt(n)
    with np.errstate(divide="ignore", over="ignore"):
        begin = np.arcsinh(side * cycle.sn / np.abs(cycle.cn))
        cn = 1.0 / np.cosh(begin + advance)
    before, after = np.tanh(begin), np.tanh(begin + advance)
    gain = np.arctan(root * after) - np.arctan(root * before)
    return side * after, side * cn, cn, np.divide(gain, root, out=np.zeros_like(n), where=root > 0.0)


def _about(axis: int, angle: Floats) -> Floats:
    """Quaternions [count, 4] of turns by these angles [count] about one of the axes."""
    turn = np.zeros((len(angle), 4))
    turn[:, 0], turn[:, 1 + axis] = np.cos(0.5 * angle), np.sin(0.5 * angle)
    return turn


def _turned(quaternions: Floats, vectors: Floats) -> Floats:
    """Vectors [count, 3] turned by unit quaternions [count, 4]."""
    twice = 2.0 * np.cross(quaternions[:, 1:], vectors)
    turned: Floats = vectors + quaternions[:, :1] * twice + np.cross(quaternions[:, 1:], twice)
    return turned


def _combined(vectors: Floats, rows: Floats) -> Floats:
    """Sums of the rows of matrices [count or 1, 3, 3] times the components of vectors [count, 3].

    Not by a matrix product, whose rounding depends on how many bodies are turned at once.
    """
    x, y, z = vectors.T[:, :, None]
    found: Floats = x * rows[:, 0] + y * rows[:, 1] + z * rows[:, 2]
    return found


def _unit(quaternions: Floats) -> Floats:
    """Quaternions [count, 4] of length 1."""
    whole: Floats = quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
    return whole


def turned_freely(
    inertia: Floats,
    attitude: Rotation,
    spin: Floats,
    spin_period: float,
    time: float,
    *,
    ground: AttitudeHistory | None = None,
    start: float = 0.0,
) -> tuple[Rotation, Floats]:
    """Attitude of a lander and its spin against the stars [rad/s], [3], a time [s] later, or earlier where it is below
    0, from those at its start, all along axes fixed to the body as it then is.

    inertia: of the lander [kg m2], [3, 3]. spin_period: of the body about z [s]. ground: Body.rotation, at a time start
    [s].
    """
    turned, spins = tumble(inertia, np.array([quaternion(attitude)]), spin[None], np.array([time]))
    # The lander turns among the stars, while the axes that its attitude is against turn on with the body.
    back = about_z(-2.0 * math.pi / spin_period * time)
    if ground is not None:
        begin, end = (Rotation.from_matrix(ground.at(at).axes[0]) for at in (start, start + time))
        back = end.inv() * back * begin
    return back * Rotation.from_quat(turned[0], scalar_first=True), back.apply(spins[0])
