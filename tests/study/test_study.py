"""The study file: what is accepted, and how everything else is refused."""

import math
import subprocess
import sys
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from lithobrake.pipeline.design.dependencies import bed_setting
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.study import Study, StudyError, check_tables, known_keys, read_study
from lithobrake.study.quantity import uncertain
from lithobrake.study.short_study import LANDERS, all_keys, escape_speed, known_body, known_lander, short_study
from lithobrake.study.template import template
from lithobrake.touchdown.soil import boulders
from lithobrake.vocabulary.known_bodies import KNOWN_BODIES, KnownBody

from ..paper_tables import paper_tables

TABLES: dict[str, Any] = paper_tables()
ROOT = Path(__file__).parents[2]
STUDIES = sorted([*(ROOT / "scenarios").glob("*.toml"), *(ROOT / "validation" / "studies").glob("*.toml")])
STUDIES.append(ROOT / "examples" / "philae.toml")


def problems(changes: dict[str, Any], folder: Path = Path()) -> list[str]:
    """What is said about the template with some keys changed; a key is dotted, None takes it away."""
    tables = deepcopy(TABLES)
    for key, value in changes.items():
        *path, last = key.split(".")
        table = tables
        for name in path:
            table = table.setdefault(name, {})
        table.pop(last, None) if value is None else table.update({last: value})
    try:
        check_tables(tables, folder)
    except StudyError as error:
        return error.problems
    return []


def table(kind: str, **parameters: float) -> dict[str, Any]:
    return {"distribution": kind, **parameters}


def test_the_template_is_a_study_with_the_papers_five_inputs() -> None:
    study = check_tables(TABLES, Path())
    assert list(uncertain(study.touchdown_values())) == ["grain.young_modulus", "grain.poisson_ratio",
        "grain.restitution", "grain.friction", "lander.restitution"]  # fmt: skip


SHORT = short_study(known_body("Dimorphos"), known_lander("2U"), (10.0, -60.0))


def test_the_short_study_is_one_of_journeys(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SHORT)
    study = read_study(tmp_path / "study.toml")
    assert study.journey.count == study.design.run_count == 48
    assert study.bed_count == 12
    assert {"impact.speed", "grain.friction"} <= uncertain(study.touchdown_values()).keys()


