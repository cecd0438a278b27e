"""The explorers of the page, of the first touchdown and of any touchdown of journeys, and arrays in a page."""

import base64
import json
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from lithobrake.report.content import LiveSection, in_html, raised_units
from lithobrake.results import ExplorerTables, Table
from lithobrake.results.page_data import PageData
from lithobrake.results.table import ExplorerAttitude
from lithobrake.statements.answers import action
from lithobrake.statements.expansion import MODEL
from lithobrake.statements.labels import input_words, output
from lithobrake.vocabulary.number_words import listing, number, percent, thousands
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import IMPACT_SPEED, OF_TOUCHDOWN

TYPES = ("float64", "float32", "int32", "int16", "uint8")
# More flown starts would make the page heavier, and no cell of them noticeably smaller.
MOST_STARTS = 20_000
SCRIPTS = (
    "live/law.js", "live/attitude.js", "live/flown.js", "live/explore.js", "live/halves.js", "live/charts.js",
    "live/explorer.js",
)  # fmt: skip
# The explorer's outputs, in the order in which it draws them: the first ones of its tables.
SHOWN = ("speed_out", "elevation_out", "spin_out")
LEVEL = ("velocity_out_x", "velocity_out_y")
START = ("start_speed", "start_elevation_deg", "velocity_x", "velocity_y")


def packed(arrays: Mapping[str, np.ndarray]) -> dict[str, dict[str, Any]]:
    """Arrays as JSON values: type, shape, and little-endian bytes as base64. Raises ValueError for another type."""
    return _values(arrays, lambda data: data)


def deflated(arrays: Mapping[str, np.ndarray]) -> dict[str, dict[str, Any]]:
    """The same with the bytes of each array deflated (RFC 1950), for those of which much is alike."""
    return _values(arrays, lambda data: zlib.compress(data, 9))


def _values(arrays: Mapping[str, np.ndarray], made: Callable[[bytes], bytes]) -> dict[str, dict[str, Any]]:
    found = {}
    for name, array in arrays.items():
        if array.dtype.name not in TYPES:
            raise ValueError(f"{name} has type {array.dtype}, but must have one of {', '.join(TYPES)}")
        data = np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<")).tobytes()
        found[name] = {
            "type": array.dtype.name,
            "shape": list(array.shape),
            "base64": base64.b64encode(made(data)).decode("ascii"),
        }
    return found


