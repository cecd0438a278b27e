"""The shape of the body as tables of other programs: plates, and numbers of each facet, as text and FITS."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.export.flown import ExportOptions, Flown, has_journeys
from lithobrake.files.atomic import write_rows, write_whole
from lithobrake.results import Column, StudyResults, Table

if TYPE_CHECKING:
    from lithobrake.smallbody import Body

# Files come in blocks of this many bytes; headers in cards of so many characters.
BLOCK, CARD = 2880, 80
# Format of the standard and of the file, by kind of number.
FORMATS = {"i": ("K", ">i8"), "f": ("D", ">f8")}


def write_fits_table(path: Path, name: str, columns: Mapping[str, Column]) -> None:
    """Write columns of whole numbers and floats as a table of this name, with their units and what they are."""
    kinds = {title: FORMATS[column.values.dtype.kind] for title, column in columns.items()}
    record = np.dtype([(title, kind[1]) for title, kind in kinds.items()])
    rows = np.empty(len(next(iter(columns.values())).values), dtype=record)
    for title, column in columns.items():
        rows[title] = column.values
    primary = [("SIMPLE", True, "FITS"), ("BITPIX", 8, ""), ("NAXIS", 0, ""), ("EXTEND", True, "")]
    table = [
        ("XTENSION", "BINTABLE", "binary table"), ("BITPIX", 8, ""), ("NAXIS", 2, ""),
        ("NAXIS1", record.itemsize, "bytes of a row"), ("NAXIS2", len(rows), "rows"),
        ("PCOUNT", 0, ""), ("GCOUNT", 1, ""), ("TFIELDS", len(columns), "columns"), ("EXTNAME", name, ""),
    ]  # fmt: skip
    for number, (title, column) in enumerate(columns.items(), 1):
        table += [(f"TTYPE{number}", title, column.long_name), (f"TFORM{number}", kinds[title][0], "")]
        table += [(f"TUNIT{number}", _unit(column.units), "")] if column.units else []
    data = rows.tobytes()
    write_whole(path, _header(primary) + _header(table) + data.ljust(-(-len(data) // BLOCK) * BLOCK, b"\0"))


def _unit(unit: str) -> str:
    """A unit as the standard writes it: powers with two stars."""
    return unit.replace("m2", "m**2")


def _header(cards: list[tuple[str, Any, str]]) -> bytes:
    text = "".join([*_cards(cards), "END".ljust(CARD)])
    return text.ljust(-(-len(text) // BLOCK) * BLOCK).encode("ascii")


def _cards(cards: list[tuple[str, Any, str]]) -> Iterator[str]:
    for key, value, comment in cards:
        written = f"'{value:<8}'".ljust(20) if isinstance(value, str) else f"{'T' if value is True else value:>20}"
        # A comment that is too long for its card is cut, as the standard says.
        yield f"{key:<8}= {written}{f' / {comment}' if comment else ''}"[:CARD].ljust(CARD)


def facet_names(results: StudyResults, _: ExportOptions) -> list[str]:
    """The files of facets. Raises ValueError where a study follows journeys, whose flights nobody counted by facet."""
    if has_journeys(results):
        raise ValueError(
            f"{results.folder} follows journeys, and facets have the impacts of first bounces: leave facets out, or "
            "take geotiff or geojson, which have the places of rest"
        )
    return ["facets.csv", "facets.fits"]


def write_facets(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write a row a facet as CSV and as a FITS table; a number that a facet does not have is left empty, and NaN."""
    table, (text, fits) = facet_table(results), paths
    titles = [f"{name} [{column.units}]" if column.units else name for name, column in table.columns.items()]
    columns = [column.values.tolist() for column in table.columns.values()]
    rows = zip(*columns, strict=True)
    write_rows(text, titles, (["" if value != value else value for value in row] for row in rows))
    write_fits_table(fits, "FACETS", table.columns)


def facet_table(results: StudyResults) -> Table:
    """Place, area and slope of each facet of body.obj, and the impacts on it."""
    flown, flights = Flown.of(results), results.flights
    hit = np.isfinite(flights["facet"])
    facet, count = flights["facet"][hit].astype(np.int64), len(flown.body.shape.faces)
    impacts = np.bincount(facet, minlength=count)

    def mean(name: str) -> np.ndarray:
        with np.errstate(invalid="ignore"):
            means: np.ndarray = np.bincount(facet, flights[name][hit], count) / np.where(impacts, impacts, np.nan)
        return means

    corner = flown.body.shape.corners
    centre = corner.mean(axis=1)
    latitude, longitude = flown.body.shape.latitude_longitude(centre)
    area = 0.5 * np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    columns = {
        "facet": Column(np.arange(count), "", "number of the facet, from 0"),
        "latitude_deg": Column(latitude, "deg", "planetocentric latitude of its centroid"),
        "longitude_deg": Column(longitude, "deg", "east longitude of its centroid"),
        "area": Column(area, "m2", "area"),
        "slope_deg": Column(
            np.degrees(_slope(flown.body, centre)), "deg", "angle of the normal from the upward plumb line"
        ),
        "impact_count": Column(impacts, "", "flights that end on it"),
        "impact_density": Column(impacts / len(hit) / area, "1/m2", "share of all flights that end on it, over area"),
        "impact_speed": Column(mean("impact_speed"), "m/s", "mean speed of those impacts"),
        "impact_incidence_deg": Column(
            mean("impact_incidence_deg"), "deg", "mean angle of their velocities from the inward normal"
        ),
    }
    return Table("facet", columns)


def _slope(body: "Body", centre: np.ndarray) -> np.ndarray:
    """Angle between outward normal and upward plumb line [rad] at the middle of each facet, shape [facet_count]."""
    felt = body.effective_acceleration(centre)
    along = -np.einsum("fi,fi->f", felt, body.shape.normals) / np.linalg.norm(felt, axis=1)
    slope: np.ndarray = np.arccos(np.clip(along, -1.0, 1.0))
    return slope


def write_plates(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write vertices [km] and plates, each with its number from 1, in the order of body.obj."""
    vertices, faces = results.body_shape
    lines = [str(len(vertices))]
    lines += [f"{number} {x!r} {y!r} {z!r}" for number, (x, y, z) in enumerate((vertices * 1e-3).tolist(), 1)]
    lines += [str(len(faces))]
    lines += [f"{number} {a} {b} {c}" for number, (a, b, c) in enumerate((np.asarray(faces) + 1).tolist(), 1)]
    write_whole(paths[0], "\n".join(lines) + "\n", "ascii")
