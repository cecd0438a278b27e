"""A study from Python: run with a function in place of the soil, opened again, its tables as objects."""

import copy
import gc
import subprocess
import sys
import tempfile
from html import escape
from pathlib import Path

import h5py
import numpy as np
import pytest
import result_models as models

import lithobrake
from lithobrake.results import StudyResults

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished study."""
    out = tmp_path_factory.mktemp("face") / "out"
    lithobrake.run(models.small_study(), out, workers=1, model=models.bounce, report=False)
    return out


@pytest.fixture(scope="module")
def results(folder: Path) -> StudyResults:
    return lithobrake.open_study(folder)


def test_a_function_makes_the_touchdowns_and_no_bed_is_poured(folder: Path, results: StudyResults) -> None:
    assert not (folder / "beds").exists()
    assert not (folder / "report").exists()
    runs = results.runs
    assert set(runs["outcome"].tolist()) == {"clear", "captured"}
    captured = runs["outcome"] == "captured"
    assert (runs["lander.restitution"][captured] < 0.43).all()
    assert np.isnan(runs["speed_out"][captured]).all()
    speed = runs["impact.speed"] * runs["lander.restitution"]
    assert runs["speed_out"][~captured] == pytest.approx(speed[~captured])
    # An output that is NaN has no value.
    assert "azimuth_out" not in runs
    assert results.beds.row_count == 0
    assert results.summary["results"]["expansion"]["designs"]["screening"]["run_count"] == 7


def test_columns_say_what_they_are(results: StudyResults) -> None:
    samples = results.samples.to_xarray()
    assert samples.sizes == {"sample": 400}
    assert samples["speed_out"].attrs["units"] == "m/s"
    assert samples["velocity_out_z"].attrs["frame"].startswith("of the touchdown")
    assert samples["impact.incidence_deg"].attrs["units"] == "deg"
    frame = results.runs.to_pandas()
    assert len(frame) == results.runs.row_count
    assert frame.attrs["penetration"]["units"] == "m"
    assert all(column.long_name for table in (results.runs, results.flights) for column in table.columns.values())
    assert results.flights.row_count == 6
    assert "speed_out [m/s]" in results.samples._repr_html_()


def test_a_notebook_shows_the_answer_and_what_can_be_asked_for(results: StudyResults, tmp_path: Path) -> None:
    shown = results._repr_html_()
    assert all(f"<li>{escape(sentence)}</li>" in shown for sentence in results.headline)
    assert "<td>flights</td>" in shown
    assert "<td>emulator</td>" not in shown
    (tmp_path / "runs.sqlite").touch()
    unfinished = lithobrake.open_study(tmp_path)._repr_html_()
    assert "Not at its end: lithobrake status" in unfinished
    assert "<td>runs</td>" in unfinished
    assert "<td>summary</td>" not in unfinished


def test_every_data_set_of_the_samples_says_of_its_columns_what_they_are(folder: Path) -> None:
    with h5py.File(folder / "samples.h5") as file:
        assert set(file) == {"inputs", "outputs", "outcome"}
        assert file["outcome"].attrs["long_name"] == "how the touchdown ended"
        for name in ("inputs", "outputs"):
            attributes, count = file[name].attrs, file[name].shape[1]
            assert len(attributes["units"]) == len(attributes["frame"]) == count
            assert all(attributes["long_name"][:])
        assert list(file["outputs"].attrs["units"]) == ["m/s", "rad", "rad/s", "m/s", "m/s", "m/s"]
        degrees = list(file.attrs["input_names"]).index("impact.incidence_deg")
        assert file["inputs"].attrs["units"][degrees] == "deg"


def test_the_expansion_is_called_by_the_names_of_its_inputs(results: StudyResults) -> None:
    names = results.surrogate.expansion.input_names
    inputs = {name: np.full((2, 3), results.surrogate.expansion.inputs[name].median) for name in names}
    found = results.surrogate(inputs)
    assert found["speed_out"].shape == (2, 3)
    assert (found["speed_out"] > 0.0).all()
    with pytest.raises(ValueError, match="give exactly"):
        results.surrogate({"speed": 1.0})


def test_opening_writes_nothing_and_a_folder_of_something_else_is_refused(folder: Path, tmp_path: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*")}
    opened = lithobrake.open_study(folder)
    assert (opened.samples.row_count, opened.flights.row_count) == (400, 6)
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*")} == before
    with pytest.raises(ValueError, match="holds no results of a study"):
        lithobrake.open_study(tmp_path)


def test_the_same_call_makes_nothing_again_and_another_study_is_refused_the_folder(folder: Path) -> None:
    before = (folder / "summary.json").stat().st_mtime_ns
    lithobrake.run(models.small_study(), folder, workers=1, model=models.bounce, report=False)
    assert (folder / "summary.json").stat().st_mtime_ns == before
    with pytest.raises(ValueError, match="choose another folder"):
        lithobrake.run(EXAMPLES / "ball_on_plate.toml", folder, workers=1, report=False)


def test_what_cannot_be_run_is_refused_before_anything_is_made(tmp_path: Path) -> None:
    tables, out = models.small_study(), tmp_path / "out"
    with pytest.raises(ValueError, match="leave it out for a temporary folder"):
        lithobrake.run(tables, " ", model=models.bounce)
    with pytest.raises(ValueError, match="cannot be sent to a process"):
        lithobrake.run(tables, out, model=lambda inputs, seed: {})
    with pytest.raises(ValueError, match="keep one of the two"):
        lithobrake.run(EXAMPLES / "ball_on_plate.toml", out, model=models.bounce)
    wrong = copy.deepcopy(tables)
    wrong["impact"]["speed"] = -1.0
    with pytest.raises(ValueError, match=r"impact\.speed is -1; allowed: above 0"):
        lithobrake.run(wrong, out, model=models.bounce)
    assert not out.exists()


def test_a_study_of_python_gives_the_bits_of_its_tables_and_goes_with_its_results(
    results: StudyResults, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    study = lithobrake.Study(**models.small_study(), model=models.bounce)
    assert repr(study).startswith("Study 'Ball on a hard plate")
    found = study.run(workers=1, report=False)
    assert found.folder.parent == tmp_path
    np.testing.assert_array_equal(found.runs["speed_out"], results.runs["speed_out"])
    kept = found.save(tmp_path / "kept")
    with pytest.raises(ValueError, match="which is there already; allowed: a new path"):
        found.save(tmp_path / "kept")
    plot = found.plot
    del found
    gc.collect()
    assert "map()" in repr(plot)
    del plot
    gc.collect()
    assert [path.name for path in tmp_path.iterdir()] == ["kept"]
    np.testing.assert_array_equal(kept.runs["speed_out"], results.runs["speed_out"])


def test_a_study_of_python_is_checked_as_its_file_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables = models.small_study()
    with pytest.raises(ValueError, match=r"^study\.toml: lander\.mas is not a known key; did you mean mass\?"):
        lithobrake.Study(**tables | {"lander": {"mas": 1.0, **tables["lander"]}}, model=models.bounce)
    with pytest.raises(ValueError, match=r"landr is not a known key; did you mean lander\?"):
        lithobrake.Study(**tables, landr={}, model=models.bounce)
    with pytest.raises(ValueError, match=r"impact\.speed is -1; allowed: above 0"):
        lithobrake.Study(**tables | {"impact": tables["impact"] | {"speed": -1.0}}, model=models.bounce)
    # What fails as it runs leaves nothing behind.
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with pytest.raises(ValueError, match="a lander that leaves moves outwards"):
        lithobrake.Study(**tables, model=models.contradicts_itself).run(workers=1, report=False)
    assert list(tmp_path.iterdir()) == []


def test_a_model_has_inputs_of_its_own_and_no_grain_stands_in_its_way(tmp_path: Path) -> None:
    tables = models.small_study()
    tables["solver"] = {"inputs": {"lift": {"distribution": "uniform", "lower": 0.5, "upper": 1.0}}}
    # No contact law would take so heavy a lander on these grains; the model has its own.
    tables["lander"]["mass"] = 1e12
    found = lithobrake.run(tables, tmp_path / "out", workers=1, model=models.lifted, report=False).runs
    lift = found["solver.inputs.lift"]
    assert 0.5 <= lift.min() < lift.max() <= 1.0
    assert found["speed_out"] == pytest.approx(lift * found["impact.speed"])


def test_a_model_that_contradicts_itself_fails_with_the_reason(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="a lander that leaves moves outwards"):
        lithobrake.run(models.small_study(), tmp_path / "out", workers=1, model=models.contradicts_itself, report=False)


def test_importing_the_package_loads_no_other() -> None:
    heavy = "{'numpy', 'pydantic', 'h5py'}"
    code = f"import lithobrake.results, sys; print(sorted({heavy} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
