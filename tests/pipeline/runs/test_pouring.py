"""Beds poured at once, one a worker: with the bits of one after the other, and whatever breaks."""

import os
import random
import time
import tomllib
from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from lithobrake.campaign import DaskExecutor, LocalExecutor
from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.runs import beds as module
from lithobrake.pipeline.runs.beds import pour_beds
from lithobrake.study import Study, check_tables
from lithobrake.touchdown import bed_library

from ...command_line import lithobrake
from ...few_grains import few_grains
from ...quick_studies import OwnProcess
from ..killed_studies import kill, start

TEXT = (
    few_grains(12, 0.3, 0.1, sides="walls").replace("[grain]", "bed_count = 3\n[grain]") + "[journey]\ntouchdowns = 1\n"
)
STUDY = check_tables(tomllib.loads(TEXT), Path())
NAMES = tuple(bed_files(STUDY))


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """An empty library of beds, beside the compiled kernels of this user."""
    root = Path(os.environ.get("LITHOBRAKE_CACHE") or os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser()
    cache = tmp_path_factory.mktemp("cache")
    (cache / "lithobrake").mkdir(mode=0o700)
    for folder in (root / "lithobrake").glob("*-*"):
        (cache / "lithobrake" / folder.name).symlink_to(folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("LITHOBRAKE_CACHE", str(cache))
        patch.setenv(bed_library.SIZE_VARIABLE, "1")
        bed_library._library.cache_clear()
        yield
    bed_library._library.cache_clear()


@dataclass
class Told(Silent):
    said: list[str] = field(default_factory=list)
    works: list[tuple[float, float, str]] = field(default_factory=list)

    def say(self, sentence: str) -> None:
        self.said.append(sentence)

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        self.works.append((done, total, what))


def pour(folder: Path, wanted: tuple[str, ...], executor: Executor | None = None) -> Told:
    """Pour these beds; without an executor any call of a worker is an error."""
    told, none = Told(), Executor()
    pour_beds(Job(DrawnDesign(STUDY), {}, StudyFolder(folder), executor or none, told, wanted=wanted))
    return told


def content(folder: Path, *names: str) -> list[bytes]:
    return [(folder / name).read_bytes() for name in names]


class Broken:
    """Beds of these numbers cannot be poured: a gravity that points nowhere is refused by the pour."""

    def __init__(self, patch: pytest.MonkeyPatch, *numbers: int) -> None:
        self.recipe = module.bed_recipe
        self.numbers = numbers
        patch.setattr(module, "bed_recipe", self)

    def __call__(self, study: Study, index: int) -> Any:
        found = self.recipe(study, index)
        if index in self.numbers:
            object.__setattr__(found, "gravity", (0.0, 0.0, float("nan")))
        return found


@pytest.fixture(scope="module")
def poured(library: None, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, int]:
    """Three beds on two workers, of which the second fails: the folder, what was said, how many workers there were."""
    folder = tmp_path_factory.mktemp("poured")
    with pytest.MonkeyPatch.context() as patch, LocalExecutor(2) as executor:
        Broken(patch, 1)
        with pytest.raises(ValueError, match="cannot be poured") as refusal:
            pour(folder, NAMES, executor)
        return folder, str(refusal.value), len(executor._workers)


def test_a_bed_that_fails_is_named_when_the_others_are_there(poured: tuple[Path, str, int]) -> None:
    folder, said, workers = poured
    assert said.startswith(
        "bed 2 of 3 cannot be poured (surface.gravity with surface.slope_deg, as a vector, is (0.0, 0.0, nan); allowed "
    )
    assert [name for name in NAMES if (folder / name).is_file()] == [NAMES[0], NAMES[2]]
    assert workers == 2


def test_beds_of_two_workers_have_the_bits_of_one_after_the_other(
    poured: tuple[Path, str, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bed_library, "_library", lambda size: None)
    told = pour(tmp_path, (NAMES[2],))
    assert told.works[0] == (0, 1, "compiling kernels")
    assert told.works[-1][2].startswith("bed 3 of 3: ")
    assert content(poured[0], NAMES[2]) == content(tmp_path, NAMES[2])
    # The first bed is another one; a cluster pours it again below.
    assert content(poured[0], NAMES[0]) != content(poured[0], NAMES[2])


def test_beds_of_the_library_ask_no_worker_and_several_failures_are_one_sentence(
    poured: tuple[Path, str, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = pour(tmp_path, (NAMES[0], NAMES[2]))
    assert (told.said, told.works) == (["bed: 2 of 2 were in the library of beds"], [])
    assert content(poured[0], NAMES[0], NAMES[2]) == content(tmp_path, NAMES[0], NAMES[2])
    Broken(monkeypatch, 1, 2)
    with (
        OwnProcess(1) as executor,
        pytest.raises(ValueError, match=r"^beds 2, 3 of 3 cannot be poured \(surface\.gravity"),
    ):
        pour(tmp_path, NAMES[1:], executor)
    with pytest.raises(ValueError, match=r"^bed 2 of 3 cannot be poured"):
        pour(tmp_path, NAMES[1:2])


def test_beds_of_a_dask_cluster_have_the_same_bits(poured: tuple[Path, str, int], tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="distributed is not installed")
    with (
        pytest.MonkeyPatch.context() as patch,
        # A worker in a thread of this process, which has imported all, and which is called through the network still.
        distributed.LocalCluster(
            1, threads_per_worker=1, processes=False, protocol="tcp", dashboard_address=None, host="127.0.0.1"
        ) as cluster,
        DaskExecutor(cluster.scheduler_address) as executor,
    ):
        patch.setattr(bed_library, "_library", lambda size: None)
        told = pour(tmp_path, (NAMES[0], NAMES[2]), executor)
    done = [work for work in told.works if work[2] == "pouring beds"]
    assert (done[0], done[-1]) == ((0, 2, "pouring beds"), (2, 2, "pouring beds"))
    assert done == sorted(done)
    assert content(poured[0], NAMES[0], NAMES[2]) == content(tmp_path, NAMES[0], NAMES[2])


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="the workers are found in /proc (Linux)")
def test_beds_that_are_stopped_and_killed_end_with_the_same_bits(
    poured: tuple[Path, str, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Without a library nothing of what was stopped is found again but in the folder.
    monkeypatch.setenv(bed_library.SIZE_VARIABLE, "0")
    study, out, chance = tmp_path / "study.toml", tmp_path / "out", random.Random(1)
    study.write_text(TEXT)
    for code, workers in ((143, 1), (-9, 2)):
        for path in (out / "beds").glob("*.h5"):
            path.unlink()
        process, limit = start(study, out, workers, "bed"), time.monotonic() + 120
        # Of three beds one is there, and another one or two are under way.
        while not list((out / "beds").glob("*.h5")) and time.monotonic() < limit:
            time.sleep(0.01)
        if code < 0:
            kill(process, "coordinator", chance)
        else:
            process.terminate()
            process.join(timeout=60)
        said = (tmp_path / "said.txt").read_text()
        assert process.exitcode == code, said
        assert (code < 0) or "Every finished run is kept; to continue" in said
    ended = lithobrake("bed", study, "--out", out, "--workers", 1)
    assert ended.returncode == 0, ended.stderr
    assert content(poured[0], NAMES[0], NAMES[2]) == content(out, NAMES[0], NAMES[2])
    assert sorted(path.name for path in (out / "beds").glob("*.h5")) == sorted(n[5:] for n in NAMES)
