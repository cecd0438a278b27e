"""Where flights end, and the sites of a map, in the formats of geographic programs: GeoTIFF and GeoJSON."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.export.flown import ExportOptions, body_name, has_journeys, study_body
from lithobrake.files.atomic import atomic_path, write_json
from lithobrake.geometry.mesh import volume_of
from lithobrake.results import StudyResults, Table
from lithobrake.results.site_results import SiteMap
from lithobrake.vocabulary.file_names import REST_FILE
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd
from lithobrake.vocabulary.plain_text import program_name
from lithobrake.vocabulary.quantities import IMPACT_SPEED

if TYPE_CHECKING:
    from PIL.TiffImagePlugin import ImageFileDirectory_v2

# Tags of the file.
PIXEL_SCALE, TIE_POINT, KEYS, DOUBLES, TEXTS, GDAL_METADATA = 33550, 33922, 34735, 34736, 34737, 42112
USER_DEFINED, GEOGRAPHIC, PIXEL_IS_AREA, DEGREE = 32767, 2, 1, 9102
GDAL_NODATA = 42113
# Finer cells would take gigabytes of memory, and are smaller than what any study knows of a place.
FINEST_DEG = 0.05
BAND_UNIT = "1/m2"
WORDS = "latitude planetocentric, longitude east positive, both of the body-fixed frame"
NOTE = f"{WORDS}; coordinates in degrees, longitude first"
# Of each impact and of each place of rest, and what those columns hold that are no floats.
PROPERTIES = ("sample", "facet", "time_s", "impact_speed", "impact_incidence_deg")
REST_PROPERTIES = ("journey", "ground", "time_s", "distance", "touchdowns", "path_length")
JOURNEY_PROPERTIES = ("journey", "bed", "time_s", "distance", "contacts", "touchdowns", "path_length", "face")
TOUCHDOWN_PROPERTIES = ("journey", "touchdown", "key", "outcome", "begin_s", "end_s", IMPACT_SPEED)
NO_FLOATS: dict[str, Callable[[Any], int | str]] = {
    **dict.fromkeys(("sample", "facet", "journey", "bed", "contacts", "touchdowns", "touchdown"), int),
    **dict.fromkeys(("ground", "face", "key", "outcome"), str),
}
UNITS = "fractions of 1; s; m; deg; m/s2; _lower and _upper: 90 % intervals; _5 and _95: 90 % of the area lies between"


@dataclass(frozen=True)
class MapFrame:
    """A geographic frame on the sphere that has the volume of a body.

    On a sphere alone the latitude of a map is the planetocentric one, which an ellipsoid's is not.
    """

    body: str
    radius: float  # [m]

    @classmethod
    def of(cls, results: StudyResults) -> "MapFrame":
        return cls(body_name(results), _ball_radius(volume_of(*results.body_shape)))

    @classmethod
    def of_partner(cls, results: StudyResults) -> "MapFrame":
        """That of the other body of a binary."""
        site = results.results.site
        partner = study_body(results, site.mass_kg, site.spin_period_s).partner
        assert partner is not None
        return cls(program_name(partner.body.name), _ball_radius(partner.body.shape.volume))

    @property
    def name(self) -> str:
        return f"{self.body} sphere, planetocentric, east positive"

    @property
    def wkt(self) -> str:
        """The frame as well-known text."""
        return (
            f'GEOGCS["{self.name}",DATUM["{self.body}",SPHEROID["{self.body} sphere",{self.radius!r},0]],'
            f'PRIMEM["Longitude 0 of {self.body}_FIXED",0],UNIT["degree",0.017453292519943295]]'
        )


def _ball_radius(volume: float) -> float:
    """Radius [m] of a ball of a volume [m3]."""
    return (0.75 * volume / math.pi) ** (1.0 / 3.0)


def map_names(results: StudyResults, chosen: ExportOptions) -> list[str]:
    return ["rest.tif" if has_journeys(results) else "impacts.tif"]


def write_geotiff(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write which share of all flights ends in each cell of latitude and longitude, over the cell's area [1/m2]; of
    journeys of landings, which share of the landers rests there.

    The sum of values times areas of the cells, on the sphere of the file, is the share of flights that end on the body.
    """
    from PIL import Image

    resolution_deg = chosen.resolution_deg
    # What is far too fine has more cells than there are numbers.
    cells = round(180.0 / resolution_deg) if resolution_deg > 0.5 * FINEST_DEG else 0
    if not (1 <= cells <= round(180.0 / FINEST_DEG) and abs(cells * resolution_deg - 180.0) < 1e-9):
        raise ValueError(
            f"resolution is {resolution_deg} deg; allowed: {FINEST_DEG} to 180 deg, a whole part of 180 deg"
        )
    frame = MapFrame.of(results)
    band, what = ("rest", "landers that rest") if has_journeys(results) else ("impact", "flights that end")
    quantity = f"share of all {what} in the cell, over its area"
    image = Image.fromarray(impact_density(results, frame.radius, cells).astype(np.float32))
    with atomic_path(paths[0]) as draft:
        image.save(draft, format="TIFF", tiffinfo=_tags(frame, 180.0 / cells, f"{band} density", quantity))


