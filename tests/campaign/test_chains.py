"""Chains of runs: each follows from the one before, whatever is known, killed or made by how many."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import campaign_models as models
import pytest
from test_runs import HereExecutor

from lithobrake.campaign import Ledger, LocalExecutor, Record, campaign_began, read_records, run_chains

FIRST = [{"chain": float(chain), "value": start} for chain, start in enumerate((27.0, 6.0, 1.0))]
# Numbers of the Collatz sequence on the way from each first value to 1.
LENGTHS = [112, 9, 1]


def then(chain: int, records: Sequence[Record]) -> Mapping[str, float] | None:
    """The next number of the Collatz sequence."""
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


class Killed(Exception):
    """The process ends here."""


def test_after_a_kill_only_what_was_under_way_is_made_again(tmp_path: Path) -> None:
    begun = HereExecutor()

    def kill(state: Any) -> None:
        if state.ended >= 40:
            raise Killed

    with pytest.raises(Killed):
        chains(tmp_path, begun, progress=kill)
    known = len([one for one in read_records(tmp_path / "runs.sqlite") if one.status == "done"])
    rest = HereExecutor()
    assert [len(one) for one in chains(tmp_path, rest)] == LENGTHS
    assert known >= 40
    assert known + rest.call_count == sum(LENGTHS)


def test_processes_give_the_same_records(tmp_path: Path) -> None:
    with LocalExecutor(2) as executor:
        made = chains(tmp_path, executor)
    (tmp_path / "other").mkdir()
    one = chains(tmp_path / "other", HereExecutor())
    assert what_came_of_chains(made) == what_came_of_chains(one)


def test_a_failed_run_ends_its_chain_as_then_says(tmp_path: Path) -> None:
    made = chains(tmp_path, HereExecutor(), models.collatz_without_ten)
    assert [len(one) for one in made] == [26, 3, 1]
    assert [one[-1].status for one in made] == ["failed", "failed", "done"]
    assert [one[-1].inputs["value"] for one in made] == [310.0, 10.0, 1.0]


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
