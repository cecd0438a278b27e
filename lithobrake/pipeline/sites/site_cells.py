"""The cells of a map of sites: shares and medians of their landers with intervals, and the ground under them."""

from collections import Counter

import numpy as np

from lithobrake.analysis import EqualAreaCells, best_choice
from lithobrake.pipeline.answer.journey_ends import MEDIAN
from lithobrake.pipeline.answer.shares_over_refits import Refits, quantile_of_some
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulated.touchdown_emulator import GRAVITY, INCIDENCE, SLOPE, SPEED
from lithobrake.pipeline.sites.site_ground import SiteGround
from lithobrake.pipeline.sites.site_landers import SiteLanders
from lithobrake.results.shares import ShareInterval
from lithobrake.results.site_map import SiteCell, SiteEnds, SiteSpread
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import UNKNOWN_END

# A cell of which more landers have an unknown end is not answered.
MOST_UNKNOWN = 0.1
# Ends of the spread over the places of a cell.
LOW, HIGH = 0.05, 0.95
WORDS = {GRAVITY: "gravity", SLOPE: "slope", SPEED: "impact speed", INCIDENCE: "impact angle"}


def site_cells(
    cells: EqualAreaCells, landers: SiteLanders, ground: SiteGround, fitted: Refits, journeys: np.ndarray
) -> tuple[SiteCell, ...]:
    """Every cell in its order; journeys: of the study with their first touchdown in each, [cell_count]."""
    unknown = (landers.end == UNKNOWN_END).mean(axis=1)
    answered = unknown <= MOST_UNKNOWN
    best, middles, bounds = set(_not_worse(landers, answered, fitted)), cells.centres_deg, cells.bounds_deg
    return tuple(
        SiteCell(
            **dict(zip(("latitude_deg", "longitude_deg"), middles[number].tolist(), strict=True)),
            **dict(zip(("south_deg", "north_deg", "west_deg", "east_deg"), bounds[number].tolist(), strict=True)),
            unknown=float(unknown[number]),
            beyond=_beyond(landers.beyond[number]),
            ends=_ends(landers, number, fitted) if answered[number] else None,
            not_worse=number in best,
            slope_deg=_spread(ground.slope_deg[number]),
            gravity=_spread(ground.gravity[number]),
            light={name: _spread(seen[number]) for name, seen in ground.light.items()},
            journeys=int(journeys[number]),
        )
        for number in range(cells.total)
    )


def all_at_rest(landers: SiteLanders, fitted: Refits) -> ShareInterval | None:
    """Landers at rest over all cells that are answered, as large as each other; None where none is.

    All cells have the same landers, so their number counts in full between the refits, and bounds are wide.
    """
    answered = (landers.end == UNKNOWN_END).mean(axis=1) <= MOST_UNKNOWN
    if not answered.any():
        return None
    end, refit = landers.end[answered].ravel(), landers.refit[answered].ravel()
    return share_of_known(end == JourneyEnd.AT_REST, end != UNKNOWN_END, refit, fitted)


def share_of_known(met: np.ndarray, known: np.ndarray, refit: np.ndarray, fitted: Refits) -> ShareInterval:
    """Share of the landers of known end that have met an event, all [lander_count]; bounds hold for all landers."""
    everyone = np.ones(len(met), dtype=bool)
    least, most = (fitted.share(one, everyone, refit) for one in (met, met | ~known))
    return ShareInterval(float(met.sum() / max(known.sum(), 1)), least.lower, most.upper)


def _ends(landers: SiteLanders, cell: int, fitted: Refits) -> SiteEnds:
    end, refit = landers.end[cell], landers.refit[cell]
    known, rests = end != UNKNOWN_END, end == JourneyEnd.AT_REST
    time, distance = (
        quantile_of_some(values[cell], rests, MEDIAN, lambda met: fitted.share(met, rests, refit))
        for values in (landers.time, landers.distance)
    )
    return SiteEnds(
        at_rest=share_of_known(rests, known, refit, fitted),
        partner=share_of_known(end == JourneyEnd.PARTNER, known, refit, fitted),
        escaped=share_of_known(end == JourneyEnd.ESCAPED, known, refit, fitted),
        under_way=share_of_known(end == JourneyEnd.UNDER_WAY, known, refit, fitted),
        time_s=time,
        distance_m=distance,
    )


def _not_worse(landers: SiteLanders, answered: np.ndarray, fitted: Refits) -> tuple[int, ...]:
    """Cells that cannot be told from the one of most landers at rest; none where refits say nothing of beds."""
    if fitted.why is not None or not answered.any():
        return ()
    order = np.argsort(landers.refit[0], kind="stable")
    rests = (landers.end == JourneyEnd.AT_REST)[:, order].reshape(len(answered), REFIT_COUNT, -1)
    return best_choice(rests, fitted.bed_count, answered).not_worse


def _beyond(beyond: np.ndarray) -> str:
    """What impacts of landers were beyond, in words, the most frequent first."""
    met = Counter(beyond[beyond != ""].tolist())
    return ", ".join(WORDS[name] for name, _ in met.most_common())


def _spread(values: np.ndarray) -> SiteSpread:
    low, high = np.quantile(values, [LOW, HIGH]).tolist()
    return SiteSpread(float(values.mean()), low, high)
