"""The sentences under the figures of a sequence, from the numbers of its summary. They are plain text."""

from collections.abc import Mapping
from typing import Any

from lithobrake.outcomes import TouchdownOutcome
from lithobrake.report.calibration_figure import band_luck, histograms, unlucky
from lithobrake.report.captions import input_words, listing, percent, thousands
from lithobrake.report.page import fixed, number
from lithobrake.report.results import SequenceResults
from lithobrake.report.scatter_figure import DRAWN_COUNT
from lithobrake.report.sequence_answer import drawn_things, emulator_outside, left_out, missing_sentence
from lithobrake.report.style import output
from lithobrake.report.variance_figure import SOIL, known_parts, part_words

RETURNS = "returns"
# An input with more than this part of what the soil does is named.
MAIN = 0.5


def sign(name: str) -> str:
    """An output in a sentence."""
    shown = output(name)
    return "the return fraction" if name == RETURNS else shown.sign or shown.words


def runs(data: SequenceResults) -> str:
    """Figure 3."""
    table = data.results["runs"]
    beds, outcomes = table["beds"], table["outcomes"]
    own = listing(["soil", *drawn_things(data)])
    clear, captured = (outcomes.get(word, 0) for word in (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED))
    said = [
        f"Every dot is a landing with {own} of its own"
        + (", all on one bed" if beds == 1 else f", on one of {beds} beds")
        + f": of {table['count']} landers {clear} left the surface and {captured} "
        f"{'was' if captured == 1 else 'were'} captured."
    ]
    quantiles = _quantiles(data)
    if quantiles:
        said.append(f"{quantiles}.")
    if table["over_rim"]:
        said.append(f"{table['over_rim']} left over the rim of the bed (rings).")
    said.append(missing_sentence(data))
    record = data.results["variance_shares"]["speed_out"]
    if record:
        said.append(
            f"Right: the same speeds bed by bed, which differ by bed in {_part(record['bed'])} of their variance."
        )
    return " ".join(filter(None, said))


def _quantiles(data: SequenceResults) -> str:
    """Median with its interval, and the middle nine tenths, of speed and elevation."""
    found = []
    for name in ("speed_out", "elevation_out"):
        levels = data.table("outputs", name, "quantiles")
        if {"0.05", "0.5", "0.95"} <= levels.keys():
            shown = output(name)
            low, middle, high = (levels[level]["value"] * shown.factor for level in ("0.05", "0.5", "0.95"))
            found.append(
                f"the median of {shown.sign} is {number(middle)} {shown.unit}{_ends(levels['0.5'], shown.factor)}, "
                f"and nine tenths lie between {number(low)} and {number(high)} {shown.unit}"
            )
    words = "; ".join(found)
    return f"{words[:1].upper()}{words[1:]}"


def _ends(entry: Mapping[str, Any], factor: float) -> str:
    """The interval of a number in brackets, where it has one."""
    if entry.get("lower") is None:
        return ""
    return f" (90 % interval {number(entry['lower'] * factor)} to {number(entry['upper'] * factor)})"


def variance(data: SequenceResults) -> str:
    """Figure 4."""
    records = {name: record for name, record in data.results["variance_shares"].items() if record}
    if not records:
        return (
            "The runs cannot tell where the scatter comes from: they lie on one bed, or are too few for their inputs."
        )
    first, *others = records
    said = [scatter_words(first, records[first])]
    if others:
        soils = [
            f"{_percent(records[name][SOIL]['share'])} of {sign(name)}" for name in others if records[name].get(SOIL)
        ]
        said.append(f"Soil accounts for {listing(soils)}." if soils else "")
    below = [
        f"{part_words(record, part)} of {sign(name)}"
        for name, record in records.items()
        for part, share in known_parts(record).items()
        if share["share"] < 0.0
    ]
    below += [
        f"{input_words(one)} in {sign(name)}"
        for name, record in records.items()
        for one, share in record["soil_by_input"].items()
        if share["share"] < 0.0
    ]
    if below:
        said.append(
            "Scatter is taken off each part, so one that is next to nothing may come out below 0 and is then drawn to "
            f"the left of it, where the others reach beyond 100 % ({len(below)} here, as {below[0]}); each bar adds up "
            "to 100 %. Intervals end at 0 and 100 %."
        )
    if all(record.get("chaos") is None for record in records.values()):
        said.append("Without twins chaos is not known apart: it is within place and attitude.")
    return " ".join(filter(None, said))


