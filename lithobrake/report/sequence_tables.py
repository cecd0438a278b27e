"""The tables and the first numbers of the page of a sequence."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from lithobrake.outcomes import TouchdownOutcome
from lithobrake.report.captions import input_words, percent
from lithobrake.report.dispersion_tables import dispersion_tables
from lithobrake.report.limit_state_tables import limit_state_tables
from lithobrake.report.page import PageTable, Tile, fixed, number
from lithobrake.report.rare_tables import rare_tables
from lithobrake.report.results import SequenceResults
from lithobrake.report.sequence_answer import (
    action,
    as_sentence,
    bounds,
    drawn_things,
    has_interval,
    interval,
    left_out,
    missing_sentence,
    outcome_label,
    share_digits,
)
from lithobrake.report.sequence_captions import RETURNS, sign
from lithobrake.report.style import output
from lithobrake.report.tables import INPUT_COLUMNS, beds_table, input_cells, table_cell, touchdowns_table
from lithobrake.report.variance_figure import PARTS, SOIL, part_words

LEVELS = {"0.05": "5 %", "0.5": "median", "0.95": "95 %"}


def tiles(data: SequenceResults) -> list[Tile]:
    """The return fraction, and the most telling numbers beside it, as far as the summary has them."""
    returns = data.results["returns"]
    alone = "of these landings, without an interval: other beds, places or attitudes give another figure"
    sure = f"({interval(data)})" if has_interval(data) else alone
    found = [Tile(f"{100 * returns['share']:.{share_digits(data)}f}", "%", f"{action(data)} {sure}")]
    median = data.table("outputs", "speed_out", "quantiles").get("0.5")
    if median:
        words = "outgoing speed V+, median over those that leave"
        if median.get("lower") is not None:
            words += f" (90 %: {number(median['lower'])} to {number(median['upper'])})"
        found.append(Tile(number(median["value"]), "m/s", words))
    runs = data.results["runs"]
    left = runs["outcomes"].get(TouchdownOutcome.CLEAR, 0)
    beds = f", on {runs['beds']} beds" if runs["beds"] > 1 else ", all on one bed"
    found.append(Tile(str(left), f"of {runs['count']}", f"landings left the surface{beds}"))
    soil = data.table("variance_shares", "speed_out").get(SOIL)
    if soil:
        ends = f"90 %: {bounds((soil['lower'], soil['upper']), 0)}"
        # Freed of scatter, a part that is next to nothing may come out below 0.
        value = fixed(100 * soil["share"], 0) if soil["share"] > 0.0 else "about 0"
        found.append(Tile(value, "%", f"of the scatter of V+ is the soil's ({ends})"))
    band = data.table("emulator", "scores", "speed_out").get("band_90")
    if band is not None:
        words = f"of V+ on {left_out(data)} lay within the 90 % bands of the emulator"
        found.append(Tile(f"{100 * band:.0f}", "%", words))
    return found


def tables(data: SequenceResults) -> list[PageTable]:
    """Those that have a row."""
    made: tuple[Callable[[SequenceResults], PageTable], ...] = (
        _answer, _inputs, _outputs, _variance, _runs, _emulator, beds_table, touchdowns_table
    )  # fmt: skip
    found = [table for table in (make(data) for make in made) if table.rows]
    side = [_side_runs(data)] if data.results["runs"]["side_runs"] else []
    return [*found, *side, *limit_state_tables(data), *rare_tables(data.rare), *dispersion_tables(data)]


def _answer(data: SequenceResults) -> PageTable:
    returns, digits = data.results[RETURNS], share_digits(data)
    rows = [[f"landers that {action(data)}", percent(returns["share"], digits)]]
    if has_interval(data):
        rows.append([f"{percent(data.level, 0)} interval", bounds((returns["lower"], returns["upper"]), digits)])
    for key, words in (("next_bed", "on one next bed"), ("if_missing", "if none or all of those without an answer do")):
        low, high = returns[key] or (0.0, 0.0)
        if low < high:
            rows.append([words, bounds((low, high), 1)])
    if returns["emulator"] is not None:
        rows.append(["the same by the emulator", percent(returns["emulator"])])
    if returns.get("flight_sampling") is not None:
        rows.append(["+- by the number of flights alone", f"{100 * returns['flight_sampling']:.1f} points"])
    rows += [["from", returns["from"]]]
    note = as_sentence(returns["why"]) if returns["why"] else ""
    return PageTable("The answer", ["quantity", "value"], rows, note)


def _outputs(data: SequenceResults) -> PageTable:
    """Mean and quantiles of the landings that left."""
    columns = ["output", "unit", "mean", "standard deviation", *LEVELS.values()]
    rows = []
    # The return fraction is the answer, and has a better estimate there.
    for name in (name for name in data.results["outputs"] if name != RETURNS):
        table, shown = data.results["outputs"][name], output(name)
        cells = [_estimate(table["mean"], shown.factor), table_cell(table["standard_deviation"] * shown.factor)]
        cells += [_estimate(table["quantiles"][level], shown.factor) for level in LEVELS]
        rows.append([shown.row.replace("_", " "), shown.unit, *cells])
    note = (
        "Of the landings that left, over soils, beds, places and attitudes that were not in the study. In brackets "
        "90 % intervals."
        if has_interval(data)
        else "Of the landings that left, without intervals: they say nothing of other beds, places or attitudes."
    )
    return PageTable("Outputs of the landings", columns, rows, note, frozenset(columns[2:]))


def _estimate(entry: Mapping[str, Any] | None, factor: float) -> str:
    """A number with its interval, where it has them."""
    if not entry:
        return ""
    value = table_cell(entry["value"] * factor)
    if entry.get("lower") is None:
        return value
    return f"{value} ({number(entry['lower'] * factor)} to {number(entry['upper'] * factor)})"


def _variance(data: SequenceResults) -> PageTable:
    """Every part of the variance of each output, soil by input."""
    records = data.results["variance_shares"]
    known = [record for record in records.values() if record]
    inputs = list(dict.fromkeys(name for record in known for name in record["soil_by_input"]))
    rows = [[SOIL, *(_part(record, SOIL) for record in records.values())]]
    rows += [
        [
            f"of it {input_words(name)} alone",
            *(_part(record and record["soil_by_input"], name) for record in records.values()),
        ]
        for name in inputs
    ]
    rows += [
        [part_words(known[0], part), *(_part(record, part) for record in records.values())]
        for part in PARTS
        if any(record.get(part) for record in known)
    ]
    note = (
        "Shares of the whole variance in per cent, over the laws of the inputs, beds, places and attitudes; in "
        "brackets 90 % intervals. The parts (without those of single inputs) add up to 100. They are freed of scatter "
        "and not cut, so one that is next to nothing may be below 0. The return fraction is a mean over headings "
        "already: what headings do is in none of its parts."
    )
    columns = ["part", *(sign(name) for name in records)]
    return PageTable("Parts of the variance", columns, rows if known else [], note, frozenset(columns[1:]))


def _part(record: Mapping[str, Any] | None, part: str) -> str:
    if record is None:
        return "not known"
    share = record.get(part)
    if share is None:
        return ""
    return f"{fixed(100 * share['share'], 1)} ({fixed(100 * share['lower'], 1)} to {fixed(100 * share['upper'], 1)})"


def _runs(data: SequenceResults) -> PageTable:
    runs = data.results["runs"]
    total = max(sum(runs["outcomes"].values()), 1)
    rows = [[outcome_label(word), str(count), percent(count / total)] for word, count in runs["outcomes"].items()]
    rows.append(["left over the rim of the bed, in flight", str(runs["over_rim"]), percent(runs["over_rim"] / total)])
    note = " ".join(filter(None, [f"On {runs['beds']} beds.", missing_sentence(data)]))
    return PageTable("Outcomes of the runs", ["outcome", "runs", "share"], rows, note, frozenset({"runs", "share"}))


def _side_runs(data: SequenceResults) -> PageTable:
    """What pairs of runs tell of soil and chaos."""
    side, rows = data.table("runs", "side_runs"), []
    effects, chaos = (data.table("runs", "side_runs", key) for key in ("soil_total_effect", "chaos_deviation"))
    for name in dict.fromkeys([*effects, *chaos]):
        shown = output(name)
        row, unit, factor = (sign(name), "", 1.0) if name == RETURNS else (shown.row, shown.unit, shown.factor)
        rows.append([row, _part(effects, name), _estimate(chaos.get(name), factor), unit])
    columns = ["output", "total effect of the soil [%]", "standard deviation by chaos", "unit"]
    note = (
        f"{side['soil_pairs']} runs were made again on a second soil, {side['twins']} at a place "
        f"{number(1e3 * side['twin_shift'])} mm beside. Total effect: the share of the variance that goes "
        "with the soil at one bed, place and attitude, whatever these are. In brackets 90 % intervals."
    )
    return PageTable("Side runs", columns, rows, note, frozenset(columns[1:3]))


def _emulator(data: SequenceResults) -> PageTable:
    """How the emulator does on beds left out."""
    emulator = data.results["emulator"]
    columns = ["output", "skill", "held by the 90 % band"]
    rows = []
    for name, score in emulator["scores"].items():
        skill, band = score.get("crps_skill", score.get("energy_skill")), score.get("band_90")
        shown = "all together" if name == "joint" else output(name).row
        rows.append([shown, *("" if one is None else percent(one) for one in (skill, band))])
    note = (
        f"{emulator['statement']} Skill: how much smaller the score (CRPS; of all together the energy score) "
        f"is than that of drawing one of the runs, on {left_out(data)}; 0 is no better."
    )
    return PageTable(f"The emulator on {left_out(data)}", columns, rows, note, frozenset(columns[1:]))


def _inputs(data: SequenceResults) -> PageTable:
    """What every run draws for itself, and which of the uncertain inputs the emulator found to matter."""
    found, rows = data.results["emulator"]["found_inputs"], []
    # Sizes of grains vary within a bed, and the site from flight to flight: neither is an input of a run.
    for name, law in ((name, law) for name, law in _uncertain(data.study) if name in data.runs):
        rows.append([*input_cells(name, law), "yes" if name in found else "no"])
    keys = {"place": "impact.region", "azimuth": "impact.azimuth_deg", "attitude": "impact.orientation"}
    named = {row[1] for row in rows}
    drawn = [words for words in drawn_things(data) if not (words == "place" and "impact.place.x" in named)]
    rows += [[f"{words} at impact", keys[words], "uniform", "drawn anew for each run", ""] for words in drawn]
    note = (
        "Found: it changes the mean of an output (where none does, nine of ten studies find none)."
        if found
        else "No input was found to change the mean of any output (where none does, nine of ten studies find none)."
    )
    return PageTable("Inputs that the runs draw", [*INPUT_COLUMNS, "found"], rows, note)


def _uncertain(tables: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Every distribution of the study by dotted key."""
    for key, value in tables.items():
        if isinstance(value, Mapping) and "distribution" in value:
            yield f"{prefix}{key}", value
        elif isinstance(value, Mapping):
            yield from _uncertain(value, f"{prefix}{key}.")


def colour_input(data: SequenceResults) -> str | None:
    """The input that figures of the samples are coloured by: the one that V+ varies most with, of those sampled."""
    sampled = [name for name, _ in _uncertain(data.study) if name in data.samples]
    parts = data.table("variance_shares", "speed_out", "soil_by_input")
    alone = {name: part["share"] for name, part in parts.items() if name in sampled}
    return max(alone, key=lambda name: alone[name]) if alone else next(iter(sampled), None)
