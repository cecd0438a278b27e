"""The landers of a map of sites at their first touchdowns: the delivery of the study, carried to every site."""

from dataclasses import replace

import numpy as np

from lithobrake.analysis import EqualAreaCells
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.answer.mean_miss import FARTHEST, offsets
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.delivered_landers import DeliveredLanders
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.number_words import HIGH


def site_arrivals(job: Job, cells: EqualAreaCells, lander_count: int) -> Arrivals:
    """The landers of all cells at their first touchdowns, one cell after the other."""
    one = _delivered(job, lander_count)
    random = np.random.default_rng(hashed_seed(job.study.seed, "sites"))
    places = cells.places_deg(np.broadcast_to(random.random((lander_count, 2)), (cells.total, lander_count, 2)))
    aims = {"latitude_deg": places[..., 0].ravel(), "longitude_deg": places[..., 1].ravel()}
    site = {key: np.tile(values, cells.total) for key, values in one.site.items()} | aims
    number, refit = np.tile(one.number, cells.total), np.tile(np.arange(lander_count) % REFIT_COUNT, cells.total)
    return Arrivals.of(job.site, number, one.rows * cells.total, site, refit)


def _delivered(job: Job, count: int) -> Arrivals:
    """So many landers of the study, whose delivery is carried from its aim point to each site.

    Landers that are flown to the ground have at each site the speed, incidence, heading and attitude with which they
    reach the ground, and lie as far from it as from the mean of their first touchdowns. Raises ValueError where these
    are no place on the body.
    """
    if not job.design.is_flown:
        return Arrivals.drawn(job.design, len(job.design.rows), count)
    found = DeliveredLanders.flown(job.design, count).begin
    found = found.taken(down := np.flatnonzero(found.ground == 0), found.refit[down])
    latitude, longitude = job.site.body.shape.latitude_longitude(found.origin)
    places = offsets(job.site, latitude, longitude)
    if not len(places) or np.quantile(np.linalg.norm(places, axis=1), HIGH) > FARTHEST * job.site.aim_radius:
        raise ValueError(
            "sites carries the delivery of the study to other places, and its landers reach the ground all around the "
            "body, or none does; narrow the spread of the release, or move its aim point there"
        )
    up, ahead = found.axes[:, 2], found.axes[:, 0]
    north = np.array([0.0, 0.0, 1.0]) - up[:, 2:] * up
    heading = np.degrees(np.arctan2((ahead * np.cross(north, up)).sum(axis=1), (ahead * north).sum(axis=1)))
    east_error, north_error = (places - places.mean(axis=0)).T
    site = {**found.site, "heading_deg": heading, "north_error": north_error, "east_error": east_error}
    # As many for each site whatever number of them misses the body.
    which = np.arange(count) % len(places)
    return replace(found, site=site).taken(which, np.arange(count) % REFIT_COUNT)
