"""Landers at rest, in sentences: when, where and how they lie, what they see, and the captions of their figures."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from lithobrake.statements.labels import (
    area,
    bracket,
    extent,
    half_width,
    partner_words,
    quantile,
    smallest_region,
    two_digits,
)
from lithobrake.statements.touchdowns import floor_words, variance
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.number_words import (
    HOUR,
    LEVEL,
    MINUTE,
    as_sentence,
    intervals,
    listing,
    out_of,
    percent,
    with_interval,
)
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import SKY_WORDS

if TYPE_CHECKING:
    from lithobrake.results.journey_results import EmulatedJourneys, JourneyRest, MeanMiss, SkyResults, SoilResults
    from lithobrake.results.page_data import PageData, PageJourneys
    from lithobrake.results.run_results import CountedShare
    from lithobrake.results.summary import Results

# What the ends of journeys vary in, in a sentence and as rows of a figure.
END_SIGNS = {
    "at_rest": "whether a lander comes to rest",
    "time_s": "the time to rest",
    "distance_m": "the distance from the aim point",
}  # fmt: skip
END_ROWS = {"at_rest": "at rest or not", "time_s": "time to rest", "distance_m": "distance from\nthe aim point"}


def end_rows(results: "Results") -> dict[str, str]:
    """The rows of the figure of what the ends vary in."""
    return {name: END_ROWS.get(name, name) for name in results.end_variance_shares}


def times_and_distances(rest: "JourneyRest") -> list[str]:
    """When those at rest came to rest, and how far away; nothing where none did."""
    if not (rest.time_s.median.is_known and rest.distance_m.median.is_known):
        return []
    return [
        f"Time from the first touchdown to rest: median {time_words(rest.time_s.median)}, 95 % within "
        f"{time_words(rest.time_s.q95)}. Contacts: median {quantile(rest.contacts.median)}, 95 % at most "
        f"{quantile(rest.contacts.q95)}. Distance from the aim point: median {quantile(rest.distance_m.median)} m, "
        f"95 % within {quantile(rest.distance_m.q95)} m."
    ]


def mean_miss(found: "MeanMiss | None") -> str:
    """Where the landers at rest lie in the mean, and where to aim instead; empty where they have no mean."""
    if found is None:
        return ""
    east, north = _way(found.east_m, "east", "west"), _way(found.north_m, "north", "south")
    said = f"The landers at rest lie in the mean {east} and {north} of the aim point ({intervals()} in brackets)"
    on_one = (found.east_on_one_ground_m, found.north_on_one_ground_m)
    if on_one[0] is not None and on_one[1] is not None and None not in (on_one[0].bounds, on_one[1].bounds):
        said += f"; on one ground {_way(on_one[0], 'east', 'west')} and {_way(on_one[1], 'north', 'south')}"
    if not found.is_distinct:
        return f"{said}. No shift of the aim can be distinguished from none."
    back = f"{two_digits(abs(found.east_m.value))} m {'west' if found.east_m.value > 0.0 else 'east'}"
    back += f" and {two_digits(abs(found.north_m.value))} m {'south' if found.north_m.value > 0.0 else 'north'}"
    there = f"latitude {found.aim_latitude_deg:.2f} deg, longitude {found.aim_longitude_deg:.2f} deg"
    return f"{said}. To move this mean onto the aim point, aim {back} of it, at {there}."


def _way(one: Estimate, ahead: str, behind: str) -> str:
    """A distance in one of two directions with its interval, "12 m east (8 to 16)"."""
    if one.value < 0.0:
        lower, upper = (None if end is None else -end for end in (one.upper, one.lower))
        return _way(Estimate(-one.value, lower, upper), behind, ahead)
    return f"{two_digits(one.value)} m {ahead}{bracket(one.lower, one.upper, two_digits)}"


def time_words(one: Estimate) -> str:
    """A time with its interval, in minutes below two hours."""
    size, unit = (MINUTE, "min") if one.value < 2.0 * HOUR else (HOUR, "h")
    return f"{quantile(one, size)} {unit}"


def rest_sentences(rest: "JourneyRest") -> list[str]:
    """When and where those at rest came to rest, and on which side they lie."""
    said = times_and_distances(rest)
    if said and rest.regions:
        half, most = rest.regions[0], rest.regions[-1]
        large = f"the one that holds {percent(most.share)} covers {area(most.area_m2)} and is {extent(most)}"
        said.append(as_sentence(f"{smallest_region(half, 'them')}; {large}"))
    if said and rest.faces:
        said.append(f"Side down: {sides_down(rest.faces)}.")
    return said


def sides_down(faces: "Mapping[str, CountedShare]") -> str:
    """The sides that are down with their shares, the most frequent first."""
    return ", ".join(f"{name} {with_interval(one.share)}" for name, one in by_share(faces))


def by_share(faces: "Mapping[str, CountedShare]") -> "list[tuple[str, CountedShare]]":
    """Sides by how often they are down, the most frequent first."""
    return sorted(faces.items(), key=lambda one: -one[1].share.value)


def sky(found: "Mapping[str, SkyResults]") -> list[str]:
    """For which part of the time those at rest see the Sun, Earth and the orbiter."""
    listed = [
        f"{SKY_WORDS[name]} {quantile(one.day_fraction, 0.01)} % of the time"
        + (f" (never by {with_interval(one.never.share)})" if one.never.count else "")
        for name, one in found.items()
    ]
    return [f"Visible from the place of rest, median: {', '.join(listed)}."] if listed else []


def soils(found: "Mapping[str, SoilResults]") -> list[str]:
    """How many touchdowns there are on the soil of each region, and how many of them end at rest."""
    listed = [
        f"{name} ({percent(one.area_share)} of the surface) {one.touchdowns} touchdowns"
        + (f", {with_interval(one.rests.share)} of which come to rest" if one.rests else "")
        for name, one in found.items()
    ]
    return [f"By soil: {'; '.join(listed)}."] if listed else []


def emulated_ends(ends: "Mapping[str, CountedShare]", agrees: bool | None, unknown: float, level: float = LEVEL) -> str:
    """Whether the emulator of all touchdowns and the landings agree."""
    rests = ends[JourneyEnd.AT_REST].share
    said = f"The emulator of all touchdowns gives {with_interval(rests)} at rest"
    more = f" and {percent(unknown)} with an unknown outcome" if unknown >= 0.005 else ""
    verdict = "" if agrees is None else f": emulator and landings {agreement(agrees)} within their {intervals(level)}"
    return f"{said}{more}{verdict}."


def agreement(agrees: bool) -> str:
    """Whether two agree."""
    return "agree" if agrees else "do not agree"


def emulator(found: "EmulatedJourneys | None") -> list[str]:
    """Whether the emulator of the touchdowns agrees with the landings, and what it does for the shares."""
    if found is None or not found.statement:
        return []
    control = found.control
    if control is None or not control.is_used:
        return [found.statement]
    return [
        found.statement,
        f"As a control variate it narrows the interval of the fraction at rest from {half_width(control.half_width)} "
        f"to {half_width(control.half_width_with)}, so the fraction may differ slightly from the count.",
    ]


def journey_ends_so_far(counts: Mapping[str, int], total: int, touchdowns: int, *, is_final: bool) -> str:
    """How many journeys have ended, and how, for a terminal."""
    found = [f"{counts[end]} {end.label}" for end in JourneyEnd if counts[end]]
    ended, more = out_of(sum(counts.values()), total), "" if is_final else " so far"
    return f"journeys: {ended} ended{more}{': ' if found else ''}{', '.join(found)}; {touchdowns} touchdowns"


def has_places(results: "Results") -> bool:
    """Whether any lander ended on the ground of the body."""
    return any(results.ends[end].count for end in (JourneyEnd.AT_REST, JourneyEnd.UNDER_WAY))


def rest_map(results: "Results", rest: "JourneyRest") -> str:
    """The map of the ends about the aim point."""
    if not has_places(results):
        return ""
    said = []
    if rest.regions:
        said.append("Lines: the smallest regions that hold these shares of the landers at rest.")
    elif rest.why_no_regions:
        said.append(f"No regions are drawn: {rest.why_no_regions.rstrip('.')}.")
    if results.delivery is not None and results.delivery.regions:
        said.append("Blue: the same for the first impacts.")
    if any(LimitState.of(one.condition).has_area for one in results.limit_states.values()):
        said.append("Dash-dotted: where landers at rest may meet a limit state.")
    if len(results.soils) > 1:
        said.append("Dotted: boundaries of soil regions, to within a degree.")
    return " ".join(said) or "Each dot is a lander."


def _elsewhere(results: "Results") -> str:
    """Landers on the partner in a list of those that a map of the body leaves out; empty without any."""
    there = results.ends[JourneyEnd.PARTNER].count
    return f"are on {partner_words(results.site)}, " if there else ""


def outcomes(results: "Results", *, has_map: bool) -> str:
    """The shares of the ends; has_map: whether the whole body stands beside them."""
    if not has_places(results):
        return ""
    said = f"Shares of {results.journeys} journeys"
    said += f" with their {intervals()}." if results.ends[JourneyEnd.AT_REST].share.lower is not None else "."
    if not has_map:
        return said
    return (
        f"{said} Map: the whole body in equal areas, on a sphere of the radius at the aim point; landers that "
        f"{_elsewhere(results)}escaped or failed are not on it."
    )


def partner_map(results: "Results") -> str:
    """The map of the other body of a binary."""
    return (
        f"Landers on the ground of {partner_words(results.site)}, by latitude and longitude on it, in equal areas on a "
        "sphere of the mean radius of these places. Longitude 0 faces the body of the site at time 0 of the flights."
    )


def times(rest: "JourneyRest") -> str:
    """The figure of times and distances."""
    if not times_and_distances(rest):
        return ""
    return (
        f"Dots: median and 95th percentile; bars: their {intervals()} over beds and impact points, dotted where a "
        "bound is unknown. The table below has their numbers."
    )


def counts(data: "PageJourneys") -> str:
    """The figure of touchdowns and contacts."""
    total, journeys = data.table["touchdowns"].sum(), len(data.table["end"])
    return (
        f"{journeys} journeys with {total:.0f} touchdowns, {two_digits(total / journeys)} each. A touchdown is one "
        "simulated landing and may have several contacts with hops between them."
    )


def attitude(rest: "JourneyRest") -> str:
    """The figure of sides and tilts."""
    tilt = rest.tilt_deg
    if not rest.faces or tilt is None or not tilt.median.is_known:
        return ""
    return (
        "Left: shares of the sides that are down. Right: tilt of the axis of that side from the plumb line. Brackets "
        f"and bars: {intervals()}."
    )


def end_variance(results: "Results") -> str:
    """Caption of the figure of the parts of the variance of the ends; empty where journeys do not show them."""
    known = {name: one for name, one in results.end_variance_shares.items() if one}
    signs = {name: END_SIGNS.get(name, f"whether it meets {name}") for name in known}
    if not known:
        return ""
    first = next(iter(known))
    whole = listing([f"{signs[name]} ({one.of})" for name, one in known.items()])
    return (
        f"Parts of the variance of {whole} over the input distributions of the study file. Delivery: position and "
        "velocity of the first impact, without attitude. Everything else includes all later touchdowns. "
        f"{floor_words(signs[first], known[first])}"
    )


def first_variance(data: "PageData") -> str:
    """The figure of the parts of the variance at the first touchdown, where inputs may be correlated."""
    if data.to_rest and not any(data.results.variance_shares.values()):
        return ""
    correlations: Iterable[tuple[str, str, float]] = (data.study.get("delivery") or {}).get("correlations") or ()
    pairs = ", ".join(f"{one} with {other}" for one, other, _ in correlations)
    more = f" As {pairs} are correlated, all of the delivery is one input, with what its parts explain together."
    return variance(data.results) + (more if pairs else "")


def time_unit(rest: "JourneyRest") -> tuple[float, str]:
    """The unit of a column of times to rest [s], and its sign: minutes where nearly all are below five hours."""
    late = rest.time_s.q95
    return (HOUR, "h") if late.is_known and late.value >= 5.0 * HOUR else (MINUTE, "min")