@pytest.mark.parametrize("lander", LANDERS)
def test_every_lander_by_name_has_a_bed_that_holds_it(lander: str, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(short_study(known_body("didymos"), known_lander(lander), (60.0, 0.0)))
    assert read_study(tmp_path / "study.toml").lander.mass == known_lander(lander).mass


def tetrahedron(radius: float) -> str:
    """OBJ of a tetrahedron with the volume of a ball: corners at (s, s, s) and so on span 8/3 s^3."""
    side = radius * (math.pi / 2.0) ** (1.0 / 3.0)
    corners = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    lines = ["v " + " ".join(str(side * part) for part in corner) for corner in corners]
    return "\n".join([*lines, "f 1 2 3", "f 1 4 2", "f 1 3 4", "f 2 4 3", ""])


@pytest.mark.parametrize(
    "body", [body for body in KNOWN_BODIES.values() if not body.is_built_in], ids=lambda body: body.name
)
def test_every_body_by_name_takes_a_mesh(body: KnownBody, tmp_path: Path) -> None:
    (tmp_path / "ball.obj").write_text(tetrahedron(body.mean_radius))
    (tmp_path / "study.toml").write_text(short_study(body, known_lander("3u"), (0.0, 0.0), "ball.obj"))
    study = read_study(tmp_path / "study.toml")
    assert (study.site.name, study.site.mass, study.site.spin_period) == (body.name, body.mass,
        pytest.approx(body.spin_period, rel=1e-7))  # fmt: skip


def test_escape_speed_of_bennu_is_that_of_its_mass_and_radius() -> None:
    """sqrt(2 G M / R) of 7.329e10 kg and 245 m: 0.1998 m/s."""
    assert escape_speed(known_body("bennu")) == pytest.approx(0.1998, abs=1e-4)


@pytest.mark.parametrize("text", [template(), SHORT + all_keys()], ids=["first bounce", "journeys"])
def test_every_key_has_a_meaning_in_a_template(text: str) -> None:
    for path, names in known_keys().items():
        # The kinds of size distribution stand in the words of bed.diameter, for boulders as for grains.
        for name in (
            names if path not in ("bed.diameter", "bed.boulders.diameter", "ground.kind.boulders.diameter") else ()
        ):
            shown = f"{name} =", f"[{name}]", f"[{f'{path}.{name}'.lstrip('.')}.NAME]"
            assert any(one in text for one in shown), f"{path}.{name}"


def constant(diameter: float) -> dict[str, Any]:
    return {"distribution": "constant", "value": diameter}


BOULDERS = {"diameter": constant(0.2), "coverage": 0.1}
REFUSED = [
    ("lander.mass", -3.0, ["lander.mass is -3", "above 0 [kg]"]),
    ("lander.mass", "3 kg", ["lander.mass", "without quotes"]),
    ("lander.mass", True, ["lander.mass is true"]),
    ("lander.mass", float("nan"), ["lander.mass is nan"]),
    ("grain.restitution", 0.0, ["above 0 and at most 1"]),
    ("grain.restitution", table("uniform", lower=0.5, upper=1.2), ["reaches from 0.5 to 1.2"]),
    ("grain.restitution", table("normal", mean=0.5, std=0.1), ["-inf to inf", "truncated_normal"]),
    ("grain.poisson_ratio", 0.5, ["at least 0 and below 0.5"]),
    ("grain.poisson_ratio", table("uniform", lower=0.3, upper=0.5), ["reaches from 0.3 to 0.5"]),
    ("grain.friction", table("exponential", rate=-1.0), ["rate must be above 0"]),
    ("grain.friction", table("uniform", lower=0.9, upper=0.3), ["lower must be less than upper"]),
    ("grain.friction", table("unifrom", lower=0.3, upper=0.9), ["did you mean uniform?"]),
    ("grain.friction", table("uniform", lower=0.3), ["uniform takes exactly the numbers lower, upper"]),
    ("grain.youngs_modulus", 1e7, ["grain.youngs_modulus is not a known key", "did you mean young_modulus?"]),
    ("grian", {}, ["grian is not a known key", "did you mean grain?"]),
    ("journey", None, ["[journey] is missing, which says how far landers are followed; add it: write touchdowns = 1"]),
    ("journey.touchdowns", 0, ["journey.touchdowns is 0", "at least 1 and at most 1000"]),
    ("rest.count", 100, ["rest is a key of an older version; write [hard_ground]"]),
    ("site", 3, ["site is 3", "write [site]"]),
    ("impact.incidence_deg", 95.0, ["below 90 [deg]"]),
    ("impact.azimuth_deg", "randm", ['or "random"']),
    ("impact.orientation", [1, 0, 0], ["4 numbers"]),
    ("impact.place", {"x": 0.9}, ["impact.place.x reaches from 0.9 to 0.9 m", "-0.275 to 0.275"]),
    ("bed.grain_count", 12.5, ["whole number"]),
    ("lander.inertia", [5e-40, 5e-40, 5e-40], ["lander.inertia is [5e-40,", "4.65e-08 to 4.65 kg m2"]),
    ("lander.inertia", [1e9, 1e9, 1e9], ["lander.inertia is [1e+09,", "mend it, or leave it out"]),
    ("lander.edges", [1e-9, 1e-9, 0.2], ["lander.edges is [1e-09, 1e-09, 0.2] m", "at least 0.001 of the longest"]),
    ("lander.edges", [1e-40, 1e-40, 1e-40], ["the lander reaches 8.66e-41 m from its centre; allowed: at least"]),
    ("bed.width", [0.3, 0.3], ["bed.width is 0.3 m", "at least 0.535 m"]),
    ("bed.diameter", table("uniform", lower=0.1), ["bed.diameter.upper is missing"]),
    ("bed.diameter", table("uniform", lower=0.2, upper=0.1), ["bed.diameter reaches from 0.2 to 0.1 m"]),
    (
        "bed.diameter",
        table("uniform", lower=1e-40, upper=0.1),
        ["bed.diameter reaches from 1e-40 to 0.1 m", "raise lower"],
    ),
    (
        "bed.diameter",
        table("power_law", lower=0.05, upper=0.1, exponent=-2.5),
        ["bed.diameter.exponent is -2.5; allowed: at least 0, as the number of grains falls with D**-exponent"],
    ),
    (
        "bed.diameter",
        table("power_law", lower=0.05, upper=0.1, cumulative_exponent=-2.5),
        ["bed.diameter.cumulative_exponent is -2.5; allowed: at least 0"],
    ),
    (
        "bed.diameter",
        table("power_law", lower=0.05, upper=0.1, exponent=3.5, cumulative_exponent=2.5),
        ["bed.diameter takes exponent or cumulative_exponent, and both are given"],
    ),
    ("bed.diameter", table("power_law", lower=0.05, upper=0.1), ["and neither is given; keep one"]),
    (
        "bed.diameter",
        table("normal", mean=1e300, std=0.01, lower=0.05, upper=0.1),
        ["bed.diameter.mean is 1e+300", "1e-50 to 1e+50 in size"],
    ),
    ("grain.young_modulus", table("gamma", shape=1e-5, scale=1e6), ["its samples (least, median, largest: 0, 0"]),
    ("grain.young_modulus", table("log_normal", mean=10.0, std=250.0), ["largest: 0, 2.2e+04, inf) leave that range"]),
    (
        "grain.friction",
        table("truncated_normal", mean=1e40, std=1.0, lower=0.1, upper=0.9),
        ["grain.friction is { distribution", "TruncatedNormal.mean is 1e+40"],
    ),
    ("bed.diameter", table("constant", value=0.6), ["bed.diameter reaches to 0.6 m", "0.183 m"]),
    ("bed.diameter", table("constant", value=0.1, upper=3.0), ["bed.diameter.upper is not a known key"]),
    ("contact.pair_rule", "smalest", ["did you mean smaller?"]),
    ("expansion.screening_degree", 9, ["expansion.screening_degree is 9", "2002 terms", "61 nodes"]),
    ("expansion.points", "sobol", ["did you mean sobol_sequence?"]),
    (
        "expansion.points",
        "latin_hypercube",
        ["expansion.screening_count is missing", "expansion.refined_count is missing"],
    ),
    ("expansion.refined_count", 50, ["expansion.refined_count does not go with", '"smolyak" takes levels']),
    ("expansion.replicate_count", 2, ["draw nothing by chance", "impact.region"]),
    ("design.method", "paper", ["design.method is a key of an older version", "[expansion] with design.run_count = 0"]),
    ("design.screening_level", 2, ["design.screening_level is a key of an older version; write it in [expansion]"]),
    ("design.run_count", 1, ["design.run_count is 1; allowed: at least 2, or 0 with [expansion]"]),
    ("expansion", None, ["design.run_count is 0; allowed: at least 2, or 0 with [expansion]"]),
    ("monte_carlo.sample_count", 50, ["monte_carlo.sample_count is 50; allowed: 0, or at least 100; raise it"]),
    ("impact.pointing_error_deg", 200.0, ["above 0 and at most 180 [deg]"]),
    ("expansion.replicate_count", 0, ["at least 1 and at most 1000"]),
    ("expansion.fit", "least squares", ["allowed: ols, lars, omp, gaussian_process or best"]),
    ("monte_carlo.scatter", "yes", ['monte_carlo.scatter is "yes"; allowed: true or false; write it without']),
    ("grain.friction", table("choice", values=[0.3, 0.9]), ["discrete choices are not supported"]),
    (
        "grain.young_modulus",
        table("log_normal", mean=16.0, std=1.0),
        ["which has no end", "log_uniform", "expansion.points"],
    ),
    ("grain.friction", table("exponential", rate=2.0), ["grain.friction is exponential, which has no end"]),
    ("impact.spin_x", table("normal", mean=0.0, std=0.1), ["impact.spin_x is normal, which has no end"]),
    ("site.name", "Rock", ['site.name is "Rock", and site.body is built in and has one; leave it out']),
    ("site.body", "no_such.obj", ["no such file"]),
    ("site.body", "Didymoss", ["no such file; did you mean didymos?"]),
    ("site.body", "a" * 5000, ["no such file"]),
    ("site.unit", "km", ["site.unit is", "leave it out"]),
    ("lander.unit", "mm", ["there is no lander.file"]),
    ("lander.inertia", [0.001, 0.001, 0.01], ["lander.inertia is [0.001, 0.001, 0.01]", "sum of the other two"]),
    ("lander.mass", 1e6, ["lander.mass is 1e+06 kg", "allowed: 6.7e-07 to 6.7e+05 kg"]),
    ("lander.mass", 1e-9, ["lander.mass is 1e-09 kg"]),
    ("impact.speed", 1e300, ["at most 1000 [m/s]"]),
    ("impact.speed", 50.0, ["impact.speed reaches 50 m/s", "0.188 m deep", "at most the radius of a grain, 0.04 m"]),
    ("site.north_error", 800.0, ["site.north_error reaches 800 m", "at most 590.1 m", "quarter of the way round"]),
    ("site.east_error", table("normal", mean=0.0, std=300.0), ["site.east_error reaches 927.1 m"]),
    ("site.mass", 3.5e10, ["bulk density of 157.6 kg/m3", "allowed: 300 to 8000 kg/m3"]),
    ("site.mass", table("uniform", lower=5e11, upper=5e12), ["2252 to 2.252e+04 kg/m3"]),
    ("bed.grain_count", 100.5, ["whole number"]),
    ("bed.grain_count", 10**399, ["bed.grain_count is about 1e399", "at most 1e+06"]),
    ("bed.width", [], ["bed.width is []", "2 numbers"]),
    ("bed.diameter", {}, ["must name its distribution"]),
    ("lander.shape", 16**5000, ["lander.shape is about 1e6021"]),
    ("lander.mass", 10**400, ["lander.mass is about 1e400", "write a finite number"]),
    ("lander.mass", [[[[[[1]]]]]], ["lander.mass is [[[[...]]]]"]),
    ("lander.mass", table(["uniform"]), ["lander.mass is", "did you mean uniform?"]),  # type: ignore[arg-type]
    ("lander.mass", "x" * 5000, ["(5002 characters)"]),
    (
        "expansion.kept_outputs",
        "speed_out",
        ['expansion.kept_outputs is "speed_out"; allowed: a list', "square brackets"],
    ),
    ("title", 3, ["title is 3; allowed: text; write it in quotation marks"]),
    ("impact.orientation", [0, 0, 0, 0], ["a quaternion of length 0", "allowed: 0.001 to 1000", "[1, 0, 0, 0]"]),
    ("impact.orientation", [1e-40, 0, 0, 0], ["a quaternion of length 1e-40"]),
    ("impact.orientation", [1e40, 1e40, 0, 0], ["a quaternion of length 1.41e+40"]),
    ("site.spin_period", 1e-40, ["site.spin_period reaches down to 1e-40 s", "at least 1 s", "write seconds"]),
    ("expansion.kept_outputs", [], ["expansion.kept_outputs is []", "at least 1 entry"]),
    ("solver.inputs", {"spring": 1.0}, ["solver.command is missing"]),
    ("solver.function", "0123456789abcdef", ["solver.function is not a known key"]),
    ("solver", {"command": "python3", "inputs": {"a$b": 1.0}}, ["solver.inputs.a$b is no name", "letters, digits"]),
    ("surface.gravity", -1e-5, ["bed.settle_gravity"]),
    ("lander.diameter", 0.2, ["does not go with this shape"]),
    ("bed.boulders", {"coverage": 0.1}, ["bed.boulders.diameter is missing"]),
    ("bed.boulders", {**BOULDERS, "coverage": 0.4}, ["bed.boulders.coverage is 0.4", "above 0 and at most 0.3"]),
    ("bed.boulders", {**BOULDERS, "cover": [0.2, 0.1]}, ["bed.boulders.cover is [0.2, 0.1] m", "swap them"]),
    ("bed.boulders", {**BOULDERS, "cover": [-10.0, 0.0]}, ["bed.boulders.cover is [-10, 0] m", "stands higher"]),
    ("bed.boulders", {**BOULDERS, "cover": [0.0, 100.0]}, ["bed.boulders.cover is [0, 100] m", "no deeper"]),
    ("bed.boulders", {**BOULDERS, "diameter": constant(0.01)}, ["boulders.diameter reaches from 0.01 m", "at least"]),
    (
        "bed.boulders",
        {**BOULDERS, "diameter": constant(5.0)},
        ["bed.width is", "for boulders of 5 m, as they lie between", "widen"],
    ),
    (
        "bed.boulders",
        {**BOULDERS, "diameter": {"distribution": "power_law", "lower": 0.3, "upper": 0.2}},
        ["bed.boulders.diameter reaches from 0.3 to 0.2 m", "bed.boulders.diameter takes exponent or"],
    ),
    ("site.mass", table("uniform", lower=0, upper=1), ["above 0 [kg]"]),
    ("site.spin_period", table("normal", mean=8136.0, std=1.0), ["-inf to inf"]),
]


@pytest.mark.parametrize(("key", "value", "words"), REFUSED, ids=[f"{key}: {words[0]}" for key, _, words in REFUSED])
def test_a_wrong_key_is_named_with_its_value_and_range(key: str, value: Any, words: list[str]) -> None:
    said = "\n".join(problems({key: value}))
    for word in ["study.toml: ", *words]:
        assert word in said


@pytest.mark.parametrize(("width", "is_wide"), [(0.9, False), (1.0, True)])
def test_ground_that_repeats_is_as_wide_as_two_boulders_ask(width: float, is_wide: bool) -> None:
    """2 (0.75 + 0.75) 0.3 m and half a grain of 0.08 m, where a bed has more than one boulder."""
    several = {"diameter": constant(0.3), "coverage": 0.2, "cover": [-0.1, 0.05]}
    said = problems({"bed.sides": "periodic", "bed.width": [width, width], "bed.boulders": several})
    assert any("allowed: at least 0.94 m for boulders of 0.3 m" in one for one in said) != is_wide


def test_the_boulders_of_a_study_are_those_of_its_beds() -> None:
    tables = deepcopy(TABLES)
    tables["bed"] |= {"boulders": {"diameter": constant(0.2), "coverage": 0.1, "cover": [0.0, 0.05]}}
    study = check_tables(tables, Path())
    found = boulders(study)
    assert (found.coverage, found.cover, found.sizes.upper) == (0.1, (0.0, 0.05), 0.2)
    assert bed_recipe(study, 0).boulders == found
    # A study without any keeps its name for what it depends on.
    assert "boulders" in bed_setting(study)
    assert "boulders" not in bed_setting(check_tables(TABLES, Path()))


SOBOL = {"expansion.points": "sobol_sequence", "expansion.screening_count": 100, "expansion.refined_count": 100}
ACCEPTED = [
    {"grain.friction": table("exponential", rate=2.0), **SOBOL},
    {"lander.mass": table("log_normal", mean=1.0, std=0.1), **SOBOL, "expansion.points": "fekete"},
    {"site.latitude_deg": table("uniform", lower=-10.0, upper=10.0),
     "site.mass": table("gamma", shape=9.0, scale=6e10)},
    {"expansion.replicate_count": 3, "impact.orientation": "random"},
    {"expansion.replicate_count": 2, "bed.bed_count": 2, "expansion.fit": "best", "monte_carlo.scatter": True},
    {"grain.restitution": 1.0}, {"bed.grain_count": 100.0}, {"lander.inertia": [0.001, 0.002, 0.003]},
    {"lander.mass": 1e6, "solver.command": "python3", "impact.speed": 900.0},
    {"site.north_error": table("normal", mean=0.0, std=50.0), "site.east_error": 590.0},
    {"impact.incidence_deg": table("truncated_normal", mean=30.0, std=5.0, lower=10.0, upper=50.0)},
    {"impact.azimuth_deg": "random", "impact.orientation": "random"},
    {"impact.place": None, "impact.region": {"x": [-0.1, 0.1], "y": [0.0, 0.1]},
     "impact.azimuth_deg": table("uniform", lower=0, upper=90)},
    {"surface.gravity": table("uniform", lower=-1e-5, upper=5e-5), "bed.settle_gravity": 2e-5},
]  # fmt: skip


@pytest.mark.parametrize("changes", ACCEPTED)
def test_what_is_within_its_limits_is_accepted(changes: dict[str, Any]) -> None:
    assert problems(changes) == []


@pytest.mark.parametrize(("changes", "words"), [
    # 2 * 0.134 m of the lander and 3.2 * 0.09 m of the grains.
    (
        {"bed.width": [0.56, 0.55], "bed.diameter": table("constant", value=0.09)},
        [
            "bed.width is 0.55 m at its narrowest; allowed: at least 0.555 m",
            "3.2 of the grains' largest diameters, as with bed",
        ],
    ),
    (
        {"bed.diameter": table("uniform", lower=0.08, upper=0.11)},
        ["at most 0.1 m, bed.width over 5.5 with bed.sides"],
    ),
    # Grains of ten points may be longer: 4 * 1.55 + 0.5 of their diameters.
    (
        {"bed.width": [0.53, 0.6], "bed.cloud_point_count": 10},
        ['at most 0.0791 m, bed.width over 6.7 with bed.sides = "periodic" and bed.cloud_point_count = 10'],
    ),
    (
        {"surface.slope_deg": 40.0, "grain.friction": 0.3},
        [
            "surface.slope_deg reaches to 40 and grain.friction down to 0.3",
            "friction of at least 0.336, 0.4 of the",
        ],
    ),
])  # fmt: skip
def test_ground_that_repeats_is_wide_enough_and_holds_on_its_slope(changes: dict[str, Any], words: list[str]) -> None:
    said = "\n".join(problems({"bed.sides": "periodic", **changes}))
    for word in words:
        assert word in said
    assert problems({"bed.sides": "periodic"}) == []


def test_beds_repeat_unless_the_file_has_walls_and_walls_hold_no_lander_beyond_its_first_touchdown() -> None:
    sides = {key: value for key, value in TABLES["bed"].items() if key != "sides"}
    assert check_tables(TABLES | {"bed": sides}, Path()).bed.sides == "periodic"
    (said,) = problems({"journey.touchdowns": None, "surface.gravity": None, "bed.settle_gravity": 1e-5})
    assert 'set bed.sides = "periodic", or journey.touchdowns = 1' in said


def test_no_scenario_with_drawn_landers_has_an_edge_to_leave_over() -> None:
    studies = [read_study(path) for path in STUDIES]
    assert {study.bed.sides for study in studies if study.design.run_count} == {"periodic"}
    assert sum(bool(study.design.run_count) for study in studies) >= 6


def test_counts_must_reach_the_terms_of_least_squares_only() -> None:
    few = {**SOBOL, "expansion.screening_count": 20}
    (said,) = problems(few)
    assert "it has 21 terms, more than the 20 points of expansion.screening_count; lower the degree or raise" in said
    assert problems({**few, "expansion.fit": "omp"}) == []


def test_all_problems_are_said_at_once() -> None:
    assert len(problems({"lander.mass": -1.0, "grain.density": "heavy", "impact.sped": 3, "bed.width": [1.0]})) == 4


def test_a_list_with_a_wrong_entry_is_told_once() -> None:
    assert [text.split(" is ")[0] for text in problems({"expansion.kept_outputs": ["speed"]})] == [
        "study.toml: expansion.kept_outputs.0"
    ]


def test_nothing_uncertain_is_refused() -> None:
    certain = {f"grain.{name}": 0.4 for name in ("young_modulus", "poisson_ratio", "restitution", "friction")}
    assert (
        "nothing in grain, lander, impact or surface is uncertain"
        in problems({**certain, "lander.restitution": 0.5})[0]
    )


def test_a_broken_file_and_a_missing_file_are_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "broken.toml").write_text("bed = [\n")
    (tmp_path / "deep.toml").write_text(f"seed = {'[' * 3000}{']' * 3000}")
    (tmp_path / "long.toml").write_text(f"seed = {'1' * 5000}")
    (tmp_path / "latin.toml").write_bytes(b'title = "caf\xe9"')
    said = {"broken": "not TOML", "missing": "cannot be read", "deep": "nested too deeply",
        "long": "thousands of digits",
        "latin": "not text in UTF-8, byte 13 is 0xe9; save it in that encoding"}  # fmt: skip
    for name, word in ((f"{stem}.toml", word) for stem, word in said.items()):
        with pytest.raises(StudyError, match=word) as caught:
            read_study(tmp_path / name)
        assert len(caught.value.problems) == 1


