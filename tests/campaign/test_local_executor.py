"""Processes of this machine: when they start, and when they end."""

import os
import time
from pathlib import Path

import pytest

from lithobrake.campaign import LocalExecutor, executors


def ended(number: int) -> bool:
    """Whether a process has ended, within some seconds."""
    deadline = time.monotonic() + 20.0
    while Path(f"/proc/{number}").exists():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="without /proc no process is looked up")
def test_a_process_without_calls_ends_and_another_takes_the_next_call(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(executors, "IDLE_TIME", 0.3)
    with LocalExecutor(2) as executor:
        first = executor.submit(os.getpid).result()
        assert ended(first)
        # The end of an idle process leaves one at work alone, here one that waits for a word.
        os.mkfifo(tmp_path / "word")
        slow, quick = executor.submit((tmp_path / "word").read_text), executor.submit(os.getpid)
        assert ended(quick.result())
        (tmp_path / "word").write_text("go on")
        assert slow.result() == "go on"
        assert executor.submit(os.getpid).result() not in (first, quick.result())


def test_a_process_is_kept_for_calls_that_follow_soon() -> None:
    with LocalExecutor(1) as executor:
        assert len({executor.submit(os.getpid).result() for _ in range(3)}) == 1
