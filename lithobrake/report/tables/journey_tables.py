"""The first numbers and the tables of the page of a study of journeys."""

from collections.abc import Sequence
from dataclasses import replace

from lithobrake.report.content import PageTable, Tile
from lithobrake.report.page_data import JourneyPage
from lithobrake.report.words.drawn_captions import as_sentence, interval
from lithobrake.report.words.journey_captions import END_WORDS, emulator_words, quantile_words, time_unit
from lithobrake.report.words.numbers import area, number
from lithobrake.results.journey_results import RestQuantiles
from lithobrake.results.run_results import CountedShare
from lithobrake.vocabulary.constants import MINUTE
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.percentages import LEVEL, interval_digits, percent, with_interval
from lithobrake.vocabulary.quantities import SKY_WORDS

# Tables of any drawn study that are of more than the first touchdown, and one that has another name here.
OF_ALL = ("Beds", "Sampled inputs")
RENAMED = {"The answer": "Return fraction"}


def tiles(data: JourneyPage) -> list[Tile]:
    """At rest, the likeliest other end, when and where; the share of each end where no lander rests."""
    count, ends = len(data.journeys["end"]), data.ends
    if not data.at_rest.time_s.median.is_known:
        return [_end_tile(name, one, count) for name, one in ends.items()]
    others = {name: one for name, one in ends.items() if name != JourneyEnd.AT_REST}
    other = max(others, key=lambda name: (others[name].share.value, others[name].share.upper or 0.0))
    found = [_end_tile(name, ends[name], count) for name in (JourneyEnd.AT_REST, other)]
    rest, (size, unit) = data.at_rest, time_unit(data)
    found.append(_quantile_tile(rest.time_s, unit, "median time to rest", size))
    found.append(_quantile_tile(rest.distance_m, "m", "median distance from the aim point"))
    if rest.regions:
        large = rest.regions[-1]
        words = f"smallest region with {percent(large.share)} of those at rest; "
        words += f"{number(large.largest_extent_m, 2)} m across"
        value, _, unit = area(large.area_m2).rpartition("\N{NO-BREAK SPACE}")
        found.append(Tile(value, unit, words))
    else:
        found.append(_quantile_tile(rest.contacts, "contacts", "median number of contacts"))
    return found


def _end_tile(name: str, one: CountedShare, count: int) -> Tile:
    share = one.share
    value, sure = percent(share.value, interval_digits(share.lower, share.upper)).removesuffix(" %"), interval(share)
    words = f"{END_WORDS[name]}, {one.count} of {count}" + (f" ({sure})" if sure else "")
    # An end that did not occur has no colour.
    return Tile(value, "%", words, name if one.count else "")


def _quantile_tile(found: RestQuantiles, unit: str, words: str, size: float = 1.0) -> Tile:
    """A median with its interval, and the 95th percentile."""
    value, _, ends = quantile_words(found.median, size).partition(" ")
    most = quantile_words(found.q95, size).partition(" ")[0]
    return Tile(value, unit, f"{words} {ends}; 95 % within {most} {unit}".replace("  ", " "))


def place_tables(data: JourneyPage) -> list[PageTable]:
    """Where the landers rest, and what they see from there."""
    return [_regions(data), _sky(data)]


def time_tables(data: JourneyPage) -> list[PageTable]:
    """How the landers come down first, and when and how they rest."""
    return [_numbers(data), _delivery(data)]


def _numbers(data: JourneyPage) -> PageTable:
    rest, (size, unit) = data.at_rest, time_unit(data)
    columns = ["landers at rest", "median", "95 %"]
    rows = [
        _row(f"time from the first touchdown to rest [{unit}]", rest.time_s, size),
        _row("contacts with the ground", rest.contacts),
        _row("distance from the aim point [m]", rest.distance_m),
    ]
    if rest.tilt_deg is not None:
        rows.append(_row("tilt of the side that is down [deg]", rest.tilt_deg))
    note = f"From {rest.of}; in brackets {percent(LEVEL)} intervals."
    if rest.faces:
        sides = sorted(rest.faces.items(), key=lambda one: -one[1].share.value)
        note += f" Side down: {', '.join(f'{name} {with_interval(one.share)}' for name, one in sides)}."
    has_rest = rest.time_s.median.is_known
    return PageTable("When and how they rest", columns, rows if has_rest else [], note, frozenset(columns[1:]))


def _row(words: str, found: RestQuantiles, size: float = 1.0) -> list[str]:
    return [words, quantile_words(found.median, size), quantile_words(found.q95, size)]


def _regions(data: JourneyPage) -> PageTable:
    columns = ["smallest region that holds", "area", "largest extent [m]"]
    rows = [
        [f"{percent(one.share)} of the landers at rest", area(one.area_m2), number(one.largest_extent_m, 2)]
        for one in data.at_rest.regions
    ]
    return PageTable("Where they rest", columns, rows, numbers=frozenset(columns[1:]))


