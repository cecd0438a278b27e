"""Landers that are delivered to every cell of a body, followed by the emulator of the touchdowns of a study."""

from dataclasses import dataclass

import numpy as np

from lithobrake.analysis import EqualAreaCells
from lithobrake.files.hashing import hashed_seed
from lithobrake.geometry.great_circle import directions
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulated.arrivals import Arrivals
from lithobrake.pipeline.emulated.landers import EmulatedLanders
from lithobrake.pipeline.emulated.touchdown_emulator import TouchdownEmulator
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.rest.aiming import ways_from_aims

TITLE = "landers at the sites"


@dataclass(frozen=True)
class SiteLanders:
    """What became of the landers of each cell, all arrays [cell_count, lander_count].

    end: a word of JourneyEnd, or UNKNOWN_END; time from the first touchdown to the end [s]; distance over the ground
    from the aim point to where it is [m]; refit: of the emulator that a lander has met; beyond: the input of an impact
    that this did not know, or "".
    """

    end: np.ndarray
    time: np.ndarray
    distance: np.ndarray
    refit: np.ndarray
    beyond: np.ndarray


def follow_sites(job: Job, cells: EqualAreaCells, lander_count: int) -> SiteLanders:
    """Follow so many landers of each cell to their ends, without a landing.

    All cells have the same landers: soil, bed, delivery but for its aim point, and refit of each are drawn once.
    """
    begin = site_arrivals(job, cells, lander_count)
    landers = EmulatedLanders.of(job, TouchdownEmulator.read(job.design, job.folder), TITLE, begin)
    landers.follow(0)
    there = directions(*job.site.body.shape.latitude_longitude(landers.position))
    distance = ways_from_aims(job.site.body, begin.site, there)
    columns = (landers.end, landers.time, distance, begin.refit, landers.beyond)
    return SiteLanders(*(one.reshape(cells.total, lander_count) for one in columns))


def site_arrivals(job: Job, cells: EqualAreaCells, lander_count: int) -> Arrivals:
    """The landers of all cells at their first touchdowns, one cell after the other."""
    one = Arrivals.drawn(job.design, job.site, len(job.design.rows), lander_count)
    random = np.random.default_rng(hashed_seed(job.study.seed, "sites"))
    places = cells.places_deg(np.broadcast_to(random.random((lander_count, 2)), (cells.total, lander_count, 2)))
    aims = {"latitude_deg": places[..., 0].ravel(), "longitude_deg": places[..., 1].ravel()}
    site = {key: np.tile(values, cells.total) for key, values in one.site.items()} | aims
    number, refit = np.tile(one.number, cells.total), np.tile(np.arange(lander_count) % REFIT_COUNT, cells.total)
    return Arrivals.of(job.site, number, one.rows * cells.total, site, refit)
