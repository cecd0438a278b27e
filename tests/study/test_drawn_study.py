"""Keys and limit states of a drawn study, tables that a program made, and the studies that come with the package."""

import re
import tomllib
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.first_touchdown import flights
from lithobrake.pipeline.runs.run_table import PLAIN_COLUMNS
from lithobrake.study import Study, StudyError, StudySource, check_tables, read_study
from lithobrake.study.ground_sections import JOURNEYS_A_BED, LANDINGS_A_BED, default_bed_count
from lithobrake.study.reader import BESIDE, shipped, shipped_by_name, study_path
from lithobrake.study.template import template
from lithobrake.study.units import input_units, run_units
from lithobrake.touchdown import OUTPUTS as OUTPUTS_OF_A_TOUCHDOWN
from lithobrake.vocabulary.quantities import (
    AIM_COLUMNS,
    BEDS,
    FLIGHT,
    FOLLOWED,
    JOURNEY,
    OUTPUTS,
    PERIODS_TRAVELLED,
    RUN,
    TO_REST,
    TOUCHDOWN,
    quantity,
)

TABLES: dict[str, Any] = tomllib.loads(template())


def study(changes: dict[str, dict[str, Any]]) -> Study:
    tables = TABLES | {name: {**TABLES.get(name, {}), **keys} for name, keys in changes.items()}
    return check_tables(tables, Path())


def test_landers_draw_what_is_left_open() -> None:
    found = study({})
    assert (found.impact.azimuth_deg, found.impact.orientation) == ("random", "random")
    assert (found.design.run_count, found.bed_count, found.design.side_runs) == (240, 12, False)


def test_what_is_given_is_kept() -> None:
    given = {"azimuth_deg": 30.0, "orientation": [1, 0, 0, 0], "pointing_error_deg": 3}
    found = study({"impact": given, "bed": {"bed_count": 7}})
    assert (found.impact.azimuth_deg, found.impact.orientation) == (30.0, (1.0, 0.0, 0.0, 0.0))
    assert (found.impact.pointing_error_deg, found.bed_count) == (3.0, 7)


def test_an_error_of_pointing_is_about_the_attitude_as_given_even_if_that_is_left_out() -> None:
    assert study({"impact": {"pointing_error_deg": 3.0}}).impact.orientation == (1.0, 0.0, 0.0, 0.0)


def test_a_study_without_drawn_landers_has_one_bed() -> None:
    assert study({"design": {"run_count": 0}, "expansion": {}}).bed_count == 1


def test_beds_follow_from_the_runs_within_limits() -> None:
    landings = {8: 8, 12: 12, 240: 12, 241: 13, 600: 30, 100_000: 1000}
    journeys = {8: 8, 48: 12, 49: 13, 240: 60, 5000: 1000}
    assert {runs: default_bed_count(runs, LANDINGS_A_BED) for runs in landings} == landings
    assert {runs: default_bed_count(runs, JOURNEYS_A_BED) for runs in journeys} == journeys


REFUSED_KEYS: list[tuple[dict[str, dict[str, Any]], list[str]]] = [
    ({"monte_carlo": {"scatter": True}}, ["monte_carlo.scatter is true, and there is no [expansion]"]),
    ({"design": {"run_count": 20}, "bed": {"bed_count": 21}}, ["bed.bed_count is 21, and design.run_count 20"]),
    ({"design": {"half_width": 0.1, "half_width_of": "fast"}}, ['design.half_width_of is "fast"; allowed: a name of']),
    ({"design": {"half_width_of": "fast"}, "limit_states": {"fast": "returns"}},
     ['design.half_width_of is "fast", and there is no design.half_width']),
    ({"design": {"half_width": 0.5}}, ["design.half_width is 0.5", "above 0 and below 0.5"]),
    ({"design": {"largest_run_count": 500}}, ["design.largest_run_count is 500, and nothing asks for more"]),
    ({"design": {"half_width": 0.02, "largest_run_count": 100}},
     ["design.largest_run_count is 100; allowed: at least design.run_count, 240"]),
    ({"design": {"half_width": 0.02}, "bed": {"bed_count": 1}}, ["design.half_width is 0.02, and runs on one bed"]),
    ({"design": {"run_count": 0, "half_width": 0.02}, "expansion": {}, "bed": {"bed_count": 12}},
     ["design.half_width asks landers drawn from the laws of the inputs, and design.run_count is 0"]),
    ({"design": {"run_count": 0, "side_runs": True}, "expansion": {}},
     ["design.side_runs asks landers drawn from the laws of the inputs, and design.run_count is 0; raise it"]),
    ({"design": {"run_count": "many"}}, ["design.run_count is", "whole number"]),
    ({"design": {"side_runs": "yes"}}, ["design.side_runs is", "true or false"]),
    ({"design": {"side_runs": True, "twin_shift": 0.0}}, ["design.twin_shift is 0", "above 0 [m]"]),
    ({"impact": {"orientation": "random", "pointing_error_deg": 5.0}},
     ["impact.pointing_error_deg is 5", "points anywhere already"]),
    ({"impact": {"place": {"x": 0.0}, "region": {"x": [-0.1, 0.1], "y": [0.0, 0.1]}}}, ["are both given"]),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "words"), REFUSED_KEYS, ids=[words[0] for _, words in REFUSED_KEYS])
