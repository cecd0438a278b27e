"""Journeys of landers as a document of CZML, which Cesium plays.

Source: [CZML-2022]
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.export.attitudes import one_sided, sampled, turns_of
from lithobrake.export.ephemerides import checked_step, flight_segments
from lithobrake.export.flown import ExportOptions, Flown, has_journeys
from lithobrake.export.oem import RESOLUTION, Frame, Segment, epoch_texts
from lithobrake.files.atomic import write_json
from lithobrake.results import StudyResults
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.known_bodies import printed_name
from lithobrake.vocabulary.outcomes import END_COLOURS, FATE_COLOURS, FlightStatus, JourneyEnd
from lithobrake.vocabulary.quantities import ORIENTATION_OUT

# So many landers where none are chosen; the film lasts so long [s]; landers at rest are shown on for a part of it.
SHOWN, FILM, AFTER = 20, 60.0, 0.1
# Of the polynomials between states; Cesium has Hermite's only for states of one velocity at each time.
DEGREE = 5
NOTE = (
    "Positions are body-fixed, in metres from the origin of the shape, and stand as the Earth-fixed ones of Cesium: "
    "hide its globe. The ellipsoid has the extents of the body."
)


def write_czml(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write a packet for each chosen lander: body-fixed way and, where that is known, attitude; a colour by its end.

    Without chosen samples the first 20 are shown. Raises ValueError as write_ephemerides does.
    """
    axes, flown = Frame.of(results, "fixed", chosen.epoch), Flown.of(results)
    flights = axes.timed(results, flown.journeys(results, chosen.samples or flown.sample[:SHOWN].tolist()))
    parts = flight_segments(flights, axes, checked_step(flown, chosen.step), chosen.progress)
    begin = min(float(one[0].time[0]) for one in parts.values())
    end = max(float(one[-1].time[-1]) for one in parts.values())
    if has_journeys(results):
        end = max(end, *(_rest_time(results, flights, sample) for sample in parts))
    end += AFTER * (end - begin)
    packets = [_document(axes, begin, end), _body(results, axes)]
    for sample, segments in parts.items():
        packets.append(_lander(results, flights, axes, sample, segments, end))
    write_json(paths[0], packets, indent=None)


def _document(axes: Frame, begin: float, end: float) -> dict[str, Any]:
    clock = {
        "interval": _interval(axes, begin, end),
        "currentTime": _text(axes, begin),
        "multiplier": (end - begin) / FILM,
        "range": "LOOP_STOP",
    }
    words = f"{NOTE} {axes.clock_sentence}"
    return {"id": "document", "version": "1.0", "name": f"Landers on {axes.body}", "description": words, "clock": clock}


def _body(results: StudyResults, axes: Frame) -> dict[str, Any]:
    """The ellipsoid that has the extents of the body, where its shape has them."""
    low, high = (pick(results.body_shape[0], axis=0) for pick in (np.min, np.max))
    fill = {"solidColor": {"color": {"rgba": [139, 143, 150, 255]}}}
    return {
        "id": axes.body,
        "name": axes.body,
        "position": {"referenceFrame": "FIXED", "cartesian": (0.5 * (low + high)).tolist()},
        "orientation": {"unitQuaternion": [0.0, 0.0, 0.0, 1.0]},
        "ellipsoid": {"radii": {"cartesian": (0.5 * (high - low)).tolist()}, "material": fill},
    }


