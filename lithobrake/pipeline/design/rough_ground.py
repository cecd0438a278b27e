"""First touchdowns on ground that is rough: the frame of the ground that a lander meets, and its touchdown in there."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.geometry.contact_frame import arriving
from lithobrake.pipeline.design.arrival import attitude_inputs, impact_inputs
from lithobrake.study import Study

Row = dict[str, float]
AZIMUTH, INCIDENCE, SPEED = "impact.azimuth_deg", "impact.incidence_deg", "impact.speed"
# Angle of an impact from the normal of the shape's facet, where the ground that is met faces another way.
MEAN_INCIDENCE = "impact.mean_incidence_deg"


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
    from lithobrake.smallbody.hopping import impact_frame

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
    angle = np.radians([row.get(MEAN_INCIDENCE, row[INCIDENCE]) for row in rows])
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
    angle = math.radians(row[INCIDENCE])
    incoming = math.sin(angle) * axes[0] - math.cos(angle) * axes[2]
    incidence = math.acos(min(max(-float(incoming @ met[2]), 0.0), 1.0))
    return {
        **row,
        **impact_inputs(row[SPEED], incidence),
        MEAN_INCIDENCE: row[INCIDENCE],
        **attitude_inputs(met, row[AZIMUTH], *arriving(row, axes)),
    }