def test_a_mark_of_the_encoding_and_whole_numbers_with_a_point_are_read(tmp_path: Path) -> None:
    text = template().replace("grain_count = 150", "grain_count = 150.0")
    (tmp_path / "study.toml").write_text(text, encoding="utf-8-sig")
    assert read_study(tmp_path / "study.toml").bed.grain_count == 150


OCTAHEDRON = "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n"


def octahedron(radius: float, middle: float = 0.0) -> str:
    """An OBJ file; the octahedron has a volume of 4/3 radius**3."""
    corners = [(radius, 0, 0), (-radius, 0, 0), (0, radius, 0), (0, -radius, 0), (0, 0, radius), (0, 0, -radius)]
    return "".join(f"v {x + middle} {y} {z}\n" for x, y, z in corners) + OCTAHEDRON


def rock(folder: Path, text: str, **changes: Any) -> list[str]:
    """What is said about a study on a body from this mesh, of 4/3e6 m3 if it is an octahedron of 100 m."""
    (folder / "rock.obj").write_text(text)
    site = {"body": "rock.obj", "mass": 3e9, "spin_period": 8000.0, **changes}
    return problems({"site": {key: value for key, value in site.items() if value is not None}}, folder)


def test_mesh_paths_count_from_the_study_file(tmp_path: Path) -> None:
    assert rock(tmp_path, octahedron(100.0)) == []
    assert rock(tmp_path, octahedron(100.0), name="2001 SN-263") == []
    tables = {**TABLES, "site": {"body": "rock.obj", "mass": 3e9, "spin_period": 8000.0}}
    assert Path(check_tables(tables, tmp_path).site.body) == tmp_path / "rock.obj"


