"""The impacts on the body as GeoJSON points in the frame of the body."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.export.map_frame import WORDS, MapFrame
from lithobrake.outcomes import FlightStatus
from lithobrake.results import StudyResults

PROPERTIES = ("time_s", "impact_speed", "impact_incidence_deg")


def write_geojson(results: StudyResults, path: Path) -> None:
    """Write a point for each flight that ends on the body, with its sample, facet, time and velocity of impact."""
    frame, flights = MapFrame.of(results), results.flights
    down = flights.where(np.flatnonzero(flights["status"] == FlightStatus.IMPACT))
    features = [
        {
            "type": "Feature",
            "geometry": {
                "type": "Point",
                "coordinates": [float(down["longitude_deg"][row]), float(down["latitude_deg"][row])],
            },
            "properties": {
                "sample": int(down["sample"][row]),
                "facet": int(down["facet"][row]),
                **{name: float(down[name][row]) for name in PROPERTIES},
            },
        }
        for row in range(down.row_count)
    ]
    # The newest standard knows the Earth alone; the member of the one before says which body this is.
    content: dict[str, Any] = {
        "type": "FeatureCollection",
        "name": f"impacts on {frame.body}",
        "crs": {"type": "name", "properties": {"name": frame.wkt}},
        "note": f"{WORDS}; coordinates in degrees, longitude first",
        "features": features,
    }
    with atomic_path(path) as draft:
        draft.write_text(json.dumps(content, allow_nan=False) + "\n", encoding="utf-8")
