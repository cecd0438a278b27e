"""Campaigns and chains of runs: computed once, kept, reproducible, undisturbed by runs that fail."""

import sqlite3
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

import campaign_models as models
import numpy as np
import pytest

from lithobrake.campaign import (
    Ledger,
    LocalExecutor,
    Record,
    RunOptions,
    Runs,
    Tally,
    campaign_began,
    read_records,
    run,
    run_chains,
    run_key,
    run_seed,
)

X = np.array([[1.0, 0.5], [2.0, 0.5], [3.0, 0.5], [1.0, 0.5]])


class HereExecutor(Executor):
    """Calls at once, in this process, and counts."""

    def __init__(self) -> None:
        self.call_count = 0

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        self.call_count += 1
        future: Future[Any] = Future()
        future.set_result(function(*args, **kwargs))
        return future


class OneWorker(HereExecutor):
    """The same, as of one worker."""

    capacity = 1


def campaign(path: Path, model: Callable[..., Any], executor: Executor, x: np.ndarray = X, **options: Any) -> Runs:
    with Ledger(path / "runs.sqlite") as ledger:
        return run(model, x, names=("a", "b"), ledger=ledger, executor=executor, **options)


def test_rows_come_back_in_order_and_a_repeated_row_is_one_run(tmp_path: Path) -> None:
    here = HereExecutor()
    assert campaign(tmp_path, models.parabola, here).outputs(["height"])[:, 0].tolist() == [1.5, 4.5, 9.5, 1.5]
    assert here.call_count == 3


def test_what_was_computed_is_not_computed_again_by_any_design(tmp_path: Path) -> None:
    campaign(tmp_path, models.parabola, HereExecutor())
    here = HereExecutor()
    runs = campaign(tmp_path, models.parabola, here, np.array([[3.0, 0.5], [4.0, 0.5]]))
    assert here.call_count == 1
    assert runs.reused_count == 1


def test_the_order_of_the_inputs_makes_no_other_run(tmp_path: Path) -> None:
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        run(models.parabola, X[:, ::-1], names=("b", "a"), ledger=ledger, executor=HereExecutor())
    here = HereExecutor()
    campaign(tmp_path, models.parabola, here)
    assert here.call_count == 0


def test_another_seed_or_context_is_another_run(tmp_path: Path) -> None:
    campaign(tmp_path, models.parabola, HereExecutor())
    others = {"options": RunOptions(seed=2)}, {"context": {"version": "2"}}, {"options": RunOptions(replicate=1)}
    for options in others:
        here = HereExecutor()
        campaign(tmp_path, models.parabola, here, **options)
        assert here.call_count == 3


def test_a_run_that_raises_is_recorded_with_its_reason(tmp_path: Path) -> None:
    runs = campaign(tmp_path, models.breaks_at_two, HereExecutor())
    assert runs.outcomes == ["clear", "failed", "clear", "clear"]
    assert np.isnan(runs.outputs(["height"])[:, 0]).tolist() == [False, True, False, False]
    assert runs.records[1].reason == "FloatingPointError: the overlap grew without bound"


def test_a_captured_lander_is_an_outcome_with_its_other_outputs(tmp_path: Path) -> None:
    runs = campaign(tmp_path, models.captured_below_two, HereExecutor())
    assert (runs.outcomes, runs.records[0].status) == (["captured", "clear", "clear", "captured"], "done")
    assert runs.outputs(["depth", "height"])[0].tolist() == pytest.approx([0.1, np.nan], nan_ok=True)


