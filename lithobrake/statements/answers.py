"""The answer of a study in sentences, as summary.json and the page have it, and the numbers beside it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from lithobrake.statements import labels, touchdowns
from lithobrake.statements.captions import place_words
from lithobrake.statements.ends import (
    Scope,
    hard_ground_ends,
    held_over,
    journey_counts,
    journey_ends,
    landing_ends,
    landing_warnings,
    rest_over,
    returning,
    sample_ends,
    unknown_outcome,
)
from lithobrake.statements.expansion import LEVEL as EXPANSION_LEVEL
from lithobrake.statements.expansion import TellingNumbers, error_words, noise, telling_sentences
from lithobrake.statements.grounds import by_kind, finer, one_ground, over_grounds
from lithobrake.statements.journeys import mean_miss, rest_sentences, sky, soils, time_unit
from lithobrake.statements.limits import met_words, rare_warnings, shown_probability
from lithobrake.vocabulary.constants import CENTIMETRES
from lithobrake.vocabulary.number_words import fixed, number, part, percent, time_limit, with_interval
from lithobrake.vocabulary.outcomes import JourneyEnd

if TYPE_CHECKING:
    from lithobrake.results.dispersion import RestRegion
    from lithobrake.results.journey_results import RestQuantiles
    from lithobrake.results.page_data import PageData, PageExpansion, PageJourneys
    from lithobrake.results.questions import LimitStateResult
    from lithobrake.results.run_results import CountedShare
    from lithobrake.results.summary import Results


def study_answer(scope: Scope, results: "Results") -> list[str]:
    """What becomes of the landers, over what that holds, what is missing, and what else the study asks for."""
    return [
        *_main_answer(scope, results),
        *hard_ground_ends(results.hard_ground, scope.journey_time),
        *(one.statement for one in results.limit_states.values() if not one.of_journey),
        *([results.emulated.statement] if results.emulated and results.emulated.statement else []),
        *([results.aim.statement] if results.aim else []),
        *results.site.cautions,
        *results.site.sentences,
    ]


def _main_answer(scope: Scope, results: "Results") -> list[str]:
    """The fraction at rest where landers are followed to rest, otherwise the return fraction."""
    if not results.ends:
        return sample_ends(scope, results) or telling_sentences(results, has_scatter=scope.has_scatter)[:1]
    if scope.to_rest and results.rest is not None:
        asked = [one.statement for one in results.limit_states.values() if one.of_journey]
        asks_aim = scope.is_flown or any(one.radius_m is not None for one in results.limit_states.values())
        aimed = [mean_miss(results.rest.miss)] if asks_aim and results.rest.miss is not None else []
        ends = [*journey_ends(scope, results), *asked, *aimed, *rest_sentences(results.rest)]
    else:
        ends = landing_ends(scope, results)
    grounds = [*over_grounds(results.over_grounds), *by_kind(results.grounds), *finer(results.finer_ground)]
    grounds = grounds or one_ground(results.beds)
    return [*ends, *grounds, *sky(results.sky), *soils(results.soils)]


def study_headline(scope: Scope, results: "Results") -> list[str]:
    """The answer, and the most informative numbers of the first touchdown behind it."""
    behind = [*_landing_numbers(results)] if results.ends else []
    if results.expansion:
        behind += telling_sentences(results, has_scatter=scope.has_scatter)
    behind = [said for said in behind if said not in results.answer]
    if scope.to_rest:
        behind = [f"First touchdown: {said[:1].lower()}{said[1:]}" for said in behind]
    return [*results.answer, *behind]


def _landing_numbers(results: "Results") -> list[str]:
    """How the first touchdowns of the landers ended, their rebound speed, and what explains and predicts it."""
    emulator, speed, shares = results.emulator, results.spreads.get("speed_out"), results.variance_shares["speed_out"]
    return [
        touchdowns.touchdown_outcomes(results.runs.outcomes, results.runs.count, "landings"),
        *([touchdowns.output_spread("speed_out", speed)] if speed else []),
        *([touchdowns.output_variance("speed_out", shares)] if shares else []),
        *([emulator.statement] if emulator else []),
        *([f"{emulator.warning}."] if emulator and emulator.warning else []),
    ]


def page_answer(data: "PageData") -> str:
    """The answer in one sentence, as a page begins."""
    results = data.results
    if data.to_rest:
        journey = data.study["journey"]
        within = [
            f" {with_interval(shown_probability(one))} {met_words(name, one)}."
            for name, one in results.limit_states.items()
            if one.radius_m is not None
        ]
        return f"{rest_over(results, journey['duration'], journey['touchdowns'])}.{''.join(within)}"
    if data.journeys is None:
        return results.answer[0]
    alone = "other beds, impact points or attitudes would change it"
    more = f", without an interval: {alone}" if results.returns.share.lower is None else ""
    return f"{with_interval(results.returns.share, level=data.level)} of the landings {action(data)}{more}."


def action(data: "PageData") -> str:
    """What the return fraction is of: landers that do this."""
    return returning(data.study["flight"]["duration"], holds=data.results.site.holds)


def page_details(data: "PageData") -> str:
    """Where the study lands, over what its answer holds, and how the body turns."""
    returns, site = data.results.returns, data.results.site
    if data.to_rest:
        # That the site holds no lander stands among the warnings.
        said = [f"The fractions are from {journey_counts(data.results)}.", site.rotation or ""]
    elif data.journeys is None:
        said = list(data.results.answer[1:])
    else:
        over = held_over(random_attitude=data.study["impact"]["orientation"] == "random")
        begin = f"The fractions are from {returns.from_}"
        said = [f"{begin}.", returns.why] if returns.why else [f"{begin} and hold {over}."]
        said += site.sentences
    return " ".join(filter(None, [place_words(data), *said]))


def page_warnings(data: "PageData") -> list[str]:
    """What makes the numbers of the page weaker than they look; to rest, warnings of runs are of first touchdowns."""
    results = data.results
    cautions = list(results.site.cautions)
    if data.journeys is None:
        return cautions
    of_runs = landing_warnings(results, results.emulator.warning if results.emulator else None)
    if data.to_rest:
        of_runs = [f"Of the first touchdown alone: {words[:1].lower()}{words[1:]}" for words in of_runs]
        of_runs = [*([results.site.warning] if results.site.warning else []), *of_runs]
    return [*cautions, *of_runs, *rare_warnings(data.rare)]


# Words of a tile with more letters name a limit state without its condition.
LONG_TILE = 80


@dataclass(frozen=True)
class Tile:
    """One of the few numbers that a reader takes away; outcome: the word of the one that it is of, if it is of one."""

    value: str
    unit: str
    words: str
    outcome: str = ""


def page_tiles(data: "PageData") -> list[Tile]:
    """The numbers beside the answer: of the landers at rest, of their first touchdown, or of the expansion."""
    if data.to_rest and data.journeys is not None:
        return _rest_tiles(data, data.journeys)
    if data.journeys is None:
        return _expansion_tiles(data.expansion, data.results) if data.expansion else []
    return _landing_tiles(data)


def _landing_tiles(data: "PageData") -> list[Tile]:
    """Who comes to rest on hard ground, the rebound speed, and what the emulator makes of it."""
    results = data.results
    found = _hard_ground_tiles(data)
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
    band = results.emulator.scores.outputs.get("speed_out") if results.emulator else None
    if band:
        held = f"within the {percent(touchdowns.BAND)} bands of the emulator"
        words = f"of the rebound speeds on {touchdowns.left_out(results.runs.beds)} lay {held}"
        found.append(Tile(percent(band.band_90).removesuffix(" %"), "%", words))
    return found


def _hard_ground_tiles(data: "PageData") -> list[Tile]:
    """Which landers come to rest on the first ground that they were followed on; none where that was not asked."""
    limit = time_limit(data.study["journey"]["duration"])
    for ground, table in data.results.hard_ground.items():
        share, _, ends = with_interval(table.ends[JourneyEnd.AT_REST].share).partition(" %")
        lost = f"; {unknown_outcome(table.unknown)}" if table.unknown > 0.0 else ""
        return [Tile(share, "%", f"at rest within {limit} on {labels.GROUND_WORDS[ground]}{ends}{lost}")]
    return []


def _expansion_tiles(data: "PageExpansion", results: "Results") -> list[Tile]:
    """The rebound speed of an expansion, how touchdowns ended, its dominant input, and how accurate it is."""
    telling = TellingNumbers.of(data.results, results.samples)
    main, score, speed = telling.main_input, telling.score, telling.speed
    index = (
        f"{labels.input_words(main.name)}: largest total index of the rebound speed in the refined expansion"
        f"{labels.bracket(*main.interval, fixed, level=EXPANSION_LEVEL)}, without truncation error"
        f"{noise(main.noise_share)}"
    )
    ends = labels.bracket(*score.q2_interval, fixed, level=EXPANSION_LEVEL)
    accuracy = f"rebound speed, new runs, all inputs varied{ends}"
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


def _rest_tiles(data: "PageData", journeys: "PageJourneys") -> list[Tile]:
    """When and where landers rest, and the likeliest end other than that; every other end where none does.

    Where the page has the answer on each ground, the limit states alone; those within a circle stand in its first line.
    """
    count, rest = len(journeys.table["end"]), journeys.rest
    others = {name: one for name, one in data.results.ends.items() if name != JourneyEnd.AT_REST}
    states = {name: one for name, one in data.results.limit_states.items() if one.of_journey and one.radius_m is None}
    asked = [_asked(name, one) for name, one in states.items()]
    if data.results.grounds:
        return asked
    if not rest.time_s.median.is_known:
        return [*asked, *(_end(data, name, one, count) for name, one in others.items())]
    size, unit = time_unit(rest)
    likeliest = max(others, key=lambda name: (others[name].share.value, others[name].share.upper or 0.0))
    return [
        *asked,
        _quantile(rest.time_s, unit, "median time to rest", size),
        _quantile(rest.distance_m, "m", "median distance from the aim point"),
        _region(rest.regions[-1]) if rest.regions else _quantile(rest.contacts, "contacts", "median"),
        _end(data, likeliest, others[likeliest], count),
    ]


def _asked(name: str, one: "LimitStateResult") -> Tile:
    """The probability of a limit state of journeys, and where it lies on one ground."""
    found = shown_probability(one)
    interval, where = labels.share_interval(found), "" if one.over_grounds is None else ", on one ground"
    ends = f" ({interval}{where})" if interval else ""
    words = met_words(name, one)
    return Tile(labels.bare_share(found), "%", f"{words if len(words) < LONG_TILE else f'meet {name}'}{ends}")


def _region(one: "RestRegion") -> Tile:
    words = f"smallest region with {percent(one.share)} of those at rest; {labels.extent(one)}"
    return Tile(labels.area(one.area_m2).removesuffix(" m2"), "m²", words)


def _end(data: "PageData", name: str, one: "CountedShare", count: int) -> Tile:
    interval, end = labels.share_interval(one.share), labels.end_words(data.results.site)[name]
    words = f"{end}, {one.count} of {count}" + (f" ({interval})" if interval else "")
    # An end that did not occur has no colour.
    return Tile(labels.bare_share(one.share), "%", words, name if one.count else "")


def _quantile(found: "RestQuantiles", unit: str, words: str, size: float = 1.0) -> Tile:
    """A median with its interval, and the 95th percentile."""
    value, _, ends = labels.quantile(found.median, size).partition(" ")
    most = labels.quantile(found.q95, size).partition(" ")[0]
    return Tile(value, unit, f"{words} {ends}; 95 % within {most} {unit}".replace(" ;", ";"))
