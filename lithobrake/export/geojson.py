"""The impacts on the body, and the places of rest, as GeoJSON points in the frame of the body."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.export.map_frame import WORDS, MapFrame
from lithobrake.files.atomic import atomic_path
from lithobrake.results import StudyResults, Table
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus

PROPERTIES = ("time_s", "impact_speed", "impact_incidence_deg")
REST_PROPERTIES = ("time_s", "rebounds", "path_length")


def write_geojson(results: StudyResults, path: Path) -> None:
    """Write a point for each flight that ends on the body, with its sample, facet, time and velocity of impact."""
    flights = results.flights
    down = flights.where(np.flatnonzero(flights["status"] == FlightStatus.IMPACT))
    properties = [
        {
            "sample": int(down["sample"][row]),
            "facet": int(down["facet"][row]),
            **{name: float(down[name][row]) for name in PROPERTIES},
        }
        for row in range(down.row_count)
    ]
    _write_points(results, path, "impacts", down, properties)


def write_rest_geojson(results: StudyResults, path: Path) -> None:
    """Write a point for each journey that ends at rest, with its sample and the ground that it was followed on."""
    journeys = results.rest
    settled = journeys.where(np.flatnonzero(journeys["status"] == JourneyStatus.SETTLED))
    # Journeys of an earlier version may lack some of these.
    known = [name for name in REST_PROPERTIES if name in settled.columns]
    properties = [
        {
            "sample": int(settled["sample"][row]),
            "ground": str(settled["ground"][row]),
            **{name: float(settled[name][row]) for name in known},
        }
        for row in range(settled.row_count)
    ]
    _write_points(results, path, "places of rest", settled, properties)


def _write_points(
    results: StudyResults, path: Path, what: str, table: Table, properties: Sequence[Mapping[str, Any]]
) -> None:
    """Write the places of a table, one point a row, in the frame of the body."""
    frame = MapFrame.of(results)
    features = [
        {
            "type": "Feature",
            "geometry": {
                "type": "Point",
                "coordinates": [float(table["longitude_deg"][row]), float(table["latitude_deg"][row])],
            },
            "properties": one,
        }
        for row, one in enumerate(properties)
    ]
    # The newest standard knows the Earth alone; the member of the one before says which body this is.
    content: dict[str, Any] = {
        "type": "FeatureCollection",
        "name": f"{what} on {frame.body}",
        "crs": {"type": "name", "properties": {"name": frame.wkt}},
        "note": f"{WORDS}; coordinates in degrees, longitude first",
        "features": features,
    }
    with atomic_path(path) as draft:
        draft.write_text(json.dumps(content, allow_nan=False) + "\n", encoding="utf-8")
