"""Touchdowns in sentences: how they ended, their rebounds, what explains these, and what their emulator is worth."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from lithobrake.statements import labels
from lithobrake.statements.ends import missing_landings
from lithobrake.vocabulary.constants import CENTIMETRES
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import (
    counted,
    intervals,
    listing,
    number,
    out_of,
    part,
    percent,
    span,
    thousands,
    with_interval,
)
from lithobrake.vocabulary.outcomes import TouchdownOutcome

if TYPE_CHECKING:
    from lithobrake.results.model_results import EmulatorResults, SampleResults
    from lithobrake.results.page_data import PageData
    from lithobrake.results.run_results import OutputEstimate, ReturnFraction, VarianceParts
    from lithobrake.results.summary import Results
    from lithobrake.vocabulary.landing_fraction import LandingFraction

ELEVATION = "elevation_out"
# An input with more than this part of what the soil does is named.
MAIN = 0.5
# Parts that are not detected, and those of which only terms of first and second degree are seen.
NAMES = {"soil": "soil", "arrival": "delivery", "attitude": "attitude", "bed": "bed"}
NO_FLIGHTS = "The return fraction is not known yet: it takes flights."
# Half of the middle nine tenths of a normal distribution, in standard deviations.
NINE_TENTHS = 1.645
# What the bands of the emulator should hold of the runs (band_90 of its scores).
BAND = 0.9


def touchdown_outcomes(ended: Mapping[str, int], total: int, what: str) -> str:
    """How touchdowns ended; ended: those of each outcome; total: of all with an outcome; what: they are."""
    left, *others = TouchdownOutcome
    found = [f"{out_of(ended.get(left, 0), total, what)} {left.label}"]
    found += [f"{ended[one]} {labels.RUN_WORDS[one]}" for one in (*others, labels.FAILED) if ended.get(one)]
    return f"{'; '.join(found)}."


def rebound_speed(of: str, quantiles: Mapping[str, float], interval: str = "") -> str:
    """Median and middle nine tenths of the rebound speed [m/s]; interval: of the median, in brackets."""
    shown = [CENTIMETRES * one for one in quantiles.values()]
    return labels.spread(f"Rebound speed of {of}", shown, "cm/s", interval)


def output_spread(name: str, one: "OutputEstimate") -> str:
    """Median with its interval and middle nine tenths of an output over the landings that have it."""
    shown, middle = labels.output(name), one.quantiles["0.5"]
    unit, factor = ("cm/s", CENTIMETRES) if shown.unit == "m/s" else (shown.unit, shown.factor)
    ends = middle.on_scale(lambda value: value * factor)
    words = f"{shown.words[:1].upper()}{shown.words[1:]} of {one.of}"
    values = [found.value * factor for found in one.quantiles.values()]
    return labels.spread(words, values, unit, labels.bracket(ends.lower, ends.upper, level=ends.level))


def runs(data: "PageData") -> str:
    """The figure of the landings: what they gave."""
    table = data.results.runs
    own = listing(["soil", *drawn_things(data.study)])
    where = "all on one bed" if table.beds == 1 else f"on one of {table.beds} beds"
    said = [f"Every dot is a landing with {own} of its own, {where}."]
    said.append(touchdown_outcomes(table.outcomes, table.count, "landings"))
    said += [output_spread(name, one) for name, one in data.results.spreads.items() if name in ("speed_out", ELEVATION)]
    if table.over_rim:
        said.append(f"Rings: {counted(table.over_rim, 'lander')} that left across the edge of the bed, in flight.")
    record = data.results.variance_shares["speed_out"]
    if record:
        said.append(f"Right: the same speeds by bed; share of their variance between beds: {part(record.bed)}.")
    return " ".join(said)


def drawn_things(study: Mapping[str, Any]) -> list[str]:
    """What every run draws for itself beside its soil; study: the tables of its file."""
    impact = study["impact"]
    place = impact["place"] or {}
    has_place = impact["region"] is not None or any(isinstance(one, Mapping) for one in place.values())
    found = {
        "impact point": has_place,
        "azimuth": impact["azimuth_deg"] == "random",
        "attitude": impact["orientation"] == "random",
    }
    return [words for words, is_drawn in found.items() if is_drawn]


def run_outcomes(results: "Results") -> str:
    """On how many beds the runs were made, and what those without an outcome could change."""
    return " ".join([f"On {counted(results.runs.beds, 'bed')}.", *missing_landings(results.runs, results.returns)])


def output_variance(name: str, record: "VarianceParts") -> str:
    """Parts of the variance of an output with their intervals, in a sentence."""
    whole = f"the {labels.output_words(name)} over the input distributions of the study file"
    return f"Parts of the variance of {whole}: {all_parts(record)} ({intervals()})."


def variance(results: "Results") -> str:
    """Caption of the figure of the parts of the variance, which shows them with their intervals."""
    records = {name: record for name, record in results.variance_shares.items() if record}
    if not records:
        return "The sources of the scatter cannot be separated: the runs are on one bed, or too few for their inputs."
    said = ["Parts of the variance of the first touchdown over the input distributions of the study file."]
    first = next(iter(records))
    said.append(floor_words(f"the {labels.output_words(first)}", records[first]))
    if all(record.chaos is None for record in records.values()):
        said.append("Without auxiliary runs chaos is not separated from everything else.")
    return " ".join(said)


def floor_words(what: str, record: "VarianceParts") -> str:
    """Of which degree the parts are lower bounds, and the part of the soil of what with wider ranges."""
    doubled = record.soil_doubled
    explains = f"at least {part(doubled)}" if doubled.value > 0.0 else part(doubled)
    return (
        f"Soil, delivery and attitude: {record.terms}; their other effects are in everything else. Soil with ranges "
        f"twice as wide ({what}): {explains}."
    )


def all_parts(record: "VarianceParts") -> str:
    """Every part of an output's variance with its interval."""
    found = []
    for name, one in record.parts.items():
        more = _main_input(record) if name == "soil" else ""
        whose = labels.part_words(record, name).replace(", chaos", " with chaos").replace(",", "")
        # What is not detected is not "at least" so much.
        found.append(f"{whose if one.value > 0.0 else NAMES.get(name, whose)} {part(one, more)}")
    return listing(found)


