"""How a lander arrives at a touchdown, and on what ground: its pull, its slope, and the impact point."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import about_z, arriving, axes_in_icrf, from_frame, quaternion
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.study.ground_checks import LEAST_FRICTION
from lithobrake.study.impact_sections import SiteSection
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.soil import grain, grain_sizes
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.quantities import (
    GROUND,
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    ORIENTATION,
    ROTATION,
    SPIN,
    Row,
)

if TYPE_CHECKING:
    from lithobrake.smallbody import AttitudeHistory
    from lithobrake.smallbody.grounds import BodyGround, Moments

# A lander that comes in along the ground meets it from above all the same.
FLATTEST_DEG = 89.9
# Angle of an impact from the normal of the shape's facet, where the ground that is met faces another way.
MEAN_INCIDENCE = "impact.mean_incidence_deg"
# The steepest bed of hulls that was seen to hold (docs/decisions/touchdown.md). Soil lies on no steeper ground: what
# was there has run down, so the bed of a touchdown is tilted no farther.
STEEPEST_DEG = 35.0
Interval = tuple[float, float]
# Sizes of grains out of their distribution, evenly by share, whose mean is that of all.
SIZE_COUNT = 1000
# Of a lander that is flown to the ground [m/s]: the smallest width is the same at every speed.
ANY_SPEED = 1.0


def impact_inputs(speed: float, incidence: float) -> Row:
    """Speed [m/s] and incidence [rad] of an impact, as inputs of its touchdown."""
    return {IMPACT_SPEED: speed, IMPACT_INCIDENCE: min(math.degrees(incidence), FLATTEST_DEG)}


def attitude_inputs(axes: np.ndarray, azimuth_deg: float, attitude: Rotation, spin: np.ndarray) -> Row:
    """Attitude and spin [rad/s], both fixed to the body, in the frame of the bed.

    axes: of the touchdown in rows, [3, 3], whose x lies along the incoming horizontal velocity, at this azimuth in the
    bed.
    """
    into_bed = about_z(math.radians(azimuth_deg)) * from_frame(axes).inv()
    spins = dict(zip(SPIN, into_bed.apply(spin).tolist(), strict=True))
    return spins | dict(zip(ORIENTATION, quaternion(into_bed * attitude), strict=True))


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
    # Not by a matrix product, whose rounding depends on how many rows there are.
    found: Array = (rotations * vectors[:, None, :]).sum(axis=2)
    return found


def against_ground(position: Array, velocity: Array, spin_period: Array) -> Array:
    """Velocities [m/s] against axes that turn about z, from those against axes that do not, all [count, 3]."""
    rate = 2.0 * np.pi / spin_period
    ground = np.stack([-rate * position[:, 1], rate * position[:, 0], np.zeros_like(rate)], axis=1)
    found: Array = velocity - ground
    return found


def lander_inertia(study: Study, row: Mapping[str, float]) -> np.ndarray:
    """Inertia of the lander of a journey about its centre of mass [kg m2], [3, 3]."""
    return lander(study, row).body.inertia


def turned_in_flight(
    inertia: np.ndarray,
    attitude: Rotation,
    spin: np.ndarray,
    spin_period: float,
    time: float,
    *,
    ground: "AttitudeHistory | None" = None,
    start: float = 0.0,
) -> tuple[Rotation, np.ndarray]:
    """Attitude and spin [rad/s], against the ground, after a flight [s], from those at its start, fixed to the body.

    inertia: of the lander [kg m2], [3, 3]. spin: at the start, against axes that do not turn. spin_period: of the body
    about z [s]. ground: Body.rotation, of which the flight begins at a time start [s].
    """
    from lithobrake.smallbody.rotation import ground_spin
    from lithobrake.smallbody.tumbling import turned_freely

    (turning,) = ground_spin(ground, np.array([start + time]), np.array([spin_period]))
    after, spin_after = turned_freely(inertia, attitude, spin, spin_period, time, ground=ground, start=start)
    return after, spin_after - turning


def roughness(study: Study) -> float:
    """Root mean square slope of the ground at the lander's scale [rad]."""
    return math.radians(study.site.roughness_deg or 0.0)


