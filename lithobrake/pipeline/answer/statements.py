"""The answer of a drawn study in sentences, with its intervals, and the most informative numbers behind it."""

import math
from collections.abc import Mapping
from typing import Any

from lithobrake.pipeline.answer.missing_landings import missing_words
from lithobrake.pipeline.answer.run_shares import CAPTURED
from lithobrake.pipeline.answer.scope import scope
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome
from lithobrake.vocabulary.percentages import interval_digits, percent, span

CENTIMETRES = 100.0
# Parts of the variance, as they stand in a sentence; of those in FLOORS only terms of first and second degree are seen.
PARTS = {
    "soil": "soil",
    "arrival": "speed, angle and spin of the impact",
    "bed": "the bed",
    "place_and_attitude": "everything else",
    "chaos": "chaos",
}
FLOORS = ("soil", "arrival")
GROUNDS = {"soil": "on the soil", "hard": "on hard ground"}


def drawn_answer(study: Study, results: Mapping[str, Any]) -> list[str]:
    """What becomes of the landers, over what that holds, what is missing, and what the site does to those that lie."""
    site = results["site"]
    holds = site["effective_acceleration_outward"] < 0.0
    return [
        *_share(study, results, holds=holds),
        *_missing(results["runs"], results["returns"]),
        _others(study, results["shares"], holds=holds),
        *(one["statement"] for one in results["limit_states"].values()),
        *([results["aim"]["statement"]] if results["aim"] else []),
        *([site["warning"]] if site["warning"] else []),
    ]


def drawn_headline(study: Study, results: Mapping[str, Any]) -> list[str]:
    """The answer, and the most informative numbers behind it, each in a sentence."""
    emulator = results["emulator"]
    return [
        *results["answer"],
        _touchdowns(results["runs"]),
        *_speed(results["outputs"]),
        *_scatter(results["variance_shares"].get("speed_out")),
        emulator["statement"],
        *([f"{emulator['warning']}."] if emulator["warning"] else []),
    ]


def limit_statement(name: str, found: Mapping[str, Any]) -> str:
    """The probability of a limit state in a sentence: its interval, where it comes from, and correlated inputs."""
    share, runs = _small(found["probability"]), found["runs"]
    begin = f"{name} ({found['condition']}): {share} of the landings"
    if found["lower"] is None:
        return f"{begin}, from {runs['from']}, without an interval: {found['why']}"
    said = f"{begin} ({100 * found['level']:.0f} % interval {_small(found['lower'])} to {_small(found['upper'])})"
    if found["source"] == "emulator":
        said += f", by the emulator: {found['failing_runs']:.3g} landings that meet it are too few for an estimate"
        if found["probability"] < found["tail_limit"]:
            said += f", and so few beds rule out no tail below {_small(found['tail_limit'])}"
    else:
        said += f", from {runs['from']}"
    made = [key for key, one in found["inputs"].items() if one["found"]]
    made.sort(key=lambda key: -found["inputs"][key]["distance"])
    none = "No input is significant" if found["inputs"] else "Its inputs are not known"
    return f"{said}. {'It is correlated with ' + ', '.join(made) if made else none}."


def _small(share: float) -> str:
    """A share in words, to two digits where it is rare or nearly certain."""
    away = min(share, 1.0 - share)
    return percent(share) if away >= 0.1 or away == 0.0 else f"{100 * share:.{_digits(away)}f} %"


def _digits(away: float) -> int:
    """Digits behind the point of a percentage that show two of a share's distance from 0 or 1."""
    return max(0, 1 - math.floor(math.log10(100.0 * away)))


def _share(study: Study, results: Mapping[str, Any], *, holds: bool) -> list[str]:
    """Who comes to rest, as far as that was asked, and the return fraction; why it has no interval, if so."""
    returns, rest = results["returns"], _at_rest(study, results["rest"], holds=holds)
    # The level of an interval is named once in a sentence.
    said = {key: value for key, value in returns.items() if key != "level" or "interval" not in rest}
    again = f"impact the surface again within {_hours(study.flight.duration)}"
    again += " or are captured where the ground holds them" if holds else ""
    of = "" if rest else " of the landings"
    share = f"{rest}{_interval(said)}{of} {again}"
    if returns["lower"] is None:
        return [f"{scope(study).where}: {share}; from {returns['from']}.", returns["why"]]
    attitudes = (
        "beds, impact points and attitudes" if study.impact.orientation == "random" else "beds and impact points"
    )
    return [
        f"{share}, over the input distributions of the study file, on {attitudes} that were not in the study; from "
        f"{returns['from']}."
    ]


