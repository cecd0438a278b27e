"""Studies that ask for a half width: how many runs they make, stopped or not, and what plan and folder say of them."""

import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lithobrake.analysis import half_width_of
from lithobrake.pipeline import StudyFolder, plan_lines, study_status
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.run_answers import answers_of, read_shares
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.planning.planner import plan_of
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.sequential_sampling import answers_of_design, grown
from lithobrake.pipeline.study_run import run_study
from lithobrake.results import open_study
from lithobrake.study import StudySource

from .ball_studies import BALL
from .journeys.bouncing_lander import bounce, journey_tables
from .synthetic_lander import land


class Said(Silent):
    """Keeps what is said, and ends the study at a word."""

    def __init__(self, last: str = "") -> None:
        self.sentences: list[str] = []
        self.last = last

    def say(self, sentence: str) -> None:
        self.sentences.append(sentence)
        if self.last and self.last in sentence:
            raise KeyboardInterrupt


def source(**design: Any) -> StudySource:
    """The ball on a plate by a function, its runs out of the sequence."""
    tables = tomllib.loads(BALL.read_text())
    del tables["solver"]
    # Where the ground holds what was captured; most of those that leave escape.
    tables["site"] = {"latitude_deg": 50.0}
    tables["impact"]["speed"] = 0.8
    tables["design"] = {"run_count": 24} | design
    del tables["expansion"]
    tables["journey"] = {"touchdowns": 1}
    tables["bed"] = {key: value for key, value in tables["bed"].items() if key not in ("sides", "bed_count")}
    tables["impact"] = {key: tables["impact"][key] for key in ("speed", "incidence_deg")}
    return StudySource.of_tables(tables, function_identity(land))


def run(folder: Path, shown: Said, **design: Any) -> DesignRuns:
    run_study(source(**design), folder, until="fly_runs", worker_count=1, model=land, shown=shown)
    return DesignRuns.load(StudyFolder.only_read(folder), "drawn")