def met_ground(
    study: Study, velocity: np.ndarray, up: np.ndarray, incidence: np.ndarray, uniforms: Callable[[], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Axes of touchdowns in rows, [count, 3, 3], and incidences [rad], [count], on the ground that landers meet.

    velocity [m/s] and up, the normals of the facets, both [count, 3]; incidence: against these [rad], [count];
    uniforms: gives numbers between 0 and 1, [count, 2], that draw the gradient; asked where the ground is rough alone.
    """
    from lithobrake.smallbody import incidence_on, met_normals
    from lithobrake.smallbody.bounce import impact_frame

    # Flat facets take no random numbers.
    if not study.site.roughness_deg:
        return impact_frame(velocity, up), incidence
    normal = met_normals(velocity, up, roughness(study), uniforms())
    return impact_frame(velocity, normal), incidence_on(velocity, normal)


def first_axes(study: Study, axes: np.ndarray, rows: Sequence[Row]) -> np.ndarray:
    """Axes of first touchdowns in rows, [count, 3, 3], from those on the facets of the shape.

    rows: inputs of the touchdowns, by which journeys have the same ground whoever asks.
    """
    if not study.site.roughness_deg or not len(rows):
        return axes
    angle = np.radians([row.get(MEAN_INCIDENCE, row[IMPACT_INCIDENCE]) for row in rows])
    incoming = np.sin(angle)[:, None] * axes[:, 0] - np.cos(angle)[:, None] * axes[:, 2]
    journeys = [int(row["journey"]) for row in rows]
    return met_ground(study, incoming, axes[:, 2], angle, lambda: first_uniforms(study, journeys))[0]


def first_uniforms(study: Study, journeys: Sequence[int]) -> np.ndarray:
    """What draws the ground of the first touchdowns of journeys, two numbers between 0 and 1 for each, [count, 2]."""
    drawn = [np.random.default_rng(hashed_seed(study.seed, "roughness", journey)).random(2) for journey in journeys]
    return np.array(drawn).reshape(-1, 2)


def on_rough_ground(study: Study, rows: Sequence[Row], axes: np.ndarray, met: np.ndarray) -> list[Row]:
    """First touchdowns in the frames of the ground that they meet, from those on the facets of the shape.

    axes, met: of both frames, in rows, [count, 3, 3]. The lander arrives as it did: speed, attitude and spin stay, seen
    from other axes. Touchdowns that are in their frames already are left as they are.
    """
    if not study.site.roughness_deg:
        return list(rows)
    each = zip(rows, axes, met, strict=True)
    return [row if MEAN_INCIDENCE in row else _seen_from(row, *frames) for row, *frames in each]


def _seen_from(row: Row, axes: np.ndarray, met: np.ndarray) -> Row:
    angle = math.radians(row[IMPACT_INCIDENCE])
    incoming = math.sin(angle) * axes[0] - math.cos(angle) * axes[2]
    incidence = math.acos(min(max(-float(incoming @ met[2]), 0.0), 1.0))
    return {
        **row,
        **impact_inputs(row[IMPACT_SPEED], incidence),
        MEAN_INCIDENCE: row[IMPACT_INCIDENCE],
        **attitude_inputs(met, row[IMPACT_AZIMUTH], *arriving(row, axes)),
    }


def ground_inputs(acceleration: Sequence[float], azimuth_deg: float, friction: float) -> Row:
    """The acceleration of a touchdown as inputs of its bed, in whose frame the incoming velocity has an azimuth.

    acceleration: along the incoming horizontal velocity, to its left, outward [m/s2]. friction: of the grains, which
    bounds the tilt of the bed.
    """
    along, aside, outward = (float(one) for one in acceleration)
    strength, sign = math.hypot(along, aside, outward), -1.0 if outward > 0.0 else 1.0
    slope = math.atan2(math.hypot(along, aside), abs(outward))
    # An acceleration below 0 turns its component along the ground round as well, which the sign takes back.
    downhill = math.degrees(math.atan2(sign * aside, sign * along)) + azimuth_deg
    # A study with such a slope is refused; a journey has the slopes of the body, so its bed is tilted no more than it
    # holds.
    tilt = min(slope, math.radians(STEEPEST_DEG), math.atan(friction / LEAST_FRICTION))
    return dict(zip(GROUND, (sign * strength, math.degrees(tilt), downhill % 360.0), strict=True))


def rotation_inputs(rotation: Sequence[float], azimuth_deg: float) -> Row:
    """The rotation of the ground [rad/s], along the incoming horizontal velocity, to its left and outward, as inputs of
    its bed, in whose frame that velocity has an azimuth.
    """
    turned = about_z(math.radians(azimuth_deg)).apply(rotation).tolist()
    return dict(zip(ROTATION, turned, strict=True))


def on_local_ground(site: Site, rows: Sequence[Row], first: int) -> list[Row]:
    """The first touchdowns of landers, numbered from `first` on, each on the soil of where it is.

    Under the acceleration there, too, unless the study gives all of them one.
    """
    from lithobrake.smallbody.grounds import BodyGround, Moments

    study = site.study
    columns = {key: values[first:] for key, values in site.sampled(first + len(rows)).items()}
    origin, axes = site.frames(columns)
    met = first_axes(study, axes, rows)
    arriving = Soils(site).on_soil(on_rough_ground(study, rows, axes, met), origin)
    if not study.has_local_ground:
        return arriving
    when = Moments(site.clock(columns), columns["mass"], columns["spin_period"])
    return on_ground(BodyGround(site.body), arriving, origin, met, when)


def on_ground(
    ground: "BodyGround", rows: Sequence[Row], origin: np.ndarray, axes: np.ndarray, when: "Moments"
) -> list[Row]:
    """Touchdowns on the turning ground at their origins [m], [count, 3], in frames with these axes, [count, 3, 3]."""
    local = np.einsum("nij,nj->ni", axes, ground.felt(origin, when))
    turns = np.einsum("nij,nj->ni", axes, ground.spin(when))
    return [
        row | ground_inputs(one, row[IMPACT_AZIMUTH], friction_of(row)) | rotation_inputs(turn, row[IMPACT_AZIMUTH])
        for row, one, turn in zip(rows, local, turns, strict=True)
    ]


def friction_of(row: Mapping[str, float]) -> float:
    """Friction of grains on each other and on their floor."""
    return row["grain.friction"]


def place_region(study: Study) -> tuple[Interval, Interval] | None:
    """The rectangle [m, from the middle of the bed, along x and y] out of which places are drawn; None for no draw.

    Where a study names neither place nor region: all of a bed that repeats; between walls, wherever the lander is
    as far from each as in the smallest bed whose walls do not answer its first blow, or in the middle where a bed is no
    wider than that.
    """
    impact = study.impact
    if impact.region is not None:
        return impact.region.x, impact.region.y
    if impact.place is not None:
        return None
    if study.bed.sides == "periodic":
        along, across = (0.5 * width for width in study.bed.width)
        return (-along, along), (-across, across)
    # Nearer to a wall its reflection would meet the lander within the first contact (docs/decisions/touchdown.md).
    along, across = (max(0.0, 0.5 * (width - smallest_width(study))) for width in study.bed.width)
    return (-along, along), (-across, across)


def smallest_width(study: Study) -> float:
    """Width [m] of the smallest bed of a study at its medians; stiffness and speed cancel in it."""
    from lithobrake.touchdown import smallest_bed

    values: dict[str, Any] = study.touchdown_medians()
    diameter = float(grain_sizes(study).draw((np.arange(SIZE_COUNT) + 0.5) / SIZE_COUNT).mean())
    speed = values.get(IMPACT_SPEED, ANY_SPEED)
    return smallest_bed(lander(study, values), grain(values), diameter, speed)[0]
