"""Tables of the first touchdowns of the drawn landers: the return fraction, outcomes, outputs and their variance."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from lithobrake.report.content import PageTable, table_cell, unit_scales
from lithobrake.report.tables.expansion_tables import INPUT_COLUMNS, input_cells
from lithobrake.results.model_results import EmulatorResults
from lithobrake.results.page_data import PageData
from lithobrake.results.run_results import SideRuns, VarianceParts
from lithobrake.statements import labels, notes
from lithobrake.statements.answers import action
from lithobrake.statements.touchdowns import BAND, drawn_things, left_out, run_outcomes
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import (
    QUANTILE_WORDS,
    as_sentence,
    at_level,
    interval_digits,
    part,
    percent,
    span,
    with_interval,
)


def why_tables(data: PageData) -> list[PageTable]:
    """What explains the variance of the rebound; to rest, the sides stand in the table of the journeys too."""
    return [_variance(data), _sides(data)]


def sure_tables(data: PageData) -> list[PageTable]:
    """The return fraction with its interval, and what is behind it."""
    side, emulator = data.results.runs.side_runs, data.results.emulator
    found = [_returns(data), _runs(data)]
    found += [_emulator(emulator, data.results.runs.beds)] if emulator else []
    return [*found, *([_side_runs(data, side)] if side else [])]


def output_tables(data: PageData) -> list[PageTable]:
    """What the landings gave."""
    return [_outputs(data), _directions(data)]


def _returns(data: PageData) -> PageTable:
    returns, missing = data.results.returns, data.results.runs.missing.count
    bounds = returns.share.bounds
    digits = interval_digits(*(bounds or (None, None)))
    rows = [[f"return fraction: landings that {action(data)}", percent(returns.share.value, digits)]]
    if bounds is not None:
        rows.append([at_level(data.level), span(*bounds)])
    if returns.next_bed is not None:
        rows.append([f"prediction interval for a new bed{_bed_size(data)}", span(*returns.next_bed)])
    if missing:
        rows.append(
            [f"if none or all of the {missing} landings with unknown outcome return", span(*returns.if_missing)]
        )
    if returns.emulator is not None:
        rows.append(["return fraction by the emulator", percent(returns.emulator, digits)])
    rows.append(["from", returns.from_])
    note = as_sentence(returns.why) if returns.why else ""
    if data.has_interval and missing:
        note = "The interval covers all possible outcomes of the landings with unknown outcome."
    return PageTable("Return fraction", ["quantity", "value"], rows, note)


def _bed_size(data: PageData) -> str:
    """How much ground a bed is; nothing where touchdowns are made without one."""
    if not data.results.beds:
        return ""
    return f" of {' x '.join(f'{length:g}' for length in data.study['bed']['width'])} m"


def _outputs(data: PageData) -> PageTable:
    """Mean and quantiles of the landings that left."""
    columns = ["output", "unit", "mean", "standard deviation", *QUANTILE_WORDS.values()]
    rows = []
    for name, table in data.results.spreads.items():
        shown = labels.output(name)
        cells = [_estimate(table.mean, shown.factor), table_cell(table.standard_deviation * shown.factor)]
        cells += [_estimate(table.quantiles[level], shown.factor) for level in QUANTILE_WORDS]
        rows.append([shown.words.replace("_", " "), shown.unit, *cells])
    return PageTable("Outputs of the landings", columns, rows, notes.outputs(data), frozenset(columns[2:]))


def _directions(data: PageData) -> PageTable:
    """Mean direction and resultant length of the angles without beginning or end."""
    columns = ["output", "mean direction [deg]", "resultant length"]
    rows = [
        [
            labels.output(name).words.replace("_", " "),
            _estimate(table.mean_direction, math.degrees(1.0)),
            _estimate(table.resultant_length, 1.0),
        ]
        for name, table in data.results.directions.items()
    ]
    return PageTable("Directions of the landings", columns, rows, notes.directions(data), frozenset(columns[1:]))


def _estimate(entry: Estimate | None, factor: float) -> str:
    """A number with its interval, where it has them."""
    if entry is None:
        return ""
    shown = entry.on_scale(lambda value: value * factor)
    return f"{table_cell(shown.value)}{labels.bracket(shown.lower, shown.upper)}"


def _variance(data: PageData) -> PageTable:
    """Every part of the variance of each output, soil by input."""
    records = data.results.variance_shares
    known = [record for record in records.values() if record]
    inputs = list(dict.fromkeys(name for record in known for name in record.soil_by_input))
    names = [name for name in labels.PART_WORDS if name != "soil" and any(name in one.parts for one in known)]
    heads = ["soil, at least", "with ranges twice as wide, at least"]
    heads += [f"of this, {labels.input_words(name)} alone" for name in inputs]
    heads += [labels.long_part_words(known[0], name) for name in names]
    rows = list(map(list, zip(heads, *(_parts(one, inputs, names) for one in records.values()), strict=True)))
    columns = ["part", *map(labels.output_words, records)]
    return PageTable(
        "Parts of the variance", columns, rows if known else [], notes.variance(data, known), frozenset(columns[1:])
    )


def _sides(data: PageData) -> PageTable:
    """What becomes of the landers by the side that faces the ground; of journeys the first touchdown."""
    columns = ["side toward the ground", "landings", "median rebound speed over impact speed", "return fraction"]
    rows = [
        [one.words, str(one.landings), labels.quantile(one.speed_ratio), with_interval(one.returns.share)]
        for one in data.results.sides.values()
    ]
    note = notes.sides(data.level)
    return PageTable("By the side that faces the ground", columns, rows, note, frozenset(columns[1:]))


def _parts(record: VarianceParts | None, inputs: Sequence[str], names: Sequence[str]) -> list[str]:
    """The parts of one output: soil, each soil input alone, the others by name."""
    if record is None:
        return ["not known"] * (2 + len(inputs) + len(names))
    found = [record.soil, record.soil_doubled, *map(record.soil_by_input.get, inputs), *map(record.parts.get, names)]
    return ["" if one is None else part(one) for one in found]


def _runs(data: PageData) -> PageTable:
    runs = data.results.runs
    total = max(sum(runs.outcomes.values()), 1)
    rows = [
        [labels.RUN_WORDS.get(word, word), str(count), percent(count / total)] for word, count in runs.outcomes.items()
    ]
    far = runs.farther_than_period
    aside, count = (
        ("left the surface across the edge of the bed", runs.over_rim)
        if far is None
        else ("travelled more than one period of the bed in contact, over ground already disturbed", far)
    )
    rows.append([f"({aside})", str(count), percent(count / total)])
    columns = ["outcome", "runs", "share"]
    return PageTable("Outcomes of the runs", columns, rows, run_outcomes(data.results), frozenset(columns[1:]))


def _side_runs(data: PageData, side: SideRuns) -> PageTable:
    """What pairs of runs tell of soil and chaos."""
    effects, chaos, rows = side.soil_total_effect, side.chaos_deviation, []
    for name in dict.fromkeys([*effects, *chaos]):
        shown = labels.output(name)
        unit, factor = ("", 1.0) if name == labels.RETURNS else (shown.unit, shown.factor)
        rows.append(
            [
                labels.output_words(name),
                part(effects[name]) if name in effects else "",
                _estimate(chaos.get(name), factor),
                unit,
            ]
        )
    columns = ["output", "total effect of the soil", "standard deviation by chaos", "unit"]
    return PageTable("Side runs", columns, rows, notes.side_runs(side, data.level), frozenset(columns[1:3]))


def _emulator(emulator: EmulatorResults, bed_count: int) -> PageTable:
    """How the emulator does on beds left out."""
    columns = ["output", "skill", f"within the {percent(BAND)} band"]
    rows = [["all together", percent(emulator.scores.joint.energy_skill), ""]]
    for name, score in emulator.scores.outputs.items():
        rows.append([labels.output(name).words, percent(score.crps_skill), percent(score.band_90)])
    title = f"The emulator on {left_out(bed_count)}"
    return PageTable(title, columns, rows, notes.emulator_scores(bed_count), frozenset(columns[1:]))


def touchdowns_table(data: PageData) -> PageTable:
    """What else the touchdowns gave."""
    found = data.results.outputs_of_runs
    numbers = {name: (one.unit, (one.smallest, one.median, one.largest)) for name, one in found.items()}
    scale = unit_scales((unit, value) for unit, values in numbers.values() for value in values)
    rows = [
        [name.replace("_", " "), unit, *(table_cell(value, scale[unit]) for value in values)]
        for name, (unit, values) in numbers.items()
    ]
    columns = ["quantity", "unit", "smallest", "median", "largest"]
    note = "Over all distinct runs." if rows else ""
    return PageTable("Other outputs of the touchdowns", columns, rows, note, frozenset(columns[2:]))


def inputs_table(data: PageData) -> PageTable:
    """What every run draws for itself, and which of the uncertain inputs the emulator found to matter."""
    emulator, rows = data.results.emulator, []
    found = emulator.found_inputs if emulator else ()
    # Sizes of grains vary within a bed, and the site from flight to flight: neither is an input of a run.
    for name, law in _uncertain(data.study):
        if name in data.runs:
            rows.append([*input_cells(name, law), "yes" if name in found else "no"])
        elif name.startswith("soil."):
            # A run draws the soils of all regions, and meets those that it comes to.
            rows.append([*input_cells(name, law), ""])
    keys = {"impact point": "impact.region", "azimuth": "impact.azimuth_deg", "attitude": "impact.orientation"}
    named = {row[1] for row in rows}
    drawn = [words for words in drawn_things(data.study) if not (words == "impact point" and "impact.place.x" in named)]
    significant = {"attitude"} if any(name.startswith("attitude.") for name in found) else set()
    rows += [
        [words, keys[words], "uniform", "randomised in each run", "yes" if words in significant else ""]
        for words in drawn
    ]
    if emulator is None:
        return PageTable("Sampled inputs", INPUT_COLUMNS, [row[:-1] for row in rows])
    note = notes.significant_inputs(data.level, has_any=bool(found))
    return PageTable("Sampled inputs", [*INPUT_COLUMNS, "significant"], rows, note)


def _uncertain(tables: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Every distribution of the study by dotted key."""
    for key, value in tables.items():
        if isinstance(value, Mapping) and "distribution" in value:
            yield f"{prefix}{key}", value
        elif isinstance(value, Mapping):
            yield from _uncertain(value, f"{prefix}{key}.")