def test_processes_give_the_same_bits_as_this_one_and_survive_a_dead_worker(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    here = campaign(tmp_path / "one", models.parabola, HereExecutor())
    with LocalExecutor(2) as executor:
        there = campaign(tmp_path, models.dies_at_two, executor)
    assert there.outcomes == ["clear", "failed", "clear", "clear"]
    assert there.records[1].reason == "its process died (signal 9)"
    for row in (0, 2):
        assert there.records[row].outputs == here.records[row].outputs
        assert there.records[row].draws == here.records[row].draws


def test_an_interrupt_keeps_what_is_finished(tmp_path: Path) -> None:
    def interrupt(state: Tally) -> None:
        if state.done >= 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        campaign(tmp_path, models.parabola, HereExecutor(), progress=interrupt)
    here = HereExecutor()
    campaign(tmp_path, models.parabola, here)
    assert here.call_count <= 1


def test_x_must_fit_the_names_and_be_finite(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="one column for each of the names"):
        campaign(tmp_path, models.parabola, HereExecutor(), np.ones((2, 3)))
    with pytest.raises(ValueError, match="not finite"):
        campaign(tmp_path, models.parabola, HereExecutor(), np.array([[1.0, np.nan]]))
    with Ledger(tmp_path / "twice.sqlite") as ledger, pytest.raises(ValueError, match="names has 'a' twice"):
        run(models.parabola, np.ones((2, 2)), names=("a", "a"), ledger=ledger, executor=HereExecutor())


@pytest.mark.parametrize("model", [5, None, "bounce", {"a": 1}])
def test_what_cannot_be_called_is_no_model(tmp_path: Path, model: Any) -> None:
    with pytest.raises(ValueError, match=r"model is .*; allowed: a function of the inputs by name and a seed"):
        campaign(tmp_path, model, HereExecutor())


def test_the_ledger_reads_as_plain_sql(tmp_path: Path) -> None:
    campaign(tmp_path, models.parabola, HereExecutor())
    with sqlite3.connect(tmp_path / "runs.sqlite") as database:
        rows = database.execute(
            "SELECT status, json_extract(inputs, '$.a'), json_extract(outputs, '$.height'), wall_s >= 0, host <> '' "
            "FROM runs ORDER BY 2"
        ).fetchall()
        assert rows == [("done", 1.0, 1.5, 1, 1), ("done", 2.0, 4.5, 1, 1), ("done", 3.0, 9.5, 1, 1)]
        assert database.execute("PRAGMA journal_mode").fetchone() == ("wal",)
    database.close()


def test_a_file_that_is_no_ledger_is_refused(tmp_path: Path) -> None:
    (tmp_path / "runs.sqlite").write_text("this is not a database, and long enough to be seen as such" * 20)
    with pytest.raises(ValueError, match="cannot be used as a ledger"):
        Ledger(tmp_path / "runs.sqlite")


def test_each_process_is_started_anew_and_has_one_thread(tmp_path: Path) -> None:
    with LocalExecutor(1) as executor:
        runs = campaign(tmp_path, models.threads, executor)
    expected = {"omp_num_threads": 1.0, "openblas_num_threads": 1.0, "numba": 1.0, "is_spawned": 1.0}
    assert all(entry.outputs == expected for entry in runs.records)


@pytest.mark.parametrize("count", [-1, 0, 1.5])
def test_a_pool_of_less_than_one_process_is_refused(count: float) -> None:
    with pytest.raises(ValueError, match=r"worker_count is .*at least 1"):
        LocalExecutor(count)  # type: ignore[arg-type]


def test_the_order_of_the_inputs_does_not_matter() -> None:
    assert run_key({"a": 1.0, "b": 2.0}, 1, 0, {}) == run_key({"b": 2.0, "a": 1.0}, 1, 0, {})


def test_whatever_determines_a_run_changes_its_key() -> None:
    keys = {run_key({"a": 1.0}, 1, 0, {}), run_key({"a": 1.0 + 2**-52}, 1, 0, {}), run_key({"b": 1.0}, 1, 0, {}),
        run_key({"a": 1.0}, 2, 0, {}), run_key({"a": 1.0}, 1, 1, {}),
        run_key({"a": 1.0}, 1, 0, {"version": "2"})}  # fmt: skip
    assert len(keys) == 6


def test_the_seed_does_not_know_the_version() -> None:
    assert run_seed({"a": 1.0}, 1, 0) == run_seed({"a": 1.0}, 1, 0)
    assert len({run_seed({"a": 1.0}, 1, 0), run_seed({"a": 1.0}, 1, 1), run_seed({"a": 1.0}, 2, 0)}) == 3
    assert 0 <= run_seed({"a": 1.0}, 1, 0) < 2**53


def test_keys_and_seeds_are_the_same_on_every_machine() -> None:
    # Fixed once: a ledger of last year must still be found.
    assert run_key({"a": 0.1}, 1, 0, {"x": [1]})[:16] == "cf9d2fb58b6476f1"
    assert run_seed({"a": 0.1}, 1, 0) == 5473392904389371


FIRST = [{"chain": float(chain), "value": start} for chain, start in enumerate((25.0, 6.0, 1.0))]
# Numbers of the Collatz sequence on the way from each first value to 1.
LENGTHS = [24, 9, 1]


def then(chain: int, records: Sequence[Record]) -> Mapping[str, float] | None:
    last = records[-1]
    if last.status == "failed" or last.inputs["value"] == 1.0:
        return None
    return {"chain": float(chain), "value": last.outputs["value"]}


def chains(path: Path, executor: Any, model: Any = models.collatz, **options: Any) -> list[list[Record]]:
    with Ledger(path / "runs.sqlite") as ledger:
        return run_chains(model, FIRST, then, ledger=ledger, executor=executor, **options)


def what_came_of_chains(made: list[list[Record]]) -> list[list[tuple[Any, ...]]]:
    """What determines each run, and what came of it."""
    return [[(one.key, one.status, one.inputs, one.outputs, one.seed) for one in chain] for chain in made]


def test_each_chain_goes_on_until_it_ends(tmp_path: Path) -> None:
    made = chains(tmp_path, HereExecutor())
    assert [len(one) for one in made] == LENGTHS
    assert [one[-1].inputs["value"] for one in made] == [1.0] * 3
    assert [record.inputs["value"] for record in made[1]] == [6.0, 3.0, 10.0, 5.0, 16.0, 8.0, 4.0, 2.0, 1.0]


def test_what_the_ledger_has_is_not_made_again(tmp_path: Path) -> None:
    first = chains(tmp_path, HereExecutor())
    again = HereExecutor()
    assert chains(tmp_path, again) == first
    assert again.call_count == 0


def test_a_chain_that_has_begun_goes_on_before_others_begin(tmp_path: Path) -> None:
    """In the order of their numbers, so that what has ended at any time does not favour short ones."""
    lengths, made = [5, 1, 3, 1, 1, 4], []

    def note(inputs: Mapping[str, float], seed: int) -> dict[str, float]:
        made.append(int(inputs["chain"]))
        return {"value": 0.0}

    def next_link(chain: int, records: Sequence[Record]) -> Mapping[str, float] | None:
        return None if len(records) == lengths[chain] else {"chain": float(chain), "link": float(len(records))}

    first = [{"chain": float(chain), "link": 0.0} for chain in range(len(lengths))]
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        run_chains(note, first, next_link, ledger=ledger, executor=OneWorker())
    begins = [made.index(chain) for chain in range(len(lengths))]
    ends = [begin + 1 + max(rest for rest, one in enumerate(made[begin:]) if one == chain)
            for chain, begin in enumerate(begins)]  # fmt: skip
    assert begins == sorted(begins)
    # Two runs are handed out to a worker, so two chains are under way.
    assert max(sum(begin <= run < end for begin, end in zip(begins, ends, strict=True)) for run in range(15)) == 2


class Killed(Exception):
    """The process ends here."""


def test_after_a_kill_only_what_was_under_way_is_made_again(tmp_path: Path) -> None:
    begun = HereExecutor()

    def kill(state: Any) -> None:
        if state.ended >= 12:
            raise Killed

    with pytest.raises(Killed):
        chains(tmp_path, begun, progress=kill)
    known = len([one for one in read_records(tmp_path / "runs.sqlite") if one.status == "done"])
    rest = HereExecutor()
    assert [len(one) for one in chains(tmp_path, rest)] == LENGTHS
    assert known >= 12
    assert known + rest.call_count == sum(LENGTHS)


def test_processes_give_the_same_records(tmp_path: Path) -> None:
    with LocalExecutor(2) as executor:
        made = chains(tmp_path, executor)
    (tmp_path / "other").mkdir()
    assert what_came_of_chains(made) == what_came_of_chains(chains(tmp_path / "other", HereExecutor()))


def test_a_failed_run_ends_its_chain_as_then_says(tmp_path: Path) -> None:
    made = chains(tmp_path, HereExecutor(), models.collatz_without_ten)
    assert [len(one) for one in made] == [16, 3, 1]
    assert [one[-1].status for one in made] == ["failed", "failed", "done"]
    assert [one[-1].inputs["value"] for one in made] == [40.0, 10.0, 1.0]


def test_two_chains_with_one_run_are_refused(tmp_path: Path) -> None:
    with Ledger(tmp_path / "runs.sqlite") as ledger, pytest.raises(ValueError, match="two chains have runs"):
        run_chains(models.collatz, [FIRST[0], FIRST[0]], then, ledger=ledger, executor=HereExecutor())


def test_a_campaign_of_chains_has_one_beginning(tmp_path: Path) -> None:
    seen: set[str | None] = set()

    def look(state: Any) -> None:
        time.sleep(0.002)  # a moment is told to the millisecond
        seen.add(campaign_began(tmp_path / "runs.sqlite"))

    chains(tmp_path, HereExecutor(), progress=look)
    assert len(seen) == 1
    assert None not in seen


def test_progress_counts_all_runs_so_far(tmp_path: Path) -> None:
    totals: list[tuple[int, int]] = []
    chains(tmp_path, HereExecutor(), progress=lambda state: totals.append((state.ended, state.total)))
    assert totals[0] == (0, 3)
    assert totals[-1] == (sum(LENGTHS), sum(LENGTHS))
    assert all(ended <= total for ended, total in totals)
