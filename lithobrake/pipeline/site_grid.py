"""The cells of a map of sites: their landers and how these end, and the ground under them."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.analysis import EqualAreaCells, best_choice, share_difference
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.files.reading import hashed_seed, read_rows
from lithobrake.pipeline.answer.emulated_ends import EmulatedTable, Refits, quantile_of_some
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.journey_limit_states import rest_values
from lithobrake.pipeline.answer.run_answers import why_no_interval
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.emulated_journeys import OWN, follow_emulated
from lithobrake.pipeline.journeys.touchdown_emulator import GRAVITY, SLOPE, TouchdownEmulator
from lithobrake.pipeline.site_arrivals import site_arrivals
from lithobrake.pipeline.sky_at_rest import Days, views, where_it_stands
from lithobrake.pipeline.study_folder import AGAIN
from lithobrake.results.site_results import MOST_UNKNOWN, SiteAgreement, SiteCell, SiteEnds, SiteSpread
from lithobrake.study import Study
from lithobrake.study.design_sections import SkyBody
from lithobrake.study.limit_state_checks import option_states
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_REGION, REFIT_COUNT
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import TOUCHDOWNS_FILE
from lithobrake.vocabulary.journey_names import JOURNEY_WORDS
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.number_words import HIGH, LOW, MEDIAN
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import IMPACT_INCIDENCE, IMPACT_SPEED, UNKNOWN_END

# Places of each cell that are looked at.
PLACES = 24
TITLE = "landers at the sites"
# What a limit state may use of them beside how they end.
TOLD = ("time_s", "distance")
# Ends of the spread over the places of a cell.
WORDS = {GRAVITY: "gravity", SLOPE: "slope", IMPACT_SPEED: "impact speed", IMPACT_INCIDENCE: "impact angle"}
# Regions of equal area, and journeys that say something of one.
REGIONS, FEWEST_JOURNEYS = 8, 8


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
        places = cells.places_deg(np.broadcast_to(_places_in_cells(random), (cells.total, PLACES, 2))).reshape(-1, 2)
        shape = job.site.body.shape
        points, facets = shape.locate(places[:, 0], places[:, 1])
        up, columns = shape.normals[facets], job.site.columns(len(points))
        time = job.site.clock(columns)
        here = job.site.body.felt(points, time, columns["mass"], columns["spin_period"])
        strength = np.linalg.norm(here, axis=1)
        slope = np.degrees(np.arccos(np.clip(-(here * up).sum(axis=1) / strength, -1.0, 1.0)))
        light: dict[str, np.ndarray] = {
            name: _seen(job, name, points, up, random).reshape(-1, PLACES) for name in job.study.sky.bodies
        }
        return cls(slope.reshape(-1, PLACES), strength.reshape(-1, PLACES), light)


def _places_in_cells(random: np.random.Generator) -> np.ndarray:
    """Places of a cell as uniform numbers [PLACES, 2]: one in each of as many strips both ways."""
    strips = np.stack([random.permutation(PLACES), random.permutation(PLACES)], axis=1)
    found: np.ndarray = (strips + random.random((PLACES, 2))) / PLACES
    return found


def _seen(job: Job, name: SkyBody, points: np.ndarray, up: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Fraction of the time in which a body is seen from points [count, 3], [count]; one far away, on a day of each."""
    from lithobrake.smallbody import seen_from

    body, mask, stands = job.site.body, job.study.sky.mask_of(name), where_it_stands(job.study, job.site, name)
    if isinstance(stands, Days):
        # One day for each place of a cell, all different: as many days as places cover the year at the cost of one.
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
    emulator = TouchdownEmulator.read(job.design, job.folder)
    # Landings at impacts outside the emulator's range would cost what the map is to save.
    found = follow_emulated(job, emulator, begin, TITLE, 0)
    columns = (found.landers.end, found.landers.time, found.landers.ways_from_aims, begin.refit, found.beyond)
    return SiteLanders(*(one.reshape(cells.total, lander_count) for one in columns))


def site_cells(
    cells: EqualAreaCells,
    landers: SiteLanders,
    ground: SiteGround,
    fitted: Refits,
    journeys: np.ndarray,
    states: Mapping[str, LimitState],
) -> tuple[SiteCell, ...]:
    """Every cell in its order.

    journeys: of the study with their first touchdown in each, [cell_count]; states: limit states that are asked of it.
    """
    unknown = (landers.end == UNKNOWN_END).mean(axis=1)
    answered = unknown <= MOST_UNKNOWN
    best, middles, bounds = set(_not_worse(landers, answered, fitted)), cells.centres_deg, cells.bounds_deg
    return tuple(
        SiteCell(
            **dict(zip(("latitude_deg", "longitude_deg"), middles[number].tolist(), strict=True)),
            **dict(zip(("south_deg", "north_deg", "west_deg", "east_deg"), bounds[number].tolist(), strict=True)),
            unknown=float(unknown[number]),
            beyond=beyond_words(landers.beyond[number]),
            ends=_ends(landers, number, fitted, states) if answered[number] else None,
            not_worse=number in best,
            slope_deg=_spread(ground.slope_deg[number]),
            gravity=_spread(ground.gravity[number]),
            light={name: _spread(seen[number]) for name, seen in ground.light.items()},
            journeys=int(journeys[number]),
        )
        for number in range(cells.total)
    )


