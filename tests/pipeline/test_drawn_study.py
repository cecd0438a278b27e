"""Studies whose runs are drawn out of one sequence, from the command line: beds and runs, and more of them later."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from lithobrake.pipeline import StudyFolder, plan_study, run_study, study_status
from lithobrake.pipeline.runs.landings import telling_run
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results import open_study
from lithobrake.study import StudySource
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, OUTPUTS, SPIN_OUT

from ..command_line import lithobrake
from ..few_grains import few_grains
from .ball_studies import FEW_RUNS, FEW_SAMPLES, drawn, edit, write_ball


def said_by(*words: object) -> str:
    """What a command prints and says, its lines joined."""
    ended = lithobrake(*words)
    assert ended.returncode == 0, ended.stderr
    return " ".join(f"{ended.stdout} {ended.stderr}".split())


def ball(folder: Path, run_count: int, more: str = "") -> Path:
    return write_ball(folder / "study.toml", drawn(run_count, more) | FEW_SAMPLES)


@pytest.fixture(scope="module")
def grown(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, DesignRuns, str]:
    """A study of twelve runs that then had 14, and side runs: its folder, its first runs, what was said at last."""
    folder = tmp_path_factory.mktemp("grown")
    run_study(StudySource.read(ball(folder, 12)), folder / "out", until="runs", worker_count=1)
    first = DesignRuns.load(StudyFolder.only_read(folder / "out"), "drawn")
    said = said_by("run", ball(folder, 14, "side_runs = true"), "--out", folder / "out", "--workers", 1)
    assert "stage 1 of 11: landers" in said
    assert f"Report: {folder / 'out' / 'report' / 'index.html'}" in said
    return folder, first, said


def test_a_study_of_more_runs_makes_only_those_that_are_new(grown: tuple[Path, DesignRuns, str]) -> None:
    folder, first, said = grown
    assert "14 journeys have 14 touchdowns, 1.0 each; 12 of them were known and are reused" in said
    assert (first.run_count, set(first.outcomes)) == (12, {"clear"})
    designs = ("drawn", "soil_pairs", "twins")
    runs = {name: DesignRuns.load(StudyFolder.only_read(folder / "out"), name) for name in designs}
    assert [one.run_count for one in runs.values()] == [14, 14, 12]
    assert runs["drawn"].keys[:12] == first.keys
    assert not set(runs["drawn"].keys) & {*runs["soil_pairs"].keys, *runs["twins"].keys}
    table = open_study(folder / "out").runs
    assert (len(table["key"]), sorted(set(table["design"]))) == (40, sorted(designs))


def test_what_is_counted_before_is_what_is_made(grown: tuple[Path, DesignRuns, str]) -> None:
    folder, _, said = grown
    # Two of 14, and the side runs.
    assert "To make: 28 touchdowns" in said
    plan = plan_study(folder / "study.toml", folder / "out")
    assert plan.stages == ()
    assert (plan.runs[0].drawn, plan.runs[0].side, plan.runs[0].new) == (14, 26, 0)
    status = " ".join(study_status(folder / "out").lines())
    assert "11 of 11 stages are current: landers, side runs, flights of the first touchdowns" in status


def test_a_stage_that_nothing_asks_for_is_told_so(grown: tuple[Path, DesignRuns, str], tmp_path: Path) -> None:
    source = StudySource.read(grown[0] / "study.toml")
    with pytest.raises(ValueError, match='"screen" is no stage of this study; allowed: bed,'):
        run_study(source, tmp_path / "out", until="screen")
    assert not (tmp_path / "out").exists()


def test_a_folder_whose_study_asks_for_other_runs_has_those_alone(
    grown: tuple[Path, DesignRuns, str], tmp_path: Path
) -> None:
    shutil.copytree(grown[0] / "out", tmp_path / "out")
    study = write_ball(tmp_path / "study.toml", FEW_RUNS | FEW_SAMPLES)
    shutil.copy(study, tmp_path / "out" / "study.toml")
    said_by("screen", study, "--out", tmp_path / "out", "--workers", 1)
    assert (tmp_path / "out" / "designs" / "drawn.csv").is_file()
    assert set(open_study(tmp_path / "out").runs["design"]) == {"screening"}
    # A folder of an early format does not note its stages: it has no other runs.
    (tmp_path / "out" / "keys.json").write_text('{"format_version": 1, "files": {}, "wall_s": {}}')
    assert set(open_study(tmp_path / "out").runs["design"]) == {"screening", "drawn", "soil_pairs", "twins"}


@pytest.fixture(scope="module")
def soil(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of four landings of a ball on two beds of a few grains, and its folder, made."""
    folder = tmp_path_factory.mktemp("soil")
    text = few_grains(30, 0.54, 0.05) + "region = { x = [-0.03, 0.03], y = [-0.02, 0.02] }\nspin_z = 1.0\n"
    text = text.replace("[grain]", "bed_count = 2\n[grain]")
    asked = "[journey]\ntouchdowns = 1\n[design]\nrun_count = 4\nside_runs = true\n[landing]\ntime_limit = 5.0\n"
    asked += "[monte_carlo]\nsample_count = 0\n"
    (folder / "study.toml").write_text(f"{text}{asked}")
    run_study(StudySource.read(folder / "study.toml"), folder / "out", until="side_runs", worker_count=1)
    return folder


