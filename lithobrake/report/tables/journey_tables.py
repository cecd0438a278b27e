"""Tables of the drawn landers: their delivery, ends and rest, what they see, and their soils and sides."""

from lithobrake.report.content import PageTable
from lithobrake.results.journey_results import RestQuantiles
from lithobrake.results.page_data import PageData, PageJourneys
from lithobrake.statements import notes
from lithobrake.statements.grounds import sizes
from lithobrake.statements.journeys import sides_down, time_unit
from lithobrake.statements.labels import end_words, quantile
from lithobrake.vocabulary.constants import MINUTE
from lithobrake.vocabulary.number_words import LEVEL, at_level, number, percent, with_interval
from lithobrake.vocabulary.quantities import SKY_WORDS


def rest_table(journeys: PageJourneys) -> PageTable:
    """When and how the landers rest."""
    rest, (size, unit) = journeys.rest, time_unit(journeys.rest)
    columns = ["landers at rest", "median", "95 %"]
    rows = [
        _row(f"time from the first touchdown to rest [{unit}]", rest.time_s, size),
        _row("contacts with the ground", rest.contacts),
        _row("distance from the aim point [m]", rest.distance_m),
    ]
    if rest.tilt_deg is not None:
        rows.append(_row("tilt of the side that is down [deg]", rest.tilt_deg))
    note = notes.journeys_at_rest(rest)
    has_rest = rest.time_s.median.is_known
    return PageTable("When and how they rest", columns, rows if has_rest else [], note, frozenset(columns[1:]))


def _row(words: str, found: RestQuantiles, size: float = 1.0) -> list[str]:
    return [words, quantile(found.median, size), quantile(found.q95, size)]


def sky_table(data: PageData) -> PageTable:
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


def delivery_table(data: PageData) -> PageTable:
    """How the landers come down first, whatever the ground does with them."""
    columns = ["first impacts", "5 %", "median", "95 %"]
    found = data.results.delivery
    if found is None or not (data.to_rest or data.study["delivery"]):
        return PageTable("How they are delivered", columns, [])
    spreads = {
        "speed [cm/s]": [100.0 * one for one in found.speed],
        "incidence, from the normal [deg]": list(found.incidence_deg),
        "time from the delivered state [min]": [one / MINUTE for one in found.descent_s or ()],
    }
    rows = [[words, *(number(one, 3) for one in spread)] for words, spread in spreads.items() if spread]
    return PageTable("How they are delivered", columns, rows, notes.delivery(found), frozenset(columns[1:]))


def sides_table(data: PageData, journeys: PageJourneys) -> PageTable:
    """What becomes of the landers by the side that faces the ground when they touch down."""
    size, unit = time_unit(journeys.rest)
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
    return PageTable("By the side that faces the ground", columns, rows, note, frozenset(columns[1:]))


def grounds_table(data: PageData, journeys: PageJourneys) -> PageTable:
    """What becomes of the landers on each kind of ground; none for a study of one ground."""
    size, unit = time_unit(journeys.rest)
    columns = ["kind of ground", "probability", "beds", "grains [m]", "journeys", "at rest", f"median time [{unit}]"]
    columns += ["median distance [m]", "side down"]
    rows = [
        [
            name, percent(one.weight), str(one.beds), sizes(one.grain_size_m), str(one.journeys),
            with_interval(one.at_rest.share), quantile(one.time_s, size), quantile(one.distance_m),
            sides_down(one.faces),
        ]
        for name, one in data.results.grounds.items()
    ]  # fmt: skip
    over = data.results.over_grounds
    if over is not None and rows:
        sides = ", ".join(f"{face} {with_interval(one)}" for face, one in over.faces.items())
        last = [with_interval(over.at_rest), quantile(over.time_s, size), quantile(over.distance_m), sides]
        rows.append(["one of these, unknown which", percent(1.0), "", "", "", *last])
    return PageTable("By kind of ground", columns, rows, notes.grounds(), frozenset(columns[1:]))


def soils_table(data: PageData) -> PageTable:
    """What becomes of the landers by the soil of the region that they come down in; none for a study of one soil."""
    columns = ["soil", "part of the surface", "touchdowns", "of these at rest", "journeys that end at rest there"]
    rows = [
        [
            name, percent(one.area_share), str(one.touchdowns), with_interval(one.rests.share) if one.rests else "",
            with_interval(one.at_rest.share),
        ]
        for name, one in data.results.soils.items()
    ]  # fmt: skip
    return PageTable("By soil", columns, rows, notes.soils(), frozenset(columns[1:]))


def ends_table(data: PageData, journeys: PageJourneys) -> PageTable:
    """How the journeys ended, by landings and by the emulator."""
    columns = ["end", "journeys", f"share ({at_level()})", "touchdowns each"]
    emulated = data.results.emulated
    by_emulator = emulated.ends if emulated else {}
    columns += ["by the emulator"] if by_emulator else []
    ended, touchdowns = journeys.table["end"], journeys.table["touchdowns"]
    rows, words = [], end_words(data.results.site)
    for name, one in data.results.ends.items():
        each = number(float(touchdowns[ended == name].mean()), 2) if one.count else ""
        beside = [with_interval(by_emulator[name].share)] if by_emulator else []
        rows.append([words[name], str(one.count), with_interval(one.share), each, *beside])
    return PageTable("How the journeys ended", columns, rows, notes.ends(data.results), frozenset(columns[1:]))
