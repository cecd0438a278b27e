"""The study file: what is accepted, and how everything else is refused."""

import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from lithobrake import study_file
from lithobrake.quantity import uncertain
from lithobrake.study import Study
from lithobrake.study_template import template

TABLES: dict[str, Any] = tomllib.loads(template())


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
        study_file.check(tables, folder)
    except study_file.StudyError as error:
        return error.problems
    return []


def table(kind: str, **parameters: float) -> dict[str, Any]:
    return {"distribution": kind, **parameters}


def test_the_template_is_a_study_with_the_papers_five_inputs() -> None:
    study = study_file.check(TABLES, Path())
    assert list(uncertain(study.touchdown_values())) == [
        "grain.young_modulus",
        "grain.poisson_ratio",
        "grain.restitution",
        "grain.friction",
        "lander.restitution",
    ]


def test_every_key_has_a_meaning_in_the_template() -> None:
    text = template()
    for path, names in study_file.known_keys().items():
        # The kinds of size distribution stand in the words of bed.diameter.
        for name in names if path != "bed.diameter" else ():
            assert f"{name} =" in text or f"[{name}]" in text, f"{path}.{name}"


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
    ("surface", None, ["surface is missing"]),
    ("site", 3, ["site is 3", "write [site]"]),
    ("impact.incidence_deg", 95.0, ["below 90 [deg]"]),
    ("impact.azimuth_deg", "randm", ['or "random"']),
    ("impact.orientation", [1, 0, 0], ["4 numbers"]),
    ("impact.place", {"x": 0.9}, ["impact.place.x reaches from 0.9 to 0.9 m", "-0.275 to 0.275"]),
    ("bed.grain_count", 12.5, ["whole number"]),
    ("bed.width", [0.3, 0.3], ["bed.width is 0.3 m", "at least 0.535 m"]),
    ("bed.diameter", table("uniform", lower=0.1), ["bed.diameter.upper is missing"]),
    ("bed.diameter", table("uniform", lower=0.2, upper=0.1), ["bed.diameter reaches from 0.2 to 0.1 m"]),
    ("bed.diameter", table("constant", value=0.6), ["bed.diameter reaches to 0.6 m", "0.183 m"]),
    ("bed.diameter", table("constant", value=0.1, upper=3.0), ["bed.diameter.upper is not a known key"]),
    ("contact.pair_rule", "smalest", ["did you mean smaller?"]),
    ("design.screening_degree", 9, ["design.screening_degree is 9", "2002 terms", "61 nodes"]),
    ("design.method", "sobol", ["did you mean sobol_sequence?"]),
    ("design.method", "latin_hypercube", ["design.screening_count is missing", "design.refined_count is missing"]),
    ("design.refined_count", 50, ["design.refined_count does not go with", '"smolyak" takes levels']),
    ("design.replicate_count", 2, ["draw nothing by chance", "impact.region"]),
    ("design.replicate_count", 0, ["at least 1 and at most 1000"]),
    ("design.fit", "least squares", ["allowed: ols, lars, omp, gaussian_process or best"]),
    ("monte_carlo.scatter", "yes", ['monte_carlo.scatter is "yes"; it must be a valid boolean']),
    ("grain.friction", table("choice", values=[0.3, 0.9]), ["discrete choices are not supported"]),
    (
        "grain.young_modulus",
        table("log_normal", mean=16.0, std=1.0),
        ["which has no end", "log_uniform", "design.method"],
    ),
    ("grain.friction", table("exponential", rate=2.0), ["grain.friction is exponential, which has no end"]),
    ("impact.spin_x", table("normal", mean=0.0, std=0.1), ["impact.spin_x is normal, which has no end"]),
    ("site.body", "no_such.obj", ["no such file"]),
    ("surface.gravity", -1e-5, ["bed.settle_gravity"]),
    ("lander.diameter", 0.2, ["does not go with this shape"]),
    ("site.mass", table("uniform", lower=0, upper=1), ["above 0 [kg]"]),
    ("site.spin_period", table("normal", mean=8136.0, std=1.0), ["-inf to inf"]),
]