def script_data(name: str, content: Mapping[str, Any]) -> str:
    """An element of the page that holds JSON and is read by its name."""
    text = json.dumps(content, allow_nan=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{text}</script>\n'


def explorer_sections(data: PageData) -> list[LiveSection]:
    """The explorer of the first touchdown with all its numbers; none without samples."""
    samples = data.samples
    if samples is None:
        return []
    flown, explorer, model = _flown(samples.flights), samples.explorer, samples.results.model
    count = len(flown["status"])
    flown_words = (
        f"No flight is computed here: each lander takes the outcome of one of {thousands(count)} flights, one of the "
        "eight nearest to its rebound speed, elevation and azimuth. "
        if count
        else "No flights were computed, so neither shares nor places are shown. "
    )
    fitted = data.expansion if model == MODEL else None
    over_beds = fitted is None and data.has_interval
    free = [name for name in explorer.input_names if name not in explorer.attitude_inputs]
    moved = free if fitted is None else list(fitted.results.kept_inputs)
    words = (
        f"Move the two ends of an input range: this page evaluates the {model} of the first touchdown for all soils in "
        f"it, weighted by their input distribution. {_fixed(explorer, moved)}{_attitudes(explorer)}"
    )
    bands = (
        f"{_fits(model, explorer)} residuals that fall on other runs; no other bed."
        if fitted
        else emulator_bands(explorer, over_beds)
    )
    facts = law_facts(explorer, moved, samples.table) | _flight_facts(data, bool(count))
    facts["reach"] = explorer.interval_reach if over_beds else None
    facts["unseenLimit"] = explorer.unseen_limit if over_beds else None
    note = f"{words}{bands} {flown_words}"
    return [
        explorer_section("explorer", "Explorer of the first touchdown", note, facts, explorer, flown if count else None)
    ]


def explorer_section(
    name: str,
    title: str,
    note: str,
    facts: Mapping[str, Any],
    explorer: ExplorerTables,
    flown: Mapping[str, np.ndarray] | None = None,
) -> LiveSection:
    """The section of an explorer. note: what it says of itself; facts and flown starts: what its scripts read."""
    law = {key: np.asarray(table, dtype=np.float64) for key, table in explorer.tables.items()}
    numbers = {"facts": facts, "law": packed(law), "flown": packed(flown) if flown else None}
    html = f"""<section id="{name}" class="explorer">
<h3>{title}</h3>
<p class="note">{in_html(note)}Grey lines: the whole input distribution.</p>
<div class="explored"><div class="controls"></div><div class="views"><p class="share" aria-live="polite"></p>
<div class="charts"></div></div></div>
</section>
{script_data(f"{name}-data", numbers)}"""
    return LiveSection(html, SCRIPTS)


def _fixed(explorer: ExplorerTables, moved: Sequence[str]) -> str:
    """What is said of the inputs without sliders."""
    others = [input_words(name) for name in explorer.input_names if name not in (*moved, *explorer.attitude_inputs)]
    return f"Removed by the screening and always over their whole distribution: {listing(others)}. " if others else ""


def _attitudes(explorer: ExplorerTables) -> str:
    """Over which attitudes the first touchdowns are, in a sentence; nothing where their emulator reads none."""
    if explorer.attitude is None:
        return ""
    drawn = "uniform over all rotations, or have one side toward the ground"
    return f"Attitudes are {drawn if explorer.attitude.drawn is None else 'those of the runs'}. "


def emulator_bands(explorer: ExplorerTables, over_beds: bool) -> str:
    """What the bands of an emulator are, in a sentence; over_beds: whether its refits draw beds."""
    drawn = "beds sampled with replacement" if over_beds else "runs sampled with replacement; no other bed"
    return f"{_fits('emulator', explorer)} {drawn}."


def _fits(model: str, explorer: ExplorerTables) -> str:
    return f"Bands: the middle {percent(0.9)} of {explorer.tables['location'].shape[0]} fits of the {model} to"


def law_facts(explorer: ExplorerTables, moved: Sequence[str], of_inputs: Table) -> dict[str, Any]:
    """Names, units and words beside the numbers. moved: inputs with sliders; of_inputs: a table that has them all."""
    names = list(explorer.output_names)
    units = {name: one.units for name, one in of_inputs.columns.items()}
    shown = {name: output(name) for name in names if name in SHOWN}
    return {
        "inputNames": list(explorer.input_names),
        "moved": [explorer.input_names.index(name) for name in moved],
        "inputs": [
            {"words": input_words(name), "unit": raised_units(units.get(name, ""))} for name in explorer.input_names
        ],
        "outputs": [
            {
                "words": one.words,
                "unit": raised_units(one.unit),
                "factor": one.factor,
                # All elevations are shown: landers that leave straight up are few, and count.
                "most": 0.5 * np.pi if name == "elevation_out" else None,
            }
            for name, one in shown.items()
        ],
        "outcomeNames": list(explorer.outcome_names),
        "outputOutcome": explorer.output_outcome,
        "capturedName": str(TouchdownOutcome.CAPTURED),
        "bound": explorer.bound,
        **{name.removesuffix("_out"): names.index(name) for name in SHOWN},
        "level": [names.index(name) for name in LEVEL if name in names] or None,
        "fates": [str(fate) for fate in FlightStatus],
        "impact": list(FlightStatus).index(FlightStatus.IMPACT),
        "bedCount": explorer.group_count,
        "attitude": _attitude(explorer.attitude, explorer.input_names),
    }


def _attitude(found: ExplorerAttitude | None, names: Sequence[str]) -> dict[str, Any] | None:
    """What draws attitudes, None where the law reads none."""
    if found is None:
        return None
    return {
        "inputs": [names.index(name) for name in found.input_names],
        "axes": found.axes,
        "hasSides": found.has_sides,
        "isCube": found.is_cube,
        "drawn": found.drawn,
        "choices": [{"words": "any", "downs": []}, *({"words": w, "downs": d} for w, d in found.sides.items())],
    }


def _flight_facts(data: PageData, is_flown: bool) -> dict[str, Any]:
    """What the share of returns and the map need; no action where there is no share."""
    site = data.results.site
    return {
        # Without drawn landers the study's share is of all samples, those without an answer among them.
        "ofAll": data.journeys is None,
        "holds": site.holds,
        "action": action(data) if is_flown else None,
        "site": [site.latitude_deg, site.longitude_deg],
    }


def _flown(flights: Table) -> dict[str, np.ndarray]:
    """Speed [m/s], elevation and azimuth [rad] of the first starts, how each ended, and where [deg], 0 for no place."""
    first = flights.where(np.arange(min(flights.row_count, MOST_STARTS)))
    speed, elevation, x, y = (np.asarray(first[name], dtype=float) for name in START)
    statuses = [str(fate) for fate in FlightStatus]
    places = [np.nan_to_num(np.asarray(first[f"{name}_deg"], dtype=float)) for name in ("latitude", "longitude")]
    return {
        "starts": np.column_stack([speed, np.radians(elevation), np.arctan2(y, x)]).astype(np.float32),
        "status": np.array([statuses.index(str(word)) for word in first["status"]], dtype=np.uint8),
        "places": np.column_stack(places).astype(np.float32),
    }


def touchdown_sections(data: PageData) -> list[LiveSection]:
    """The explorer of any touchdown with all its numbers; none where the touchdowns have no emulator."""
    if data.journeys is None or data.journeys.explorer is None:
        return []
    explorer, touchdowns = data.journeys.explorer, data.journeys.touchdowns
    fitted = touchdowns.where(np.isin(touchdowns["outcome"], explorer.outcome_names))
    beds = len(np.unique(fitted["bed"]))
    # Refits draw runs where those that left lie on one bed.
    over_beds = 1 < beds == explorer.group_count
    moved = [name for name in explorer.input_names if name not in explorer.attitude_inputs]
    facts = law_facts(explorer, moved, fitted) | {
        # Of all touchdowns that are drawn, those that are captured.
        "ofAll": True,
        "holds": True,
        "action": "come to rest at this touchdown",
        "reach": explorer.interval_reach if over_beds else None,
        "unseenLimit": explorer.unseen_limit if over_beds else None,
    }
    note = f"{_what(explorer, fitted, beds)} {_law(explorer)} {emulator_bands(explorer, over_beds)} "
    return [explorer_section("touchdown-explorer", "Explorer of any touchdown", note, facts, explorer)]


def _of_touchdown(explorer: ExplorerTables) -> list[str]:
    """The inputs that differ from touchdown to touchdown; one that does not vary in the study is none."""
    return [name for name in OF_TOUCHDOWN if name in explorer.input_names]


def _what(explorer: ExplorerTables, fitted: Table, beds: int) -> str:
    """What is evaluated, and over which range it is known."""
    ranges = listing([_range(fitted, name) for name in _of_touchdown(explorer)])
    return (
        "Any touchdown of a journey: move the two ends of an input range, and this page evaluates the emulator of all "
        "touchdowns over it. The emulator was fitted to "
        f"{thousands(fitted.row_count)} touchdowns on {beds} {'bed' if beds == 1 else 'beds'}, with {ranges}; the "
        "sliders extend to the end of its training range."
    )


def _range(fitted: Table, name: str) -> str:
    """The range of an input, "speed at impact from 0.01 to 0.08 m/s"."""
    low, high = (number(float(end), 2) for end in (fitted[name].min(), fitted[name].max()))
    return f"{input_words(name)} from {low} to {high} {fitted.columns[name].units}"


def _law(explorer: ExplorerTables) -> str:
    """What the inputs are drawn from, and what no slider moves."""
    moved = _of_touchdown(explorer)
    even = listing([f"the logarithm of {input_words(name)}" if name == IMPACT_SPEED else input_words(name)
                    for name in moved])  # fmt: skip
    uniform = "is uniform over its range" if len(moved) == 1 else "are uniform over their ranges"
    others = set(explorer.input_names) - {*OF_TOUCHDOWN, *explorer.attitude_inputs}
    words = [
        "soil and lander follow their input distributions" if others else "",
        f"{even} {uniform}, independently of the number of touchdowns there" if moved else "",
    ]
    attitude = "attitudes are uniform over all rotations, or have one side toward the ground"
    words = ["; ".join(filter(None, words)), f"{attitude}; spin and bed are part of the scatter" if explorer.attitude
             else "spin and bed are part of the scatter"]  # fmt: skip
    return " ".join(f"{one[:1].upper()}{one[1:]}." for one in words if one)
