"""The sites of a map as polygons for other programs: GeoJSON in the geographic frame of the body's own."""

import math
from pathlib import Path

from lithobrake.export.flown import plain_name
from lithobrake.export.maps import NOTE, MapFrame, write_features
from lithobrake.results.site_map import SiteMap

UNITS = "fractions of 1; s; m; deg; m/s2; _lower and _upper: 90 % intervals; _5 and _95: 90 % of the area lies between"


def site_cells_file(place: Path) -> Path:
    """The file of the polygons in the folder of a map."""
    return place / "sites.geojson"


def write_site_cells(site_map: SiteMap, place: Path) -> Path:
    """Write a polygon for each site of a map, with its numbers, null where it has none; returns the file.

    Borders of sites are lines of constant latitude or longitude, as straight lines in these coordinates are.
    """
    radius = math.sqrt(site_map.area_m2 * len(site_map.cells) / (4.0 * math.pi))
    frame, path = MapFrame(plain_name(site_map.body), radius), site_cells_file(place)
    features = []
    for number, site in enumerate(site_map.cells):
        south, north, west, east = site.bounds_deg
        ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
        features += [
            {
                "type": "Feature",
                "id": number,
                "geometry": {"type": "Polygon", "coordinates": [ring]},
                "properties": site.row,
            }
        ]
    write_features(frame, path, "sites", features, note=f"{NOTE}; {UNITS}")
    return path