def impact_density(results: StudyResults, radius: float, cells: int) -> np.ndarray:
    """Share of the flights by area [1/m2], shape [cells, 2 cells], first row at the north, first column at -180 deg."""
    table, ends = _ends_on_ground(results)
    edges = np.linspace(90.0, -90.0, cells + 1)
    counts, _, _ = np.histogram2d(
        table["latitude_deg"][ends],
        table["longitude_deg"][ends],
        bins=[edges[::-1], np.linspace(-180.0, 180.0, 2 * cells + 1)],
    )
    area = radius**2 * np.pi / cells * -np.diff(np.sin(np.radians(edges)))
    density: np.ndarray = counts[::-1] / max(table.row_count, 1) / area[:, None]
    return density


def _ends_on_ground(results: StudyResults) -> tuple[Table, np.ndarray]:
    """Flights of samples, or journeys, and which of them end on the body: of journeys those at rest."""
    if has_journeys(results):
        return results.journeys, results.journeys["end"] == JourneyEnd.AT_REST
    return results.flights, results.flights["status"] == FlightStatus.IMPACT


def _tags(frame: MapFrame, resolution_deg: float, band: str, quantity: str) -> "ImageFileDirectory_v2":
    """What the file says of its cells, of their frame, and of the quantity in them."""
    from PIL.TiffImagePlugin import ImageFileDirectory_v2

    citation = f"GCS Name = {frame.name}|Datum = {frame.body}|Ellipsoid = {frame.body} sphere|Primem = {frame.body}|"
    doubles = (frame.radius, frame.radius, 0.0)
    entries = [
        (1024, 0, 1, GEOGRAPHIC), (1025, 0, 1, PIXEL_IS_AREA), (2048, 0, 1, USER_DEFINED),
        (2049, TEXTS, len(citation), 0), (2050, 0, 1, USER_DEFINED), (2051, 0, 1, USER_DEFINED), (2054, 0, 1, DEGREE),
        (2056, 0, 1, USER_DEFINED), (2057, DOUBLES, 1, 0), (2058, DOUBLES, 1, 1), (2061, DOUBLES, 1, 2),
    ]  # fmt: skip
    items = {"QUANTITY": quantity, "UNIT": BAND_UNIT, "FRAME": WORDS}
    metadata = "".join(f'<Item name="{name}">{words}</Item>' for name, words in items.items())
    of_band = {"DESCRIPTION": band, "UNITTYPE": BAND_UNIT}
    metadata += "".join(
        f'<Item name="{name}" sample="0" role="{name.lower()}">{words}</Item>' for name, words in of_band.items()
    )
    tags = ImageFileDirectory_v2()
    values = {
        PIXEL_SCALE: (12, (resolution_deg, resolution_deg, 0.0)),
        TIE_POINT: (12, (0.0, 0.0, 0.0, -180.0, 90.0, 0.0)),
        KEYS: (3, (1, 1, 0, len(entries), *(number for entry in entries for number in entry))),
        DOUBLES: (12, doubles),
        TEXTS: (2, citation),
        GDAL_METADATA: (2, f"<GDALMetadata>{metadata}</GDALMetadata>"),
        # Every cell has a value, 0 where no flight ends.
        GDAL_NODATA: (2, "nan"),
    }
    for tag, (kind, value) in values.items():
        tags.tagtype[tag] = kind
        tags[tag] = value
    return tags


