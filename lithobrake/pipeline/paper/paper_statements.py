"""The answer of a paper study in sentences, and the most informative numbers behind it."""

from typing import Any

from lithobrake.pipeline.answer.scope import scope
from lithobrake.pipeline.emulate.samples import MISSING
from lithobrake.results.telling_numbers import MainInput, TellingNumbers
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import FlightStatus, SampleOutcome, TouchdownOutcome

CENTIMETRES = 100.0


def answer(study: Study, results: dict[str, Any]) -> list[str]:
    """What becomes of the landers, over what that holds, what is missing, and what the site does to those that lie."""
    shares, site, hours = results["shares"], results["site"], f"{study.flight.duration / 3600:.3g} h"
    holds = site["effective_acceleration_outward"] < 0.0
    down = (
        f"are captured or impact the surface again within {hours}"
        if holds
        else f"impact the surface again within {hours}"
    )
    returning = _percent(shares["returns"]["share"])
    ways = {FlightStatus.ESCAPED: "escape", FlightStatus.FLYING: f"are still flying after {hours}"}
    if shares[FlightStatus.PARTNER]["count"]:
        ways[FlightStatus.PARTNER] = "impact the partner"
    beside = [f"{_percent(shares[status]['share'])} {words}" for status, words in ways.items()]
    captured = shares[SampleOutcome.CAPTURED]
    if captured["count"] and not holds:
        beside.append(f"{_percent(captured['share'])} are captured and lifted off again")
    sentences = [
        f"{scope(study).where}: {returning} of the landers {down}; {', '.join(beside)}.",
        scope(study).why,
    ]
    if shares["missing"]["count"]:
        lost = [f"{_percent(shares[outcome]['share'])} {outcome.label}" for outcome in MISSING]
        low, high = (_percent(bound) for bound in results["returns"]["if_missing"])
        sentences.append(
            f"{_percent(shares['missing']['share'])} of the samples have no outcome ({', '.join(lost)}): {low} impact "
            f"again if none, {high} if all of these do."
        )
    return [*sentences, *([site["warning"]] if site["warning"] else [])]


def headline(study: Study, results: dict[str, Any]) -> list[str]:
    """The answer, and the most informative numbers behind it, each in a sentence."""
    telling = TellingNumbers.of(results)
    return [
        *results["answer"],
        _touchdowns(telling),
        *_speed(study, telling.speed),
        _main_input(telling.main_input),
        _explained(telling.score),
    ]


def _touchdowns(telling: TellingNumbers) -> str:
    """How the touchdowns ended."""
    left, *unclear = TouchdownOutcome
    others = [f"{telling.ended[one]} {one.label}" for one in unclear if telling.ended[one]]
    others += [f"{telling.failed} more failed"] if telling.failed else []
    return "; ".join([f"{telling.left_count} of {telling.ended.total()} touchdowns {left.label}", *others]) + "."


def _speed(study: Study, speed: dict[str, float] | None) -> list[str]:
    """The rebound speed of the samples that leave."""
    if not speed:
        return []
    low, middle, high = (CENTIMETRES * speed[f"quantile_{level:g}"] for level in (0.05, 0.5, 0.95))
    of = "with the scatter from run to run" if study.monte_carlo.scatter else "of the expansion, without scatter"
    return [
        f"Rebound speed of those that leave, {of}: {middle:.3g} cm/s (median; 5 to 95 %: {low:.3g} to {high:.3g} cm/s)."
    ]


def _main_input(main: MainInput) -> str:
    """The dominant input of the rebound speed, with its interval, of what it is a share, and what rivals it."""
    if main.total <= 0.0:
        return "No input was found to explain the rebound speed."
    low, high = main.interval
    noise = main.noise_share
    role = f"cannot be told from {', '.join(main.equals)} by its" if main.equals else "is the dominant input by its"
    rest = (
        "" if noise is None else f"; {100 * noise:.0f} % of the variance of the runs is scatter that no input explains"
    )
    return (
        f"For the rebound speed {main.name} {role} total Sobol index, {main.total:.2f} (95 % interval {low:.2f} to "
        f"{high:.2f}) of the variance that the refined expansion of degree {main.degree} explains over its inputs; the "
        f"interval contains no truncation error{rest}."
    )


def _explained(score: dict[str, Any]) -> str:
    """How well the expansion predicts fresh runs."""
    error = (
        f"error {CENTIMETRES * score['rmse']:.2g} cm/s at a spread of {CENTIMETRES * score['std']:.2g} cm/s, "
        f"MAPE {'undefined' if score['mape'] is None else format(score['mape'], '.2g') + ' %'}"
    )
    if score["q2"] is None:
        return f"On fresh runs with all inputs varying the rebound speed does not vary ({error})."
    q2 = f"Q2 = {score['q2']:.2f}"
    low, high = score.get("q2_interval") or (None, None)
    if high is not None:
        q2 += f", 95 %: {'below any bound' if low is None else format(low, '.2f')} to {high:.2f}"
    words = (
        f"explains {100 * score['q2']:.0f} % of the variance of the rebound speed"
        if score["q2"] > 0.0
        else "is worse than the mean of the runs: it explains nothing of the rebound speed"
    )
    return f"On fresh runs with all inputs varying the expansion {words} ({q2}; {error})."


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"
