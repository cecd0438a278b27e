"""Where journeys of landings end, in sentences: what a landing team asks first."""

from collections.abc import Mapping

from lithobrake.analysis import LEVEL
from lithobrake.results.journey_results import EndShare, JourneyRest, RestQuantile
from lithobrake.results.sky_results import SkyResults
from lithobrake.results.soil_results import SoilResults
from lithobrake.results.summary import DrawnResults
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.percentages import percent, with_interval
from lithobrake.vocabulary.quantities import SKY_WORDS

HOUR = 3600.0


def journey_answer(study: Study, results: DrawnResults) -> list[str]:
    """The ends of the journeys, then where, when and how the landers rest."""
    ends, rest = results.ends, results.rest
    if ends is None or study.journey is None or not isinstance(rest, JourneyRest):
        return []
    at_rest = ends[JourneyEnd.AT_REST]
    hours = f"{study.journey.duration / HOUR:.3g} h"
    level = None if at_rest.lower is None else LEVEL
    said = [
        f"{with_interval(at_rest, level=level)} of the landers come to rest within {hours} ({results.journeys} "
        f"journeys, {results.touchdowns} simulated landings, {results.runs.beds} beds).{_others(ends)}"
    ]
    if at_rest.why is not None:
        said.append(at_rest.why)
    return [*said, *_rest(rest), *_sky(results.sky), *_soils(results.soils)]


def _others(ends: Mapping[str, EndShare]) -> str:
    """The shares of the other ends that occurred."""
    words = {end.value: end.label for end in JourneyEnd if end != JourneyEnd.AT_REST}
    listed = [f"{with_interval(one)} {words[name]}" for name, one in ends.items() if name in words and one.count]
    return f" Other ends: {', '.join(listed)}." if listed else ""


def _rest(rest: JourneyRest) -> list[str]:
    """When and where those at rest came to rest, and on which side they lie."""
    if rest.time_s.median.value is None:
        return []
    said = [
        f"Time from the first touchdown to rest: median {_hours(rest.time_s.median)}, 95 % within "
        f"{_hours(rest.time_s.q95)}. Contacts: median {_count(rest.contacts.median)}, 95 % at most "
        f"{_count(rest.contacts.q95)}. Distance from the aim point: median {_metres(rest.distance_m.median)}, 95 % "
        f"within {_metres(rest.distance_m.q95)}."
    ]
    if rest.regions:
        half, most = rest.regions[0], rest.regions[-1]
        said.append(
            f"The smallest region that holds {percent(half.share)} of them covers {_rounded(half.area_m2)} m2; the one "
            f"that holds {percent(most.share)} covers {_rounded(most.area_m2)} m2 and is "
            f"{_rounded(most.largest_extent_m)} m across."
        )
    if rest.faces:
        listed = sorted(rest.faces.items(), key=lambda one: -one[1].share)
        said.append("Side down: " + ", ".join(f"{name} {with_interval(one)}" for name, one in listed) + ".")
    return said


def _sky(sky: Mapping[str, SkyResults]) -> list[str]:
    """For which part of the time those at rest see the Sun, Earth and the orbiter."""
    listed = [
        f"{SKY_WORDS[name]} {_with_bounds(one.day_fraction, 0.01)} % of the time"
        + (f" (never by {with_interval(one.never)})" if one.never.count else "")
        for name, one in sky.items()
    ]
    return [f"Visible from the place of rest, median: {', '.join(listed)}."] if listed else []


def _soils(soils: Mapping[str, SoilResults]) -> list[str]:
    """How many touchdowns there are on the soil of each region, and how many of them end at rest."""
    listed = [
        f"{name} ({percent(one.area_share)} of the surface) {one.touchdowns} touchdowns"
        + (f", {with_interval(one.rests)} of which come to rest" if one.rests else "")
        for name, one in soils.items()
    ]
    return [f"By soil: {'; '.join(listed)}."] if listed else []


def _hours(one: RestQuantile) -> str:
    """A time with its interval, in minutes below two hours."""
    size, unit = (60.0, "min") if (one.value or 0.0) < 2.0 * HOUR else (HOUR, "h")
    return f"{_with_bounds(one, size)} {unit}"


def _metres(one: RestQuantile) -> str:
    return f"{_with_bounds(one, 1.0)} m"


def _count(one: RestQuantile) -> str:
    return _with_bounds(one, 1.0)


def _with_bounds(one: RestQuantile, size: float) -> str:
    value = _rounded((one.value or 0.0) / size)
    if one.lower is None or one.upper is None:
        return value
    return f"{value} ({_rounded(one.lower / size)}-{_rounded(one.upper / size)})"


def _rounded(value: float) -> str:
    """A number to two digits, or to whole ones where it has more, without a power of ten."""
    return f"{value:.0f}" if abs(value) >= 10.0 else f"{value:.2g}"
