"""The answer of a study in sentences, with its intervals."""

from collections.abc import Mapping

from lithobrake.analysis import LEVEL
from lithobrake.pipeline.answer.run_answers import missing_words, scope
from lithobrake.results.journey_results import JourneyRest, SkyResults, SoilResults
from lithobrake.results.questions import LimitStateResult
from lithobrake.results.run_results import CountedShare, OutputEstimate, ReturnFraction, RunResults, VarianceParts
from lithobrake.results.summary import DrawnResults
from lithobrake.study import Study
from lithobrake.vocabulary.constants import CENTIMETRES, HOUR
from lithobrake.vocabulary.durations import hours
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.outcomes import CAPTURED, FlightStatus, JourneyEnd, JourneyStatus, TouchdownOutcome
from lithobrake.vocabulary.percentages import interval_digits, part, percent, rare_percent, with_interval
from lithobrake.vocabulary.quantities import SKY_WORDS


def journey_answer(study: Study, results: DrawnResults) -> list[str]:
    """The ends of the journeys, then where, when and how the landers rest."""
    ends, rest = results.ends, results.rest
    if ends is None or study.journey is None or not isinstance(rest, JourneyRest):
        return []
    at_rest = ends[JourneyEnd.AT_REST].share
    hours = f"{study.journey.duration / HOUR:.3g} h"
    level = None if at_rest.lower is None else LEVEL
    said = [
        f"{with_interval(at_rest, level=level)} of the landers come to rest within {hours} ({results.journeys} "
        f"journeys, {results.touchdowns} simulated landings, {results.runs.beds} beds).{_other_journey_ends(ends)}"
    ]
    if at_rest.why_missing is not None:
        said.append(at_rest.why_missing)
    return [*said, *_rest(rest), *_sky(results.sky), *_soils(results.soils)]


def _other_journey_ends(ends: Mapping[str, CountedShare]) -> str:
    """The shares of the other ends that occurred."""
    words = {end.value: end.label for end in JourneyEnd if end != JourneyEnd.AT_REST}
    listed = [f"{with_interval(one.share)} {words[name]}" for name, one in ends.items() if name in words and one.count]
    return f" Other ends: {', '.join(listed)}." if listed else ""


