"""How the ground of each cell lies, and how much light falls on it, whatever lands there."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.analysis import EqualAreaCells
from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.design.local_ground import felt
from lithobrake.pipeline.job import Job
from lithobrake.study.quantity import Scalar, Uncertain

# Places of each cell that are looked at.
PLACES = 24


@dataclass(frozen=True)
class SiteGround:
    """Numbers at places that are spread evenly over each cell, [cell_count, PLACES].

    slope_deg: of the facets against gravity, rotation and the partner's tide; gravity: the acceleration of what rests
    there [m/s2]; light: fraction of a day in which a body is seen, by its name.
    """

    slope_deg: np.ndarray
    gravity: np.ndarray
    light: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, job: Job, cells: EqualAreaCells) -> "SiteGround":
        """That of a study's body at the medians of its mass and spin, over a day and the seasons of its [sky]."""
        random = np.random.default_rng(hashed_seed(job.study.seed, "ground of the sites"))
        places = cells.places_deg(np.broadcast_to(_spread(random), (cells.total, PLACES, 2))).reshape(-1, 2)
        shape = job.site.body.shape
        points, facets = shape.locate(places[:, 0], places[:, 1])
        up, columns = shape.normals[facets], job.site.columns(len(points))
        time = job.site.body.partner_time(columns["partner_longitude_deg"], columns["spin_period"])
        here = felt(job.site.body, points, time, columns["mass"], columns["spin_period"])
        strength = np.linalg.norm(here, axis=1)
        slope = np.degrees(np.arccos(np.clip(-(here * up).sum(axis=1) / strength, -1.0, 1.0)))
        light = {
            name: _seen(job, name, latitude, points, up, random).reshape(-1, PLACES)
            for name, latitude in job.study.sky.bodies.items()
        }
        return cls(slope.reshape(-1, PLACES), strength.reshape(-1, PLACES), light)


def _spread(random: np.random.Generator) -> np.ndarray:
    """Places of a cell as uniform numbers [PLACES, 2]: one in each of as many strips both ways."""
    strips = np.stack([random.permutation(PLACES), random.permutation(PLACES)], axis=1)
    found: np.ndarray = (strips + random.random((PLACES, 2))) / PLACES
    return found


def _seen(
    job: Job, name: str, latitude: Scalar, points: np.ndarray, up: np.ndarray, random: np.random.Generator
) -> np.ndarray:
    """Fraction of a day in which a body far away is seen from points [count, 3], each on a day of its own, [count]."""
    from lithobrake.smallbody import seen_over_a_day

    shape, mask = job.site.body.shape, job.study.sky.mask_of(name)
    days = (np.argsort(random.random((len(points) // PLACES, PLACES)), axis=1) + 0.5).ravel() / PLACES
    over = latitude.to_chaos().ppf(days) if isinstance(latitude, Uncertain) else np.full(len(points), latitude)
    found = np.empty(len(points))
    for first in range(0, len(points), PLACES):
        job.progress(first, len(points), f"{name} over the sites")
        part = slice(first, first + PLACES)
        found[part] = seen_over_a_day(shape, points[part], up[part], over[part], mask).mean(axis=1)
    job.progress(len(points), len(points), f"{name} over the sites")
    return found
