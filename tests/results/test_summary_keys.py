"""Every key that a study writes has a field with its type and its words, and the page says the same."""

import json
import runpy
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest
import result_models as models

import lithobrake
from lithobrake.results.model_results import OutputErrors
from lithobrake.results.run_results import RunShares
from lithobrake.results.study_files import json_values, results_in
from lithobrake.results.summary import Estimates, Provenance, Results

DOCS, SHOWCASE = (Path(__file__).parents[2] / name for name in ("docs", "showcase"))


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    """What docs/make_summary_page.py defines."""
    return runpy.run_path(str(DOCS / "make_summary_page.py"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study with scatter, landers on other ground, and an expansion of each kind of fit to choose from."""
    tables = models.small_study()
    tables["expansion"] |= {"fit": "best", "screening_level": 2}
    tables["monte_carlo"]["scatter"] = True
    tables["hard_ground"] = {"count": 4}
    tables["impact"]["speed"] = {"distribution": "uniform", "lower": 0.1, "upper": 0.2}
    out = tmp_path_factory.mktemp("keys") / "out"
    lithobrake.run(tables, out, workers=1, model=models.bounce, report=False)
    return out


def leaves(value: Any, path: tuple[str, ...] = ()) -> set[str]:
    """The dotted place of every number, word and null of a JSON value; of a list of tables, the places in each."""
    if isinstance(value, dict) and value:
        return {place for key, inner in value.items() for place in leaves(inner, (*path, key))}
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return {place for inner in value for place in leaves(inner, (*path, "*"))}
    return {".".join(path)}


def test_every_number_of_a_summary_has_a_field_and_comes_back_as_it_was(folder: Path) -> None:
    results = lithobrake.open_study(folder)
    assert json.dumps(json_values(results.results)) == json.dumps(results.summary["results"])


def test_every_score_has_a_field(folder: Path) -> None:
    scores = json.loads((folder / "scores.json").read_text())
    for score in (score for table in scores.values() for score in table.values()):
        assert json.dumps(json_values(results_in(OutputErrors, score))) == json.dumps(score)


@pytest.mark.parametrize("name", ["screening.json", "refined.json"])
def test_every_key_of_an_expansion_is_described(name: str, folder: Path, script: dict[str, Any]) -> None:
    places = leaves(json.loads((folder / name).read_text()))
    assert len(places) > 9
    for place in places:
        assert any(fnmatchcase(place, key) for key in script["EXPANSION_KEYS"]), place


def test_a_key_that_is_not_there_is_named_with_its_place(folder: Path) -> None:
    table = lithobrake.open_study(folder).summary["results"]
    with pytest.raises(KeyError, match=r"results\.returns\.share"):
        results_in(Results, table | {"returns": {}}, "results")


@pytest.mark.parametrize(("changes", "words"), [
    ({"share": "much"}, r"shares\.impact\.share is 'much': Input should be a valid number"),
    ({"count": True}, r"shares\.impact\.count is True: Input should be a valid integer"),
    ({"lower": "none"}, r"shares\.impact\.lower is 'none': Input should be a valid number"),
])  # fmt: skip
def test_a_value_of_another_type_is_named_with_its_place(changes: dict[str, Any], words: str) -> None:
    entry = {"count": 1, "share": 0.5, "lower": None, "upper": None}
    counts = {"sample_count": 2, "flight_count": 1, "level": 0.9, "why": None}
    assert results_in(RunShares, {**counts, "impact": entry}).outcomes["impact"].count == 1
    with pytest.raises(ValueError, match=words):
        results_in(RunShares, {**counts, "impact": entry | changes}, "shares")


def test_the_page_is_what_its_script_makes(script: dict[str, Any]) -> None:
    page = (DOCS / "summary.md").read_text(encoding="utf-8")
    assert page == script["page"](), "make it again with: python docs/make_summary_page.py"


@pytest.mark.parametrize(("heading", "key", "unit"), [
    ("### `results.site`", "effective_acceleration_outward", "[m/s2]"),
    ("### `results.flights`", "jacobi_drift_median_m2_s2", "[m2/s2]"),
    ("### `results.flights`", "impact_speed", "[m/s]"),
    ("### `results.hard_ground.*`", "path_length", "[m]"),
])  # fmt: skip
def test_a_quantity_without_its_unit_in_the_name_has_it_in_the_words(heading: str, key: str, unit: str) -> None:
    section = (DOCS / "summary.md").read_text(encoding="utf-8").split(f"{heading}\n")[1].split("###")[0]
    assert (
        unit in next(line for line in section.splitlines() if line.startswith(f"| `{key}` |"))
        or key == "effective_acceleration_along_heading"
    )


@pytest.mark.parametrize("name", ["first_bounce", "mission"])
def test_the_files_of_a_showcase_come_back_as_they_were(name: str) -> None:
    folder = SHOWCASE / name
    summary, estimates = (json.loads((folder / file).read_text()) for file in ("summary.json", "estimates.json"))
    parts = (
        (Results, summary["results"]),
        (Provenance, summary["provenance"]),
        (Estimates, estimates),
    )
    for kind, content in parts:
        assert json.dumps(json_values(results_in(kind, content))) == json.dumps(content)