@pytest.mark.parametrize(("key", "value", "words"), REFUSED, ids=[f"{key}={value}" for key, value, _ in REFUSED])
def test_a_wrong_key_is_named_with_its_value_and_range(key: str, value: Any, words: list[str]) -> None:
    said = "\n".join(problems({key: value}))
    for word in ["study.toml: ", *words]:
        assert word in said


SOBOL = {"design.method": "sobol_sequence", "design.screening_count": 100, "design.refined_count": 100}
ACCEPTED = [
    {"grain.friction": table("exponential", rate=2.0), **SOBOL},
    {"lander.mass": table("log_normal", mean=1.0, std=0.1), **SOBOL, "design.method": "fekete"},
    {
        "site.latitude_deg": table("uniform", lower=-10.0, upper=10.0),
        "site.mass": table("gamma", shape=9.0, scale=6e10),
    },
    {"design.replicate_count": 3, "impact.orientation": "random"},
    {"design.replicate_count": 2, "bed.bed_count": 2, "design.fit": "best", "monte_carlo.scatter": True},
    {"grain.restitution": 1.0},
    {"impact.incidence_deg": table("truncated_normal", mean=30.0, std=5.0, lower=10.0, upper=50.0)},
    {"impact.azimuth_deg": "random", "impact.orientation": "random"},
    {"impact.region": {"x": [-0.1, 0.1], "y": [0.0, 0.1]}, "impact.azimuth_deg": table("uniform", lower=0, upper=90)},
    {"surface.gravity": table("uniform", lower=-1e-5, upper=5e-5), "bed.settle_gravity": 2e-5},
]


@pytest.mark.parametrize("changes", ACCEPTED)
def test_what_is_within_its_limits_is_accepted(changes: dict[str, Any]) -> None:
    assert problems(changes) == []


def test_counts_must_reach_the_terms_of_least_squares_only() -> None:
    few = {**SOBOL, "design.screening_count": 20}
    (said,) = problems(few)
    assert "it has 21 terms, more than the 20 points of design.screening_count; lower the degree or raise" in said
    assert problems({**few, "design.fit": "omp"}) == []


def test_all_problems_are_said_at_once() -> None:
    wrong = {"lander.mass": -1.0, "grain.density": "heavy", "impact.sped": 3, "bed.width": [1.0]}
    assert len(problems(wrong)) == 4


def test_nothing_uncertain_is_refused() -> None:
    certain = {f"grain.{name}": 0.4 for name in ("young_modulus", "poisson_ratio", "restitution", "friction")}
    assert (
        "nothing in grain, lander, impact or surface is uncertain"
        in problems({**certain, "lander.restitution": 0.5})[0]
    )


def test_a_broken_file_and_a_missing_file_are_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "broken.toml").write_text("bed = [\n")
    for name, word in (("broken.toml", "not TOML"), ("missing.toml", "cannot be read")):
        with pytest.raises(study_file.StudyError, match=word) as caught:
            study_file.read(tmp_path / name)
        assert len(caught.value.problems) == 1


def test_mesh_paths_count_from_the_study_file(tmp_path: Path) -> None:
    tables = {**TABLES, "site": {"body": "rock.obj", "mass": 1e11, "spin_period": 8000.0}}
    (tmp_path / "rock.obj").write_text("")
    assert Path(study_file.check(tables, tmp_path).site.body) == tmp_path / "rock.obj"


def test_scalars_of_the_touchdown_and_of_the_site_are_apart() -> None:
    study = Study.model_validate(TABLES)
    assert {name.split(".")[0] for name in study.touchdown_values()} == {"grain", "lander", "impact", "surface"}
    assert {name.split(".")[0] for name in study.site_values()} == {"site"}


def test_what_only_the_flight_reads_may_be_uncertain() -> None:
    study = study_file.check({**TABLES, "site": {"mass": table("uniform", lower=5e11, upper=6e11)}}, Path())
    assert "site.mass" not in uncertain(study.touchdown_values())
    assert "site.mass" in uncertain(study.site_values())


@pytest.mark.parametrize(
    "path", sorted((Path(__file__).parents[1] / "scenarios").glob("*.toml")), ids=lambda path: path.stem
)
def test_the_scenarios_are_studies(path: Path) -> None:
    counts = {"bounces": 3, "paper": 5, "quick": 5}
    assert len(uncertain(study_file.read(path).touchdown_values())) == counts[path.stem]
