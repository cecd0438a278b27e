"""Plates and numbers of facets, as the libraries of their fields read them."""

import csv
from pathlib import Path

import numpy as np
import pytest

from lithobrake.export import write_facet_csv, write_facet_fits, write_plates
from lithobrake.results import StudyResults
from lithobrake.smallbody import Shape, dimorphos


def test_plates_make_a_shape_kernel_with_the_same_shape(results: StudyResults, tmp_path: Path) -> None:
    """What MKDSK does with the table, by the routines that it calls, and back."""
    spice = pytest.importorskip("spiceypy")
    write_plates(results, tmp_path / "body.txt")
    words = (tmp_path / "body.txt").read_text().split()
    count = int(words[0])
    numbered = np.array(words[1 : 1 + 4 * count], dtype=float).reshape(-1, 4)
    plates = np.array(words[2 + 4 * count :], dtype=np.int64).reshape(-1, 4)
    assert int(words[1 + 4 * count]) == len(plates)
    for table in (numbered, plates):
        assert table[:, 0].tolist() == list(range(1, len(table) + 1))
    kernel = str(tmp_path / "body.bds")
    handle = spice.dskopn(kernel, "test", 0)
    vertices, faces = (np.array(table[:, 1:], order="C") for table in (numbered, plates.astype(np.int32)))
    spaixd, spaixi = spice.dskmi2(vertices, faces, 0.5, 5, 100000, 100000, 100000, True, 1000000)
    corners = (-np.pi, np.pi, -np.pi / 2, np.pi / 2, 0.0, 1.0)
    spice.dskw02(
        *(handle, 120065803, 1, 1, "J2000", 1, np.zeros(10), *corners, -1e9, 1e9, vertices, faces, spaixd, spaixi)
    )
    spice.dskcls(handle, True)
    handle = spice.dasopr(kernel)
    found = spice.dskv02(handle, spice.dlabfs(handle), 1, count)
    read = spice.dskp02(handle, spice.dlabfs(handle), 1, len(plates))
    spice.dascls(handle)
    shape = Shape(np.array(found) * 1e3, np.array(read, dtype=np.int64) - 1)
    assert shape.vertices == pytest.approx(dimorphos().shape.vertices, rel=1e-15)
    assert np.array_equal(shape.faces, dimorphos().shape.faces)


def test_a_plate_table_is_read_as_a_shape_again(results: StudyResults, tmp_path: Path) -> None:
    write_plates(results, tmp_path / "body.tab")
    shape = Shape.read(tmp_path / "body.tab", "km")
    assert shape.volume == pytest.approx(dimorphos().shape.volume, rel=1e-14)


def test_facets_of_both_tables_are_those_of_the_shape_in_its_order(results: StudyResults, tmp_path: Path) -> None:
    fits = pytest.importorskip("astropy.io.fits")
    write_facet_csv(results, tmp_path / "facets.csv")
    write_facet_fits(results, tmp_path / "facets.fits")
    with open(tmp_path / "facets.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    with fits.open(tmp_path / "facets.fits") as file:
        file.verify("exception")
        table, columns = file["FACETS"].data, file["FACETS"].columns
        shape = dimorphos().shape
        assert len(rows) == len(table) == len(shape.faces)
        assert columns["area"].unit == "m**2"
        assert table["facet"].tolist() == list(range(len(table)))
        assert table["area"].sum() == pytest.approx(
            np.linalg.norm(shape.polyhedron.facet_terms[:, :3], axis=1) @ table["area"]
        )
        for name, title in (
            ("area", "area [m2]"),
            ("slope_deg", "slope_deg [deg]"),
            ("latitude_deg", "latitude_deg [deg]"),
        ):
            assert [float(row[title]) for row in rows] == table[name].tolist()
        latitude, longitude = shape.latitude_longitude(shape.corners.mean(axis=1))
        assert table["latitude_deg"] == pytest.approx(latitude)
        assert table["longitude_deg"] == pytest.approx(longitude)


def test_impacts_lie_on_the_facets_that_the_flights_name(results: StudyResults, tmp_path: Path) -> None:
    fits = pytest.importorskip("astropy.io.fits")
    write_facet_fits(results, tmp_path / "facets.fits")
    table, flights = fits.getdata(tmp_path / "facets.fits"), results.flights
    facet = int(flights["facet"][0])
    on_it = flights["facet"] == facet
    assert table["impact_count"][facet] == on_it.sum()
    assert table["impact_count"].sum() == np.isfinite(flights["facet"]).sum()
    assert table["impact_speed"][facet] == pytest.approx(flights["impact_speed"][on_it].mean())
    assert np.isnan(table["impact_speed"][table["impact_count"] == 0]).all()
    share = (table["impact_density"] * table["area"]).sum()
    assert share == pytest.approx(np.isfinite(flights["facet"]).mean())


def test_slopes_are_those_of_the_body(results: StudyResults, tmp_path: Path) -> None:
    from lithobrake.export.flown import Flown
    from lithobrake.export.shape_tables import facet_table

    table, body = facet_table(results), Flown.of(results).body
    # The middle of a facet, seen from the origin, lies in that facet where the body is convex.
    slope = np.degrees(body.slope(table["latitude_deg"], table["longitude_deg"]))
    assert table["slope_deg"] == pytest.approx(slope, abs=1e-9)
