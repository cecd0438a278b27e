"""The sentences of the page of a study of journeys, from the numbers of its summary. They are plain text."""

from lithobrake.report.page_data import JourneyPage
from lithobrake.report.words.captions import place_words
from lithobrake.report.words.drawn_captions import detected_words, floor_words, landing_warnings, variance
from lithobrake.report.words.numbers import area, number
from lithobrake.vocabulary.constants import HOUR, MINUTE
from lithobrake.vocabulary.durations import hours
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.percentages import LEVEL, percent, with_interval

# How a journey ended, as short as it has to be in a legend.
END_WORDS: dict[str, str] = {end.value: end.label for end in JourneyEnd}
FIRST = "Of the first touchdown alone"
# What the ends of journeys vary in, in a sentence and as rows of a figure.
END_SIGNS = {
    "at_rest": "whether a lander comes to rest",
    "time_s": "the time to rest",
    "distance_m": "the distance from the aim point",
}  # fmt: skip
END_ROWS = {"at_rest": "at rest or not", "time_s": "time to rest", "distance_m": "distance from\nthe aim point"}


def answer(data: JourneyPage) -> str:
    """How many landers come to rest, in one line."""
    at_rest = data.ends[JourneyEnd.AT_REST].share
    level = None if at_rest.lower is None else LEVEL
    return f"{with_interval(at_rest, level=level)} of the landers come to rest within {_limit(data)}."


def details(data: JourneyPage) -> list[str]:
    """Where the study lands, and the whole answer."""
    return [" ".join([*place_words(data), *data.results.answer])]


def journey_warnings(data: JourneyPage) -> list[str]:
    """What makes the numbers of the page weaker than they look; those of runs are of first touchdowns."""
    site = data.results.site.warning
    return [
        *([site] if site else []),
        *(f"{FIRST}: {words[:1].lower()}{words[1:]}" for words in landing_warnings(data)),
    ]


def has_places(data: JourneyPage) -> bool:
    """Whether any lander ended on the ground of the body."""
    return any(data.ends[end].count for end in (JourneyEnd.AT_REST, JourneyEnd.UNDER_WAY))


def rest_map(data: JourneyPage) -> str:
    """The map about the aim point."""
    if not has_places(data):
        return ""
    rest, said = data.at_rest, []
    if rest.regions:
        areas = " and ".join(f"{percent(one.share)} ({area(one.area_m2)})" for one in rest.regions)
        said.append(
            f"Smallest regions that hold {areas} of the landers at rest, from a density fitted to their positions."
        )
    elif rest.why_no_regions:
        said.append(f"No regions are drawn: {rest.why_no_regions.rstrip('.')}.")
    said += _delivery(data)
    if len(data.results.soils) > 1:
        said.append("Dotted: boundaries of soil regions, to within a degree.")
    return " ".join(said) or "Each dot is a lander."


def outcomes(data: JourneyPage, *, has_map: bool) -> str:
    """The shares of the ends; has_map: whether the whole body stands beside them."""
    if not has_places(data):
        return ""
    total = len(data.journeys["end"])
    at_rest = with_interval(data.ends[JourneyEnd.AT_REST].share)
    words = f"{at_rest} of {total} landers come to rest within {_limit(data)}."
    if not has_map:
        return words
    return (
        f"{words} Map: the whole body in equal areas, on a sphere of the radius at the aim point; landers that "
        "escaped, landed on the partner or failed are not on it."
    )


def _delivery(data: JourneyPage) -> list[str]:
    """The regions of the first impacts, where there are any."""
    found = data.results.delivery
    if found is None or not found.regions:
        return []
    large = found.regions[-1]
    return [f"Blue: the same for the first impacts; {percent(large.share)} lie within {area(large.area_m2)}."]


