"""What is said of the runs of a sequence while more of them come in, in words and as JSON."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.analysis import mean_estimate, share_estimate
from lithobrake.campaign import Ledger, Record, RunStatus
from lithobrake.cli import app
from lithobrake.pipeline import StudyFolder, study_status
from lithobrake.pipeline.commands.running_estimates import running_estimates

SPEEDS = np.random.default_rng(1).uniform(0.05, 0.1, 60)
OUTCOMES = ["captured" if run % 5 == 0 else "clear" for run in range(60)]


def record(run: int, bed_count: int = 6, outcome: str | None = None) -> Record:
    """A run that has ended, each on the next bed."""
    how = outcome or OUTCOMES[run]
    outputs = {"speed_out": float(SPEEDS[run])} if how == "clear" else {}
    inputs = {"bed": float(run % bed_count)}
    return Record(
        f"run {run:02d}", RunStatus.DONE, how, inputs, outputs, {}, run, 0, 1, None, 1.0, 1.0, None, "", None, None
    )


def test_estimates_are_those_of_the_runs_with_beds_as_units() -> None:
    found = running_estimates([record(run) for run in range(60)], {})
    bed, captured = np.arange(60) % 6, np.array([how == "captured" for how in OUTCOMES])
    assert found.captured == share_estimate(captured.astype(float), bed)
    assert found.speed_out == mean_estimate(np.where(captured, np.nan, SPEEDS), bed)
    first, share, speed, last = found.lines()
    assert first == "so far, from 60 landings on 6 beds:"
    assert share.startswith("  captured: 20 % (90 % interval ")
    assert speed.startswith(f"  mean speed_out: {SPEEDS[~captured].mean():.4g} m/s (90 %: ")
    assert "The return fraction is not known yet" in last
    content = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert content["captured"]["from"] == "60 landings on 6 beds"
    assert (content["returns"], content["speed_out"]["level"]) == (None, 0.9)
    shares = np.where(captured, 1.0, 0.25)
    flown = running_estimates([record(run) for run in range(60)], {f"run {run:02d}": shares[run] for run in range(60)})
    assert flown.returns == share_estimate(shares, bed)
    assert flown.lines()[-1].startswith("  return fraction: 40 % (90 % interval ")


def test_the_order_in_which_runs_end_changes_no_digit() -> None:
    records, orders = [record(run) for run in range(40)], np.random.default_rng(2)
    found = {running_estimates([records[row] for row in orders.permutation(40)], {}) for _ in range(20)}
    assert found == {running_estimates(records, {})}


def test_runs_without_an_answer_widen_it_and_one_bed_has_no_interval() -> None:
    runs = [record(run) for run in range(59)] + [record(59, outcome="left_sideways")]
    found = running_estimates(runs, {})
    assert found.captured.if_missing == pytest.approx((12 / 60, 13 / 60))
    assert found.captured.lower < 12 / 60 < 13 / 60 < found.captured.upper
    assert "59 of 60 landings" in found.lines()[0]
    one_bed = running_estimates([record(run, bed_count=1) for run in range(60)], {})
    assert one_bed.speed_out is None
    assert "20 %, without an interval: all runs landed on one bed" in one_bed.lines()[1]


def test_too_few_runs_say_nothing() -> None:
    assert running_estimates([record(0)], {}) is None
    lost = running_estimates([record(run, outcome="time_limit") for run in range(3)], {})
    assert (lost.captured, lost.lines()) == (None, [])


@pytest.fixture
def under_way(tmp_path: Path) -> Path:
    """The folder of a sequence of 60 runs of which 40 have ended, with runs beside it and one of another setting."""
    folder, keys = StudyFolder(tmp_path), [record(run).key for run in range(60)]
    folder.begin(None, b"", {"bed": {"title": "bed", "key": "", "files": []}}, print)
    folder.note_runs("drawn", keys)
    folder.note_runs("twins", ["twin"])
    with Ledger(folder / "runs.sqlite") as ledger:
        asked = [record(run) for run in range(60)]
        entries = [(one.key, one.inputs, one.seed, 0) for one in asked]
        entries += [(name, {"bed": 0.0}, 0, 0) for name in ("twin", "other")]
        ledger.queue(entries, version="")
        for one in asked[:40]:
            ledger.finish(one.key, {"status": "done", "outcome": one.outcome, "outputs": one.outputs, "attempts": 1})
        for name in ("twin", "other"):
            ledger.finish(name, {"status": "done", "outcome": "captured", "outputs": {}, "attempts": 1})
    return tmp_path


def test_status_says_them_while_runs_come_in(under_way: Path) -> None:
    said = CliRunner().invoke(app, ["status", str(under_way)])
    assert said.exit_code == 0, said.output
    assert "\n".join(running_estimates([record(run) for run in range(40)], {}).lines()) in said.stdout
    assert "61 runs: 41 done, 0 running, 0 failed" in said.stdout
    assert "1 more runs in the ledger are of earlier settings of the study" in said.stdout
    assert said.stdout.splitlines() == study_status(under_way).lines()


def test_status_gives_all_of_it_as_json(under_way: Path) -> None:
    content = json.loads(CliRunner().invoke(app, ["status", str(under_way), "--json"]).stdout)
    assert content["folder"] == str(under_way)
    assert (content["at_work"], content["campaign_began"], content["unknown"]) == (None, None, None)
    runs = content["runs"]
    assert [runs[name] for name in ("total", "done", "running", "failed", "of_earlier_settings")] == [61, 41, 0, 0, 1]
    assert (runs["rate"], runs["seconds_left"]) == (None, None)
    assert runs["outcomes"] == {"captured": 9, "clear": 32}
    assert runs["spreads"]["speed_out"]["count"] == 32
    expected = running_estimates([record(run) for run in range(40)], {})
    assert runs["estimates"] == json.loads(json.dumps(expected.to_json()))


def test_status_of_a_campaign_that_is_no_study_is_json_too(tmp_path: Path) -> None:
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        ledger.queue([("first", {"height": 1.0}, 0, 0)], version="")
    content = json.loads(CliRunner().invoke(app, ["status", str(tmp_path), "--json"]).stdout)
    assert (content["stages"], content["runs"]["total"], content["runs"]["estimates"]) == ([], 1, None)
