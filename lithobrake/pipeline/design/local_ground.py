"""The acceleration of a touchdown where it is: gravity, rotation and the partner's tide, against the normal there."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.design.felt_acceleration import felt
from lithobrake.pipeline.design.rough_ground import first_axes, on_rough_ground
from lithobrake.pipeline.design.soils import Soils
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
    """The first touchdowns of journeys, numbered from `first` on, each on the soil and under the acceleration there."""
    site = Site(study)
    columns = {key: values[first:] for key, values in site.sampled(first + len(rows)).items()}
    origin, axes = site.frames(columns)
    met = first_axes(study, axes, rows)
    arriving = Soils(site).on_soil(on_rough_ground(study, rows, axes, met), origin)
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
