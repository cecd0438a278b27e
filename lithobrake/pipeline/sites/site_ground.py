"""How the ground of each cell lies, and how much light falls on it, whatever lands there."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.analysis import EqualAreaCells
from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.design.felt_acceleration import felt
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.sky.seen_from_rest import views
from lithobrake.pipeline.sky.where_they_stand import Days, where_it_stands
from lithobrake.study.sky_section import SkyBody

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
        time = job.site.clock(columns)
        here = felt(job.site.body, points, time, columns["mass"], columns["spin_period"])
        strength = np.linalg.norm(here, axis=1)
        slope = np.degrees(np.arccos(np.clip(-(here * up).sum(axis=1) / strength, -1.0, 1.0)))
        light: dict[str, np.ndarray] = {
            name: _seen(job, name, points, up, random).reshape(-1, PLACES) for name in job.study.sky.bodies
        }
        return cls(slope.reshape(-1, PLACES), strength.reshape(-1, PLACES), light)


def _spread(random: np.random.Generator) -> np.ndarray:
    """Places of a cell as uniform numbers [PLACES, 2]: one in each of as many strips both ways."""
    strips = np.stack([random.permutation(PLACES), random.permutation(PLACES)], axis=1)
    found: np.ndarray = (strips + random.random((PLACES, 2))) / PLACES
    return found


def _seen(job: Job, name: SkyBody, points: np.ndarray, up: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Fraction of the time in which a body is seen from points [count, 3], [count]; one far away, on a day of each."""
    from lithobrake.smallbody import seen_from

    body, mask, stands = job.site.body, job.study.sky.mask_of(name), where_it_stands(job.study, job.site, name)
    if isinstance(stands, Days):
        days = (np.argsort(random.random((len(points) // PLACES, PLACES)), axis=1) + 0.5).ravel() / PLACES
        stands = Days(np.quantile(stands.latitude, days)[:, None])
    found = np.empty(len(points))
    for first in range(0, len(points), PLACES):
        job.progress(first, len(points), f"{name} over the sites")
        here = np.arange(first, first + PLACES)
        found[here] = sum(
            seen_from(
                *(body.shape, points[here], up[here], view.directions, mask), distance=view.distance, screen=view.screen
            )
            @ view.weight
            for view in views(body, points[here], here, stands)
        )
    job.progress(len(points), len(points), f"{name} over the sites")
    return found
