"""Studies and examples that come with the package: by name, and copied without replacing anything."""

import re
import tomllib
from pathlib import Path

import pytest

from lithobrake.study import StudyError, StudySource, read_study
from lithobrake.study.reader import BESIDE, shipped, shipped_by_name, study_path

ROOT = Path(__file__).parents[2]


def test_every_file_for_readers_is_shipped_once() -> None:
    files = {path for one in shipped().values() for path in (one.path, *one.beside)}
    assert files == {path for name in ("scenarios", "examples") for path in (ROOT / name).iterdir() if path.is_file()}
    assert all(path.is_file() for path in files)
    assert set(BESIDE) <= set(shipped())


# How examples name what they need: an import, a program in quotes, a table of a command.
NEEDS = re.compile(r'from (ball_\w+) import|"(?:python3 )?(\w+)\.py"|examples/(\w+)\.csv')


@pytest.mark.parametrize("name", BESIDE)
def test_what_an_example_needs_comes_with_it(name: str) -> None:
    one = shipped_by_name(name)
    for path in (one.path, *one.beside):
        needed = {word for found in NEEDS.findall(path.read_text(encoding="utf-8")) for word in found if word}
        assert needed <= {path.stem for path in one.beside}, path


@pytest.mark.parametrize(("name", "words"), [("quick", "Quick look"), ("notebook_own_shape", "Your own shape")])
def test_each_has_a_title_on_one_line(name: str, words: str) -> None:
    assert shipped_by_name(name).title.startswith(words)
    assert all(one.title and "\n" not in one.title and len(one.title) < 70 for one in shipped().values())


def test_a_name_that_is_no_file_is_a_shipped_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    source = StudySource.read(Path("quick"))
    assert (source.stem, source.path) == ("quick", ROOT / "scenarios" / "quick.toml")
    assert source.study == read_study(Path("quick"))
    # A folder of this name is no study, and a file is.
    (tmp_path / "aim").mkdir()
    assert study_path(Path("aim")) == ROOT / "scenarios" / "aim.toml"
    (tmp_path / "paper").write_text("title = 'mine'\n")
    assert study_path(Path("paper")) == Path("paper")
    assert study_path(Path("runs/quick")) == Path("runs/quick")
    with pytest.raises(StudyError, match=r"quik: .*; did you mean quick\?; name .*: aim, ball_on_plate, "):
        StudySource.read(Path("quik"))
    with pytest.raises(StudyError, match=r"quick\.toml: .*; name an existing TOML file$"):
        StudySource.read(Path("quick.toml"))


def test_a_copy_replaces_nothing(tmp_path: Path) -> None:
    found = shipped_by_name("ball_on_plate")
    written = found.write(tmp_path)
    assert [path.name for path in written] == ["ball_on_plate.toml", "ball_on_plate.py"]
    assert tomllib.loads(written[0].read_text())["title"] == "Ball on a hard plate"
    assert found.write(tmp_path) == written
    written[1].write_text("mine")
    written[0].unlink()
    with pytest.raises(ValueError, match=r"ball_on_plate\.py exists, and is not replaced"):
        found.write(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["ball_on_plate.py"]
    with pytest.raises(ValueError, match="'bal_on_plate'; did you mean ball_on_plate"):
        shipped_by_name("bal_on_plate")
