"""Every key that a study writes into its summary, scores and expansions is described, and the page says the same."""

import json
from pathlib import Path

import pytest
import result_models as models

import lithobrake
from lithobrake.results.key_words import KEY_TABLES, leaves, page, words_of

PAGE = Path(__file__).parents[2] / "docs" / "summary.md"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study with scatter, journeys on both grounds, and an expansion of each kind of fit to choose from."""
    tables = models.small_study()
    tables["design"] |= {"fit": "best", "screening_level": 2}
    tables["monte_carlo"]["scatter"] = True
    tables["rest"] = {"count": 10}
    tables["impact"]["speed"] = {"distribution": "uniform", "lower": 0.1, "upper": 0.2}
    out = tmp_path_factory.mktemp("keys") / "out"
    lithobrake.run(tables, out, workers=1, model=models.bounce, report=False)
    return out


@pytest.mark.parametrize("name", ["summary.json", "scores.json", "screening.json", "refined.json"])
def test_every_key_that_a_study_writes_is_described(name: str, folder: Path) -> None:
    places = set(leaves(json.loads((folder / name).read_text())))
    assert len(places) > 9
    assert all(words_of(name, place) for place in places)


def test_a_key_that_nothing_is_said_of_is_named() -> None:
    with pytest.raises(KeyError, match=r"results\.shares\.returns\.colour of summary\.json is described nowhere"):
        words_of("summary.json", ("results", "shares", "returns", "colour"))


def test_no_key_is_described_twice() -> None:
    said = [(table.file, place, key) for table in KEY_TABLES for place in table.places for key in table.keys]
    assert len(said) == len(set(said))


def test_the_page_is_what_its_script_makes() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "make it again with: python docs/make_summary_page.py"


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        (("site", "effective_acceleration_outward"), "[m/s2]"),
        (("site", "effective_acceleration_along_heading"), "[m/s2]"),
        (("flights", "impact_speed", "quantile_0.5"), "[m/s]"),
        (("rest", "hard", "path_length", "quantile_0.5"), "[m]"),
    ],
)
def test_a_quantity_without_its_unit_in_the_name_has_it_in_the_words(path: tuple[str, ...], unit: str) -> None:
    assert unit in words_of("summary.json", ("results", *path))
