"""Mean direction of an angle and how closely its values gather there, with intervals from beds."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, Bounds, answered_runs, normal_quantile, t_quantile
from lithobrake.analysis.share_estimate import standard_error


@dataclass(frozen=True)
class DirectionEstimate:
    """Mean direction and resultant length of an angle over the input distributions and over new beds.

    mean_direction           [rad], above -pi and at most pi
    mean_direction_bounds    the direction less and plus at most pi [rad], so they may lie outside -pi to pi; a whole
                             turn where the landings have no preferred direction; None without an interval
    resultant_length         0 where directions cancel, 1 where all are alike
    resultant_length_bounds  its interval, within 0 to 1; None without an interval
    level                    confidence of each interval
    """

    mean_direction: float
    mean_direction_bounds: Bounds | None
    resultant_length: float
    resultant_length_bounds: Bounds | None
    level: float = LEVEL


def direction_estimate(angle: ArrayLike, bed: ArrayLike, *, why: str | None = None) -> DirectionEstimate:
    """Estimate the mean direction of an angle [run_count] in rad, NaN where a run has none, on beds [run_count].

    why: a reason why these runs give no interval, as one impact point; on one bed there is none either. The interval of
    the direction m is m -+ arcsin(t se / R), with R the resultant length and se the standard error of the mean of
    sin(angle - m) from beds; that of R comes from the noncentral chi-square distribution with the error of the mean of
    cos(angle - m), or the larger of both where m may be any direction, so it reaches 0 where none is preferred. Its
    upper end is at least that of the median length without a preferred direction.
    Raises ValueError where no run has the angle.
    Source: [Mardia-2000], sections 2.3 (mean direction, resultant length) and 4.8.1 (their large-sample distribution);
    [Cameron-2008] (errors from few clusters).
    """
    values, beds = answered_runs(angle, bed)
    if len(values) == 0:
        raise ValueError("no run has the angle; give one in radians for each run, some of them known")
    cosine, sine = float(np.cos(values).mean()), float(np.sin(values).mean())
    direction, length = math.atan2(sine, cosine), math.hypot(cosine, sine)
    bed_count = int(beds.max()) + 1
    if why is not None or bed_count == 1:
        return DirectionEstimate(direction, None, length, None)
    quantile = t_quantile(bed_count - 1)
    across, along = (quantile * standard_error(wave(values - direction), beds) for wave in (np.sin, np.cos))
    # Where the error of the mean vector is as long as the vector itself it may point anywhere.
    half = math.asin(across / length) if across < length else math.pi
    # Which way a vector points that may be 0 is chance, and so is which error is the one along it.
    error = max(across, along) if half == math.pi else along
    lengths = _length_bounds(length, error / normal_quantile())
    return DirectionEstimate(direction, (direction - half, direction + half), length, lengths)


def _length_bounds(length: float, error: float) -> Bounds:
    """Bounds of the length of a mean vector in the plane, each component of which has this standard error.

    The square of the length over that of the error is chi-square with two degrees of freedom, and the square of the
    true ratio is its noncentrality. Source: [Mardia-2000], section 4.8.1.
    """
    from scipy import optimize, special

    if error == 0.0:
        return length, length

    def bound(length: float, probability: float) -> float:
        square = (length / error) ** 2

        def excess(ratio: float) -> float:
            return float(special.chndtr(square, 2.0, ratio**2)) - probability

        # Six errors beyond the length nothing is left of the tail.
        return error * float(optimize.brentq(excess, 0.0, length / error + 6.0)) if excess(0.0) > 0.0 else 0.0

    lower = bound(length, 0.5 + 0.5 * LEVEL)
    # A length that chance alone made so short is no proof of none: the upper end is that of its median without any.
    upper = bound(max(length, error * math.sqrt(2.0 * math.log(2.0))), 0.5 - 0.5 * LEVEL)
    return min(lower, length), min(max(upper, length), 1.0)
