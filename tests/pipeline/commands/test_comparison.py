"""Two studies compared run by run, from their folders to the page."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import lithobrake
from lithobrake.cli import app
from lithobrake.pipeline import compare_studies
from lithobrake.pipeline.commands.comparison import OneStudy, _other_beds
from lithobrake.results.comparison import StudyComparison
from lithobrake.results.json_values import from_json
from lithobrake.results.table import Table
from lithobrake.vocabulary.quantities import BEDS

from ..journeys.bouncing_lander import journey_tables, run_without_emulator
from ..journeys.test_delivered_journeys import tables, write_states

FASTER = {"speed": {"distribution": "uniform", "lower": 0.08, "upper": 0.16}}


def made(folder: Path, seed: int = 2, **changes: dict[str, object]) -> Path:
    run_without_emulator(journey_tables(**changes) | {"seed": seed}, folder)
    return folder


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Journeys of 48 landers, and of the first 36 of them at twice the speed."""
    place = tmp_path_factory.mktemp("comparison")
    return made(place / "slow"), made(place / "fast", delivery=FASTER, journey={"count": 36})


def test_differences_are_those_of_the_pairs(pair: tuple[Path, Path]) -> None:
    found = compare_studies(*pair)
    slow, fast = (lithobrake.open_study(path).journeys for path in pair)
    rests = [table["end"][:36] == "at_rest" for table in (slow, fast)]
    answer = found.answers["at_rest"]
    assert (answer.pairs, answer.is_fraction) == (36, True)
    assert answer.difference.value == pytest.approx(rests[1].mean() - rests[0].mean())
    assert answer.difference.lower < answer.difference.value < answer.difference.upper
    time = found.answers["time_s_median"]
    medians = [np.median(table["time_s"][:36][rest]) for table, rest in zip((slow, fast), rests, strict=True)]
    assert time.difference.value == pytest.approx(medians[1] - medians[0])
    assert time.difference.lower > 0.0
    assert "36 pairs on 12 beds" in found.of
    assert list(found.settings) == ["delivery.speed"]


def test_landers_that_miss_the_ground_keep_their_number(tmp_path: Path) -> None:
    """Two of the first study's landers fly away, and have journeys without a run: the pairs behind them stay pairs."""
    folders = []
    for name, away in (("some", (3, 9)), ("all", ())):
        states = tmp_path / f"{name}.csv"
        write_states(states, away)
        run_without_emulator(tables(delivery={"states": str(states)}), tmp_path / name)
        folders.append(tmp_path / name)
    found = compare_studies(*folders)
    ends = [lithobrake.open_study(folder).journeys["end"] == "at_rest" for folder in folders]
    assert f"{len(ends[0])} pairs" in found.of
    answer = found.answers["at_rest"]
    assert answer.difference.value == pytest.approx(ends[1].mean() - ends[0].mean())
    assert answer.pairs == len(ends[0])


def test_beds_that_differ_are_named(pair: tuple[Path, Path]) -> None:
    one, two = (replace(OneStudy.open(pair[0]), results=WithBeds(height)) for height in (0.3, 0.31))
    used = np.arange(3)
    assert _other_beds(one, one, used) is None
    assert "1 of 3 beds differ between the studies" in (_other_beds(one, two, used) or "")
    assert _other_beds(OneStudy.open(pair[0]), OneStudy.open(pair[1]), used) is None


class WithBeds:
    """Results with three beds, the last of this surface height [m]."""

    def __init__(self, height: float) -> None:
        numbers = {"solid_fraction": [0.6, 0.61, 0.62], "surface_height_m": [0.3, 0.3, height]}
        self.beds = Table.of("bed", {name: (BEDS[name], values) for name, values in numbers.items()})


def test_the_command_writes_a_page_and_its_numbers(pair: tuple[Path, Path], tmp_path: Path) -> None:
    out = tmp_path / "compared"
    said = CliRunner().invoke(app, ["compare", *map(str, pair), "--out", str(out)])
    assert said.exit_code == 0, said.output
    assert f"A: {pair[0]}" in said.stdout
    assert "Time to rest, median: A " in said.stdout
    numbers = json.loads((out / "comparison.json").read_text())
    assert from_json(StudyComparison, numbers) == compare_studies(*pair)
    page = (out / "index.html").read_text()
    assert "Comparison of two studies" in page
    assert "delivery.speed" in page
    assert (out / "figure_1_differences.svg").is_file()
    again = CliRunner().invoke(app, ["compare", *map(str, pair), "--out", str(out)])
    assert again.exit_code == 2
    assert "--force" in again.output
    shown = CliRunner().invoke(app, ["compare", *map(str, pair), "--out", str(out), "--force", "--json"])
    assert json.loads(shown.stdout) == numbers


def test_studies_that_cannot_be_paired_are_refused(pair: tuple[Path, Path], tmp_path: Path) -> None:
    other = made(tmp_path / "other", seed=3, journey={"count": 24})
    with pytest.raises(
        ValueError, match=r"cannot be paired: run 12 has bed 1 in A and 3 in B .* give both the same seed"
    ):
        compare_studies(pair[0], other)
    with pytest.raises(ValueError, match="holds no results of a study"):
        compare_studies(pair[0], tmp_path)
