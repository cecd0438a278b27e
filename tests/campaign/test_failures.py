"""Runs that fail: recorded, tried again, counted, looked at for holes; and scripts with and without a guard."""

import importlib.util
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, ClassVar

import campaign_models as models
import numpy as np
import pytest

from lithobrake.campaign import (
    Ledger,
    Limits,
    LocalExecutor,
    RunOptions,
    Runs,
    executors,
    missing,
    read_records,
    run,
    run_key,
)
from lithobrake.campaign.executors import WorkerDiedError
from lithobrake.campaign.worker import Call, MainModuleError, Worker, refuse_unreachable

X = np.array([[1.0, 0.5], [2.0, 0.5], [3.0, 0.5], [4.0, 0.5]])


def campaign(
    path: Path, model: Any, limits: Limits | None = None, x: np.ndarray = X, workers: int = 2, **options: Any
) -> Runs:
    with Ledger(path / "runs.sqlite") as ledger, LocalExecutor(workers) as executor:
        return run(model, x, names=("a", "b"), ledger=ledger, executor=executor, limits=limits, **options)


def test_a_run_over_its_wall_limit_is_ended_and_the_others_go_on(tmp_path: Path) -> None:
    began = time.monotonic()
    runs = campaign(tmp_path, models.sleeps_at_two, Limits(wall_s=0.5))
    assert runs.outcomes == ["clear", "failed", "clear", "clear"]
    ended = runs.records[1]
    assert ended.reason == "it ran longer than its limit of 0.5 s"
    assert ended.wall_s > 0.5
    assert ended.host == runs.records[0].host
    assert time.monotonic() - began < 600


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="memory is measured on Linux only")
def test_a_run_over_its_memory_limit_is_ended_and_the_others_go_on(tmp_path: Path) -> None:
    runs = campaign(tmp_path, models.swells_at_two, Limits(memory_bytes=4e8))
    assert runs.outcomes == ["clear", "failed", "clear", "clear"]
    assert "bytes of memory, more than its limit of 4e+08" in str(runs.records[1].reason)


def test_limits_are_above_zero() -> None:
    with pytest.raises(ValueError, match=r"Limits\.wall_s is 0"):
        Limits(wall_s=0.0)


@pytest.mark.parametrize("how", ["raises", "dies"])
def test_a_failed_run_is_tried_again_as_often_as_configured(how: str, tmp_path: Path) -> None:
    model = models.FailsOnce(tmp_path, how)
    once = campaign(tmp_path, model)
    assert once.outcomes == ["failed"] * 4
    assert [entry.attempts for entry in once.records] == [1] * 4
    # Asked for again with as few tries, they stay what they are; with one more, they are made.
    assert campaign(tmp_path, model).reused_count == 4
    again = campaign(tmp_path, model, options=RunOptions(retry_count=1))
    assert again.outcomes == ["clear"] * 4
    assert [(entry.attempts, entry.reason) for entry in again.records] == [(2, None)] * 4


def test_a_retry_within_one_campaign(tmp_path: Path) -> None:
    runs = campaign(tmp_path, models.FailsOnce(tmp_path, "dies"), options=RunOptions(retry_count=1))
    assert runs.outcomes == ["clear"] * 4
    assert [entry.attempts for entry in runs.records] == [2] * 4


MANY = np.column_stack([np.linspace(0.5, 41.0, 82), np.full(82, 0.5)])


def tries(folder: Path) -> int:
    return sum(int(mark.read_text()) for mark in folder.glob("tried_*"))


@pytest.mark.parametrize("retry_count", [0, 1])
def test_a_model_that_never_works_is_given_up_after_first_runs_and_retries(retry_count: int, tmp_path: Path) -> None:
    model = models.WorksAbove(1000.0, tmp_path)
    said = r"the first (1\d) runs have all failed \(1\d x OSError: no \[/licence\]\), so the (6|7)\d that are left"
    with pytest.raises(ValueError, match=said):
        # With two, the one that starts first may be through with many runs before the other has begun with its first.
        campaign(tmp_path, model, x=MANY, workers=1, options=RunOptions(retry_count=retry_count))
    # Beside the ten only what was under way meanwhile: two at most.
    assert 10 * (retry_count + 1) <= tries(tmp_path) <= 12 * (retry_count + 1)
    assert 10 <= len([entry for entry in read_records(tmp_path / "runs.sqlite") if entry.status == "failed"]) <= 12
    # Nothing of it counts: mended, the same command makes all runs.
    assert campaign(tmp_path, models.WorksAbove(-1.0, tmp_path), x=MANY).outcomes == ["clear"] * 82