def answers(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """What the runs of a folder answer, and their beds."""
    known = {record.key: record for record in open_study(folder).ledger}
    only_read = StudyFolder.only_read(folder)
    return answers_of(DesignRuns.load(only_read, "drawn").keys, known, read_shares(only_read))


@pytest.fixture(scope="module")
def narrow(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, DesignRuns, list[str]]:
    """A study that was asked for 10 points: its folder, its runs, what it said."""
    folder, said = tmp_path_factory.mktemp("narrow"), Said()
    return folder, run(folder, said, half_width=0.1), said.sentences


def test_runs_are_made_until_the_half_width_is_met(narrow: tuple[Path, DesignRuns, list[str]]) -> None:
    folder, runs, said = narrow
    values, bed = answers(folder)
    assert len(values) == runs.run_count
    assert (half_width_of(values, bed) or 1.0) <= 0.1
    # A quarter is captured: 1.7 sqrt(0.1875 / N) is 0.1 at 54 runs; one stage more at the most.
    assert 55 <= runs.run_count <= 110
    assert len(set(bed)) == max(12, -(-runs.run_count // 20))
    steps = [sentence for sentence in said if sentence.startswith("the return fraction is known to +- ")]
    assert "from 24 runs on 12 beds, and design.half_width asks for +- 10: going on to 50 runs on 12" in steps[0]
    assert f"from {runs.run_count} runs on " in steps[-1]
    assert steps[-1].endswith("asks for +- 10: that is enough")


def test_a_half_width_may_be_that_of_a_limit_state(tmp_path: Path) -> None:
    said, tables = Said(), dict(source(half_width=0.1).tables)
    tables |= {"design": tables["design"] | {"half_width_of": "caught"}, "limit_states": {"caught": "captured"}}
    asked = StudySource.of_tables(tables, function_identity(land))
    run_study(asked, tmp_path, until="fly_runs", worker_count=1, model=land, shown=said)
    steps = [one for one in said.sentences if one.startswith("the probability of caught is known to +- ")]
    assert len(steps) >= 2
    assert steps[-1].endswith("asks for +- 10: that is enough")
    runs = DesignRuns.load(StudyFolder.only_read(tmp_path), "drawn")
    assert (half_width_of((np.array(runs.outcomes) == "captured").astype(float), runs.inputs["bed"]) or 1.0) <= 0.1


def test_a_half_width_may_be_that_of_a_limit_state_of_journeys(tmp_path: Path) -> None:
    said, error = Said(), {"distribution": "normal", "mean": 5.0, "std": 10.0}
    tables = journey_tables(
        limit_states={"near": "distance < 20"}, delivery={"north_error": error},
        design={"half_width": 0.14, "half_width_of": "near"}, journey={"count": 36, "emulated_count": 0},
    )  # fmt: skip
    asked = StudySource.of_tables(tables, function_identity(bounce))
    run_study(asked, tmp_path, until="fly_runs", worker_count=1, model=bounce, shown=said)
    steps = [one for one in said.sentences if one.startswith("the probability of near is known to +- ")]
    assert len(steps) >= 2
    assert steps[-1].endswith("asks for +- 14: that is enough")
    table = JourneyTable.load(StudyFolder.only_read(tmp_path))
    near = np.where(table.end == "failed", np.nan, table.rests & (table.numbers["distance"] < 20.0))
    assert (half_width_of(near, table.bed) or 1.0) <= 0.14


def of_landers(condition: str) -> Any:
    """A design of 60 landers on 12 beds of which every third escapes before a contact, and its limit state."""
    status = np.where(np.arange(60) % 3 == 0, "escaped", "impact")
    study = SimpleNamespace(
        design=SimpleNamespace(half_width_of="lost"),
        limit_states=SimpleNamespace(conditions=lambda: {"lost": condition}),
    )
    descents = SimpleNamespace(touches_down=status == "impact", flights=SimpleNamespace(status=status))
    beds = np.random.default_rng(1).permutation(60) % 12
    keys = [str(lander) for lander in np.flatnonzero(status == "impact")]
    return SimpleNamespace(study=study, descents=descents, beds=beds.tolist(), keys=keys)


@pytest.mark.parametrize(("condition", "met"), [
    ("escaped or under_way", 20), ("not at_rest", 20), ("distance < 20", 0), ("not distance < 20", 20),
])  # fmt: skip
def test_landers_that_never_touch_down_meet_limit_states_of_journeys(condition: str, met: int) -> None:
    """All that touch down come to rest within 20 m, so the interval is that of 20 of 60, or of 40 of 60 near."""
    design = of_landers(condition)
    known: Any = {key: SimpleNamespace(inputs={"bed": design.beds[int(key)]}) for key in design.keys}
    values, bed = answers_of_design(design, known, dict.fromkeys(design.keys, float(met == 0)))
    escaped = np.arange(60) % 3 == 0
    expected = (escaped if met else ~escaped).astype(float)
    assert values.sum() == expected.sum()
    # 1.8 sqrt(p (1 - p) / 60) is 11 points.
    assert half_width_of(values, bed) == pytest.approx(0.11, abs=0.01)
    assert half_width_of(values, bed) == pytest.approx(half_width_of(expected, design.beds))


def test_landers_that_never_touch_down_have_no_first_touchdown() -> None:
    values, _ = answers_of_design(of_landers("captured"), {}, {})
    assert np.isnan(values).tolist() == [True] * 20


def test_what_ends_is_the_study_of_that_many_runs(narrow: tuple[Path, DesignRuns, list[str]]) -> None:
    folder, runs, _ = narrow
    files = {path: path.stat().st_mtime_ns for path in folder.glob("designs/*")}
    again = Said()
    assert run(folder, again, half_width=0.1).keys == runs.keys
    # Nothing was made, not even the table of the runs.
    assert {path: path.stat().st_mtime_ns for path in folder.glob("designs/*")} == files
    assert not any("going on" in sentence for sentence in again.sentences)
    study = source(half_width=0.1).study
    only_read = StudyFolder.only_read(folder)
    design = grown(DrawnDesign(study), only_read)
    assert (len(design.rows), design.keys) == (runs.run_count, runs.keys)
    assert design.study.with_run_count(24) == study.with_run_count(24)
    plan = plan_of(design, "ball", only_read, 2)
    # What follows the runs was not asked for.
    assert (plan.stages[0], len(plan.runs), plan.runs[0].drawn) == ("estimates", 1, runs.run_count)
    answered = sum(outcome in ("clear", "captured") for outcome in runs.outcomes)
    assert f"From the {answered} finished runs: mean 0." in " ".join(plan_lines(plan))
    assert f"{runs.run_count} runs: {runs.run_count} done" in " ".join(study_status(folder).lines())
    assert run(folder, again, run_count=runs.run_count).keys == runs.keys
    assert {path: path.stat().st_mtime_ns for path in folder.glob("designs/*")} == files


def test_a_study_that_is_stopped_between_two_looks_ends_with_the_same_runs(
    narrow: tuple[Path, DesignRuns, list[str]], tmp_path: Path
) -> None:
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, Said("going on to 50"), half_width=0.1)
    assert DesignRuns.load(StudyFolder.only_read(tmp_path), "drawn").run_count == 24
    said = Said()
    assert run(tmp_path, said, half_width=0.1).keys == narrow[1].keys
    assert "50 journeys have 50 touchdowns, 1.0 each; 24 of them were known and are reused" in said.sentences


def test_a_study_that_goes_on_still_shows_the_runs_that_there_are(tmp_path: Path) -> None:
    class Stopped(Said):
        """Ends the study as it begins its stages anew."""

        def begin(self, title: str, number: int, count: int) -> None:
            if number == 1 and any("going on to 50 runs" in sentence for sentence in self.sentences):
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, Stopped(), half_width=0.1)
    lines = study_status(tmp_path).lines()
    assert any(line.startswith("24 runs: 24 done, 0 running") for line in lines)
    assert any(line.startswith("so far, from ") for line in lines)


def test_there_is_an_end_to_runs_that_are_not_enough(tmp_path: Path) -> None:
    said = Said()
    assert run(tmp_path, said, half_width=0.01, largest_run_count=60).run_count == 60
    assert said.sentences[-1].endswith("no more are made, since design.largest_run_count is 60")


@pytest.mark.parametrize("asked", [{}, {"half_width": 0.3}], ids=["a count", "a half width"])
def test_a_damaged_table_of_flights_is_made_again(asked: dict[str, float], tmp_path: Path) -> None:
    run(tmp_path, Said(), **asked)
    table, study, only_read = tmp_path / "run_flights.csv", source(**asked).study, StudyFolder.only_read(tmp_path)
    whole = table.read_bytes()
    table.write_text("nothing that could be read")
    plan = plan_of(grown(DrawnDesign(study), only_read), "ball", only_read, 2)
    assert plan.stages[0] == "flights of the first touchdowns"
    run(tmp_path, Said(), **asked)
    assert table.read_bytes() == whole
