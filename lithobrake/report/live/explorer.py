"""The explorer of the page: the coefficients of the emulator or expansion and the flown starts, for a browser."""

from html import escape
from typing import Any

import numpy as np

from lithobrake.report.content import LiveSection
from lithobrake.report.live.packed import packed, script_data
from lithobrake.report.page_data import DrawnPage, PageData, PaperPage
from lithobrake.report.words.captions import hours, input_words, listing, thousands
from lithobrake.report.words.drawn_warnings import action, has_interval
from lithobrake.report.words.labels import output
from lithobrake.results import ExplorerTables, Table
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome

# More flown starts would make the page heavier, and no cell of them noticeably smaller.
MOST_STARTS = 20_000
SCRIPTS = ("live/law.js", "live/flown.js", "live/explore.js", "live/charts.js", "live/explorer.js")
# The explorer's outputs, in the order in which it draws them: the first ones of its tables.
SHOWN = ("speed_out", "elevation_out", "spin_out")
LEVEL = ("velocity_out_x", "velocity_out_y")
START = ("start_speed", "start_elevation_deg", "velocity_x", "velocity_y")


def explorer_sections(data: PaperPage | DrawnPage) -> list[LiveSection]:
    """The explorer with all its numbers."""
    flown = _flown(data.flights)
    count = thousands(len(flown["status"]))
    flown_words = (
        f"Each lander that is drawn here takes the end of one of {count} flown starts, one of the eight nearest to its "
        "speed, elevation and azimuth: nothing is flown anew. "
        if count != "0"
        else "Nothing was flown, so neither shares nor places are shown. "
    )
    words = (
        f"Move the two ends of an input: the {data.model} is evaluated in this page, at every soil between them as "
        f"often as the study's law has it there. {_fixed(data, data.explorer)}"
    )
    numbers = {"facts": _facts(data, data.explorer), "law": packed(_law(data.explorer)), "flown": packed(flown)}
    html = f"""<section id="explorer">
<p class="note">{escape(f"{words}{_bands(data, data.explorer)} {flown_words}")}Grey lines: the whole law.</p>
<div class="explored"><div class="controls"></div><div class="views"><p class="share" aria-live="polite"></p>
<div class="charts"></div></div></div>
</section>
{script_data("explorer-data", numbers)}"""
    return [LiveSection("Explorer", html, SCRIPTS)]


def _fixed(data: PageData, explorer: ExplorerTables) -> str:
    """What is said of the inputs without sliders."""
    others = [input_words(name) for name in explorer.input_names if name not in _moved(data, explorer)]
    return f"Not kept by the screening, and over the whole law at all times: {listing(others)}. " if others else ""


def _moved(data: PageData, explorer: ExplorerTables) -> list[str]:
    """The inputs with sliders: those of an expansion that the screening has kept, and all of an emulator."""
    return list(data.results.kept_inputs if isinstance(data, PaperPage) else explorer.input_names)


def _bands(data: PaperPage | DrawnPage, explorer: ExplorerTables) -> str:
    """What the bands are, in a sentence."""
    fits = f"Bands: the middle nine tenths of {explorer.tables['location'].shape[0]} fits of the {data.model} to "
    if isinstance(data, PaperPage):
        return fits + "residuals that fall on other runs; no other bed."
    return fits + (
        "beds drawn with replacement." if has_interval(data) else "runs drawn with replacement; no other bed."
    )


def _law(explorer: ExplorerTables) -> dict[str, np.ndarray]:
    """The tables of the law; JSON-free arrays may hold infinite bounds."""
    return {name: np.asarray(table, dtype=np.float64) for name, table in explorer.tables.items()}


def _facts(data: PaperPage | DrawnPage, explorer: ExplorerTables) -> dict[str, Any]:
    """Names, units and words beside the numbers."""
    names, site = list(explorer.output_names), data.results.site
    units = {name: one.units for name, one in data.samples.columns.items()}
    shown = {name: output(name) for name in names if name in SHOWN}
    return {
        "inputNames": list(explorer.input_names),
        "moved": [explorer.input_names.index(name) for name in _moved(data, explorer)],
        "inputs": [{"words": input_words(name), "unit": units.get(name, "")} for name in explorer.input_names],
        "outputs": [
            {
                "words": one.row,
                "unit": one.unit,
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
        # The study's share is of all samples, those without an answer among them.
        "ofAll": isinstance(data, PaperPage),
        "fates": [str(fate) for fate in FlightStatus],
        "impact": list(FlightStatus).index(FlightStatus.IMPACT),
        "holds": site.holds,
        "action": action(data),
        "hours": hours(data.study["flight"]["duration"]),
        "site": [site.latitude_deg, site.longitude_deg],
        "bedCount": explorer.group_count,
        "reach": explorer.interval_reach if has_interval(data) else None,
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
