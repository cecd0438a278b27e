"""Studies that come with the package, and the units of what goes into runs and comes out."""

import re
import tomllib
from pathlib import Path

import pytest

from lithobrake.pipeline.fly import flights
from lithobrake.pipeline.rest import aiming
from lithobrake.pipeline.rest import journeys as rest
from lithobrake.pipeline.runs.run_table import PLAIN_COLUMNS
from lithobrake.study import StudyError, StudySource, check_tables, read_study
from lithobrake.study.shipped import BESIDE, shipped, shipped_by_name, study_path
from lithobrake.study.template import template
from lithobrake.study.touchdown_model import draw, medians
from lithobrake.study.units import input_units, run_units
from lithobrake.touchdown import OUTPUTS as OUTPUTS_OF_A_TOUCHDOWN
from lithobrake.vocabulary.quantities import BEDS, FLIGHT, OUTPUTS, PERIODS_TRAVELLED, RUN, TO_REST, TOUCHDOWN, quantity

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


def test_every_input_of_a_run_has_its_unit() -> None:
    study = check_tables(tomllib.loads(template()), Path())
    inputs, units = draw(study, medians(study), 1), input_units()
    # The number of the bed that a run draws counts nothing.
    assert set(inputs) - set(units) == {"bed"}
    assert (units["grain.young_modulus"], units["grain.friction"], units["impact.incidence_deg"]) == ("Pa", "-", "deg")
    assert (units["lander.surface_energy"], units["impact.place.x"], units["surface.gravity"]) == ("J/m2", "m", "m/s2")


def test_every_output_has_its_unit() -> None:
    assert {*OUTPUTS, *OUTPUTS_OF_A_TOUCHDOWN, *TO_REST, PERIODS_TRAVELLED} == set(TOUCHDOWN)
    assert all(run_units()[name] and one.long_name for name, one in TOUCHDOWN.items())
    assert run_units()["peak_acceleration"] == "m/s2"


def test_every_column_of_the_tables_has_words() -> None:
    assert set(PLAIN_COLUMNS) <= set(RUN)
    own = {name for name in (*flights.COLUMNS, *rest.COLUMNS, *aiming.COLUMNS) if not name.startswith("site_")}
    assert own == set(FLIGHT)
    assert all(one.long_name for one in (FLIGHT | RUN | BEDS).values())
    # A name that ends with its unit has that unit.
    assert all(one.units == name.rpartition("_")[2] for name, one in FLIGHT.items() if name.endswith(("_s", "_deg")))


def test_columns_of_the_study_file_have_its_units_and_own_names_have_none() -> None:
    units = input_units()
    assert quantity("site_spin_period", FLIGHT, units) == ("s", "spin period of the sample", "", "")
    assert quantity("grain.young_modulus", TOUCHDOWN, units)[:2] == ("Pa", "grain, young modulus")
    assert quantity("grain.friction", TOUCHDOWN, units).units == ""
    # What a program of the user's own calls gravity need not be that of a bed.
    assert quantity("gravity", TOUCHDOWN, units) == ("", "gravity", "", "")
