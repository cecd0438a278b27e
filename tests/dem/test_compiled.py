"""Kernels are compiled once, and kept where only this user writes; what is damaged is made again."""

import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake.compilation.compiled as compiled
import lithobrake.compilation.disk_cache as disk_cache
from lithobrake.dem.bodies.orientation import write_rotations

QUARTER_TURN = np.array([[0.5, 0.5, -0.5, 0.5]])
TURNED = [0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0]


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache in the place of the user's."""
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(tmp_path))
    compiled.disk_cache.cache_clear()
    compiled.announce.cache_clear()
    yield tmp_path
    compiled.disk_cache.cache_clear()


def rotation() -> list[float]:
    """A quarter turn, by a kernel that this process has not compiled yet."""
    compiled.disk_cache.cache_clear()
    result = np.zeros((1, 3, 3))
    compiled.kernel(write_rotations.py_func)(QUARTER_TURN, result)
    return result.ravel().tolist()


def kept(cache: Path) -> list[Path]:
    """The kernel of `rotation` in the cache."""
    return sorted(cache.rglob("dem.bodies.orientation.write_rotations-*"))


def test_cache_folder_changes_with_any_source_of_the_part(tmp_path, monkeypatch):
    package = tmp_path / "package"
    for part in ("dem", "compilation"):
        (package / part).mkdir(parents=True)
    callee = package / "dem" / "callee.py"
    callee.write_text("a = 1\n")
    monkeypatch.setattr(compiled, "__file__", str(package / "compilation" / "compiled.py"))
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(tmp_path))
    compiled.disk_cache.cache_clear()
    before = compiled.disk_cache("dem").folder
    callee.write_text("a = 2\n")
    compiled.disk_cache.cache_clear()
    after = compiled.disk_cache("dem").folder
    compiled.disk_cache.cache_clear()
    assert isinstance(before, Path)
    assert before != after


def test_kernel_is_kept_for_this_user_alone(cache):
    assert rotation() == TURNED
    (file,) = kept(cache)
    assert [path.stat().st_mode & 0o777 for path in (file.parent.parent, file.parent, file)] == [0o700, 0o700, 0o600]
    before = file.stat()
    assert rotation() == TURNED
    assert file.stat().st_mtime_ns == before.st_mtime_ns


def spoil_by_another(file: Path) -> None:
    compiled.disk_cache("dem").write("another", b"a whole file")
    (file.parent / "another").rename(file)


def spoil_by_loop(file: Path) -> None:
    file.unlink()
    file.symlink_to(file)


@pytest.mark.parametrize(("spoil", "word"), [
    (lambda file: file.write_bytes(file.read_bytes()[:-1000]), "is damaged"),
    (lambda file: file.write_bytes(b""), "is damaged"),
    (lambda file: file.write_bytes(b"\0" * 5000), "is damaged"),
    (spoil_by_another, "is damaged"),
    (lambda file: file.chmod(0o666), "another user"),
    (spoil_by_loop, "cannot be read"),
], ids=["truncated", "empty", "garbage", "another's", "open to all", "unreadable"])  # fmt: skip
def test_damaged_kernel_is_made_again(cache, caplog, spoil: Callable[[Path], Any], word: str):
    assert rotation() == TURNED
    (file,) = kept(cache)
    spoil(file)
    caplog.clear()
    assert rotation() == TURNED
    (told,) = caplog.messages
    assert str(file) in told
    assert word in told
    assert told.endswith("it is made again.")
    caplog.clear()
    assert rotation() == TURNED
    assert caplog.messages == []


def refuse_owner(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: other)


