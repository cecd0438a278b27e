"""How far the landers at rest lie from the aim point in the mean, and where the aim should be moved."""

import math
from typing import Any

import numpy as np

from lithobrake.analysis.mean_over_grounds import mean_over_beds, mean_over_grounds
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.run_answers import is_on_one_ground, why_no_interval
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.site import Site
from lithobrake.results.journey_results import MeanMiss
from lithobrake.vocabulary.number_words import HIGH, LEVEL

# Beyond this angle from the aim point [rad] a direction over the ground says little of where a place is.
FARTHEST = 0.5 * math.pi
# Of east and north each, so that both together hold at the level.
LEVEL_OF_EACH = 1.0 - 0.5 * (1.0 - LEVEL)


def offsets(
    site: Site, latitude_deg: np.ndarray, longitude_deg: np.ndarray, middle_deg: tuple[float, float] | None = None
) -> np.ndarray:
    """Metres east and north of a place, [count, 2], of others by latitude and longitude [deg], [count].

    As far and in the direction in which the way over a ball of the radius at the aim point begins (azimuthal
    equidistant). middle_deg: latitude and longitude of the one place; None: the aim point.
    Source: [Snyder-1987], chapter 25.
    """
    aim = site.aim if middle_deg is None else middle_deg
    middle, latitude = math.radians(aim[0]), np.radians(latitude_deg)
    turn = np.radians(longitude_deg - aim[1])
    east = np.cos(latitude) * np.sin(turn)
    north = math.cos(middle) * np.sin(latitude) - math.sin(middle) * np.cos(latitude) * np.cos(turn)
    facing = math.sin(middle) * np.sin(latitude) + math.cos(middle) * np.cos(latitude) * np.cos(turn)
    level = np.hypot(east, north)
    way = site.aim_radius * np.arctan2(level, facing)
    return np.column_stack([east, north]) * (way / np.maximum(level, 1e-300))[:, None]


def _place(site: Site, east: float, north: float) -> tuple[float, float]:
    """Latitude and longitude [deg] of a place so far east and north of the aim point [m]."""
    angle, heading = math.hypot(east, north) / site.aim_radius, math.atan2(east, north)
    middle = math.radians(site.aim[0])
    height = math.sin(middle) * math.cos(angle) + math.cos(middle) * math.sin(angle) * math.cos(heading)
    turn = math.atan2(
        math.sin(heading) * math.sin(angle) * math.cos(middle), math.cos(angle) - math.sin(middle) * height
    )
    longitude = (site.aim[1] + math.degrees(turn) + 180.0) % 360.0 - 180.0
    return math.degrees(math.asin(max(min(height, 1.0), -1.0))), longitude


def rest_offsets(job: Job, table: JourneyTable) -> np.ndarray | None:
    """Metres east and north of the aim point of each lander at rest, NaN of the others, [journey_count, 2].

    None where no lander rests, or more than a twentieth lie beyond a quarter of the way around the body.
    """
    if not table.rests.any():
        return None
    if np.quantile(table.numbers["distance"][table.rests], HIGH) > FARTHEST * job.site.aim_radius:
        return None
    found = offsets(job.site, table.numbers["latitude_deg"], table.numbers["longitude_deg"])
    return np.where(table.rests[:, None], found, np.nan)


def mean_miss(job: Job, table: JourneyTable) -> MeanMiss | None:
    """The mean of where the landers at rest lie; None where there is none, as `rest_offsets` says.

    It is distinct from the aim point by a joint test of east and north at the level, with Bonferroni's bound: where
    there is no miss, at most one study in ten says so. On unknown ground it is that of one ground which is tested.
    """
    places = rest_offsets(job, table)
    if places is None:
        return None
    is_one, farthest = is_on_one_ground(job.study), math.pi * job.site.aim_radius
    # A lander of unknown end may rest anywhere on the body.
    how: dict[str, Any] = {
        "bed": table.bed, "why": why_no_interval(job.study), "missing": table.unknown, "limits": (-farthest, farthest),
    }  # fmt: skip
    east, north = (mean_over_beds(one, **how) for one in places.T)
    on_one = [mean_over_grounds(one, **how) if is_one else None for one in places.T]
    mean = mean_over_grounds if is_one else mean_over_beds
    both = [mean(one, **how, level=LEVEL_OF_EACH).bounds for one in places.T]
    latitude, longitude = _place(job.site, -east.value, -north.value)
    mean_latitude, mean_longitude = _place(job.site, east.value, north.value)
    return MeanMiss(
        east_m=east,
        north_m=north,
        east_on_one_ground_m=on_one[0],
        north_on_one_ground_m=on_one[1],
        aim_latitude_deg=latitude,
        aim_longitude_deg=longitude,
        latitude_deg=mean_latitude,
        longitude_deg=mean_longitude,
        is_distinct=any(bounds is not None and not bounds[0] <= 0.0 <= bounds[1] for bounds in both),
    )
