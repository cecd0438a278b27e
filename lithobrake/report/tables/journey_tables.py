"""The tables of the page of a study of journeys."""

from collections.abc import Sequence
from dataclasses import replace

from lithobrake.report.content import PageTable
from lithobrake.results.journey_results import RestQuantiles
from lithobrake.results.page_data import JourneyPage
from lithobrake.statements import notes
from lithobrake.statements.journeys import time_unit
from lithobrake.statements.labels import END_WORDS, area, quantile, two_digits
from lithobrake.vocabulary.constants import MINUTE
from lithobrake.vocabulary.number_words import LEVEL, at_level, number, percent, with_interval
from lithobrake.vocabulary.quantities import SKY_WORDS

# Tables of any drawn study that are of more than the first touchdown, and one that has another name here.
OF_ALL = ("Beds", "Sampled inputs")
RENAMED = {"The answer": "Return fraction"}


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
    note = notes.journeys_at_rest(data)
    has_rest = rest.time_s.median.is_known
    return PageTable("When and how they rest", columns, rows if has_rest else [], note, frozenset(columns[1:]))


def _row(words: str, found: RestQuantiles, size: float = 1.0) -> list[str]:
    return [words, quantile(found.median, size), quantile(found.q95, size)]


def _regions(data: JourneyPage) -> PageTable:
    columns = ["smallest region of landers at rest that holds", "area", "largest extent [m]"]
    rows = [[percent(one.share), area(one.area_m2), two_digits(one.largest_extent_m)] for one in data.at_rest.regions]
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
            SKY_WORDS[name], quantile(one.day_fraction, 0.01), quantile(one.day_fraction_q05, 0.01),
            with_interval(one.probability), with_interval(one.never.share),
            "; ".join(f"{side} {with_interval(value)}" for side, value in best),
            f"{dark[0]} on {with_interval(dark[1].share)}" if dark else "",
        ])  # fmt: skip
    return PageTable("What they see from there", columns, rows, notes.sky(), frozenset(columns[1:]))


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
    return PageTable("How they are delivered", columns, rows, notes.delivery(data), frozenset(columns[1:]))


def side_tables(data: JourneyPage) -> list[PageTable]:
    """What becomes of the landers by the side that faces the ground when they touch down."""
    size, unit = time_unit(data)
    columns = ["side toward the ground", "first touchdowns", "at rest in the end", f"median time to rest [{unit}]"]
    columns += ["median rebound speed over impact speed", "all touchdowns", "of these at rest"]
    rows = [
        [
            one.words, str(one.landings), with_interval(one.at_rest.share), quantile(one.time_s, size),
            quantile(one.speed_ratio), str(one.touchdowns), with_interval(one.rests.share),
        ]
        for one in data.results.sides.values()
        if one.at_rest and one.time_s and one.rests
    ]  # fmt: skip
    note = notes.sides(LEVEL)
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
    return [PageTable("By soil", columns, rows, notes.soils(), frozenset(columns[1:]))] if rows else []


def sure_tables(data: JourneyPage) -> list[PageTable]:
    """How the journeys ended, by landings and by the emulator."""
    return [_ends(data)]


def first_tables(found: Sequence[PageTable]) -> list[PageTable]:
    """Tables of a drawn study under titles that say that they are of first touchdowns, where they are."""
    return [_of_first(table) for table in found]


def _ends(data: JourneyPage) -> PageTable:
    columns = ["end", "journeys", f"share ({at_level()})", "touchdowns each"]
    emulated = data.results.emulated
    by_emulator = emulated.ends if emulated else {}
    columns += ["by the emulator"] if by_emulator else []
    ended, touchdowns = data.journeys["end"], data.journeys["touchdowns"]
    rows = []
    for name, one in data.ends.items():
        each = number(float(touchdowns[ended == name].mean()), 2) if one.count else ""
        beside = [with_interval(by_emulator[name].share)] if by_emulator else []
        rows.append([END_WORDS[name], str(one.count), with_interval(one.share), each, *beside])
    return PageTable("How the journeys ended", columns, rows, notes.ends(data), frozenset(columns[1:]))


def _of_first(table: PageTable) -> PageTable:
    """A table of a drawn study under a title that says that it is of the first touchdown, where it is."""
    if table.title in OF_ALL:
        return table
    title = RENAMED.get(table.title, table.title)
    return replace(table, title=f"First touchdown: {title[:1].lower()}{title[1:]}")