def refuse_mode(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    compiled.disk_cache("dem").folder.chmod(0o777)


def refuse_place(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (cache / "lithobrake").write_text("a file")


def refuse_writing(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # What a file system says that is mounted for reading alone.
    monkeypatch.setattr(os, "access", lambda path, mode: False)


def refuse_all(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(disk_cache, "atomic_path", full)


@pytest.mark.parametrize(("refuse", "word"), [
    (refuse_owner, "another user"),
    (refuse_mode, "can be written by others"),
    (refuse_place, "no folder for a cache can be made"),
    (refuse_writing, "cannot be written, so"),
    (refuse_all, "No space left on device"),
])  # fmt: skip
def test_without_a_trusted_cache_kernels_are_compiled_each_time(cache, monkeypatch, caplog, refuse, word):
    refuse(cache, monkeypatch)
    package = Path(compiled.__file__).parent
    before = {path for path in package.rglob("*") if path.suffix != ".pyc"}
    caplog.clear()
    assert rotation() == TURNED
    compiled.announce.cache_clear()
    compiled.announce("dem")
    told = [message for message in caplog.messages if "LITHOBRAKE_CACHE" in message]
    assert len(told) == 1
    assert word in told[0]
    assert kept(cache) == []
    assert {path for path in package.rglob("*") if path.suffix != ".pyc"} == before
    assert caplog.messages[-1] == "Compiling the soft-surface engine for this processor: about half a minute."


def test_kernel_that_only_kernels_call_has_no_wrapper_and_one_form_for_all_constants(cache):
    scaled = compiled.kernel(lambda factor, value: factor * value)
    scaled.py_func.__module__ = "lithobrake.dem.test"

    def doubled_and_tripled(value: float) -> float:
        return scaled(2, value) + scaled(3, value)

    doubled_and_tripled.__module__ = "lithobrake.dem.test"
    assert compiled.kernel(doubled_and_tripled)(1.5) == 7.5
    assert scaled.signatures == []
    assert [str(types) for types in scaled.within.signatures] == ["(int64, float64)"]
    # It can still be called from Python.
    assert scaled(2, 1.5) == 3.0


def test_waiting_for_another_process_is_told_once(cache, caplog):
    """Kernels are compiled one after the other, each in a turn of its own."""
    ours, theirs = disk_cache.DiskCache("dem"), disk_cache.DiskCache("dem")
    order: list[str] = []

    def take_turn() -> None:
        with ours.turn("Waiting."):
            order.append("ours")

    for _ in range(2):
        with theirs.turn("Never said."):
            other = threading.Thread(target=take_turn)
            other.start()
            for _ in range(1000):
                other.join(0.01)
                if caplog.messages:
                    break
            order.append("theirs")
        other.join()
    assert order == ["theirs", "ours", "theirs", "ours"]
    assert caplog.messages == ["Waiting."]


TURN = """
import sys
import numpy as np
from lithobrake.dem.bodies.orientation import write_rotations
print("ready", flush=True)
sys.stdin.readline()
rotation = np.zeros((1, 3, 3))
write_rotations(np.array([[0.5, 0.5, -0.5, 0.5]]), rotation)
print(rotation.ravel().tolist())
"""


def test_processes_that_start_together_compile_once(cache, caplog):
    """Two start into an empty cache together, a third finds it filled: all with the same numbers, one compiles."""
    environment = {**os.environ, "LITHOBRAKE_CACHE": str(cache)}

    def process() -> subprocess.Popen[str]:
        return subprocess.Popen([sys.executable, "-c", TURN], env=environment, text=True, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE)  # fmt: skip

    together = [process() for _ in range(2)]
    for one in together:
        assert one.stdout.readline() == "ready\n"
    for one in together:
        one.stdin.write("go\n")
        one.stdin.flush()
    told = [one.communicate() for one in together]
    assert {out for out, _ in told} == {f"{TURNED}\n"}
    assert sum("Compiling the soft-surface engine for this processor, once" in message for _, message in told) == 1
    assert {message for _, message in told if "Compiling" not in message} <= {
        "",
        "Waiting for another process that compiles the soft-surface engine: about half a minute.\n",
    }
    (file,) = kept(cache)
    before = file.stat().st_mtime_ns
    assert rotation() == TURNED
    assert caplog.messages == []
    assert [path.stat().st_mtime_ns for path in kept(cache)] == [before]
