"""The command that writes the files."""

import json
from pathlib import Path

from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.export import KINDS
from lithobrake.results import StudyResults

RUNNER = CliRunner()


def test_each_kind_is_written_once(results: StudyResults, tmp_path: Path) -> None:
    # A study whose solver is its own has no landing to show.
    shown = [kind for kind in KINDS if kind not in ("vtkhdf", "sheet")]
    kinds = [word for kind in [*shown, "plates"] for word in ("--to", kind)]
    sample = int(results.flights["sample"][0])
    found = RUNNER.invoke(app, ["export", str(results.folder), *kinds, "--flight", str(sample), "--out", str(tmp_path)])
    assert found.exit_code == 0, found.output
    written = ["flight_mean.oem", f"flight_{sample}.oem", "body.plates.txt", "facets.csv", "facets.fits"]
    written += ["impacts.tif", "impacts.geojson"]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(written)
    assert found.output.splitlines() == [f"Wrote {tmp_path / name}" for name in written]


def test_the_files_stand_in_the_folder_of_the_study_unless_told_otherwise(results: StudyResults) -> None:
    found = RUNNER.invoke(app, ["export", str(results.folder), "--to", "plates"])
    assert found.exit_code == 0
    assert (results.folder / "export/body.plates.txt").is_file()


def test_what_is_wrong_is_said_in_one_sentence(results: StudyResults, tmp_path: Path) -> None:
    for words, said in (
        (["export", str(results.folder), "--to", "kml"], "allowed: oem, plates, facets, geotiff, geojson"),
        (["export", str(tmp_path), "--to", "oem"], "holds no results of a study"),
    ):
        found = RUNNER.invoke(app, words)
        assert found.exit_code == 2
        assert said in found.stderr
        assert len(found.stderr.splitlines()) == 1


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