def test_a_mesh_in_another_unit_is_refused_with_the_unit_that_was_meant_and_read_with_it(tmp_path: Path) -> None:
    (said,) = rock(tmp_path, octahedron(0.1))
    assert "bulk density of 2.25e+12 kg/m3; allowed: 300 to 8000 kg/m3" in said
    assert 'is the mesh in km? then set site.unit = "km"' in said
    assert rock(tmp_path, octahedron(0.1), unit="km") == []
    (said,) = rock(tmp_path, octahedron(10_000.0))
    assert 'set site.unit = "cm"' in said
    # Right in itself, and a pebble.
    (said,) = rock(tmp_path, octahedron(0.1), mass=3.0)
    assert "0.1366 m across" in said
    assert "1 to 1e+06 m" in said


@pytest.mark.parametrize(("text", "changes", "said"), [
    (octahedron(100.0).replace("f 1 4 6\n", ""), {}, "open, 3 edges belong to one facet only"),
    ("a stone\n", {}, "0 facets cannot enclose a volume"),
    ("v 1 2 x\n", {}, "is not a vertex or a facet"),
    (octahedron(100.0, middle=200.0), {}, "the origin, about which the body turns, lies outside"),
    (octahedron(100.0), {"mass": None}, "site.mass is missing"),
    (octahedron(100.0), {"east_error": 120.0}, "at most 107"),
    (octahedron(100.0), {"name": "<b>"}, 'site.name is "<b>"; allowed: 1 to 40 letters'),
    (octahedron(100.0), {"name": ""}, 'site.name is ""; allowed'),
    (octahedron(100.0), {"name": "a" * 41}, "site.name is"),
])  # fmt: skip
def test_a_body_that_cannot_be_used_is_refused_before_anything_runs(
    text: str, changes: dict[str, Any], said: str, tmp_path: Path
) -> None:
    assert [said in problem for problem in rock(tmp_path, text, **changes)] == [True]


