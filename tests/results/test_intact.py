"""What is read of a study's folder is what the study made, or is refused with what to do."""

import hashlib
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from lithobrake.files.atomic import locked
from lithobrake.pipeline.folder_state import read_state
from lithobrake.results import StudyResults, open_study
from lithobrake.results.study_files import SUMMARY_FORMAT, intact_file

BODY = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
SUMMARY = {
    "format_version": SUMMARY_FORMAT, "study": {},
    "results": {"headline": ["75 % return"], "answer": ["75 % return"], "beds": [{"mass": 1.0}]}, "provenance": {},
}  # fmt: skip
FLIGHTS = "sample,status,latitude_deg,longitude_deg,facet\n0,impact,1.0,2.0,3\n"
ASKED: dict[str, tuple[str, Callable[[StudyResults], Any]]] = {
    "summary.json": (json.dumps(SUMMARY), lambda results: results.headline),
    "body.obj": (BODY, lambda results: results.body_shape), "flights.csv": (FLIGHTS, lambda results: results.flights),
    "study.toml": ("[site]\n", lambda results: results.study_text),
    "designs/drawn.csv": ("key,outcome\na,clear\n", lambda results: results.runs),
    "emulator.json": ("{}", lambda results: results.emulator),
    "refined.json": ("{}", lambda results: results.surrogate), "scores.json": ("{}", lambda results: results.scores),
    "samples.h5": ("", lambda results: results.samples), "landing.h5": ("", lambda results: results.median_landing),
    "explorer.h5": ("", lambda results: results.explorer),
    "beds/bed_0.h5": ("", lambda results: results.bed_bodies()),
}  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder of a study, with a note of the bytes of its files."""
    path = tmp_path / "study"
    for name, (text, _) in ASKED.items():
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (path / name).write_text(text)
    files = {name: {"key": "k", "sha256": sha256(path / name)} for name in ASKED if name != "study.toml"}
    study = {"file": "../study.toml", "sha256": sha256(path / "study.toml")}
    keys = {"format_version": 2, "study": study, "files": files}
    (path / "keys.json").write_text(json.dumps(keys))
    return path


def sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.mark.parametrize(("name", "asked"), [(name, asked) for name, (_, asked) in ASKED.items()], ids=ASKED)
def test_a_file_that_changed_after_it_was_made_is_refused(folder: Path, name: str, asked: Callable[[Any], Any]) -> None:
    with (folder / name).open("a") as file:
        file.write("\n")
    with pytest.raises(ValueError, match=r"changed after it was made, as its hash in keys\.json tells; make it again"):
        asked(open_study(folder))


def test_what_is_whole_not_noted_or_being_made_is_read(folder: Path) -> None:
    assert open_study(folder).headline == ["75 % return"]
    (folder / "flights.csv").write_text(FLIGHTS + "1,impact,1.0,2.0,3\n")
    with locked(folder / ".lock", "busy"):
        assert open_study(folder).flights.row_count == 2
    with pytest.raises(ValueError, match="changed after it was made"):
        _ = open_study(folder).flights
    (folder / "keys.json").unlink()
    assert open_study(folder).flights.row_count == 2


def test_a_shape_may_have_blank_lines(folder: Path) -> None:
    (folder / "keys.json").unlink()
    (folder / "body.obj").write_text(BODY.replace("f 1 3 2", "\n  \nf 1 3 2"))
    vertices, faces = open_study(folder).body_shape
    assert (len(vertices), len(faces)) == (4, 4)


@pytest.mark.parametrize("answer", [999, [], None, {"a": 1}])
def test_a_notebook_shows_results_whatever_the_summary_says(folder: Path, answer: object) -> None:
    results = open_study(folder)
    results._content["results"]["answer"] = answer
    assert " ".join(repr(results).split()) == f"StudyResults of {folder}: no answer in the summary"
    assert "75 % return" in results._repr_html_()
    results._content["results"] = answer
    assert " ".join(repr(results).split()).endswith("no answer in the summary")


def test_samples_that_claim_more_than_there_is_memory_are_one_sentence(folder: Path) -> None:
    (folder / "keys.json").unlink()
    with h5py.File(folder / "samples.h5", "w") as file:
        file.attrs["outcomes"] = ["clear"]
        file["outcome"] = np.zeros(1, np.int8)
        file.attrs["input_names"], file.attrs["output_names"] = ["a"], ["b"]
        file.create_dataset("inputs", (10**9, 1_000_000), "f8", chunks=(1000, 1000))
        file["outputs"] = np.zeros((1, 1))
    with pytest.raises(ValueError, match=r"samples\.h5 cannot be read \(Unable to allocate"):
        _ = open_study(folder).samples


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes")
def test_pipes_are_not_waited_for(folder: Path) -> None:
    (folder / "keys.json").unlink()
    (folder / "runs.sqlite").touch()
    # A design that is no file counts as one that has not been run yet; without an emulator no study counts as drawn.
    for name in (name for name in ASKED if name != "designs/drawn.csv"):
        (folder / name).unlink()
        os.mkfifo(folder / name)
        with pytest.raises(ValueError, match="no regular file"):
            ASKED[name][1](open_study(folder))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes")
@pytest.mark.parametrize("name", ["study.toml", "emulator.json", "body.obj"])
def test_a_file_of_a_study_is_no_pipe_device_or_folder(folder: Path, name: str) -> None:
    path = folder / name
    for put in (lambda: os.mkfifo(path), lambda: path.symlink_to("/dev/zero"), lambda: path.symlink_to(folder)):
        path.unlink()
        put()
        with pytest.raises(ValueError, match=rf"{name} cannot be read \(it is no regular file\); make it again"):
            intact_file(folder, name, "make it again")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes")
@pytest.mark.parametrize("target", ["pipe", "/dev/zero"])
def test_a_noted_study_file_without_an_end_is_not_read(folder: Path, target: str) -> None:
    os.mkfifo(folder / "pipe")
    stages = {name: {"title": name, "key": "k", "files": []} for name in ("bed", "summary")}
    keys = json.loads((folder / "keys.json").read_text()) | {"stages": stages}
    keys["study"]["file"] = target
    (folder / "keys.json").write_text(json.dumps(keys))
    assert read_state(folder).edited is None