def test_what_does_not_go_together_is_refused_in_one_sentence(
    changes: dict[str, dict[str, Any]], words: list[str]
) -> None:
    with pytest.raises(StudyError) as refusal:
        study(changes)
    (said,) = refusal.value.problems
    for word in words:
        assert word in said


def test_tables_that_are_none_are_refused_as_ever() -> None:
    for name in ("bed", "impact", "design"):
        with pytest.raises(StudyError, match=f"{name} is 3"):
            check_tables(TABLES | {name: 3}, Path())


REFUSED_CONDITIONS: list[tuple[str, str]] = [
    ("speed > 1", "speed is no output; did you mean speed_out?"), ("speed_out", "speed_out is a number: compare it"),
    ("returns > 1", "returns is true or false, and no number"),
    ("retuns", "retuns is no name here; did you mean returns?"),
    ("distanc < 60", "distanc is no output; did you mean distance?; of a touchdown there are"),
    ("speed_out > 0.1 and distance < 60", "speed_out is of the first touchdown, and distance of the whole journey"),
    ("face", "face is the side down: compare it, as in face == +z"), ("face < +z", "compare it by == or != with one"),
    ("face == up", "compare it by == or != with one of +x"), ("distance", "distance is a number: compare it"),
    ("speed_out == 0.1", "outputs are compared by <, <=, >, >="), ("1 < 2", "compares numbers alone"),
    ("speed_out > 1e999", "neither an output nor a finite number"),
    ("speed_out > 1j", "neither an output nor a finite number"),
    ("speed_out + 1 > 2", "neither an output nor a finite number"), ("speed_out > true", "true is no output"),
    ("__import__('os').remove('x')", "is no condition"), ("(speed_out > 1", "it cannot be read"),
    ("returns\0", "it cannot be read"),
    ("speed_out > 0.1 # and not returns", "it has a comment (#) or a line break: write a condition on one line"),
    ("# returns", "it has a comment (#)"), ("(speed_out > 0.1\nand returns)", "it has a comment (#) or a line break"),
    ("(speed_out > 0.1\u2028and returns)", "or a line break"),
    ("-" * 400 + "1 > speed_out", f"{'-' * 400}1 is neither an output nor a finite number"),
    ("-" * 400 + "speed_out", "-speed_out is no condition"),
    ("~" * 400 + "returns and returns", "~returns is no condition"),
    (" and ".join(["returns"] * 100), "it has 1195 characters"),
]  # fmt: skip


def refusal(limit_states: object, **tables: dict[str, Any]) -> str:
    """What a study file with this table is refused with."""
    with pytest.raises(StudyError) as error:
        check_tables(TABLES | tables | {"limit_states": limit_states}, Path())
    return str(error.value)


@pytest.mark.parametrize(("text", "words"), REFUSED_CONDITIONS)
def test_what_is_no_condition_is_refused_in_one_sentence(text: str, words: str) -> None:
    said = refusal({"fast": text})
    assert said.startswith("study.toml: limit_states.fast is ")
    assert words in said
    assert "\n" not in said


def test_other_things_than_texts_under_names_are_refused() -> None:
    assert "limit_states.fast is 3; allowed: outputs (SI) compared" in refusal({"fast": 3})
    assert "limit_states is 3; allowed: a table" in refusal(3)
    assert "limit_states.too fast is no name" in refusal({"too fast": "returns"})


def test_a_study_without_drawn_landers_has_no_limit_states() -> None:
    said = refusal({"fast": "returns"}, design={"run_count": 0}, expansion={})
    assert "[limit_states] asks landers drawn from the laws of the inputs, and design.run_count is 0" in said