def _sky(data: JourneyPage) -> PageTable:
    """What the landers at rest see of the Sun, of Earth and of the orbiter."""
    columns = ["seen", "median part of the time [%]", "5 % of the landers see less than [%]", "probability at any time"]
    columns += ["never seen by", "sides that face it most, probability", "side that most often never faces it"]
    rows = []
    for name, one in data.results.sky.items():
        best = sorted(one.side_probabilities.items(), key=lambda item: -item[1].value)[:2]
        dark = max(one.dark_sides.items(), key=lambda item: item[1].share.value, default=None)
        rows.append([
            SKY_WORDS[name], quantile_words(one.day_fraction, 0.01), quantile_words(one.day_fraction_q05, 0.01),
            with_interval(one.probability), with_interval(one.never.share),
            "; ".join(f"{side} {with_interval(value)}" for side, value in best),
            f"{dark[0]} on {with_interval(dark[1].share)}" if dark else "",
        ])  # fmt: skip
    note = (
        "Of the landers at rest, over a day of the body, the dates of the study, or the positions of the orbiter; "
        f"occultation by the ground, the rest of the shape and a partner included. In brackets {percent(LEVEL)} "
        "intervals."
    )
    return PageTable("What they see from there", columns, rows, note, frozenset(columns[1:]))


def _delivery(data: JourneyPage) -> PageTable:
    """How the landers come down first, whatever the ground does with them."""
    columns = ["first impacts", "5 %", "median", "95 %"]
    found = data.results.delivery
    if found is None:
        return PageTable("How they are delivered", columns, [])
    spreads = {
        "speed [cm/s]": [100.0 * one for one in found.speed],
        "incidence, from the normal [deg]": list(found.incidence_deg),
        "time from the delivered state [min]": [one / MINUTE for one in found.descent_s or ()],
    }
    rows = [[words, *(number(one, 3) for one in spread)] for words, spread in spreads.items() if spread]
    note = f"{found.count} of {found.of} landers touch down."
    for one in found.regions:
        note += (
            f" The smallest region with {percent(one.share)} of the first impacts covers {area(one.area_m2)} and "
            f"is {number(one.largest_extent_m, 2)} m across."
        )
    return PageTable("How they are delivered", columns, rows, note, frozenset(columns[1:]))


def side_tables(data: JourneyPage) -> list[PageTable]:
    """What becomes of the landers by the side that faces the ground when they touch down."""
    size, unit = time_unit(data)
    columns = ["side toward the ground", "first touchdowns", "at rest in the end", f"median time to rest [{unit}]"]
    columns += ["median rebound speed over impact speed", "all touchdowns", "of these at rest"]
    rows = [
        [
            one.words, str(one.landings), with_interval(one.at_rest.share), quantile_words(one.time_s, size),
            quantile_words(one.speed_ratio), str(one.touchdowns), with_interval(one.rests.share),
        ]
        for one in data.results.sides.values()
        if one.at_rest and one.time_s and one.rests
    ]  # fmt: skip
    note = (
        "The side whose axis is nearest to the normal of the ground at the impact; an edge or a corner of it touches "
        f"first. In brackets {percent(LEVEL)} intervals, of each side by itself."
    )
    return [PageTable("By the side that faces the ground", columns, rows, note, frozenset(columns[1:]))] if rows else []


def soil_tables(data: JourneyPage) -> list[PageTable]:
    """What becomes of the landers by the soil of the region that they come down in; none for a study of one soil."""
    columns = ["soil", "part of the surface", "touchdowns", "of these at rest", "journeys that end at rest there"]
    rows = [
        [
            name, percent(one.area_share), str(one.touchdowns), with_interval(one.rests.share) if one.rests else "",
            with_interval(one.at_rest.share),
        ]
        for name, one in data.results.soils.items()
    ]  # fmt: skip
    note = (
        "By the region of the study file in which a lander lands; elsewhere the soil is that of [grain]. In "
        f"brackets {percent(LEVEL)} intervals, of each region by itself."
    )
    return [PageTable("By soil", columns, rows, note, frozenset(columns[1:]))] if rows else []


def sure_tables(data: JourneyPage) -> list[PageTable]:
    """How the journeys ended, by landings and by the emulator."""
    return [_ends(data)]


def first_tables(found: Sequence[PageTable]) -> list[PageTable]:
    """Tables of a drawn study under titles that say that they are of first touchdowns, where they are."""
    return [_of_first(table) for table in found]


def _ends(data: JourneyPage) -> PageTable:
    columns = ["end", "journeys", f"share ({percent(LEVEL)} interval)", "touchdowns each"]
    emulated = data.results.emulated
    by_emulator = emulated.ends if emulated else {}
    columns += ["by the emulator"] if by_emulator else []
    ended, touchdowns = data.journeys["end"], data.journeys["touchdowns"]
    rows = []
    for name, one in data.ends.items():
        each = number(float(touchdowns[ended == name].mean()), 2) if one.count else ""
        beside = [with_interval(by_emulator[name].share)] if by_emulator else []
        rows.append([END_WORDS[name], str(one.count), with_interval(one.share), each, *beside])
    why = next((one.share.why_missing for one in data.ends.values() if one.share.why_missing), None)
    said = [f"{JourneyEnd(name).label}: {JourneyEnd(name).sentence}" for name, one in data.ends.items() if one.count]
    more = [*([as_sentence(why)] if why else []), *emulator_words(data)]
    note = " ".join([f"{words[:1].upper()}{words[1:]}" for words in said] + more)
    return PageTable("How the journeys ended", columns, rows, note, frozenset(columns[1:]))


def _of_first(table: PageTable) -> PageTable:
    """A table of a drawn study under a title that says that it is of the first touchdown, where it is."""
    if table.title in OF_ALL:
        return table
    title = RENAMED.get(table.title, table.title)
    return replace(table, title=f"First touchdown: {title[:1].lower()}{title[1:]}")