def _at_rest(study: Study, rest: Mapping[str, Any], *, holds: bool) -> str:
    """Which landings come to rest, on the soil or else on hard ground; of none where journeys were not asked for."""
    ground = next((ground for ground in GROUNDS if rest[ground] is not None), None)
    if ground is None:
        return "" if holds else "None of the landings stays at the site; "
    table = rest[ground]
    settled, unknown = table[JourneyStatus.SETTLED], table[JourneyStatus.OUTSIDE]["share"]
    lost = f" (of {percent(unknown)} the outcome is unknown)" if unknown > 0.0 else ""
    return (
        f"{_interval(settled | {'level': table['level']})} of the landings come to rest {GROUNDS[ground]} within "
        f"{_hours(study.rest.duration)}{lost}; "
    )


def _missing(runs: Mapping[str, Any], returns: Mapping[str, Any]) -> list[str]:
    """What landings without an outcome could change."""
    lost = runs["missing"]
    if not lost["count"]:
        return []
    ends = returns["if_missing"]
    low, high = (percent(bound, interval_digits(*ends)) for bound in ends)
    covers = "" if returns["lower"] is None else "; the interval covers both"
    return [
        f"{lost['count']} of {runs['count']} landings have no outcome ({missing_words(lost['outcomes'])}): {low} "
        f"impact again if none, {high} if all of these do{covers}."
    ]


def _others(study: Study, shares: Mapping[str, Any], *, holds: bool) -> str:
    """What becomes of the others."""
    ways: dict[str, str] = {
        FlightStatus.ESCAPED: "escape",
        FlightStatus.FLYING: f"are still flying after {_hours(study.flight.duration)}",
    }
    if shares[FlightStatus.PARTNER]["count"]:
        ways[FlightStatus.PARTNER] = "impact the partner"
    if shares[CAPTURED]["count"] and not holds:
        ways[CAPTURED] = "are captured and lifted off again"
    return f"Of all landings {', '.join(f'{_interval(shares[name])} {words}' for name, words in ways.items())}."


def _touchdowns(runs: Mapping[str, Any]) -> str:
    """How the touchdowns ended."""
    left, *others = TouchdownOutcome
    found = [f"{runs['outcomes'].get(left, 0)} of {runs['count']} landings {left.label}"]
    found += [f"{runs['outcomes'][one]} {one.label}" for one in others if one in runs["outcomes"]]
    found += [f"{runs['outcomes']['failed']} failed"] if "failed" in runs["outcomes"] else []
    return f"{'; '.join(found)}."


def _speed(outputs: Mapping[str, Any]) -> list[str]:
    """The rebound speed of the landings that have one."""
    if "speed_out" not in outputs:
        return []
    low, middle, high = outputs["speed_out"]["quantiles"].values()
    ends = [middle["lower"], middle["upper"]]
    interval = (
        "" if None in ends else ", 90 % interval {:.3g} to {:.3g} cm/s".format(*(CENTIMETRES * one for one in ends))
    )
    return [
        f"Rebound speed of {outputs['speed_out']['of']}: median {CENTIMETRES * middle['value']:.3g} cm/s{interval}; 5 "
        f"to 95 % of them: {CENTIMETRES * low['value']:.3g} to {CENTIMETRES * high['value']:.3g} cm/s."
    ]


def _scatter(parts: Mapping[str, Any] | None) -> list[str]:
    """What explains the variance of the rebound speed."""
    if parts is None:
        return []
    listed = [f"{words} {_part(parts[name], name)}" for name, words in PARTS.items() if parts.get(name) is not None]
    return [
        "The variance of the rebound speed, over the input distributions of the study file, comes from: "
        f"{', '.join(listed)} (90 % intervals)."
    ]


def _part(part: Mapping[str, float], name: str) -> str:
    """A part of a variance within what it can be; estimates without bias may lie a little outside."""
    share, lower, upper = (min(max(part[key], 0.0), 1.0) for key in ("share", "lower", "upper"))
    shown = f"{'at least ' if name in FLOORS else ''}{percent(share)}" if share > 0.0 else "not detected"
    return f"{shown} ({span(lower, upper)})"


def _interval(found: Mapping[str, Any]) -> str:
    """A share with its interval, where it has one: "75 % (90 % interval 71-77 %)"."""
    if found["lower"] is None:
        return percent(found["share"])
    digits = interval_digits(found["lower"], found["upper"])
    level = f"{100 * found['level']:.0f} % interval " if "level" in found else ""
    return f"{percent(found['share'], digits)} ({level}{span(found['lower'], found['upper'], digits)})"


def _hours(seconds: float) -> str:
    return f"{seconds / 3600:.3g} h"
