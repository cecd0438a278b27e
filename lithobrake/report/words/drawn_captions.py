"""The sentences of the page of a drawn study, and what a reader has to beware of."""

from collections.abc import Mapping

from lithobrake.report.page_data import DrawnPage, PageData, RunsPage
from lithobrake.report.words.captions import BAND, band_luck, input_words, listing, thousands, unlucky
from lithobrake.report.words.labels import output, part_words
from lithobrake.report.words.numbers import number
from lithobrake.results.questions import AimResults, RareLimitState
from lithobrake.results.run_results import VarianceParts
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.outcomes import RETURNS, TouchdownOutcome
from lithobrake.vocabulary.percentages import QUANTILE_WORDS, interval_digits, part, percent, span

# With fewer beds intervals are wide, and how much beds differ is hardly known.
FEW_BEDS = 12


def has_interval(data: PageData) -> bool:
    """Whether the runs tell how sure the share is."""
    return data.results.returns.share.lower is not None


def interval(entry: Estimate) -> str:
    """The interval of an entry with its level, "90 % interval 68-73 %"; empty where it has none."""
    return "" if entry.bounds is None else f"{percent(entry.level)} interval {span(*entry.bounds)}"


def drawn_things(data: RunsPage) -> list[str]:
    """What every run draws for itself beside its soil."""
    impact = data.study["impact"]
    place = impact["place"] or {}
    has_place = impact["region"] is not None or any(isinstance(one, Mapping) for one in place.values())
    found = {
        "impact point": has_place,
        "azimuth": impact["azimuth_deg"] == "random",
        "attitude": impact["orientation"] == "random",
    }
    return [words for words, is_drawn in found.items() if is_drawn]


def as_sentence(words: str) -> str:
    """Words with a capital, which a dotted key at their beginning does not take, and a full stop."""
    first = words[:1] if "." in words.split(" ", 1)[0] else words[:1].upper()
    return f"{first}{words[1:].rstrip('.')}."


def left_out(data: RunsPage) -> str:
    """What the emulator was validated on: beds that it had not seen, or, where there is but one, runs."""
    return "held-out runs" if data.results.runs.beds == 1 else "held-out beds"


def outcome_label(word: str) -> str:
    """How a run ended, in a few words."""
    return TouchdownOutcome(word).label if word in list(TouchdownOutcome) else word


def missing_sentence(data: RunsPage) -> str:
    """How many runs have no outcome, and between which shares the truth then lies; empty where all have one."""
    missing, returns = data.results.runs.missing, data.results.returns
    if not missing.count:
        return ""
    kinds = listing([f"{number} {outcome_label(word)}" for word, number in missing.outcomes.items()])
    ends = returns.if_missing
    low, high = (percent(end, interval_digits(*ends)) for end in ends)
    return (
        f"{missing.count} of {data.results.runs.count} landings have no outcome ({kinds}): the return "
        f"fraction is {low} if none of these return, {high} if all do."
    )


def warnings(data: DrawnPage) -> list[str]:
    """What makes the numbers of the page weaker than they look."""
    return [*landing_warnings(data, emulator_outside(data)), *rare_warnings(data.rare)]


def landing_warnings(data: RunsPage, outside: str = "") -> list[str]:
    """What makes the numbers of the landings weaker than they look; outside: that an emulator contradicts them."""
    runs, site = data.results.runs, data.results.site
    return [words for words in (_said(runs.warning), _few_beds(data), outside, _said(site.gravity_warning)) if words]


def _few_beds(data: RunsPage) -> str:
    beds = data.results.runs.beds
    if not has_interval(data) or beds >= FEW_BEDS:
        return ""
    return (
        f"The study has only {beds} beds: intervals are wide, and the variance between beds is poorly known. Set "
        f"bed.bed_count to {FEW_BEDS} or more."
    )


def emulator_outside(data: DrawnPage) -> str:
    """That the emulator contradicts the runs it was made from, if it does."""
    return _said(data.emulator.warning)


