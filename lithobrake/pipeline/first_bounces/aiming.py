"""Landers at every aim of a study, followed until they rest: on the soil, and on hard ground."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.analysis import sample_inputs
from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.frames import angles, directions
from lithobrake.pipeline.first_bounces.bounces_to_rest import Sites, journey_dependencies, on_hard_ground, on_soil
from lithobrake.pipeline.first_bounces.emulator import REFIT_COUNT, drawn_samples
from lithobrake.pipeline.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import JourneyStatus
from lithobrake.vocabulary.quantities import AIM_COLUMNS
from lithobrake.vocabulary.study_files import AIM_FILE

if TYPE_CHECKING:
    from lithobrake.smallbody import Body

FILE, COLUMNS = AIM_FILE, AIM_COLUMNS
SITE = "site."


def aim_files(study: Study) -> list[str]:
    """What the stage writes: nothing where the study has no aims to choose from."""
    return [FILE] if study.aim.names else []


def aim_dependencies(study: Study) -> dict[str, Any]:
    # Which aims are allowed is asked of what is already there.
    return {"rest": journey_dependencies(study), "grid": study.aim.grid, "lander_count": study.aim.lander_count}


def follow_aims(job: Job) -> None:
    """Follow the landers of every aim on both grounds and write aim.csv, one aim after the other.

    All aims have the same landers: soil, site and refit of each are drawn once, and only what is aimed at differs.
    """
    study, aims = job.study, job.study.aim.aims()
    count = study.aim.lander_count * REFIT_COUNT
    inputs, site = _aimed(job, aims, count)
    samples = drawn_samples(job, inputs, "aims")
    sites = Sites.of(job.site, samples, site)
    rows: list[list[Any]] = []
    for ground, bounce in (("soil", on_soil(job, samples)), ("hard", on_hard_ground(study, sites))):
        ends = sites.follow(job, ground, *bounce)
        distance = _distances(sites.body, site, ends)
        for number, (end, way) in enumerate(zip(ends, distance.tolist(), strict=True)):
            _, _, status, time, *_ = end
            settled = status == JourneyStatus.SETTLED
            rows.append([ground, number // count, number % REFIT_COUNT, status, time, way if settled else ""])
    write_table(job.folder, FILE, COLUMNS, rows)


def _aimed(job: Job, aims: list[dict[str, float]], count: int) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Inputs [aim_count * count, input_count] and sites of all landers, one aim after the other."""
    names = list(job.design.inputs)
    x = np.tile(sample_inputs(job.design.inputs, count, hashed_seed(job.study.seed, "aims")), (len(aims), 1))
    site = {key: np.tile(values, len(aims)) for key, values in job.site.sampled(count).items()}
    for number, aim in enumerate(aims):
        own = slice(number * count, (number + 1) * count)
        for name, value in aim.items():
            if name.startswith(SITE):
                site[name.removeprefix(SITE)][own] = value
            else:
                x[own, names.index(name)] = value
    return x, site


def _distances(body: "Body", site: dict[str, np.ndarray], ends: list[list[Any]]) -> np.ndarray:
    """Ways over the ground [m] from the aims to where the journeys end, [count], NaN where that is not on the ground.

    As if the body were a ball of the radius at the aim; what the delivery misses the aim by counts.
    """
    place = np.array([[np.nan, np.nan] if end[4] == "" else end[4:6] for end in ends], dtype=float)
    return ways_from_aims(body, site, directions(*place.T))


def ways_from_aims(body: "Body", site: Mapping[str, np.ndarray], there: np.ndarray) -> np.ndarray:
    """Ways over the ground [m] from the aims of landers to directions [count, 3], [count], as if the body were a ball.

    Of the radius at the aim. site: columns of SITE_KEYS, [count] each.
    """
    latitude, longitude = site["latitude_deg"], site["longitude_deg"]
    # All landers of an aim share its radius, which takes a search among the facets.
    aims, inverse = np.unique(np.column_stack([latitude, longitude]), axis=0, return_inverse=True)
    radius = np.linalg.norm(body.shape.surface_point(*aims.T), axis=1)
    ways: np.ndarray = radius[inverse.ravel()] * angles(directions(latitude, longitude), there)
    return ways