def _rest(rest: JourneyRest) -> list[str]:
    """When and where those at rest came to rest, and on which side they lie."""
    if not rest.time_s.median.is_known:
        return []
    said = [
        f"Time from the first touchdown to rest: median {_journey_hours(rest.time_s.median)}, 95 % within "
        f"{_journey_hours(rest.time_s.q95)}. Contacts: median {_count(rest.contacts.median)}, 95 % at most "
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
        listed = sorted(rest.faces.items(), key=lambda one: -one[1].share.value)
        said.append("Side down: " + ", ".join(f"{name} {with_interval(one.share)}" for name, one in listed) + ".")
    return said


def _sky(sky: Mapping[str, SkyResults]) -> list[str]:
    """For which part of the time those at rest see the Sun, Earth and the orbiter."""
    listed = [
        f"{SKY_WORDS[name]} {_with_bounds(one.day_fraction, 0.01)} % of the time"
        + (f" (never by {with_interval(one.never.share)})" if one.never.count else "")
        for name, one in sky.items()
    ]
    return [f"Visible from the place of rest, median: {', '.join(listed)}."] if listed else []


def _soils(soils: Mapping[str, SoilResults]) -> list[str]:
    """How many touchdowns there are on the soil of each region, and how many of them end at rest."""
    listed = [
        f"{name} ({percent(one.area_share)} of the surface) {one.touchdowns} touchdowns"
        + (f", {with_interval(one.rests.share)} of which come to rest" if one.rests else "")
        for name, one in soils.items()
    ]
    return [f"By soil: {'; '.join(listed)}."] if listed else []


def _journey_hours(one: Estimate) -> str:
    """A time with its interval, in minutes below two hours."""
    size, unit = (60.0, "min") if one.value < 2.0 * HOUR else (HOUR, "h")
    return f"{_with_bounds(one, size)} {unit}"


def _metres(one: Estimate) -> str:
    return f"{_with_bounds(one, 1.0)} m"


def _count(one: Estimate) -> str:
    return _with_bounds(one, 1.0)


def _with_bounds(one: Estimate, size: float) -> str:
    value = _rounded(one.value / size)
    return value if one.bounds is None else f"{value} ({'-'.join(_rounded(end / size) for end in one.bounds)})"


def _rounded(value: float) -> str:
    """A number to two digits, or to whole ones where it has more, without a power of ten."""
    return f"{value:.0f}" if abs(value) >= 10.0 else f"{value:.2g}"


# Parts of the variance, as they stand in a sentence; of those in FLOORS only terms of first and second degree are seen.
PARTS = {
    "soil": "soil",
    "arrival": "speed, angle and spin of the impact",
    "attitude": "attitude",
    "bed": "bed",
    "place": "everything else",
    "chaos": "chaos",
}
FLOORS = ("soil", "arrival", "attitude")
GROUNDS = {"soil": "on the soil", "hard": "on hard ground"}


def drawn_answer(study: Study, results: DrawnResults) -> list[str]:
    """What becomes of the landers, over what that holds, what is missing, and what the site does to those that lie."""
    first_bounce = [*_share(study, results), *_missing(results.runs, results.returns), _others(study, results)]
    return [
        *(first_bounce if results.ends is None else journey_answer(study, results)),
        *(one.statement for one in results.limit_states.values()),
        *([results.emulated.statement] if results.emulated and results.emulated.statement else []),
        *([results.aim.statement] if results.aim else []),
        *results.site.sentences,
    ]


def drawn_headline(results: DrawnResults) -> list[str]:
    """The answer, and the most informative numbers behind it, each in a sentence."""
    emulator = results.emulator
    behind = [
        _touchdowns(results.runs),
        *_speed(results.spreads.get("speed_out")),
        *_scatter(results.variance_shares.get("speed_out")),
        *([emulator.statement] if emulator else []),
        *([f"{emulator.warning}."] if emulator and emulator.warning else []),
    ]
    if results.ends is not None:
        behind = [f"First touchdown: {said[:1].lower()}{said[1:]}" for said in behind]
    return [*results.answer, *behind]


def limit_statement(name: str, found: LimitStateResult) -> str:
    """The probability of a limit state in a sentence: its interval, where it comes from, and correlated inputs."""
    begin = f"{name} ({found.condition}): {rare_percent(found.probability.value)} of the landings"
    bounds = found.probability.bounds
    if bounds is None:
        return f"{begin}, from {found.runs.from_}; no interval: {found.why}"
    said = f"{begin} ({percent(found.probability.level)} interval {' to '.join(map(rare_percent, bounds))})"
    if found.source == "emulator":
        said += f", from the emulator, since {found.failing_runs:.3g} landings that meet it are too few for an estimate"
        if found.probability.value < found.tail_limit:
            said += f"; so few beds cannot resolve probabilities below {rare_percent(found.tail_limit)}"
    else:
        said += f", from {found.runs.from_}"
    made = [key for key, one in found.inputs.items() if one.found]
    made.sort(key=lambda key: -found.inputs[key].distance.value)
    none = "No input is significant" if found.inputs else "Its correlated inputs are unknown"
    return f"{said}. {'It is correlated with ' + ', '.join(made) if made else none}."


def _share(study: Study, results: DrawnResults) -> list[str]:
    """Who comes to rest, as far as that was asked, and the return fraction; why it has no interval, if so."""
    returns, rest = results.returns, _at_rest(study, results)
    again = f"impact the surface again within {hours(study.flight.duration)}"
    again += " or are captured where the ground holds them" if results.site.holds else ""
    # The level of an interval is named once in a sentence.
    share = with_interval(returns.share, level=None if "interval" in rest else returns.share.level)
    said = f"{rest}{share}{'' if rest else ' of the landings'} {again}"
    if returns.why is not None:
        return [f"{scope(study).where}: {said}; from {returns.from_}.", returns.why]
    attitudes = (
        "beds, impact points and attitudes" if study.impact.orientation == "random" else "beds and impact points"
    )
    return [
        f"{said}, over the input distributions of the study file and for {attitudes} outside the study; from "
        f"{returns.from_}."
    ]


def _at_rest(study: Study, results: DrawnResults) -> str:
    """Which landings come to rest, on the soil or else on hard ground; of none where journeys were not asked for."""
    grounds = results.rest.grounds
    ground = next((ground for ground in GROUNDS if ground in grounds), None)
    if ground is None:
        return "" if results.site.holds else "None of the landings remains at the site; "
    outcomes = grounds[ground].outcomes
    settled, unknown = outcomes[JourneyStatus.SETTLED].share, outcomes[JourneyStatus.OUTSIDE].share.value
    lost = f" ({percent(unknown)} have an unknown outcome)" if unknown > 0.0 else ""
    return (
        f"{with_interval(settled, level=LEVEL)} of the landings come to rest {GROUNDS[ground]} within "
        f"{hours(study.rest.duration)}{lost}; "
    )


def _missing(runs: RunResults, returns: ReturnFraction) -> list[str]:
    """What landings without an outcome could change."""
    lost = runs.missing
    if not lost.count:
        return []
    low, high = (percent(bound, interval_digits(*returns.if_missing)) for bound in returns.if_missing)
    covers = "" if returns.share.lower is None else "; the interval covers both"
    return [
        f"{lost.count} of {runs.count} landings have no outcome ({missing_words(lost.outcomes)}): the return fraction "
        f"is {low} if none of these return and {high} if all do{covers}."
    ]


def _others(study: Study, results: DrawnResults) -> str:
    """What becomes of the others."""
    outcomes = results.shares.outcomes
    ways: dict[str, str] = {
        FlightStatus.ESCAPED: "escape",
        FlightStatus.FLYING: f"are still flying after {hours(study.flight.duration)}",
    }
    if outcomes[FlightStatus.PARTNER].count:
        ways[FlightStatus.PARTNER] = "impact the partner"
    if outcomes[CAPTURED].count and not results.site.holds:
        ways[CAPTURED] = "are captured and lifted off again"
    listed = [f"{with_interval(outcomes[name].share)} {words}" for name, words in ways.items()]
    return f"Of all landings {', '.join(listed)}."


def _touchdowns(runs: RunResults) -> str:
    """How the touchdowns ended."""
    left, *others = TouchdownOutcome
    found = [f"{runs.outcomes.get(left, 0)} of {runs.count} landings {left.label}"]
    found += [f"{runs.outcomes[one]} {one.label}" for one in others if one in runs.outcomes]
    found += [f"{runs.outcomes['failed']} failed"] if "failed" in runs.outcomes else []
    return f"{'; '.join(found)}."


def _speed(speed: OutputEstimate | None) -> list[str]:
    """The rebound speed of the landings that have one."""
    if speed is None:
        return []
    low, middle, high = speed.quantiles.values()
    interval = ""
    if middle.bounds is not None:
        ends = " to ".join(f"{CENTIMETRES * end:.3g}" for end in middle.bounds) + " cm/s"
        interval = f", {percent(LEVEL)} interval {ends}"
    return [
        f"Rebound speed of {speed.of}: median {CENTIMETRES * middle.value:.3g} cm/s{interval}; 5th to 95th "
        f"percentile {CENTIMETRES * low.value:.3g} to {CENTIMETRES * high.value:.3g} cm/s."
    ]


def _scatter(record: VarianceParts | None) -> list[str]:
    """What explains the variance of the rebound speed."""
    if record is None:
        return []
    listed = [
        f"{PARTS[name]} {'at least ' if name in FLOORS and one.value > 0.0 else ''}{part(one)}"
        for name, one in record.parts.items()
    ]
    return [
        "Parts of the variance of the rebound speed over the input distributions of the study file: "
        f"{', '.join(listed)} ({percent(LEVEL)} intervals)."
    ]