def _main_input(record: "VarianceParts") -> str:
    """Which input makes most of what the soil does, where one does and the soil does something."""
    alone = {name: one.value for name, one in record.soil_by_input.items()}
    name = max(alone, key=lambda one: alone[one], default="")
    is_main = bool(name) and alone[name] > MAIN * record.soil.value and (record.soil_by_input[name].lower or 0.0) > 0.0
    return f"; most of it {labels.input_words(name)}" if is_main else ""


def left_out(bed_count: int) -> str:
    """What an emulator was validated on: beds that it had not seen, or, where there is but one, runs."""
    return "held-out runs" if bed_count == 1 else "held-out beds"


def so_far(captured: "LandingFraction", speed: Estimate | None, returns: "LandingFraction | None") -> list[str]:
    """What the runs say while more of them come in, for a terminal; speed: the mean rebound speed [m/s]."""
    lines = [f"so far, from {captured.from_}:", f"  captured: {_with_reason(captured)}"]
    if speed is not None:
        mean = speed.on_scale(lambda value: CENTIMETRES * value)
        interval = labels.bracket(mean.lower, mean.upper, level=mean.level)
        lines.append(f"  mean rebound speed: {number(mean.value)} cm/s{interval}")
    return [*lines, f"  {NO_FLIGHTS}" if returns is None else f"  return fraction: {_with_reason(returns)}"]


def _with_reason(found: "LandingFraction") -> str:
    """A share with its interval, which holds whatever became of landings without an outcome, or why it has none."""
    share, why = found.share, found.share.why_missing
    return with_interval(share, level=share.level) + ("" if why is None else f", without an interval: {why}")