def _lander(
    results: StudyResults, flights: Flown, axes: Frame, sample: int, segments: list[Segment], end: float
) -> dict[str, Any]:
    """The packet of a lander; end: of the film [s]."""
    fate = _fate(results, sample)
    colour = {"rgba": [*(int((END_COLOURS | FATE_COLOURS)[fate][1 + 2 * one :][:2], 16) for one in range(3)), 255]}
    ways = [_way(axes, segment.time, segment.state[:, :3], DEGREE) for segment in segments]
    ways += [_contact(axes, one, other) for one, other in pairwise(segments)]
    last = float(segments[-1].time[-1])
    if fate == JourneyEnd.AT_REST:
        place = np.array([results.journeys[f"position_{axis}"][sample] for axis in "xyz"])
        rest = _rest_time(results, flights, sample)
        ways.append(_way(axes, np.array([last, rest]), np.array([segments[-1].state[-1, :3], place]), 1))
        ways.append({"interval": _interval(axes, rest, end), "referenceFrame": "FIXED", "cartesian": place.tolist()})
        last = end
    packet = {
        "id": f"SAMPLE_{sample}",
        "name": f"lander {sample}: {_fate_words(results, fate)}",
        "availability": _interval(axes, float(segments[0].time[0]), last),
        "position": sorted(ways, key=lambda way: str(way["interval"])),
        "point": {"pixelSize": 6, "color": colour},
        "path": {"width": 2, "leadTime": 0, "material": {"solidColor": {"color": colour}}},
    }
    turned = _orientation(results, flights, axes, sample)
    return packet | ({"orientation": turned} if turned else {})


def _fate(results: StudyResults, sample: int) -> JourneyEnd | FlightStatus:
    """How the journey of a sample ended, or where no journeys are followed its flight."""
    if has_journeys(results):
        return JourneyEnd(results.journeys["end"][sample])
    row = int(np.flatnonzero(results.flights["sample"] == sample)[0])
    return FlightStatus(results.flights["status"][row])


def _fate_words(results: StudyResults, fate: JourneyEnd | FlightStatus) -> str:
    partner = results.results.site.partner
    return f"at rest on {printed_name(str(partner))}" if fate is JourneyEnd.PARTNER and partner else fate.label


def _rest_time(results: StudyResults, flights: Flown, sample: int) -> float:
    """When a journey ends [s]."""
    of_sample = np.flatnonzero(flights.sample == sample)[-1]
    arcs = results.arcs.where(results.arcs["sample"] == sample)
    # Of arcs the beginning counts from the first touchdown, as the end of the journey does.
    return float(flights.begin[of_sample] - arcs["begin_s"][-1] + results.journeys["time_s"][sample])


def _orientation(results: StudyResults, flights: Flown, axes: Frame, sample: int) -> list[dict[str, Any]]:
    """How the lander turns, in intervals; none where that is not known."""
    if not has_journeys(results) or not set(ORIENTATION_OUT) <= set(results.touchdowns):
        return []
    found = []
    for turn in turns_of(results, flights, sample):
        time, attitudes = sampled(turn, axes, None)
        table = np.column_stack([turn.begin + time, one_sided(attitudes)])
        found.append(_sampled(axes, "unitQuaternion", table, 1))
    return found


def _way(axes: Frame, time: Array, place: Array, degree: int) -> dict[str, Any]:
    """A way in an interval; times since the epoch [s], [count], places [m], [count, 3]."""
    return _sampled(axes, "cartesian", np.column_stack([time, place]), degree) | {"referenceFrame": "FIXED"}


def _contact(axes: Frame, before: Segment, after: Segment) -> dict[str, Any]:
    """The way over the ground between two flights, as a straight line."""
    time = np.array([before.time[-1], max(after.time[0], before.time[-1] + RESOLUTION)])
    return _way(axes, time, np.array([before.state[-1, :3], after.state[0, :3]]), 1)


def _sampled(axes: Frame, name: str, table: Array, degree: int) -> dict[str, Any]:
    """A property in an interval from rows of times and values."""
    return {
        "interval": _interval(axes, table[0, 0], table[-1, 0]),
        "epoch": _text(axes, 0.0),
        name: table.ravel().tolist(),
        "interpolationAlgorithm": "LAGRANGE" if degree > 1 else "LINEAR",
        "interpolationDegree": min(degree, len(table) - 1),
    }


def _interval(axes: Frame, begin: float, end: float) -> str:
    return f"{_text(axes, begin)}/{_text(axes, end)}"


def _text(axes: Frame, time: float) -> str:
    return f"{epoch_texts(axes.epoch, np.array([time]))[0]}Z"
