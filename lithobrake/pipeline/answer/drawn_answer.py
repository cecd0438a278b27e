"""The answer of a drawn study in sentences, with its intervals, and the most informative numbers behind it."""

from lithobrake.analysis import LEVEL
from lithobrake.pipeline.answer.journey_answer import journey_answer
from lithobrake.pipeline.answer.missing_landings import missing_words
from lithobrake.pipeline.answer.run_shares import CAPTURED
from lithobrake.pipeline.answer.scope import scope
from lithobrake.results.limit_state_results import LimitStateResult
from lithobrake.results.run_results import OutputEstimate, RunResults, VarianceParts
from lithobrake.results.shares import ReturnFraction
from lithobrake.results.summary import DrawnResults
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome
from lithobrake.vocabulary.percentages import interval_digits, percent, rare_percent, with_interval

CENTIMETRES = 100.0
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
    begin = f"{name} ({found.condition}): {rare_percent(found.probability)} of the landings"
    if found.lower is None or found.upper is None:
        return f"{begin}, from {found.runs.from_}; no interval: {found.why}"
    said = f"{begin} ({percent(found.level)} interval {rare_percent(found.lower)} to {rare_percent(found.upper)})"
    if found.source == "emulator":
        said += f", from the emulator, since {found.failing_runs:.3g} landings that meet it are too few for an estimate"
        if found.probability < found.tail_limit:
            said += f"; so few beds cannot resolve probabilities below {rare_percent(found.tail_limit)}"
    else:
        said += f", from {found.runs.from_}"
    made = [key for key, one in found.inputs.items() if one.found]
    made.sort(key=lambda key: -found.inputs[key].distance)
    none = "No input is significant" if found.inputs else "Its correlated inputs are unknown"
    return f"{said}. {'It is correlated with ' + ', '.join(made) if made else none}."


def _share(study: Study, results: DrawnResults) -> list[str]:
    """Who comes to rest, as far as that was asked, and the return fraction; why it has no interval, if so."""
    returns, rest = results.returns, _at_rest(study, results)
    again = f"impact the surface again within {_hours(study.flight.duration)}"
    again += " or are captured where the ground holds them" if results.site.holds else ""
    # The level of an interval is named once in a sentence.
    share = with_interval(returns, level=None if "interval" in rest else returns.level)
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
    settled, unknown = outcomes[JourneyStatus.SETTLED], outcomes[JourneyStatus.OUTSIDE].share
    lost = f" ({percent(unknown)} have an unknown outcome)" if unknown > 0.0 else ""
    return (
        f"{with_interval(settled, level=LEVEL)} of the landings come to rest {GROUNDS[ground]} within "
        f"{_hours(study.rest.duration)}{lost}; "
    )


def _missing(runs: RunResults, returns: ReturnFraction) -> list[str]:
    """What landings without an outcome could change."""
    lost = runs.missing
    if not lost.count:
        return []
    low, high = (percent(bound, interval_digits(*returns.if_missing)) for bound in returns.if_missing)
    covers = "" if returns.lower is None else "; the interval covers both"
    return [
        f"{lost.count} of {runs.count} landings have no outcome ({missing_words(lost.outcomes)}): the return fraction "
        f"is {low} if none of these return and {high} if all do{covers}."
    ]


def _others(study: Study, results: DrawnResults) -> str:
    """What becomes of the others."""
    outcomes = results.shares.outcomes
    ways: dict[str, str] = {
        FlightStatus.ESCAPED: "escape",
        FlightStatus.FLYING: f"are still flying after {_hours(study.flight.duration)}",
    }
    if outcomes[FlightStatus.PARTNER].count:
        ways[FlightStatus.PARTNER] = "impact the partner"
    if outcomes[CAPTURED].count and not results.site.holds:
        ways[CAPTURED] = "are captured and lifted off again"
    listed = [f"{with_interval(outcomes[name])} {words}" for name, words in ways.items()]
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
    if middle.lower is not None and middle.upper is not None:
        ends = f"{CENTIMETRES * middle.lower:.3g} to {CENTIMETRES * middle.upper:.3g} cm/s"
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
        f"{PARTS[name]} {'at least ' if name in FLOORS and one.share > 0.0 else ''}{one.words()}"
        for name, one in record.parts.items()
    ]
    return [
        "Parts of the variance of the rebound speed over the input distributions of the study file: "
        f"{', '.join(listed)} ({percent(LEVEL)} intervals)."
    ]


def _hours(seconds: float) -> str:
    return f"{seconds / 3600:.3g} h"
