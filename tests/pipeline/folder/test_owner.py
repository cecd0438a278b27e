"""Where a study may write: a new folder, an empty one, its own; never over what another made."""

import json
import os
import shutil
from pathlib import Path

import pytest

from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.study_folder import refuse_others_folder
from lithobrake.study import StudySource

STAGES = {
    name: {"title": name, "key": "1", "files": []}
    for name in ("bed", "screening_runs", "refined_runs", "test_runs", "report")
}


def write_study(path: Path, text: str = "seed = 1") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def source(study: Path) -> StudySource:
    """A study file as a study has it; what stands in it does not matter to whose folder it is."""
    return StudySource(None, {}, study.read_bytes(), study)  # type: ignore[arg-type]


def begun(study: Path, out: Path) -> StudyFolder:
    """A folder in which a study has begun to run."""
    refuse_others_folder(source(study), out)
    folder = StudyFolder(out)
    with folder.alone():
        folder.begin(study, study.read_bytes(), STAGES, lambda sentence: None)
    return folder


def refusal(study: Path, out: Path) -> str:
    """What is said; nothing in the folder changes."""
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    with pytest.raises(ValueError, match="with --out") as refused:
        refuse_others_folder(source(study), out)
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before
    assert "\n" not in str(refused.value)
    return str(refused.value)


def test_a_folder_that_is_not_there_or_empty_is_taken(tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    begun(study, tmp_path / "new" / "out")
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty" / ".gitkeep").touch()
    begun(study, tmp_path / "empty")


def test_a_study_that_is_edited_goes_on_in_its_folder(tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    begun(study, tmp_path / "out")
    write_study(study, "seed = 2")
    assert (begun(study, tmp_path / "out") / "study.toml").read_text() == "seed = 2"


def test_a_study_and_its_folder_move_together(tmp_path: Path) -> None:
    begun(write_study(tmp_path / "a" / "study.toml"), tmp_path / "a" / "runs" / "study")
    (tmp_path / "a").rename(tmp_path / "b")
    begun(write_study(tmp_path / "b" / "study.toml", "seed = 2"), tmp_path / "b" / "runs" / "study")


def test_a_folder_with_other_things_is_refused(tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    mine = tmp_path / "mine"
    write_study(mine / "study.toml", "seed = 1")
    (mine / "body.obj").write_text("v 0 0 0")
    assert refusal(study, mine).startswith(f"{mine} holds body.obj, study.toml, and no study made it")


def test_the_folder_of_the_study_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    assert f"{study} lies in {study.parent}" in refusal(study, study.parent)
    assert f"{study} lies in {tmp_path}" in refusal(study, tmp_path)
    monkeypatch.chdir(study.parent)
    assert "study.toml lies in ." in refusal(Path("study.toml"), Path())


@pytest.mark.skipif(os.name != "posix", reason="links need rights elsewhere")
def test_a_link_to_a_study_file_counts_where_it_lies_and_where_it_leads(tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "study.toml").symlink_to(study)
    for folder in ("a", "b"):
        assert "lies in" in refusal(tmp_path / "b" / "study.toml", tmp_path / folder)


def test_the_folder_of_another_study_of_the_same_name_is_refused_until_its_file_is_copied_there(tmp_path: Path) -> None:
    one, other = write_study(tmp_path / "a" / "study.toml"), write_study(tmp_path / "b" / "study.toml", "seed = 2")
    out = tmp_path / "runs" / "study"
    begun(one, out)
    said = refusal(other, out)
    assert f"{out} has the files of another study, {one}" in said
    assert f"copy {other} over {out / 'study.toml'}" in said
    shutil.copy(other, out / "study.toml")
    begun(other, out)
    write_study(other, "seed = 3")
    begun(other, out)
    assert "has the files of another study" in refusal(one, out)


@pytest.mark.parametrize("keys", ['{"format_version": 1, "files": {}, "wall_s": {}}', "", "[3]"])
def test_a_folder_of_the_first_format_or_with_bad_keys_goes_on_with_its_study_file(keys: str, tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    begun(study, tmp_path / "out")
    (tmp_path / "out" / "keys.json").write_text(keys)
    begun(study, tmp_path / "out")
    (tmp_path / "out" / "keys.json").write_text(keys)
    write_study(study, "seed = 2")
    assert "does not record which study it belongs to" in refusal(study, tmp_path / "out")
    shutil.copy(study, tmp_path / "out" / "study.toml")
    begun(study, tmp_path / "out")


def test_a_folder_of_a_later_format_is_refused(tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    folder = begun(study, tmp_path / "out")
    keys = json.loads((folder / "keys.json").read_text()) | {"format_version": 9}
    (folder / "keys.json").write_text(json.dumps(keys))
    with pytest.raises(ValueError, match=r"keys\.json has format 9; this version reads 1 to 2"):
        refuse_others_folder(source(study), tmp_path / "out")


def test_damaged_keys_are_told_and_noted_anew(tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    folder = begun(study, tmp_path / "out")
    folder.write_json("scores.json", {"a": 1})
    folder.note("test", ["scores.json"], "key", 1.0)
    (folder / "keys.json").write_text('{"format_version": 2, "files": 3}')
    said: list[str] = []
    folder.begin(study, study.read_bytes(), STAGES, said.append)
    assert said == [
        f"{folder / 'keys.json'} cannot be read (files is 3, not of type dict); so its files are made again."
    ]
    assert not folder.is_current(["scores.json"], "key")


def test_runs_of_a_design_are_forgotten_when_its_stage_changes(tmp_path: Path) -> None:
    study = write_study(tmp_path / "a" / "study.toml")
    folder = begun(study, tmp_path / "out")
    for design in ("screening", "refined", "test_all"):
        folder.note_runs(design, ["1f", "2e"])
    folder.begin(
        study, study.read_bytes(), STAGES | {"test_runs": STAGES["test_runs"] | {"key": "2"}}, lambda sentence: None
    )
    assert set(json.loads((folder / "keys.json").read_text())["designs"]) == {"screening", "refined"}


def test_a_file_that_is_named_as_a_probe_would_be_stays(tmp_path):
    (tmp_path / ".writable").write_text("a note of mine")
    StudyFolder(tmp_path)
    assert (tmp_path / ".writable").read_text() == "a note of mine"
    assert [path.name for path in tmp_path.iterdir()] == [".writable"]


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="here every folder can be written")
def test_a_folder_that_cannot_be_written_is_refused(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(ValueError, match=r"cannot be written .*; choose another folder with --out"):
        StudyFolder(tmp_path)
