"""Landers of a study's journeys by the emulator and by landings, over the whole body and in its regions."""

import numpy as np

from lithobrake.analysis import EqualAreaCells, share_difference
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.emulated_ends import EmulatedTable
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.emulated.emulated_journeys import OWN
from lithobrake.pipeline.folder.study_folder import AGAIN
from lithobrake.pipeline.job import Job
from lithobrake.results.shares import ShareInterval
from lithobrake.results.site_map import SiteAgreement
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import TOUCHDOWNS_FILE, UNKNOWN_END

# Regions of equal area, and journeys and beds that say something of one.
REGIONS, FEWEST, FEWEST_BEDS = 8, 8, 4


def first_places(job: Job) -> tuple[np.ndarray, np.ndarray]:
    """Latitude and longitude [deg] of the first touchdown of each journey, [journey_count], NaN where it has none."""
    rows = read_rows(job.folder / TOUCHDOWNS_FILE, ("journey", "touchdown", "latitude_deg", "longitude_deg"), AGAIN)
    found = np.full((2, len(JourneyTable.load(job.folder).end)), np.nan)
    for row in rows:
        if row["touchdown"] == "0":
            found[:, int(row["journey"])] = float(row["latitude_deg"]), float(row["longitude_deg"])
    return found[0], found[1]


def site_agreement(job: Job) -> tuple[SiteAgreement, ...]:
    """Over the whole body, then in regions with enough journeys; none where the emulator has not followed them."""
    own, table = EmulatedTable.load(job.folder, OWN), JourneyTable.load(job.folder)
    if not len(own.end):
        return ()
    latitude, longitude = first_places(job)
    landings, emulator = table.rests.astype(float), _by_emulator(own, len(table.end))
    why, regions = why_no_interval(job.study), EqualAreaCells.of(REGIONS)
    known = np.isfinite(latitude) & np.isfinite(emulator)
    region = np.full(len(known), -1)
    region[known] = regions.cell_of(latitude[known], longitude[known])
    parts = [(None, known)] + [(place, region == place) for place in range(REGIONS)]
    found = []
    for place, those in parts:
        if place is not None and (those.sum() < FEWEST or len(np.unique(table.bed[those])) < FEWEST_BEDS):
            continue
        latitude_deg, longitude_deg = (None, None) if place is None else regions.centres_deg[place].tolist()
        of_region = share_difference(landings[those], emulator[those], table.bed[those], why=why)
        pair = (of_region.first, of_region.second)
        first, second = (ShareInterval(one.value or 0.0, one.lower, one.upper) for one in pair)
        difference = ShareInterval(of_region.value or 0.0, of_region.lower, of_region.upper)
        found.append(SiteAgreement(latitude_deg, longitude_deg, int(those.sum()), first, second, difference))
    return tuple(found)


def _by_emulator(own: EmulatedTable, count: int) -> np.ndarray:
    """Fraction at rest of the copies of known end of each lander [journey_count], NaN where none is known."""
    known, rests = own.end != UNKNOWN_END, own.end == JourneyEnd.AT_REST
    met, of = (np.bincount(own.journey[one], minlength=count) for one in (rests, known))
    found: np.ndarray = np.divide(met, of, out=np.full(count, np.nan), where=of > 0)
    return found