CHECK = """
import sys
from pathlib import Path
from lithobrake.study import read_study
read_study(Path(sys.argv[1]))
print("numba" in sys.modules)
"""


def test_a_mesh_is_looked_at_without_loading_the_compiler(tmp_path: Path) -> None:
    (tmp_path / "rock.obj").write_text(octahedron(100.0))
    site = f'body = "{tmp_path / "rock.obj"}"\nmass = 3e9\nspin_period = 8000.0\n'
    text = (Path(__file__).parents[2] / "examples" / "ball_on_plate.toml").read_text()
    (tmp_path / "study.toml").write_text(f"{text}\n[site]\n{site}")
    command = [sys.executable, "-c", CHECK, str(tmp_path / "study.toml")]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == "False\n"


def test_a_lander_in_another_unit_is_asked_about(tmp_path: Path) -> None:
    (tmp_path / "lander.obj").write_text(octahedron(100.0))
    lander = {"lander.shape": "hull", "lander.edges": None, "lander.file": "lander.obj"}
    (said,) = problems(lander, tmp_path)
    assert 'name the unit of lander.file (lander.unit is "m")' in said
    assert problems({**lander, "lander.unit": "mm"}, tmp_path) == []


def test_scalars_of_the_touchdown_and_of_the_site_are_apart() -> None:
    study = Study.model_validate(TABLES)
    assert {name.split(".")[0] for name in study.touchdown_values()} == {"grain", "lander", "impact", "surface"}
    assert {name.split(".")[0] for name in study.site_values()} == {"site"}


