"""The answer of a sequence in sentences, with its interval, and the numbers that tell most beside it."""

import math
from collections.abc import Mapping
from typing import Any

from lithobrake.outcomes import FlightStatus, SampleOutcome, TouchdownOutcome
from lithobrake.pipeline.scope import scope
from lithobrake.study import Study

CENTIMETRES = 100.0
# Parts of the variance, as they stand in a sentence.
PARTS = {
    "soil": "soil",
    "arrival": "arrival",
    "bed": "the bed",
    "place_and_attitude": "place and attitude",
    "chaos": "chaos",
}


def drawn_answer(study: Study, results: Mapping[str, Any]) -> list[str]:
    """What becomes of the landers, over what that holds, what is missing, and what the site does to those that lie."""
    returns, site, hours = results["returns"], results["site"], f"{study.flight.duration / 3600:.3g} h"
    holds = site["effective_acceleration_outward"] < 0.0
    down = f"stay or come down again within {hours}" if holds else f"come down again within {hours}"
    return [
        *_share(study, returns, down),
        *_missing(results["runs"], returns),
        _others(results["shares"], holds=holds),
        *(one["statement"] for one in results["limit_states"].values()),
        *([results["aim"]["statement"]] if results["aim"] else []),
        *([site["warning"]] if site["warning"] else []),
    ]


def drawn_headline(study: Study, results: Mapping[str, Any]) -> list[str]:
    """The answer, and the most telling numbers behind it, each in a sentence."""
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
    """The probability of a limit state in a sentence: its interval, what answers, and which inputs make it."""
    share, runs = _small(found["probability"]), found["runs"]
    begin = f"{name} ({found['condition']}): {share} of the landers"
    if found["lower"] is None:
        return f"{begin}, from {runs['from']}, without an interval: {found['why']}"
    said = f"{begin} ({100 * found['level']:.0f} % interval {_small(found['lower'])} to {_small(found['upper'])})"
    if found["source"] == "emulator":
        said += f", by the emulator, as {found['failing_runs']:.3g} of {runs['from']} are too few to tell"
        if found["probability"] < found["tail_limit"]:
            said += f"; so many places rule out no tail below {_small(found['tail_limit'])}"
    else:
        said += f", from {runs['from']}"
    made = [key for key, one in found["inputs"].items() if one["found"]]
    made.sort(key=lambda key: -found["inputs"][key]["distance"])
    no_input = "no input was found to make it" if found["inputs"] else "which inputs make it is not known"
    return f"{said}; {'it comes with ' + ', '.join(made) if made else no_input}."


def _small(share: float) -> str:
    """A share in words, to two digits where it is rare or nearly certain."""
    away = min(share, 1.0 - share)
    return _percent(share) if away >= 0.1 or away == 0.0 else f"{100 * share:.{_digits(away)}f} %"


def _digits(away: float) -> int:
    """Digits behind the point of a percentage that show two of a share's distance from 0 or 1."""
    return max(0, 1 - math.floor(math.log10(100.0 * away)))


def _share(study: Study, returns: Mapping[str, Any], down: str) -> list[str]:
    share, level = _percent(returns["share"]), f"{100 * returns['level']:.0f} %"
    if returns["lower"] is None:
        return [f"{scope(study).where}: {share} of the landers {down}; from {returns['from']}.", returns["why"]]
    attitudes = "beds, places and attitudes" if study.impact.orientation == "random" else "beds and places"
    sentences = [
        f"{share} of the landers {down} ({level} interval {_span(returns['lower'], returns['upper'])}), over the laws "
        f"of the study file, on {attitudes} that were not in the study; from {returns['from']}."
    ]
    if returns["next_bed"] is not None:
        low, high = returns["next_bed"]
        sentences.append(f"On one next bed the share lies between {_span(low, high, 'and')} ({level}).")
    return sentences


def _missing(runs: Mapping[str, Any], returns: Mapping[str, Any]) -> list[str]:
    """What it would change if landers stayed or flew of which nobody knows."""
    known = (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)
    lost = {name: count for name, count in runs["outcomes"].items() if name not in known}
    if not lost:
        return []
    labels = {str(one): one.label for one in TouchdownOutcome} | {"failed": "failed"}
    count = sum(lost.values())
    words = ", ".join(f"{number} {labels[name]}" for name, number in lost.items())
    low, high = (f"{100 * bound:.1f} %" for bound in returns["if_missing"])
    return [
        f"Of {count} of {runs['count']} landings nobody knows where the lander went ({words}): {low} if none, {high} "
        "if all of them came down again."
    ]


def _others(shares: Mapping[str, Any], *, holds: bool) -> str:
    """What becomes of the others."""
    ways: dict[str, str] = {FlightStatus.ESCAPED: "escape", FlightStatus.FLYING: "are still flying"}
    if shares[FlightStatus.PARTNER]["count"]:
        ways[FlightStatus.PARTNER] = "come down on the partner"
    if shares[SampleOutcome.CAPTURED]["count"] and not holds:
        ways[SampleOutcome.CAPTURED] = "are captured and lifted again"
    listed = [f"{_percent(shares[name]['share'])} {words}" for name, words in ways.items()]
    return f"By the emulator {', '.join(listed)}."


def _touchdowns(runs: Mapping[str, Any]) -> str:
    """How the touchdowns ended."""
    left, *others = TouchdownOutcome
    found = [f"{runs['outcomes'].get(left, 0)} of {runs['count']} touchdowns {left.label}"]
    found += [f"{runs['outcomes'][one]} {one.label}" for one in others if one in runs["outcomes"]]
    found += [f"{runs['outcomes']['failed']} failed"] if "failed" in runs["outcomes"] else []
    return f"{'; '.join(found)}."


def _speed(outputs: Mapping[str, Any]) -> list[str]:
    """The outgoing speed of the runs that leave."""
    if "speed_out" not in outputs:
        return []
    low, middle, high = outputs["speed_out"]["quantiles"].values()
    ends = [middle["lower"], middle["upper"]]
    interval = "" if None in ends else ", {:.3g} to {:.3g} at 90 %".format(*(CENTIMETRES * end for end in ends))
    return [
        f"Outgoing speed of those that leave: {CENTIMETRES * middle['value']:.3g} cm/s (median{interval}; 5 to 95 % of "
        f"the landers: {CENTIMETRES * low['value']:.3g} to {CENTIMETRES * high['value']:.3g} cm/s)."
    ]


def _scatter(parts: Mapping[str, Any] | None) -> list[str]:
    """Where the scatter of the outgoing speed comes from."""
    if parts is None:
        return []
    found = {words: parts[name] for name, words in PARTS.items() if parts[name] is not None}
    # Shares are free of bias, and so may be a little outside of what a share can be.
    shown = {words: min(max(part["share"], 0.0), 1.0) for words, part in found.items()}
    listed = [
        f"{words} {_percent(shown[words])} ({_span(part['lower'], part['upper'])})" for words, part in found.items()
    ]
    return [f"The scatter of the outgoing speed comes from: {', '.join(listed)} (90 % intervals)."]


def _span(lower: float, upper: float, word: str = "to") -> str:
    return f"{_percent(lower).removesuffix(' %')} {word} {_percent(upper)}"


def _percent(share: float) -> str:
    """A share in words, to a tenth only near its ends."""
    return f"{100 * share:.0f} %" if 0.01 <= share <= 0.99 or share in (0.0, 1.0) else f"{100 * share:.1f} %"
