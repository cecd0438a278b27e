"""The speed that no lander leaves with: what energy allows."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.beds import bed_files
from lithobrake.pipeline.folder import StudyFolder
from lithobrake.study import Study
from lithobrake.touchdown_model import lander, medians, stored_bed

if TYPE_CHECKING:
    from numpy.typing import NDArray

SPIN = ("impact.spin_x", "impact.spin_y", "impact.spin_z")


def fastest(
    study: Study, folder: StudyFolder, values: "Mapping[str, NDArray[np.float64]]", count: int
) -> "NDArray[np.float64]":
    """Speed [m/s] of a lander that keeps all its energy and gains what gravity may give it over the bed, [count].

    values: of uncertain inputs, [count] each, by dotted key; all others are as the study has them. The bed is at rest
    and contacts only take energy away: v^2 + I w^2 / m + 2 g h, with h the height of the bed, and its fall across.
    """
    known = {name: np.full(count, value) for name, value in medians(study).items()} | dict(values)
    spin = sum(known[name] ** 2 for name in SPIN)
    slope = np.radians(known["surface.slope_deg"])
    # Gravity that points outwards lifts a lander as far as the other makes it fall.
    gained = np.abs(known["surface.gravity"]) * (_height(study, folder) + np.hypot(*study.bed.width) * np.sin(slope))
    bound: NDArray[np.float64] = np.sqrt(known["impact.speed"] ** 2 + _gyration(study, known) * spin + 2.0 * gained)
    return bound


def _height(study: Study, folder: StudyFolder) -> float:
    """Height [m] of the highest bed; a program of the user's own tells of none."""
    return max((float(stored_bed(folder / name).surface_height) for name in bed_files(study)), default=0.0)


def _gyration(study: Study, values: "Mapping[str, NDArray[np.float64]]") -> "NDArray[np.float64]":
    """Largest principal moment of inertia over the mass [m2], [count]."""
    if study.lander.inertia is not None:
        return max(study.lander.inertia) / values["lander.mass"]
    body = lander(study, medians(study))
    own = float(np.linalg.eigvalsh(body.shape.inertia_per_density)[-1]) / body.shape.volume
    # A ball is the one shape whose size may be uncertain.
    of_ball = values.get("lander.diameter")
    return np.full(len(values["lander.mass"]), own) if of_ball is None else 0.1 * of_ball**2