def luck(counts: Sequence[int]) -> tuple[float, float]:
    """Between which counts nine of ten bins lie where all is right, if runs are independent."""
    total, bins = sum(counts), len(counts)
    half = NINE_TENTHS * math.sqrt(total / bins * (1.0 - 1.0 / bins))
    return total / bins - half, total / bins + half


def unlucky(counts: Sequence[int]) -> list[bool]:
    """Which bins lie outside of that."""
    low, high = luck(counts)
    return [not low <= count <= high for count in counts]


def band_luck(run_count: int) -> tuple[float, float]:
    """Between which shares nine of ten right bands hold as many independent runs."""
    half = NINE_TENTHS * math.sqrt(BAND * (1.0 - BAND) / run_count)
    return BAND - half, BAND + half


def calibration(emulator: "EmulatorResults", bed_count: int) -> str:
    """The figure of the calibration: whether to believe the emulator."""
    scores = emulator.scores.outputs
    held = {name: score.band_90 for name, score in scores.items()}
    bins = [is_beyond for score in scores.values() for is_beyond in unlucky(score.pit)]
    shares = [f"{percent(share)} of {labels.output_words(name)}" for name, share in held.items()]
    said = [
        f"On {left_out(bed_count)} the {percent(BAND)} bands contained {listing(shares)}.",
        f"For a calibrated emulator the histogram is flat; the grey band covers {percent(BAND)} of the sampling "
        "fluctuation of independent runs. High ends indicate bands that are too narrow, a hump in the middle bands "
        "that are too wide, and a slope a bias.",
        f"{out_of(sum(bins), len(bins), 'bars')} lie outside the grey band{' (orange)' if any(bins) else ''}; chance "
        f"alone gives {number((1.0 - BAND) * len(bins), 2)}.",
    ]
    lucky = {name: band_luck(sum(score.pit)) for name, score in scores.items()}
    for words, off in (
        ("too narrow", [labels.output_words(name) for name, share in held.items() if share < lucky[name][0]]),
        ("too wide", [labels.output_words(name) for name, share in held.items() if share > lucky[name][1]]),
    ):
        if off:
            said.append(f"The bands of {listing(off)} are {words}, by more than chance explains.")
    return " ".join([*said, emulator.statement])


def samples(found: "SampleResults") -> str:
    """The figure of what may come out of a touchdown."""
    total, leaving = thousands(found.sample_count), thousands(found.leaving_count)
    if not found.leaving_count:
        return f"None of the {total} samples leaves the surface, so there is nothing to draw."
    said = f"Of {total} samples of the {found.model} {leaving} leave the surface; dots are the runs."
    speed, angle = (found.outputs.get(name) for name in ("speed_out", ELEVATION))
    if speed is None or angle is None:
        return said
    ends = ("quantile_0.05", "quantile_0.95")
    low, high = (number(CENTIMETRES * speed.quantiles[level]) for level in ends)
    least, most = (number(labels.output(ELEVATION).factor * angle.quantiles[level]) for level in ends)
    middle = f"{low} to {high} cm/s and {least} to {most} deg above the surface"
    return f"{said} The middle {percent(0.9)} of those that leave have {middle}."


def disagreement(returns: "ReturnFraction") -> str | None:
    """That runs and emulator disagree; None where they agree, or no interval says how far they may."""
    bounds = returns.share.bounds
    if bounds is None or returns.emulator is None or bounds[0] <= returns.emulator <= bounds[1]:
        return None
    return (
        f"The emulator gives a return fraction of {percent(returns.emulator, 1)}, outside the interval of the runs "
        f"({span(*bounds, 1)}): do not rely on results of the emulator (flights, landing regions, "
        "rest); make more runs"
    )


def followed(ground: str, count: int) -> str:
    """Which journeys the numbers of a ground describe, and what of the study they depend on."""
    if ground == "hard":
        return f"{count} journeys on the ground of [hard_ground], from the impacts of the study, without soil or bed"
    if ground == "expansion":
        return f"{count} journeys by samples of the refined expansion"
    return f"{count} journeys on hard ground with the restitution that the soil implies, by samples of the emulator"
