"""Landings and the bed for ParaView, and a landing on a contact sheet, from a study on a bed of a few grains."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.pipeline import run_study
from lithobrake.results import MovingBodies, StudyResults, open_study
from lithobrake.study import StudySource

from ..few_grains import few_grains

RUNNER = CliRunner()
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


def test_the_landing_shown_and_the_bed_are_written_with_all_their_frames(
    soil_results: StudyResults, tmp_path: Path
) -> None:
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