def all_at_rest(landers: SiteLanders, fitted: Refits) -> Estimate | None:
    """Landers at rest over all cells that are answered, as large as each other; None where none is.

    All cells have the same landers, so their number counts in full between the refits, and bounds are wide.
    """
    answered = (landers.end == UNKNOWN_END).mean(axis=1) <= MOST_UNKNOWN
    if not answered.any():
        return None
    end, refit = landers.end[answered].ravel(), landers.refit[answered].ravel()
    return fitted.share_of_known(end == JourneyEnd.AT_REST, end != UNKNOWN_END, refit)


def site_states(study: Study) -> dict[str, LimitState]:
    """The limit states of a study that are asked of the landers of a site, wherever it is."""
    return {name: one for name, one in option_states(study).items() if set(one.journey) <= {*TOLD, *JOURNEY_WORDS}}


def _ends(landers: SiteLanders, cell: int, fitted: Refits, states: Mapping[str, LimitState]) -> SiteEnds:
    end, refit = landers.end[cell], landers.refit[cell]
    known, rests = end != UNKNOWN_END, end == JourneyEnd.AT_REST
    time, distance = (
        quantile_of_some(values[cell], rests, MEDIAN, lambda met, of: fitted.share(met, of, refit), ~known)
        for values in (landers.time, landers.distance)
    )
    values = rest_values(end.astype(str), {"time_s": landers.time[cell], "distance": landers.distance[cell]})
    return SiteEnds(
        limit_states={
            name: fitted.share_of_known(limit_state_met(state, values) == 1.0, known, refit)
            for name, state in states.items()
        },
        at_rest=fitted.share_of_known(rests, known, refit),
        partner=fitted.share_of_known(end == JourneyEnd.PARTNER, known, refit),
        escaped=fitted.share_of_known(end == JourneyEnd.ESCAPED, known, refit),
        under_way=fitted.share_of_known(end == JourneyEnd.UNDER_WAY, known, refit),
        time_s=time,
        distance_m=distance,
    )


def _not_worse(landers: SiteLanders, answered: np.ndarray, fitted: Refits) -> tuple[int, ...]:
    """Cells that cannot be told from the one of most landers at rest; none where refits say nothing of beds."""
    if fitted.why is not None or not answered.any():
        return ()
    # The landers of one refit together, in the same order in all cells, as best_choice compares them draw by draw.
    order = np.argsort(landers.refit[0], kind="stable")
    met = np.where(landers.end == UNKNOWN_END, np.nan, (landers.end == JourneyEnd.AT_REST).astype(float))
    rests = met[:, order].reshape(len(answered), REFIT_COUNT, -1)
    return best_choice(rests, fitted.bed_count, answered).not_worse


def beyond_words(beyond: np.ndarray) -> str:
    """What impacts of landers were beyond, in words, the most frequent first."""
    met = Counter(beyond[beyond != ""].tolist())
    return ", ".join(WORDS[name] for name, _ in met.most_common())


def _spread(values: np.ndarray) -> SiteSpread:
    low, high = np.quantile(values, [LOW, HIGH]).tolist()
    return SiteSpread(float(values.mean()), low, high)


def first_places(job: Job) -> tuple[np.ndarray, np.ndarray]:
    """Latitude and longitude [deg] of the first touchdown of each journey, [journey_count]; NaN: none on the body."""
    columns = ("journey", "touchdown", "body", "latitude_deg", "longitude_deg")
    rows = read_rows(job.folder / TOUCHDOWNS_FILE, columns, AGAIN)
    found = np.full((2, len(JourneyTable.load(job.folder).end)), np.nan)
    for row in rows:
        if row["touchdown"] == "0" and row["body"] == job.site.ground_names[0]:
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
        if place is not None and (
            those.sum() < FEWEST_JOURNEYS or len(np.unique(table.bed[those])) < FEWEST_BEDS_OF_REGION
        ):
            continue
        latitude_deg, longitude_deg = (None, None) if place is None else regions.centres_deg[place].tolist()
        of_region = share_difference(landings[those], emulator[those], table.bed[those], why=why)
        # The map says why there are no intervals.
        shares = (one.without_reason for one in (of_region.first, of_region.second, of_region.difference))
        found.append(SiteAgreement(latitude_deg, longitude_deg, int(those.sum()), *shares))
    return tuple(found)


def _by_emulator(own: EmulatedTable, count: int) -> np.ndarray:
    """Fraction at rest of the copies of known end of each lander [journey_count], NaN where none is known."""
    known, rests = own.end != UNKNOWN_END, own.end == JourneyEnd.AT_REST
    met, of = (np.bincount(own.journey[one], minlength=count) for one in (rests, known))
    found: np.ndarray = np.divide(met, of, out=np.full(count, np.nan), where=of > 0)
    return found