def test_landings_of_a_sequence_use_their_beds_and_tell_how_the_lander_turns(soil: Path) -> None:
    folder = StudyFolder.only_read(soil / "out")
    runs = DesignRuns.load(folder, "drawn")
    assert sorted(runs.inputs["bed"]) == [0.0, 0.0, 1.0, 1.0]
    assert sorted(path.name for path in (soil / "out" / "beds").iterdir()) == ["bed_0.h5", "bed_1.h5"]
    assert (soil / "out" / "beds" / "bed_0.h5").read_bytes() != (soil / "out" / "beds" / "bed_1.h5").read_bytes()
    clear = runs.has_outputs
    assert clear.sum() >= 2
    spin = np.column_stack([runs.output(name) for name in SPIN_OUT])[clear]
    assert np.linalg.norm(spin, axis=1) == pytest.approx(runs.output("spin_out")[clear], rel=1e-12)
    attitude = np.column_stack([runs.output(name) for name in ORIENTATION_OUT])[clear]
    assert np.linalg.norm(attitude, axis=1) == pytest.approx(1.0, abs=1e-9)
    assert set(runs.output("over_rim")[clear]) <= {0.0, 1.0}
    # A tenth of a millimetre changes a landing, and not by much.
    twins = DesignRuns.load(folder, "twins")
    both = clear & twins.has_outputs
    assert both.any()
    assert np.all(twins.output("speed_out")[both] != runs.output("speed_out")[both])
    column = open_study(soil / "out").runs.columns["spin_out_x"]
    assert (column.units, column.frame.split(":")[0]) == ("rad/s", "of the touchdown")


def test_the_landing_that_is_shown_is_the_run_of_the_median_speed(soil: Path, tmp_path: Path) -> None:
    shutil.copytree(soil, tmp_path / "study")
    study, out = tmp_path / "study" / "study.toml", tmp_path / "study" / "out"
    assert "run" not in open_study(out).median_landing.attributes
    run_study(StudySource.read(study), out, until="telling_landing", worker_count=1)
    runs, shown = DesignRuns.load(StudyFolder.only_read(out), "drawn"), open_study(out).median_landing
    speeds = np.sort(runs.output("speed_out")[runs.has_outputs])
    row = runs.keys.index(shown.attributes["run"])
    assert runs.output("speed_out")[row] == speeds[(len(speeds) - 1) // 2]
    # The last way of the lander is that of the run, up to where its frames end.
    velocity = np.diff(shown.position[-2:, -1], axis=0)[0] / np.diff(shown.time[-2:])
    assert np.linalg.norm(velocity) == pytest.approx(runs.output("speed_out")[row], rel=1e-2)
    # What was there to look at before all runs is there still, and a stopped study goes on behind it.
    assert (out / "landing.h5").is_file()
    made = (out / "telling_landing.h5").stat().st_mtime_ns
    run_study(StudySource.read(study), out, until="telling_landing", worker_count=1)
    assert (out / "telling_landing.h5").stat().st_mtime_ns == made
    run_study(
        StudySource.read(edit(study, {"run_count = 4": "run_count = 5"})), out, until="telling_landing", worker_count=1
    )
    assert (out / "telling_landing.h5").stat().st_mtime_ns > made


def test_where_no_lander_leaves_the_first_run_that_ended_is_shown() -> None:
    def of(outcomes: list[str], speeds: list[float]) -> int:
        outputs = {name: np.array(speeds) for name in OUTPUTS}
        return telling_run(DesignRuns(["a", "b", "c"], outcomes, ["", "", ""], {}, outputs))

    assert of(["failed", "captured", "time_limit"], [np.nan] * 3) == 1
    assert of(["clear", "clear", "clear"], [0.3, 0.1, 0.2]) == 2
    assert of(["clear", "captured", "clear"], [0.3, np.nan, 0.2]) == 2


def test_a_landing_of_a_sequence_can_be_made_again_from_its_folder(soil: Path) -> None:
    results = open_study(soil / "out")
    clear = [row for row, outcome in enumerate(results.runs["outcome"]) if outcome == "clear"]
    outcome = results.landing(clear[0], frame_count=4)
    assert outcome.outputs["speed_out"] == results.runs["speed_out"][clear[0]]