def scatter_words(name: str, record: Mapping[str, Any]) -> str:
    """Where the scatter of an output comes from, in a sentence with 90 % intervals."""
    words: list[str] = []
    for part, share in known_parts(record).items():
        main, verb = (_main_input(record) if part == SOIL else ""), ("" if words else " accounts")
        article = "the " if part == "bed" else ""
        words.append(f"{article}{part_words(record, part)}{verb} for {_part(share, main)}")
    return f"Of the scatter of {sign(name)}, {listing(words)} (in brackets 90 % intervals)."


def _main_input(record: Mapping[str, Any]) -> str:
    """Which input makes most of what the soil does, where one does and the soil does something."""
    alone = {name: part["share"] for name, part in record["soil_by_input"].items()}
    soil = record[SOIL]
    name = max(alone, key=lambda one: alone[one], default="")
    is_main = bool(name) and alone[name] > MAIN * soil["share"] and record["soil_by_input"][name]["lower"] > 0.0
    return f"; most of it {input_words(name)}" if is_main else ""


def _part(part: Mapping[str, float], more: str = "") -> str:
    return f"{_percent(part['share'])} ({fixed(100 * part['lower'], 0)} to {fixed(100 * part['upper'], 0)}{more})"


def _percent(share: float) -> str:
    """A share in per cent, with a digit more where it is small."""
    return f"{fixed(100 * share, 1 if abs(share) < 0.0095 else 0)} %"


def calibration(data: SequenceResults) -> str:
    """Figure 5."""
    emulator = data.results["emulator"]
    scores = emulator["scores"]
    found = histograms(scores)
    held = {name: scores[name]["band_90"] for name in found}
    bins = [is_beyond for counts in found.values() for is_beyond in unlucky(counts)]
    shares = [f"{percent(share, 0)} of {sign(name)}" for name, share in held.items()]
    said = [
        f"On {left_out(data)} the 90 % bands held {listing(shares)}." if shares else "",
        "Where the emulator is right every bar is as high as the line, but for luck (grey: nine of ten bars of as many "
        "independent runs); high ends mean bands that are too narrow, a hump in the middle too wide, a slope that all "
        "lies to one side.",
        f"{sum(bins)} of {len(bins)} bars lie outside of the grey{' (orange)' if any(bins) else ''}; luck alone would "
        f"have it of {number(0.1 * len(bins), 2)}.",
    ]
    lucky = {name: band_luck(sum(found[name])) for name in held}
    for words, off in (
        ("too narrow", [sign(name) for name, share in held.items() if share < lucky[name][0]]),
        ("too wide", [sign(name) for name, share in held.items() if share > lucky[name][1]]),
    ):
        if off:
            said.append(f"The bands of {listing(off)} are {words} for luck alone.")
    return " ".join([*said, emulator["statement"]])


def samples(data: SequenceResults, colour_name: str | None) -> str:
    """Figure 6."""
    if colour_name is None:
        return ""
    outcome = data.samples["outcome"]
    total, leaving = len(outcome), int((outcome == TouchdownOutcome.CLEAR).sum())
    if not leaving:
        return f"None of the {thousands(total)} samples leaves the surface, so there is nothing to draw."
    first = f" (the first {thousands(DRAWN_COUNT)} are drawn)" if leaving > DRAWN_COUNT else ""
    colour = f"the colour is the {input_words(colour_name)}"
    if not data.results["emulator"]["follows_inputs"]:
        colour += ", and says nothing: the emulator draws runs whatever the inputs"
    count = f"Of {thousands(total)} samples of the emulator {thousands(leaving)} leave the surface"
    return " ".join(filter(None, [f"{count}{first}; {colour}.", emulator_outside(data)]))


def aims(data: SequenceResults) -> str:
    """The figure of the aims."""
    table = data.results["aim"]
    crossed = " Aims that the limits rule out are crossed." if table["within"] else ""
    return (
        f"{thousands(table['lander_count'])} landers at each aim, followed until they rest; below each number its 90 % "
        f"interval, a frame about the best.{crossed} {table['statement']}"
    )
