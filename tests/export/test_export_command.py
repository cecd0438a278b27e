"""The command that writes the files, and landings and beds for ParaView and on a contact sheet."""

import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.export import KINDS
from lithobrake.pipeline import run_study
from lithobrake.results import MovingBodies, StudyResults, open_study
from lithobrake.study import StudySource

from ..few_grains import few_grains

RUNNER = CliRunner()


def test_each_kind_is_written_once(results: StudyResults, tmp_path: Path) -> None:
    # A study whose solver is its own has no landing to show.
    # Attitudes are known of journeys alone, and this study has no pole.
    shown = [kind for kind in KINDS if kind not in ("vtkhdf", "sheet", "aem", "spk")]
    kinds = [word for kind in [*shown, "plates"] for word in ("--to", kind)]
    sample = int(results.flights["sample"][0])
    found = RUNNER.invoke(app, ["export", str(results.folder), *kinds, "--flight", str(sample), "--out", str(tmp_path)])
    assert found.exit_code == 0, found.output
    written = ["flight_mean.oem", f"flight_{sample}.oem", "landers.czml", "body.plates.txt", "facets.csv"]
    written += ["facets.fits", "impacts.tif", "impacts.geojson", "rest.geojson"]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(written)
    assert found.stdout.splitlines() == [f"Wrote {tmp_path / name}" for name in written]


def test_journeys_have_attitudes_and_kernels(delivered: StudyResults, tmp_path: Path) -> None:
    pytest.importorskip("spiceypy")
    words = [word for kind in ("aem", "spk") for word in ("--to", kind)]
    place = ["--flight", "1", "--flight", "2", "--out", str(tmp_path)]
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
    words = ["export", str(results.folder), "--to", "plates", "--to", kind, "--out", str(tmp_path)]
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
        (["export", str(results.folder), "--to", "vtkhdf", "--out", str(tmp_path)], "a program or function of its own"),
        (["film", str(results.folder), "--out", str(tmp_path / "a.mp4")], "ask that program for its frames"),
        (["film", str(results.folder), "--run", "²", "--out", str(tmp_path / "a.mp4")], "run is '²', which none of"),
        (["film", str(results.folder), "--out", str(film)], f"{film} exists; choose another name with --out"),
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
    few_grains(20, width=0.4, lander_diameter=0.12, friction="0.7")
    + '[design]\nmethod = "paper"\nscreening_level = 1\nscreening_degree = 1\nkept_outputs = ["speed_out"]\n'
)


@pytest.fixture(scope="module")
def soil_results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """A study up to its screening runs."""
    home = tmp_path_factory.mktemp("motions")
    (home / "few.toml").write_text(STUDY)
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