def test_a_campaign_goes_on_when_one_of_its_first_runs_succeeds(tmp_path: Path) -> None:
    # Ten of 82 succeed, the first trial run among them.
    keys = {run_key({"a": a, "b": 0.5}, 0, 0, {}): a for a in MANY[:, 0].tolist()}
    lucky = keys[min(keys)]
    runs = campaign(tmp_path, models.WorksAbove(lucky - 0.25, tmp_path, lucky + 0.25), x=MANY)
    assert [row[0] for row, outcome in zip(MANY, runs.outcomes, strict=True) if outcome == "clear"] == [lucky]


def test_runs_that_fail_again_when_they_are_tried_once_more_end_no_campaign(tmp_path: Path) -> None:
    model = models.WorksAbove(10.0, tmp_path)
    first = campaign(tmp_path, model, x=MANY)
    assert first.outcomes.count("failed") == 20
    assert campaign(tmp_path, model, x=MANY, options=RunOptions(retry_count=1)).outcomes == first.outcomes


def test_a_log_of_each_run_on_demand(tmp_path: Path) -> None:
    runs = campaign(tmp_path, models.talks, options=RunOptions(log_folder=tmp_path / "logs"))
    logs = [(tmp_path / "logs" / f"{entry.key}.log").read_text() for entry in runs.records]
    assert all(f"rolling on {row[0]}" in log for row, log in zip(X, logs, strict=True))
    assert "Traceback" in logs[1]
    assert "Traceback" not in logs[0]
    assert runs.records[0].outputs == {"height": 1.0}


GRID = np.array([[a, b] for a in np.linspace(0, 1, 10) for b in np.linspace(0, 1, 10)])


def reasons(failed: np.ndarray) -> list[str | None]:
    return ["it diverged" if entry else None for entry in failed]


def test_nothing_missing_says_nothing() -> None:
    assert missing(GRID, [None] * 100, ("a", "b"), 0.1) == ""


def test_scattered_failures_are_counted_and_accepted() -> None:
    failed = np.zeros(100, dtype=bool)
    failed[np.random.default_rng(3).choice(100, 8, replace=False)] = True
    assert missing(GRID, reasons(failed), ("a", "b"), 0.1) == (
        "8 of 100 runs failed (8 x it diverged); what is fitted goes without them"
    )