def times(data: JourneyPage) -> str:
    """The figure of times and distances."""
    time, distance = data.at_rest.time_s, data.at_rest.distance_m
    if not (time.median.is_known and distance.median.is_known):
        return ""
    size, unit = time_unit(data)
    return (
        f"Time from the first touchdown to rest: median {quantile_words(time.median, size)} {unit}, 95 % within "
        f"{quantile_words(time.q95, size)} {unit}. Distance from the aim point: median "
        f"{quantile_words(distance.median)} m, 95 % within {quantile_words(distance.q95)} m. Dots: median and 95th "
        f"percentile; bars: their {percent(LEVEL)} intervals over beds and impact points, dotted where a bound is "
        "unknown."
    )


def counts(data: JourneyPage) -> str:
    """The figure of touchdowns and contacts."""
    total, journeys = data.journeys["touchdowns"].sum(), len(data.journeys["end"])
    contacts = data.at_rest.contacts.median
    said = (
        f"{journeys} journeys with {total:.0f} touchdowns, {number(total / journeys, 2)} each. A touchdown is one "
        "simulated landing and may have several contacts with hops between them."
    )
    if not contacts.is_known:
        return said
    return f"{said} Landers at rest: median {quantile_words(contacts)} contacts."


def attitude(data: JourneyPage) -> str:
    """The figure of sides and tilts."""
    tilt = data.at_rest.tilt_deg
    if not data.at_rest.faces or tilt is None or not tilt.median.is_known:
        return ""
    name, most = max(data.at_rest.faces.items(), key=lambda one: one[1].share.value)
    return (
        f"The side {name} is down most often, for {with_interval(most.share)} of the landers at rest. Tilt of its "
        f"axis from the plumb line: median {quantile_words(tilt.median)} deg, 95th percentile "
        f"{quantile_words(tilt.q95)} deg. Brackets and bars: {percent(LEVEL)} intervals."
    )


def end_variance(data: JourneyPage) -> str:
    """The figure of what decides the ends; empty where the journeys cannot tell."""
    known = {name: one for name, one in data.results.end_variance_shares.items() if one}
    said = [
        f"Parts of the variance of {END_SIGNS[name]} ({one.of}): {detected_words(one)} ({percent(LEVEL)} intervals)."
        for name, one in known.items()
    ]
    if said:
        said.append(
            "Delivery: position and velocity of the first impact, without attitude. Everything else includes all later "
            "touchdowns."
        )
        said.append(floor_words(next(iter(known.values()))))
    return " ".join(said)


def first_variance(data: JourneyPage) -> str:
    """The figure of the parts of the variance; empty where it has none."""
    if not any(data.results.variance_shares.values()):
        return ""
    said = variance(data)
    correlations = (data.study.get("delivery") or {}).get("correlations") or ()
    pairs = ", ".join(f"{one} with {other}" for one, other, _ in correlations)
    if pairs:
        said += f" The parts assume independent inputs, but {pairs} are correlated: read their parts together."
    return said


def emulator_words(data: JourneyPage) -> list[str]:
    """Whether the emulator of the touchdowns agrees with the landings, and what it does for the shares."""
    found = data.results.emulated
    if found is None or not found.statement:
        return []
    control = found.control
    if control is None or not control.is_used:
        return [found.statement]
    half, narrow = (percent(one) for one in (control.half_width, control.half_width_with))
    return [
        found.statement,
        f"As a control variate it narrows the interval of the fraction at rest from +- {half} to +- {narrow}, so the "
        "fraction may differ slightly from the count.",
    ]


def quantile_words(one: Estimate, size: float = 1.0) -> str:
    """A quantile with its interval, "27 (23-32)", or with the bound that is known."""
    value = number(one.value / size if one.is_known else 0.0, 2)
    low, high = ("" if end is None else number(end / size, 2) for end in (one.lower, one.upper))
    if low and high:
        return f"{value} ({low}-{high})"
    return f"{value} (at least {low})" if low else f"{value} (at most {high})" if high else value


def time_unit(data: JourneyPage) -> tuple[float, str]:
    """The unit of times to rest [s], and its sign: minutes where nearly all are below five hours."""
    late = data.at_rest.time_s.q95
    return (HOUR, "h") if late.is_known and late.value >= 5.0 * HOUR else (MINUTE, "min")


def _limit(data: JourneyPage) -> str:
    return hours(data.study["journey"]["duration"])
