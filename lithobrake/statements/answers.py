"""The answer of a study in sentences, as summary.json and the page have it, and the numbers beside it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lithobrake.results.journey_results import JourneyRest
from lithobrake.statements import labels, touchdowns
from lithobrake.statements.captions import place_words
from lithobrake.statements.ends import (
    Scope,
    at_rest,
    held_over,
    journey_counts,
    journey_ends,
    landing_ends,
    landing_warnings,
    returning,
    sample_ends,
    unknown_outcome,
)
from lithobrake.statements.expansion import LEVEL as PAPER_LEVEL
from lithobrake.statements.expansion import error_words, noise, telling_sentences
from lithobrake.statements.journeys import rest_sentences, sky, soils, time_unit
from lithobrake.statements.limits import rare_warnings
from lithobrake.vocabulary.constants import CENTIMETRES
from lithobrake.vocabulary.number_words import LEVEL, fixed, number, part, percent, time_limit, with_interval
from lithobrake.vocabulary.outcomes import JourneyEnd, JourneyStatus, SampleOutcome

if TYPE_CHECKING:
    from lithobrake.results.dispersion import RestRegion
    from lithobrake.results.journey_results import RestQuantiles
    from lithobrake.results.page_data import DrawnPage, JourneyPage, PageData, PaperPage, RunsPage
    from lithobrake.results.run_results import CountedShare
    from lithobrake.results.summary import DrawnResults, PaperResults
    from lithobrake.statements.expansion import TellingNumbers

FIRST = "Of the first touchdown alone"


def landing_answer(scope: Scope, results: "DrawnResults") -> list[str]:
    """What becomes of the landers, over what that holds, what is missing, and what the site does to those that lie."""
    rest = results.rest
    ends = landing_ends(scope, results) if results.ends is None else journey_ends(scope, results)
    if results.ends is not None and isinstance(rest, JourneyRest):
        ends = [*ends, *rest_sentences(rest), *sky(results.sky), *soils(results.soils)]
    return [
        *ends,
        *(one.statement for one in results.limit_states.values()),
        *([results.emulated.statement] if results.emulated and results.emulated.statement else []),
        *([results.aim.statement] if results.aim else []),
        *results.site.sentences,
    ]


def landing_headline(results: "DrawnResults") -> list[str]:
    """The answer, and the most informative numbers behind it."""
    emulator, speed, shares = results.emulator, results.spreads.get("speed_out"), results.variance_shares["speed_out"]
    behind = [
        touchdowns.touchdown_outcomes(results.runs.outcomes, results.runs.count, "landings"),
        *([touchdowns.output_spread("speed_out", speed)] if speed else []),
        *([touchdowns.output_variance("speed_out", shares)] if shares else []),
        *([emulator.statement] if emulator else []),
        *([f"{emulator.warning}."] if emulator and emulator.warning else []),
    ]
    if results.ends is not None:
        behind = [f"First touchdown: {said[:1].lower()}{said[1:]}" for said in behind]
    return [*results.answer, *behind]


def sample_answer(scope: Scope, results: "PaperResults", missing: Sequence[SampleOutcome]) -> list[str]:
    """The answer of an expansion; missing: outcomes of samples after which nothing is known."""
    return [*sample_ends(scope, results, missing), *results.site.sentences]


def sample_headline(scope: Scope, results: "PaperResults") -> list[str]:
    """The answer of an expansion, and the most informative numbers behind it."""
    return [*results.answer, *telling_sentences(results, has_scatter=scope.has_scatter)]


def page_answer(data: "RunsPage") -> str:
    """The return fraction, as a page begins."""
    returns, alone = data.results.returns, "other beds, impact points or attitudes would change it"
    more = f", without an interval: {alone}" if returns.share.lower is None else ""
    return f"{with_interval(returns.share, level=data.level)} of the landings {action(data)}{more}."


def journey_page_answer(data: "JourneyPage") -> str:
    """How many landers come to rest, as a page begins."""
    return f"{at_rest(data.ends[JourneyEnd.AT_REST].share, data.study['journey']['duration'], level=LEVEL)}."


def action(data: "PageData") -> str:
    """What the return fraction is of: landers that do this."""
    return returning(data.study["flight"]["duration"], holds=data.results.site.holds)


def landing_details(data: "DrawnPage") -> list[str]:
    """Where the study lands, and what the page has nowhere else: over what its answer holds, how the body turns."""
    returns, site = data.results.returns, data.results.site
    over = held_over(random_attitude=data.study["impact"]["orientation"] == "random")
    begin = f"The fractions are from {returns.from_}"
    said = [f"{begin}.", returns.why] if returns.why else [f"{begin} and hold {over}."]
    return [" ".join([place_words(data), *said, *site.sentences])]


def sample_details(data: "PageData") -> list[str]:
    """The same of the samples of an expansion: what its answer says behind its first sentence."""
    return [" ".join([place_words(data), *data.results.answer[1:]])]


def journey_details(data: "JourneyPage") -> list[str]:
    """The same of journeys; that the site holds no lander stands among the warnings."""
    said = [place_words(data), f"The fractions are from {journey_counts(data.results)}.", data.results.site.rotation]
    return [" ".join(filter(None, said))]


def page_warnings(data: "DrawnPage") -> list[str]:
    """What makes the numbers of the page weaker than they look."""
    return [*landing_warnings(data.results, data.emulator.warning), *rare_warnings(data.rare)]


def journey_warnings(data: "JourneyPage") -> list[str]:
    """The same of journeys; warnings of runs are of first touchdowns."""
    site = data.results.site.warning
    of_first = [f"{FIRST}: {words[:1].lower()}{words[1:]}" for words in landing_warnings(data.results)]
    return [*([site] if site else []), *of_first]


@dataclass(frozen=True)
class Tile:
    """One of the few numbers that a reader takes away; outcome: the word of the one that it is of, if it is of one."""

    value: str
    unit: str
    words: str
    outcome: str = ""


def landing_tiles(data: "DrawnPage") -> list[Tile]:
    """Who comes to rest, the rebound speed, and what the emulator makes of it."""
    results = data.results
    found = _at_rest(data)
    if "speed_out" in results.spreads:
        median = results.spreads["speed_out"].quantiles["0.5"]
        shown = median.on_scale(lambda value: CENTIMETRES * value)
        words = f"rebound speed, median of those that leave{labels.bracket(shown.lower, shown.upper, level=data.level)}"
        found.append(Tile(number(shown.value), "cm/s", words))
    parts = results.variance_shares["speed_out"]
    if parts is not None:
        value, _, unit = part(parts.soil).partition(" (")[0].partition(" %")
        is_found = value[0].isdigit()
        words = "at least of the variance of the rebound speed is explained by soil"
        words = words if is_found else "effect of the soil on the variance of the rebound speed"
        interval = labels.share_interval(parts.soil)
        found.append(Tile(value, "%" if is_found else unit, f"{words} ({interval})"))
    band = data.emulator.scores.outputs.get("speed_out")
    if band:
        held = f"within the {percent(touchdowns.BAND)} bands of the emulator"
        words = f"of the rebound speeds on {touchdowns.left_out(results.runs.beds)} lay {held}"
        found.append(Tile(percent(band.band_90).removesuffix(" %"), "%", words))
    return found


def _at_rest(data: "DrawnPage") -> list[Tile]:
    """Which landers come to rest after all bounces, on the soil or else on hard ground; none where it was not asked."""
    limit = time_limit(data.study["rest"]["duration"])
    for ground, table in data.results.rest.grounds.items():
        share, _, ends = with_interval(table.outcomes[JourneyStatus.SETTLED].share).partition(" %")
        unknown = table.outcomes[JourneyStatus.OUTSIDE].share.value
        lost = f"; {unknown_outcome(unknown)}" if unknown > 0.0 else ""
        return [
            Tile(
                share, "%", f"at rest within {limit}, bounce after bounce on {labels.GROUND_WORDS[ground]}{ends}{lost}"
            )
        ]
    return []


def sample_tiles(data: "PaperPage", telling: "TellingNumbers") -> list[Tile]:
    """The rebound speed of an expansion, how touchdowns ended, its dominant input, and how accurate it is."""
    main, score, speed = telling.main_input, telling.score, telling.speed
    index = (
        f"{labels.input_words(main.name)}: largest total index of the rebound speed in the refined expansion"
        f"{labels.bracket(*main.interval, fixed, level=PAPER_LEVEL)}, without truncation error{noise(main.noise_share)}"
    )
    accuracy = (
        f"rebound speed, new runs, all inputs varied{labels.bracket(*score.q2_interval, fixed, level=PAPER_LEVEL)}"
    )
    beside = f"; {telling.failed} more runs failed" if telling.failed else ""
    found = [
        Tile(str(telling.left_count), f"of {telling.ended.total()}", f"touchdowns left the surface{beside}"),
        Tile(fixed(main.total), "Sobol", index),
        Tile("none" if score.q2 is None else fixed(score.q2), "Q2", f"{accuracy}: {error_words(score)}"),
    ]
    if not speed:
        return found
    low, middle, high = (number(CENTIMETRES * speed[f"quantile_{level}"]) for level in ("0.05", "0.5", "0.95"))
    return [Tile(middle, "cm/s", f"rebound speed, median; 5th to 95th percentile {low} to {high}"), *found]


def journey_tiles(data: "JourneyPage") -> list[Tile]:
    """When and where landers rest, and the likeliest end other than that; every other end where none does."""
    count, rest = len(data.journeys["end"]), data.at_rest
    others = {name: one for name, one in data.ends.items() if name != JourneyEnd.AT_REST}
    if not rest.time_s.median.is_known:
        return [_end(name, one, count) for name, one in others.items()]
    size, unit = time_unit(data)
    likeliest = max(others, key=lambda name: (others[name].share.value, others[name].share.upper or 0.0))
    return [
        _quantile(rest.time_s, unit, "median time to rest", size),
        _quantile(rest.distance_m, "m", "median distance from the aim point"),
        _region(rest.regions[-1]) if rest.regions else _quantile(rest.contacts, "contacts", "median"),
        _end(likeliest, others[likeliest], count),
    ]


def _region(one: "RestRegion") -> Tile:
    words = f"smallest region with {percent(one.share)} of those at rest; {labels.extent(one)}"
    return Tile(labels.area(one.area_m2).removesuffix(" m2"), "m²", words)


def _end(name: str, one: "CountedShare", count: int) -> Tile:
    interval = labels.share_interval(one.share)
    words = f"{labels.END_WORDS[name]}, {one.count} of {count}" + (f" ({interval})" if interval else "")
    # An end that did not occur has no colour.
    return Tile(labels.bare_share(one.share), "%", words, name if one.count else "")


def _quantile(found: "RestQuantiles", unit: str, words: str, size: float = 1.0) -> Tile:
    """A median with its interval, and the 95th percentile."""
    value, _, ends = labels.quantile(found.median, size).partition(" ")
    most = labels.quantile(found.q95, size).partition(" ")[0]
    return Tile(value, unit, f"{words} {ends}; 95 % within {most} {unit}".replace(" ;", ";"))
