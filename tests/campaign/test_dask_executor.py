"""A real Dask cluster on this machine: a scheduler and workers, each a process of its own."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import campaign_models as models
import numpy as np
import pytest
from dask_cluster import Cluster, cluster
from test_runs import chains, what_came_of_chains

from lithobrake.campaign import DaskExecutor, Ledger, Limits, LocalExecutor, Runs, Tally, read_records, run

pytest.importorskip("distributed", reason="distributed is not installed (pip install lithobrake[dask])")

X = np.column_stack([np.linspace(0.5, 10.0, 20), np.full(20, 0.5)])


def campaign(path: Path, executor: Any, model: Any = models.sleeps_a_moment, **options: Any) -> list[tuple[Any, ...]]:
    """Make the runs at X; give what determines them and what came of them."""
    with Ledger(path) as ledger, executor:
        return what_came(run(model, X, names=("a", "b"), ledger=ledger, executor=executor, **options))


def what_came(runs: Runs) -> list[tuple[Any, ...]]:
    return [(e.key, e.status, e.outcome, e.inputs, e.outputs, e.draws, e.seed, e.reason) for e in runs.records]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """One cluster: each test has the workers that it asks for, and the last one ends the scheduler."""
    with cluster(tmp_path_factory.mktemp("cluster")) as made:
        yield made


def losing(worker: "subprocess.Popen[bytes]", is_time: Callable[[Tally], bool]) -> Callable[[Tally], None]:
    """What kills a worker when it is time."""

    def lose(state: Tally) -> None:
        if is_time(state) and worker.poll() is None:
            worker.kill()
            worker.wait()

    return lose


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Any, ...]]:
    """The campaign on this machine."""
    return campaign(tmp_path_factory.mktemp("here") / "here.sqlite", LocalExecutor(2))


def test_a_cluster_that_loses_a_worker_gives_the_bits_of_this_machine(
    made: Cluster, here: list[tuple[Any, ...]], tmp_path: Path
) -> None:
    lost, _ = made.workers(2)
    lose_a_worker = losing(lost, lambda state: state.done >= 5)
    there = campaign(tmp_path / "there.sqlite", DaskExecutor(made.address), progress=lose_a_worker)
    assert lost.poll() is not None
    assert there == here


def test_chains_on_a_cluster_that_loses_a_worker_are_those_of_this_machine(made: Cluster, tmp_path: Path) -> None:
    lost, _ = made.workers(2)
    lose_a_worker = losing(lost, lambda state: state.ended >= 12)
    with DaskExecutor(made.address) as executor:
        there = chains(tmp_path, executor, models.collatz_after_a_moment, progress=lose_a_worker)
    assert lost.poll() is not None
    (tmp_path / "here").mkdir()
    with LocalExecutor(1) as executor:
        here = chains(tmp_path / "here", executor)
    assert what_came_of_chains(there) == what_came_of_chains(here)


COORDINATE = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from test_dask_executor import campaign, DaskExecutor
campaign(Path(sys.argv[2]), DaskExecutor(sys.argv[3]))
"""


def done_count(path: Path) -> int:
    return sum(entry.status == "done" for entry in read_records(path))


def test_a_coordinator_that_is_killed_loses_no_run_that_its_cluster_has_made(
    made: Cluster, here: list[tuple[Any, ...]], tmp_path: Path
) -> None:
    path = tmp_path / "there.sqlite"
    made.workers(1)
    # A ledger that is being made is there a moment before its table.
    Ledger(path).close()
    arguments = [str(Path(__file__).parent), str(path), made.address]
    coordinator = subprocess.Popen([sys.executable, "-c", COORDINATE, *arguments], env=made.environment)
    while done_count(path) < 5 and coordinator.poll() is None:
        time.sleep(0.02)
    coordinator.kill()
    coordinator.wait()
    kept = done_count(path)
    with Ledger(path) as ledger, DaskExecutor(made.address) as executor:
        runs = run(models.sleeps_a_moment, X, names=("a", "b"), ledger=ledger, executor=executor)
    assert 5 <= runs.reused_count == kept
    assert what_came(runs) == here


def test_limits_hold_on_a_cluster_and_its_worker_lives_on(made: Cluster, tmp_path: Path) -> None:
    # A worker under a nanny is a daemon, which may not start processes as it is.
    made.workers(1, nannies=True)
    runs = campaign(
        tmp_path / "runs.sqlite", DaskExecutor(made.address), models.sleeps_at_ten, limits=Limits(wall_s=0.5)
    )
    assert [entry[1] for entry in runs] == ["done"] * 19 + ["failed"]
    assert runs[19][7] == "it ran longer than its limit of 0.5 s"
    assert all(entry.wall_s and entry.host for entry in read_records(tmp_path / "runs.sqlite"))


def test_a_scheduler_that_goes_away_is_one_sentence_and_what_had_ended_is_kept(made: Cluster, tmp_path: Path) -> None:
    made.workers(1, nannies=True)

    def lose_the_scheduler(state: Tally) -> None:
        if state.done >= 5:
            made.processes["scheduler"].kill()

    with pytest.raises(ConnectionError, match="every run that had ended is kept"):
        campaign(tmp_path / "runs.sqlite", DaskExecutor(made.address), progress=lose_the_scheduler)
    with Ledger(tmp_path / "runs.sqlite") as ledger, LocalExecutor(1) as executor:
        runs = run(models.sleeps_a_moment, X, names=("a", "b"), ledger=ledger, executor=executor)
    assert 5 <= runs.reused_count < 20


def test_no_scheduler_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lithobrake.campaign.dask_executor._CONNECT_TIMEOUT", 0.3)
    with pytest.raises(ValueError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        DaskExecutor("tcp://127.0.0.1:9")


@pytest.mark.parametrize("address", ["nonsense", "127.0.0.1:8786", "tcp://127.0.0.1", "", "tcp:// x:1"])
def test_an_address_that_is_none_is_refused_at_once(address: str) -> None:
    with pytest.raises(ValueError, match="allowed: tcp://HOST:PORT or tls://HOST:PORT"):
        DaskExecutor(address)


def test_certificates_that_do_not_go_with_the_address_are_refused_at_once(tmp_path: Path) -> None:
    import dask

    with pytest.raises(ValueError, match="asks for certificates, and Dask's settings name none"):
        DaskExecutor("tls://127.0.0.1:9")
    with (
        dask.config.set({"distributed.comm.require-encryption": True}),
        pytest.raises(ValueError, match=r"require encryption, and tcp://127\.0\.0\.1:9 has none"),
    ):
        DaskExecutor("tcp://127.0.0.1:9")
    (tmp_path / "none.pem").write_text("no certificate")
    tls = {f"distributed.comm.tls.{key}": str(tmp_path / "none.pem") for key in ("ca-file", "client.cert")}
    with (
        dask.config.set(tls),
        pytest.raises(ValueError, match=r"the certificates in Dask's settings cannot be used \("),
    ):
        DaskExecutor("tls://127.0.0.1:9")