def test_what_only_the_flight_reads_may_be_uncertain() -> None:
    study = check_tables({**TABLES, "site": {"mass": table("uniform", lower=5e11, upper=6e11)}}, Path())
    assert "site.mass" not in uncertain(study.touchdown_values())
    assert "site.mass" in uncertain(study.site_values())


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_the_studies_of_the_repository_are_studies(path: Path) -> None:
    same = ("one_place", "paper", "drawn_700", "drawn_170", "first_bounce")
    counts = {
        "aim": 6,
        "sites": 6,
        "release": 4,
        "philae": 4,
        "quick": 6,
        "one_ground": 6,
        "mission": 10,
    }
    counts |= dict.fromkeys(same, 5)
    counts |= dict.fromkeys(("juventas", "juventas_with_booms", "milani", "milani_with_wings"), 17)
    assert len(uncertain(read_study(path).touchdown_values())) == counts[path.stem]


def test_held_grains_ask_for_steps_of_their_own() -> None:
    assert problems({"contact.held_speed": 0.1, "contact.stepping": "local"}) == []
    assert problems({"contact.held_speed": 0.1, "contact.stepping": "global"}) == [
        'study.toml: contact.held_speed is 0.1 with contact.stepping = "global"; allowed above 0: "local" only; change '
        "either"
    ]


@pytest.mark.parametrize("name", ["dimorphos", "Dimorphos", "DIMORPHOS"])
def test_the_name_of_a_body_may_have_capitals(name: str) -> None:
    tables = deepcopy(TABLES) | {"site": {"body": name}}
    assert check_tables(tables, Path()).site.body == "dimorphos"