def _said(warning: str | None) -> str:
    return as_sentence(warning) if warning else ""


def rare_warnings(rare: Mapping[str, RareLimitState]) -> list[str]:
    """Where the same with another seed may give quite another probability."""
    return [f"{name}: {found.warning}" for name, found in rare.items() if found.warning]


# An input with more than this part of what the soil does is named.
MAIN = 0.5


def output_words(name: str) -> str:
    """An output, or the return fraction, in words."""
    return "return fraction" if name == RETURNS else output(name).words


def runs(data: RunsPage) -> str:
    """What the landings gave."""
    table = data.results.runs
    beds, outcomes = table.beds, table.outcomes
    own = listing(["soil", *drawn_things(data)])
    clear, captured = (outcomes.get(word, 0) for word in (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED))
    said = [
        f"Every dot is a landing with {own} of its own"
        + (", all on one bed" if beds == 1 else f", on one of {beds} beds")
        + f": of {table.count} landers {clear} left the surface and {captured} "
        f"{'was' if captured == 1 else 'were'} captured."
    ]
    quantiles = _quantiles(data)
    if quantiles:
        said.append(f"{quantiles}.")
    if table.over_rim:
        said.append(f"{table.over_rim} of these left across the edge of the bed, in flight (rings).")
    said.append(missing_sentence(data))
    record = data.results.variance_shares["speed_out"]
    if record:
        said.append(f"Right: the same speeds by bed; share of their variance between beds: {part(record.bed)}.")
    return " ".join(filter(None, said))


def _quantiles(data: RunsPage) -> str:
    """Median with its interval, and the middle nine tenths, of speed and elevation."""
    found = []
    for name in ("speed_out", "elevation_out"):
        if name in data.results.spreads:
            levels, shown = data.results.spreads[name].quantiles, output(name)
            low, middle, high = (levels[level].value * shown.factor for level in QUANTILE_WORDS)
            ends = _ends(data, levels["0.5"], shown.factor)
            found.append(
                f"the median {shown.words} is {number(middle)} {shown.unit}{ends}, "
                f"with 90 % of the landings between {number(low)} and {number(high)} {shown.unit}"
            )
    words = "; ".join(found)
    return f"{words[:1].upper()}{words[1:]}"


def _ends(data: RunsPage, entry: Estimate, factor: float) -> str:
    """The interval of a number in brackets, where it has one."""
    ends = " to ".join(number(end * factor) for end in entry.bounds or ())
    return f" ({percent(data.level)} interval {ends})" if ends else ""


def variance(data: RunsPage) -> str:
    """What decides."""
    records = {name: record for name, record in data.results.variance_shares.items() if record}
    if not records:
        return "The sources of the scatter cannot be separated: the runs are on one bed, or too few for their inputs."
    first, *others = records
    said = [
        f"Parts of the variance of the {output_words(first)} over the input distributions of the study file: "
        f"{scatter_words(records[first])} ({percent(data.level)} intervals)."
    ]
    if others:
        soils = [f"{part(records[name].soil)} of the {output_words(name)}" for name in others]
        said.append(f"Soil, at least: {listing(soils)}.")
    said.append(floor_words(records[first]))
    if all(record.chaos is None for record in records.values()):
        said.append("Without auxiliary runs chaos is not separated from everything else.")
    return " ".join(said)


def floor_words(record: VarianceParts) -> str:
    """Of which degree the parts are lower bounds, and for which ranges."""
    doubled = record.soil_doubled
    explains = f"at least {part(doubled)}" if doubled.value > 0.0 else part(doubled)
    return (
        f"Soil, delivery and attitude: {record.terms}, for the ranges of the study file; their other effects "
        f"are in everything else. Soil with ranges twice as wide: {explains}."
    )


# Parts that are not detected.
NAMES = {"soil": "soil", "arrival": "delivery", "attitude": "attitude", "bed": "bed"}