def point_names(results: StudyResults, chosen: ExportOptions) -> list[str]:
    has_rest = has_journeys(results) or (results.folder / REST_FILE).is_file()
    partner = results.results.site.partner
    there = [f"impacts_{partner}.geojson", f"rest_{partner}.geojson"] if _is_on_partner(results).any() else []
    return ["impacts.geojson", *(["rest.geojson"] if has_rest else []), *there]


def _is_on_partner(results: StudyResults) -> np.ndarray:
    """Which touchdowns of journeys are on the other body of a binary, [touchdown_count]; none of other studies."""
    partner = results.results.site.partner
    if partner is None or not has_journeys(results):
        return np.zeros(0, dtype=bool)
    there: np.ndarray = results.touchdowns["body"] == partner
    return there


def write_geojson(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write a point for each flight that ends on the body, or each touchdown of journeys, and one for each place of
    rest, with their numbers; those on the partner of the body to files of their own."""
    ends, ends_on_ground = _ends_on_ground(results)
    frame = MapFrame.of(results)
    if has_journeys(results):
        touchdowns = results.touchdowns
        there = _is_on_partner(results) if len(paths) > 2 else np.zeros(touchdowns.row_count, dtype=bool)
        _write_points(frame, paths[0], "touchdowns", touchdowns.where(~there), TOUCHDOWN_PROPERTIES)
        _write_points(frame, paths[1], "places of rest", ends.where(ends_on_ground), JOURNEY_PROPERTIES)
        if len(paths) > 2:
            rests, partner = ends.where(ends["end"] == JourneyEnd.PARTNER), MapFrame.of_partner(results)
            own = tuple(name for name in JOURNEY_PROPERTIES if name != "distance")
            _write_points(partner, paths[2], "touchdowns", touchdowns.where(there), TOUCHDOWN_PROPERTIES)
            _write_points(partner, paths[3], "places of rest", rests, own)
        return
    _write_points(frame, paths[0], "impacts", ends.where(ends_on_ground), PROPERTIES)
    for path in paths[1:]:
        at_rest = results.rest.where(results.rest["end"] == JourneyEnd.AT_REST)
        # A table without rows lacks some of its columns.
        known = [name for name in REST_PROPERTIES if name in at_rest.columns]
        _write_points(frame, path, "places of rest", at_rest, known)


def _write_points(frame: MapFrame, path: Path, what: str, table: Table, names: Sequence[str]) -> None:
    """Write the places of a table, one point a row with its numbers of these names, in the frame of their body."""
    features = [
        {
            "type": "Feature",
            "geometry": {
                "type": "Point",
                "coordinates": [float(table["longitude_deg"][row]), float(table["latitude_deg"][row])],
            },
            "properties": {name: NO_FLOATS.get(name, float)(table[name][row]) for name in names},
        }
        for row in range(table.row_count)
    ]
    write_features(frame, path, what, features, units={name: table.columns[name].units for name in names})


def write_features(frame: MapFrame, path: Path, what: str, features: Sequence[Any], **more: Any) -> None:
    """Write features as GeoJSON in the frame of the body; more: members that say more of them."""
    # RFC 7946 has coordinates on the Earth alone and no member for others: this one has a name of its own.
    content = {
        "type": "FeatureCollection",
        "name": f"{what} on {frame.body}",
        "body_frame": frame.wkt,
        "note": NOTE,
        **more,
        "features": features,
    }
    write_json(path, content, indent=None)


def site_cells_file(place: Path) -> Path:
    """The file of the polygons in the folder of a map."""
    return place / "sites.geojson"


def write_site_cells(site_map: SiteMap, place: Path) -> Path:
    """Write a polygon for each site of a map, with its numbers, null where it has none; returns the file.

    Borders of sites are lines of constant latitude or longitude, as straight lines in these coordinates are.
    """
    radius = math.sqrt(site_map.area_m2 * len(site_map.cells) / (4.0 * math.pi))
    frame, path = MapFrame(program_name(site_map.body), radius), site_cells_file(place)
    features = []
    for number, site in enumerate(site_map.cells):
        south, north, west, east = site.bounds_deg
        ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
        polygon = {"type": "Polygon", "coordinates": [ring]}
        features.append({"type": "Feature", "id": number, "geometry": polygon, "properties": site.row})
    write_features(frame, path, "sites", features, note=f"{NOTE}; {UNITS}")
    return path