def test_a_study_keeps_its_conditions_by_name() -> None:
    conditions = {"fast": "speed_out > 0.1", "gone": "not returns"}
    assert check_tables(TABLES | {"limit_states": conditions}, Path()).limit_states.conditions() == conditions
    assert check_tables(TABLES, Path()).limit_states.conditions() == {}


def tables(section: str, **keys: Any) -> dict[str, Any]:
    return TABLES | {section: TABLES[section] | keys}


def test_scalars_and_arrays_of_numpy_are_numbers() -> None:
    given = tables("lander", mass=np.float32(2.5), edges=np.array([0.1, 0.1, 0.25]), restitution=np.longdouble(0.5))
    given |= {"seed": np.int64(7), "bed": TABLES["bed"] | {"width": (np.float64(0.6), 1)}}
    source = StudySource.of_tables(given)
    lander = source.study.lander
    assert (lander.mass, lander.edges, lander.restitution, source.study.seed) == (2.5, (0.1, 0.1, 0.25), 0.5, 7)
    # What the folder keeps is a study file that says the same.
    assert StudySource.of_tables(tomllib.loads(source.content.decode())).study == source.study
    assert isinstance(StudySource.of_tables(tables("site", partner=np.bool_(True))).study.site.partner, bool)


def test_a_path_is_text(tmp_path: Path) -> None:
    given = tables("lander", shape="hull", file=tmp_path / "absent.obj")
    del given["lander"]["edges"]
    with pytest.raises(ValueError, match=r"lander\.file is .*absent\.obj.; no such file"):
        StudySource.of_tables(given)


LOOP: dict[str, Any] = {}
LOOP["loop"] = LOOP


@pytest.mark.parametrize(("given", "words"), [
    (tables("lander", mass=Decimal(1)), "lander.mass is 1, of the type Decimal; allowed: numbers, text"),
    (tables("lander", mass=Fraction(1, 2)), "lander.mass is 1/2, of the type Fraction"),
    (tables("lander", mass=1j), "lander.mass is 1j, of the type complex"),
    (tables("lander", mass=None), "lander.mass is None, of the type NoneType"),
    (tables("lander", edges=[0.1, 0.1, b"x"]), "lander.edges.2 is b'x', of the type bytes"),
    (tables("lander", mass=np.ma.masked), "lander.mass is"),
    (TABLES | {"title": b"x"}, "title is b'x', of the type bytes"),
    (TABLES | {"title": "a\ud800"}, 'title is "a\\ud800", which UTF-8 cannot hold'),
    (TABLES | {3: {}}, "the study has the key 3; allowed: names in text"),
    (TABLES | {"limit_states": {"a\ud800": "stays"}}, 'a key of limit_states is "a\\ud800"'),
    (TABLES | {"lander": {3: 1}}, "lander has the key 3"),
    (TABLES | {"lander": LOOP}, "is nested too deeply"),
])  # fmt: skip
def test_a_value_of_another_type_is_refused_by_its_key_and_type(given: Any, words: str) -> None:
    with pytest.raises(ValueError, match=r"^study\.toml: [^\n]*$") as refused:
        StudySource.of_tables(given)
    assert words in str(refused.value)
    str(refused.value).encode()


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
    inputs, units = draw(study, study.touchdown_medians(), 1, None), input_units()
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
    own = {name for name in (*flights.COLUMNS, *AIM_COLUMNS) if not name.startswith("site_")}
    assert own - set(JOURNEY) == set(FLIGHT) - set(JOURNEY)
    assert all(one.long_name for one in (FLIGHT | FOLLOWED | RUN | BEDS).values())
    # A name that ends with its unit has that unit.
    assert all(one.units == name.rpartition("_")[2] for name, one in FLIGHT.items() if name.endswith(("_s", "_deg")))


def test_columns_of_the_study_file_have_its_units_and_own_names_have_none() -> None:
    units = input_units()
    assert quantity("site_spin_period", FLIGHT, units) == ("s", "spin period of the sample", "", "")
    assert quantity("grain.young_modulus", TOUCHDOWN, units)[:2] == ("Pa", "grain, young modulus")
    assert quantity("grain.friction", TOUCHDOWN, units).units == ""
    # What a program of the user's own calls gravity need not be that of a bed.
    assert quantity("gravity", TOUCHDOWN, units) == ("", "gravity", "", "")
