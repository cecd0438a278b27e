"""Maps, plates and numbers of facets as the libraries of their fields read them; the command that writes files."""

import csv
import json
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.export import KINDS, ExportOptions, export_study, formats
from lithobrake.export.maps import MapFrame
from lithobrake.pipeline import run_study
from lithobrake.results import MovingBodies, StudyResults, open_study
from lithobrake.smallbody import Shape, dimorphos
from lithobrake.study import StudySource

from ..few_grains import EXPANSION, ONE_IMPACT, few_grains
from ..quick_studies import quick_studies


def test_cells_hold_the_share_of_the_flights_that_end_in_them(results: StudyResults, tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    (path,) = export_study(results, tmp_path, ["geotiff"], ExportOptions(resolution_deg=2.0))
    with rasterio.open(path) as file:
        density, crs, tags = file.read(1), file.crs, file.tags()
        assert tuple(file.bounds) == (-180.0, -90.0, 180.0, 90.0)
        assert file.tags()["AREA_OR_POINT"] == "Area"
        assert (file.descriptions, file.units) == (("impact density",), ("1/m2",))
        assert np.isnan(file.nodata)
        latitude, longitude = results.flights["latitude_deg"], results.flights["longitude_deg"]
        cells = {file.index(east, north) for north, east in zip(latitude, longitude, strict=True)}
    assert {tuple(cell) for cell in np.argwhere(density > 0.0).tolist()} == cells
    radius = MapFrame.of(results).radius
    area = radius**2 * np.radians(2.0) * -np.diff(np.sin(np.radians(np.linspace(90.0, -90.0, 91))))
    assert (density * area[:, None]).sum() == pytest.approx(1.0, rel=1e-6)
    # The frame is a sphere of this body, in degrees, and no place of the Earth.
    assert crs.is_geographic
    found = crs.to_dict()
    assert (found["proj"], found["R"]) == ("longlat", pytest.approx(radius))
    assert "planetocentric, east positive" in crs.to_wkt()
    assert tags["UNIT"] == "1/m2"


def test_points_carry_what_the_flights_have_and_the_frame_of_the_body(results: StudyResults, tmp_path: Path) -> None:
    geojson = pytest.importorskip("geojson")
    rasterio = pytest.importorskip("rasterio")
    path, _ = export_study(results, tmp_path, ["geojson"])
    found = geojson.loads(path.read_text())
    assert found.is_valid
    assert len(found["features"]) == 16
    for row, point in enumerate(found["features"]):
        assert point["geometry"]["coordinates"] == pytest.approx(
            # The library keeps six digits of a degree.
            [results.flights["longitude_deg"][row], results.flights["latitude_deg"][row]],
            abs=1e-6,
        )
        assert point["properties"]["impact_speed"] == results.flights["impact_speed"][row]
    content = json.loads(path.read_text())
    # RFC 7946, section 4: no member "crs".
    assert "crs" not in content
    crs = rasterio.crs.CRS.from_user_input(content["body_frame"])
    assert crs.to_dict()["R"] == pytest.approx(MapFrame.of(results).radius)


def test_places_of_rest_are_those_of_the_landers_that_rest(results: StudyResults, tmp_path: Path) -> None:
    _, path = export_study(results, tmp_path, ["geojson"])
    found = json.loads(path.read_text())
    assert found["name"] == "places of rest on DIMORPHOS"
    rows = [row for row, end in enumerate(results.rest["end"]) if end == "at_rest"]
    assert [point["properties"]["journey"] for point in found["features"]] == results.rest["journey"][rows].tolist()
    for row, point in zip(rows, found["features"], strict=True):
        place = [results.rest["longitude_deg"][row], results.rest["latitude_deg"][row]]
        assert point["geometry"]["coordinates"] == place
        assert set(point["properties"]) == {"journey", "ground", "time_s", "distance", "touchdowns", "path_length"}
    assert found["units"] == {
        "journey": "", "ground": "", "time_s": "s", "distance": "m", "touchdowns": "", "path_length": "m",
    }  # fmt: skip


def test_places_of_rest_of_journeys_have_frame_nodata_and_units(delivered: StudyResults, tmp_path: Path) -> None:
    """The cell, the point and the table have one place; a swap of latitude and longitude puts them apart."""
    geojson, rasterio = pytest.importorskip("geojson"), pytest.importorskip("rasterio")
    _, points, cells = export_study(delivered, tmp_path, ["geojson", "geotiff"])
    found = geojson.loads(points.read_text())
    journeys, radius = delivered.journeys, MapFrame.of(delivered).radius
    assert found.is_valid
    assert found["units"]["path_length"] == "m"
    numbers = [point["properties"]["journey"] for point in found["features"]]
    assert numbers == np.flatnonzero(journeys["end"] == "at_rest").tolist()
    assert cells.name == "rest.tif"
    with rasterio.open(cells) as file:
        density = file.read(1)
        assert (file.descriptions, file.units) == (("rest density",), ("1/m2",))
        assert np.isnan(file.nodata)
        for number, point in zip(numbers, found["features"], strict=True):
            east, north = point["geometry"]["coordinates"]
            assert [north, east] == pytest.approx(
                [journeys["latitude_deg"][number], journeys["longitude_deg"][number]], abs=1e-6
            )
            row, column = file.index(east, north)
            strip = np.diff(np.sin(np.radians([89.0 - row, 90.0 - row])))[0]
            share = density[row, column] * radius**2 * np.radians(1.0) * strip
            assert share * 8 == pytest.approx(round(share * 8), abs=1e-5)
            assert round(share * 8) >= 1


@pytest.mark.parametrize("resolution", [0.0, -1.0, 0.7, 1e-320, 0.01, float("nan")])
def test_cells_that_do_not_fit_the_globe_are_refused(results: StudyResults, tmp_path: Path, resolution: float) -> None:
    with pytest.raises(ValueError, match="a whole part of 180"):
        export_study(results, tmp_path, ["geotiff"], ExportOptions(resolution_deg=resolution))


def test_plates_make_a_shape_kernel_with_the_same_shape(results: StudyResults, tmp_path: Path) -> None:
    """What MKDSK does with the table, by the routines that it calls, and back."""
    spice = pytest.importorskip("spiceypy")
    (path,) = export_study(results, tmp_path, ["plates"])
    words = path.read_text().split()
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
    (path,) = export_study(results, tmp_path, ["plates"])
    assert Shape.read(path, "km").volume == pytest.approx(dimorphos().shape.volume, rel=1e-14)


def test_facets_of_both_tables_are_those_of_the_shape_in_its_order(results: StudyResults, tmp_path: Path) -> None:
    fits = pytest.importorskip("astropy.io.fits")
    text, binary = export_study(results, tmp_path, ["facets"])
    with text.open(newline="") as file:
        rows = list(csv.DictReader(file))
    with fits.open(binary) as file:
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
        assert (table["latitude_deg"], table["longitude_deg"]) == (pytest.approx(latitude), pytest.approx(longitude))


def test_impacts_lie_on_the_facets_that_the_flights_name(results: StudyResults, tmp_path: Path) -> None:
    fits = pytest.importorskip("astropy.io.fits")
    _, path = export_study(results, tmp_path, ["facets"])
    table, flights = fits.getdata(path), results.flights
    facet = int(flights["facet"][0])
    on_it = flights["facet"] == facet
    assert table["impact_count"][facet] == on_it.sum()
    assert table["impact_count"].sum() == np.isfinite(flights["facet"]).sum()
    assert table["impact_speed"][facet] == pytest.approx(flights["impact_speed"][on_it].mean())
    assert np.isnan(table["impact_speed"][table["impact_count"] == 0]).all()
    assert (table["impact_density"] * table["area"]).sum() == pytest.approx(np.isfinite(flights["facet"]).mean())


def test_slopes_are_those_of_the_body(results: StudyResults, tmp_path: Path) -> None:
    from lithobrake.export.flown import Flown
    from lithobrake.export.shape_tables import facet_table

    table, body = facet_table(results), Flown.of(results).body
    # The middle of a facet, seen from the origin, lies in that facet where the body is convex.
    slope = np.degrees(body.slope(table["latitude_deg"], table["longitude_deg"]))
    assert table["slope_deg"] == pytest.approx(slope, abs=1e-9)


RUNNER = CliRunner()


def test_each_kind_is_written_once(results: StudyResults, tmp_path: Path) -> None:
    # A study whose solver is its own has no landing to show.
    # Attitudes and bounce laws are known of journeys alone, and this study has no pole.
    shown = [kind for kind in KINDS if kind not in ("vtkhdf", "sheet", "aem", "spk", "bounce-law")]
    kinds = [word for kind in [*shown, "plates"] for word in ("--to", kind)]
    sample = int(results.flights["sample"][0])
    chosen = ["--flight", str(sample), "--step", "600", "--out", str(tmp_path)]
    found = RUNNER.invoke(app, ["export", str(results.folder), *kinds, *chosen])
    assert found.exit_code == 0, found.output
    written = ["flight_mean.oem", f"flight_{sample}.oem", "landers.czml", "body.plates.txt", "facets.csv"]
    written += ["facets.fits", "impacts.tif", "impacts.geojson", "rest.geojson"]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(written)
    assert found.stdout.splitlines() == [f"Wrote {tmp_path / name}" for name in written]


def test_journeys_have_attitudes_and_kernels(delivered: StudyResults, tmp_path: Path) -> None:
    pytest.importorskip("spiceypy")
    words = [word for kind in ("aem", "spk") for word in ("--to", kind)]
    place = ["--flight", "1", "--flight", "2", "--step", "300", "--out", str(tmp_path)]
    found = RUNNER.invoke(app, ["export", str(delivered.folder), *words, *place, "--frame", "icrf"])
    assert found.exit_code == 0, found.output
    written = ["attitude_1.aem", "attitude_2.aem", "flights.bsp", "body.tpc"]
    assert found.stdout.splitlines() == [f"Wrote {tmp_path / name}" for name in written]
    none = RUNNER.invoke(app, ["export", str(delivered.folder), *words, "--out", str(tmp_path), "--force"])
    assert none.exit_code == 2
    assert "name some with --flight" in none.stderr


def test_the_files_stand_in_the_folder_of_the_study_unless_told_otherwise(results: StudyResults) -> None:
    assert RUNNER.invoke(app, ["export", str(results.folder), "--to", "plates", "--force"]).exit_code == 0
    assert (results.folder / "export/body.plates.txt").is_file()


@pytest.mark.parametrize(("kind", "name"), [
    ("oem", "flight_mean.oem"),
    ("plates", "body.plates.txt"),
    ("facets", "facets.fits"),
    ("geotiff", "impacts.tif"),
    ("geojson", "rest.geojson"),
    ("vtkhdf", "bed_0.vtkhdf"),
    ("sheet", "landing.png"),
])  # fmt: skip
def test_a_file_of_the_user_is_replaced_when_told(results: StudyResults, tmp_path: Path, kind: str, name: str) -> None:
    (tmp_path / name).write_text("mine")
    words = ["export", str(results.folder), "--to", "plates", "--to", kind, "--step", "600", "--out", str(tmp_path)]
    found = RUNNER.invoke(app, words)
    assert (found.exit_code, found.stdout) == (2, "")
    assert found.stderr.startswith(f"{tmp_path / name} exists; choose another folder with --out, or replace")
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "mine"
    if kind not in ("vtkhdf", "sheet"):
        assert RUNNER.invoke(app, [*words, "--force"]).exit_code == 0
        assert (tmp_path / name).read_bytes() != b"mine"


def test_what_is_wrong_is_said_in_one_sentence(results: StudyResults, tmp_path: Path) -> None:
    taken, film = tmp_path / "a file", tmp_path / "taken.mp4"
    for path in (taken, film):
        path.write_text("mine")
    for words, said in (
        (["export", str(results.folder), "--to", "kml"], "allowed: oem, aem, spk, czml, plates, facets"),
        (["export", str(tmp_path), "--to", "oem"], "holds no results of a study"),
        (
            ["export", str(results.folder), "--to", "oem", "--out", str(taken)],
            f"{taken} is no folder and cannot become",
        ),
        (["export", str(results.folder), "--to", "vtkhdf", "--out", str(tmp_path)], "a program or function of the"),
        (["film", str(results.folder), "--out", str(tmp_path / "a.png")], "ask that program for its frames"),
        (["film", str(results.folder), "--out", str(film)], "ask that program for its frames"),
        (["view", str(results.folder), "--3d", "--run", "²"], "run is '²', which none of"),
        (["view", str(results.folder), "--run", "5"], "--run 5 is given without --3d"),
    ):
        found = RUNNER.invoke(app, words)
        assert found.exit_code == 2
        assert said in found.stderr
        assert len(found.stderr.splitlines()) == 1
        assert [path.read_text() for path in (taken, film)] == ["mine", "mine"]


def test_a_program_is_told_of_runs_and_files_as_json(results: StudyResults, tmp_path: Path) -> None:
    found = RUNNER.invoke(app, ["export", str(results.folder), "--to", "plates", "--out", str(tmp_path), "--json"])
    assert json.loads(found.stdout) == {"files": [str(tmp_path / "body.plates.txt")]}
    listed = json.loads(RUNNER.invoke(app, ["runs", str(results.folder), "--json"]).stdout)
    assert listed["units"]["velocity_out_z"] == "m/s"
    assert [run["key"] for run in listed["runs"]] == [record.key for record in results.ledger]
    assert listed["runs"][0]["outputs"] == results.ledger[0].outputs
    refused = RUNNER.invoke(app, ["runs", str(results.folder), "--json", "--csv"])
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert "--csv and --json are two forms of one list" in refused.stderr


STUDY = (
    few_grains(20, width=0.4, lander_diameter=0.12, friction="0.7", sides="walls")
    + f'{ONE_IMPACT}{EXPANSION}screening_level = 1\nscreening_degree = 1\nkept_outputs = ["speed_out"]\n'
)


@pytest.fixture(scope="module")
def soil_results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """A study up to its screening runs."""
    home = tmp_path_factory.mktemp("motions")
    (home / "few.toml").write_text(STUDY)
    with quick_studies():
        run_study(StudySource.read(home / "few.toml"), home / "out", until="screening_runs", worker_count=1)
    return open_study(home / "out")


def exported(results: StudyResults, place: Path, *words: str) -> list[str]:
    found = RUNNER.invoke(app, ["export", str(results.folder), "--out", str(place), *words])
    assert found.exit_code == 0, found.output
    return sorted(path.name for path in place.iterdir())


def test_the_landing_shown_and_the_bed_are_written_with_all_frames(soil_results: StudyResults, tmp_path: Path) -> None:
    assert exported(soil_results, tmp_path, "--to", "vtkhdf") == ["bed_0.vtkhdf", "landing.vtkhdf"]
    for name, bodies in (("landing", soil_results.median_landing), ("bed_0", soil_results.bed_bodies())):
        with h5py.File(tmp_path / f"{name}.vtkhdf") as file:
            np.testing.assert_array_equal(file["VTKHDF/Steps/Values"], bodies.time)
            assert file["VTKHDF/CellData/body"][:].max() == len(bodies.vertices) - 1


def test_any_run_is_landed_again_once_for_its_frames(
    soil_results: StudyResults, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    key, asked, land = soil_results.runs["key"][1], [], StudyResults.landing_bodies

    def counted(results: StudyResults, run: str | int, **others: Any) -> MovingBodies:
        asked.append(run)
        return land(results, run, **others)

    monkeypatch.setattr(StudyResults, "landing_bodies", counted)
    monkeypatch.setattr(formats, "contact_sheet", partial(formats.contact_sheet, picture_count=2))
    written = exported(soil_results, tmp_path, "--to", "vtkhdf", "--to", "sheet", "--run", key[:12])
    assert written == ["bed_0.vtkhdf", f"landing_{key[:12]}.png", f"landing_{key[:12]}.vtkhdf"]
    assert asked == [key[:12]]
    again = soil_results.landing_bodies(1)
    with h5py.File(tmp_path / f"landing_{key[:12]}.vtkhdf") as file:
        np.testing.assert_array_equal(file["VTKHDF/Steps/Values"], again.time)


def test_a_run_that_there_is_not_is_refused(soil_results: StudyResults, tmp_path: Path) -> None:
    words = ["export", str(soil_results.folder), "--to", "sheet", "--run", "99", "--out", str(tmp_path)]
    found = RUNNER.invoke(app, words)
    assert found.exit_code == 2
    assert "run is 99, which none of the" in found.stderr
