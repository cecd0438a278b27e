"""What a run of a study takes at random beside its uncertain inputs: bed, impact point, azimuth and attitude."""

import math
from collections.abc import Mapping

import numpy as np

from lithobrake.geometry.attitude import pointed
from lithobrake.study import Study
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, ORIENTATION, PLACE, Row

Interval = tuple[float, float]


def draw(study: Study, values: Mapping[str, float], seed: int, region: tuple[Interval, Interval] | None) -> Row:
    """The values of a run with what it draws by chance, or is given in its place.

    region: ends of x and y between which impact points are drawn [m]; None: the point is given.

    bed: number of the bed; impact.place.x and .y [m], impact.azimuth_deg, impact.orientation.w to .z. All are drawn,
    whether used or not, so that each has the same random numbers in every study. A run takes the bed with the largest
    number of its own: one more bed takes its part of the runs over, and all others stay on theirs (rendezvous hashing).

    Source: [Thaler-1998].
    """
    # A stream of its own, as the number of beds decides how much is taken from it: the other draws stay as they are.
    bed = int(np.argmax(np.random.Generator(np.random.PCG64([seed, 1])).random(study.bed_count)))
    generator = np.random.Generator(np.random.PCG64(seed))
    fractions, turn = generator.random(2), generator.random()
    # Four normal numbers point evenly over the unit quaternions.
    quaternion = generator.standard_normal(4)
    impact = study.impact
    if region is None:
        place = [values[name] for name in PLACE]
    else:
        place = [low + part * (high - low) for part, (low, high) in zip(fractions.tolist(), region, strict=True)]
    azimuth = 360 * turn if impact.azimuth_deg == "random" else values[IMPACT_AZIMUTH]
    if impact.orientation != "random":
        quaternion = given_attitude(study, *generator.random(2).tolist())
    orientation = (quaternion / np.linalg.norm(quaternion)).tolist()
    return {
        **values,
        "bed": float(bed),
        **dict(zip(PLACE, place, strict=True)),
        IMPACT_AZIMUTH: float(azimuth),
        **dict(zip(ORIENTATION, orientation, strict=True)),
    }


def given_attitude(study: Study, distance: float, direction: float) -> np.ndarray:
    """The attitude that the study gives, off by its error of pointing as two uniform numbers say."""
    orientation = np.array(study.impact.orientation)
    if study.impact.pointing_error_deg is None:
        return orientation
    return pointed(orientation, math.radians(study.impact.pointing_error_deg), distance, direction)