def scatter_words(record: VarianceParts) -> str:
    """What explains the variance of an output, in a part of a sentence with intervals."""
    words = {"soil": "soil at least"}
    found = []
    for name, share in record.parts.items():
        more = _main_input(record) if name == "soil" else ""
        whose = words.get(name, part_words(record, name).replace(", chaos", " with chaos").replace(",", ""))
        # What is not detected is not "at least" so much.
        found.append(f"{whose if share.value > 0.0 else NAMES.get(name, whose)} {part(share, more)}")
    return listing(found)


def detected_words(record: VarianceParts) -> str:
    """What of an output's variance is detected, likewise, but for everything else."""
    detected = {name: one for name, one in record.parts.items() if one.value > 0.0 and name != "place"}
    if not detected:
        return "none is detected"
    whose = [
        f"{NAMES.get(name, name)}{' at least' if name != 'bed' else ''} {part(one)}" for name, one in detected.items()
    ]
    return listing(whose)


def _main_input(record: VarianceParts) -> str:
    """Which input makes most of what the soil does, where one does and the soil does something."""
    alone = {name: share.value for name, share in record.soil_by_input.items()}
    name = max(alone, key=lambda one: alone[one], default="")
    is_main = bool(name) and alone[name] > MAIN * record.soil.value and (record.soil_by_input[name].lower or 0.0) > 0.0
    return f"; most of it {input_words(name)}" if is_main else ""


def calibration(data: DrawnPage) -> str:
    """Whether to believe the emulator."""
    emulator = data.emulator
    scores = emulator.scores.outputs
    held = {name: score.band_90 for name, score in scores.items()}
    bins = [is_beyond for score in scores.values() for is_beyond in unlucky(score.pit)]
    shares = [f"{percent(share)} of {output_words(name)}" for name, share in held.items()]
    said = [
        f"On {left_out(data)} the {percent(BAND)} bands contained {listing(shares)}.",
        "For a calibrated emulator the histogram is flat; the grey band covers 90 % of the sampling fluctuation of "
        "independent runs. High ends indicate bands that are too narrow, a hump in the middle bands that are too wide, "
        "and a slope a bias.",
        f"{sum(bins)} of {len(bins)} bars lie outside the grey band{' (orange)' if any(bins) else ''}; chance alone "
        f"gives {number(0.1 * len(bins), 2)}.",
    ]
    lucky = {name: band_luck(sum(score.pit)) for name, score in scores.items()}
    for words, off in (
        ("too narrow", [output_words(name) for name, share in held.items() if share < lucky[name][0]]),
        ("too wide", [output_words(name) for name, share in held.items() if share > lucky[name][1]]),
    ):
        if off:
            said.append(f"The bands of {listing(off)} are {words}, by more than chance explains.")
    return " ".join([*said, emulator.statement])


def samples(data: DrawnPage) -> str:
    """What may come out."""
    outcome = data.samples["outcome"]
    total, leaving = len(outcome), int((outcome == TouchdownOutcome.CLEAR).sum())
    if not leaving:
        return f"None of the {thousands(total)} samples leaves the surface, so there is nothing to draw."
    count = f"Of {thousands(total)} samples of the emulator {thousands(leaving)} leave the surface; dots are the runs."
    return " ".join(filter(None, [count, emulator_outside(data)]))


def aims(data: RunsPage, table: AimResults) -> str:
    """The figure of the aims."""
    crossed = " Options that the limits exclude are crossed out." if table.within else ""
    return (
        f"{table.statement} {thousands(table.lander_count)} landers at each delivery option, followed until they rest; "
        f"below each number its {percent(data.level)} interval. Dotted frames: options that cannot be distinguished "
        f"from the best, which has a full frame.{crossed}"
    )


def rare_caption(rare: Mapping[str, RareLimitState]) -> str:
    """The sentence of the figure."""
    named = ", ".join(f"{name} ({found.condition})" for name, found in rare.items())
    level = percent(next(iter(rare.values())).probability.level)
    return (
        f"Subset simulation with landings of {named}: each point is a level, and the next level starts "
        f"from the landings beyond its threshold; at 0 the limit state is reached. Bars are {level} intervals."
    )