@pytest.mark.parametrize(("failed", "words"), [
    (np.arange(100) % 9 == 0, r"12 of 100 runs failed .* allowed: at most 10 %"),
    (GRID[:, 0] > 0.7, r"30 of 100 .*, 30 of them where a > 0\.5; allowed: at most 10 %"),
    (GRID[:, 0] > 0.95, r"10 of them lie where a > 0\.5, so"),
    ((GRID[:, 0] > 0.6) & (GRID[:, 1] < 0.2), r"8 of them lie where a > 0\.5 and b < 0\.5"),
], ids=["scattered", "together", "on one side", "in a corner of two inputs"])  # fmt: skip
def test_too_many_failures_or_some_that_lie_together_are_refused(failed: np.ndarray, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        missing(GRID, reasons(failed), ("a", "b"), 0.1)


def test_chance_alone_seldom_looks_like_a_corner() -> None:
    generator, refused = np.random.default_rng(1), 0
    for _ in range(300):
        failed = np.zeros(100, dtype=bool)
        failed[generator.choice(100, 10, replace=False)] = True
        try:
            missing(GRID, reasons(failed), ("a", "b"), 0.1)
        except ValueError:
            refused += 1
    # The chance is at most 0.01 in each of the 300; more than 9 would itself have a chance below 0.002.
    assert refused <= 9


def test_a_model_that_no_worker_can_import_ends_the_campaign_and_fails_no_run(tmp_path: Path) -> None:
    (tmp_path / "passing.py").write_text("def model(inputs, seed):\n    return {}\n")
    spec = importlib.util.spec_from_file_location("passing", tmp_path / "passing.py")
    module = sys.modules["passing"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    with pytest.raises(ConnectionError, match="ModuleNotFoundError: No module named 'passing'"):
        campaign(tmp_path, module.model)
    # Which of them were handed to a process before it told that it cannot, depends on how fast it starts.
    assert {entry.status for entry in read_records(tmp_path / "runs.sqlite")} <= {"queued", "running"}


def test_a_model_that_cannot_be_sent_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="a model may be a function of a file, outside of any other function"):
        campaign(tmp_path, lambda inputs, seed: {})


UNGUARDED = """
import numpy as np
from lithobrake import campaign

def model(inputs, seed):
    return {"height": 1.0}

with campaign.Ledger("runs.sqlite") as ledger:
    campaign.run(model, np.ones((1, 1)), names=["a"], ledger=ledger, executor=campaign.LocalExecutor(1))
"""


def test_a_script_that_its_workers_would_start_again_is_told_so_and_fails_no_run(tmp_path: Path) -> None:
    (tmp_path / "unguarded.py").write_text(UNGUARDED)
    said = subprocess.run([sys.executable, "unguarded.py"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert said.returncode == 1
    last = said.stderr.strip().splitlines()[-1]
    assert "worker processes import this script, because it defines the model" in last
    assert 'belongs under: if __name__ == "__main__":' in last
    assert {entry.status for entry in read_records(tmp_path / "runs.sqlite")} <= {"queued", "running"}


class KilledFirst(Worker):
    """A process that stands still before it is given a call, and is killed when it has it: the first that starts."""

    started: ClassVar[list[Worker]] = []

    def __init__(self) -> None:
        super().__init__()
        self.started.append(self)
        if self is self.started[0]:
            os.kill(self.number, signal.SIGSTOP)

    def take(self, call: Call) -> bool:
        taken = super().take(call)
        if self is self.started[0]:
            os.kill(self.number, signal.SIGKILL)
        return taken


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such signals")
def test_a_process_killed_before_it_begins_costs_no_run_a_try(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executors, "Worker", KilledFirst)
    monkeypatch.setattr(KilledFirst, "started", [])
    runs = campaign(tmp_path, models.parabola, workers=1)
    assert len(KilledFirst.started) == 2
    assert [(one.outcome, one.attempts) for one in runs.records] == [("clear", 1)] * 4


class FirstStands(Worker):
    """A process that stands still from the start: the first that starts."""

    started: ClassVar[list[Worker]] = []

    def __init__(self) -> None:
        super().__init__()
        self.started.append(self)
        if len(self.started) == 1:
            os.kill(self.number, signal.SIGSTOP)


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such signals")
def test_a_call_that_is_ended_before_it_begins_is_given_to_no_other_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executors, "Worker", FirstStands)
    executor = LocalExecutor(1)
    future = executor.submit(abs, -1)
    while not any(one.call for one in FirstStands.started):
        time.sleep(0.001)
    executor.shutdown(cancel_futures=True)
    assert len(FirstStands.started) == 1
    with pytest.raises(WorkerDiedError, match="ended before it began"):
        future.result(timeout=0.0)


# The model stands in a file of its own; what the script prints would come twice if a process imported it.
SCRIPT = """
print("started")
import numpy as np
import sums
from lithobrake import campaign

with campaign.Ledger("runs.sqlite") as ledger, campaign.LocalExecutor(2) as executor:
    runs = campaign.run(sums.model, np.ones((3, 2)), names=["a", "b"], ledger=ledger, executor=executor)
print(runs.outputs(["sum"]).ravel())
"""
OWN_MODEL = """
import numpy as np
from lithobrake import campaign

def model(inputs, seed):
    return {"sum": inputs["a"] + inputs["b"]}

def main():
    with campaign.Ledger("runs.sqlite") as ledger, campaign.LocalExecutor(1) as executor:
        runs = campaign.run(model, np.ones((3, 2)), names=["a", "b"], ledger=ledger, executor=executor)
    print(runs.outputs(["sum"]).ravel())

if __name__ == "__main__":
    main()
"""


def python(place: Path, *words: str, given: str | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *words], cwd=place, input=given, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("piped", [False, True])
def test_a_script_without_a_guard_starts_a_campaign_and_is_not_started_again(piped: bool, tmp_path: Path) -> None:
    (tmp_path / "sums.py").write_text("def model(inputs, seed):\n    return {'sum': inputs['a'] + inputs['b']}\n")
    (tmp_path / "script.py").write_text(SCRIPT)
    said = python(tmp_path, "-", given=SCRIPT) if piped else python(tmp_path, "script.py")
    assert (said.stderr, said.stdout) == ("", "started\n[2. 2. 2.]\n")


def test_a_model_of_a_guarded_script_is_found(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(OWN_MODEL)
    assert python(tmp_path, "script.py").stdout == "[2. 2. 2.]\n"
    (tmp_path / "runs.sqlite").unlink()
    assert python(tmp_path, "-m", "script").stdout == "[2. 2. 2.]\n"


def test_a_model_of_a_piped_script_is_refused_in_one_sentence(tmp_path: Path) -> None:
    said = python(tmp_path, "-", given=OWN_MODEL)
    assert said.returncode == 1
    assert "MainModuleError: the model is defined in a notebook, an interactive session or a piped" in said.stderr
    assert said.stderr.count("Traceback") == 1


def test_words_like_those_of_a_script_are_no_part_of_it() -> None:
    import pickle

    # Nothing of these tests is a script that a process could import.
    refuse_unreachable(pickle.dumps("call it __main__"))
    with pytest.raises(MainModuleError, match="write it to a file, say"):
        refuse_unreachable(b"c__main__\nmodel\n.".replace(b"c__main__\nmodel\n", b"\x8c\x08__main__\x8c\x05model\x93"))
