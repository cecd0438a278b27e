"""The answer of a paper study in sentences, and the most informative numbers behind it."""

from collections.abc import Mapping

from lithobrake.pipeline.answer.scope import scope
from lithobrake.pipeline.emulate.samples import MISSING
from lithobrake.results.expansions import OutputErrors
from lithobrake.results.summary import PaperResults
from lithobrake.results.telling_numbers import MainInput, TellingNumbers
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import FlightStatus, SampleOutcome, TouchdownOutcome
from lithobrake.vocabulary.percentages import percent

CENTIMETRES = 100.0


def answer(study: Study, results: PaperResults) -> list[str]:
    """What becomes of the landers, over what that holds, what is missing, and what the site does to those that lie."""
    outcomes, site, hours = results.shares.outcomes, results.site, f"{study.flight.duration / 3600:.3g} h"
    again = f"impact the surface again within {hours}"
    down = f"are captured or {again}" if site.holds else again
    ways = {FlightStatus.ESCAPED: "escape", FlightStatus.FLYING: f"are still flying after {hours}"}
    if outcomes[FlightStatus.PARTNER].count:
        ways[FlightStatus.PARTNER] = "impact the partner"
    beside = [f"{percent(outcomes[status].share, 1)} {words}" for status, words in ways.items()]
    captured = outcomes[SampleOutcome.CAPTURED]
    if captured.count and not site.holds:
        beside.append(f"{percent(captured.share, 1)} are captured and lifted off again")
    returning = percent(outcomes["returns"].share, 1)
    sentences = [f"{scope(study).where}: {returning} of the landers {down}; {', '.join(beside)}.", scope(study).why]
    if outcomes["missing"].count:
        lost = [f"{percent(outcomes[outcome].share, 1)} {outcome.label}" for outcome in MISSING]
        low, high = (percent(bound, 1) for bound in results.returns.if_missing)
        sentences.append(
            f"{percent(outcomes['missing'].share, 1)} of the samples have no outcome ({', '.join(lost)}): the return "
            f"fraction is {low} if none of these return and {high} if all do."
        )
    return [*sentences, *site.sentences]


def headline(study: Study, results: PaperResults) -> list[str]:
    """The answer, and the most informative numbers behind it, each in a sentence."""
    telling = TellingNumbers.of(results)
    return [
        *results.answer,
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


def _speed(study: Study, speed: Mapping[str, float] | None) -> list[str]:
    """The rebound speed of the samples that leave."""
    if not speed:
        return []
    low, middle, high = (CENTIMETRES * speed[f"quantile_{level:g}"] for level in (0.05, 0.5, 0.95))
    of = "with run-to-run scatter" if study.monte_carlo.scatter else "by the expansion alone, without scatter"
    return [
        f"Rebound speed of the samples that leave the surface, {of}: median {middle:.3g} cm/s; 5th to 95th percentile "
        f"{low:.3g} to {high:.3g} cm/s."
    ]


def _main_input(main: MainInput) -> str:
    """The dominant input of the rebound speed, with its interval, of what it is a share, and what rivals it."""
    if main.total <= 0.0:
        return "No input explains the rebound speed significantly."
    low, high = main.interval
    noise = main.noise_share
    rivals = f", not distinguishable from {', '.join(main.equals)}" if main.equals else ""
    rest = "" if noise is None else f"; {percent(noise)} of the variance of the runs is scatter that no input explains"
    return (
        f"Largest total Sobol index of the rebound speed: {main.name}, {main.total:.2f} (95 % interval {low:.2f} to "
        f"{high:.2f}, without truncation error){rivals}, as a share of the variance that the refined expansion of "
        f"degree {main.degree} explains{rest}."
    )


def _explained(score: OutputErrors) -> str:
    """How well the expansion predicts fresh runs."""
    error = (
        f"error {CENTIMETRES * score.rmse:.2g} cm/s at a spread of {CENTIMETRES * score.std:.2g} cm/s, "
        f"MAPE {'undefined' if score.mape is None else format(score.mape, '.2g') + ' %'}"
    )
    if score.q2 is None:
        return f"On fresh runs with all inputs varying the rebound speed does not vary ({error})."
    q2 = f"Q2 = {score.q2:.2f}"
    low, high = score.q2_interval
    if high is not None:
        q2 += f", 95 %: {'below any bound' if low is None else format(low, '.2f')} to {high:.2f}"
    words = (
        f"explains {percent(score.q2)} of the variance of the rebound speed"
        if score.q2 > 0.0
        else "predicts the rebound speed no better than the mean of the runs"
    )
    return f"On fresh runs with all inputs varying the expansion {words} ({q2}; {error})."
