"""Logs of programs that print much: the beginning and the end are kept, the rest is counted."""

import re
import shlex
import sys
from pathlib import Path

import pytest

from lithobrake.campaign import Command
from lithobrake.campaign.capped_log import KEPT, CappedLog, last_words
from lithobrake.campaign.single_run import run_model


@pytest.mark.parametrize("piece", [1000, 65_536, 5_000_000])
def test_the_first_and_the_last_megabyte_are_kept_and_the_rest_is_counted(piece: int, tmp_path: Path) -> None:
    total = b"".join(b"line %8d\n" % number for number in range(700_000))
    with CappedLog(tmp_path / "log.txt") as log:
        for start in range(0, len(total), piece):
            log.write(total[start : start + piece])
    kept = (tmp_path / "log.txt").read_bytes()
    assert len(kept) <= 3 * KEPT
    notice = re.search(rb"\n\.\.\. (\d+) bytes are left out here \.\.\.\n", kept)
    first, last = kept[: notice.start()], kept[notice.end() :]
    assert len(first) == KEPT
    assert len(last) >= KEPT
    assert total.startswith(first)
    assert total.endswith(last)
    assert len(first) + int(notice[1]) + len(last) == len(total)


def test_a_short_log_is_kept_whole(tmp_path: Path) -> None:
    with CappedLog(tmp_path / "log.txt") as log:
        log.write(b"no licence\n\n")
        # A process that is ended here leaves all that it has written.
        assert (tmp_path / "log.txt").read_bytes() == b"no licence\n\n"
    assert last_words(tmp_path / "log.txt") == "no licence"


PRINTS_MUCH = "import sys; [print('overlap', 'x' * 10000) for _ in range(2000)]; print('it diverged'); sys.exit(3)"
LEAVES_SOMETHING = """
import json, subprocess, sys
subprocess.Popen([sys.executable, "-c", "import time; time.sleep(20)"])
print("all is well")
json.dump({"height": 1.0}, open("outputs.json", "w"))
"""


def test_a_program_that_prints_without_end_fills_no_disk_and_its_last_words_are_the_reason(tmp_path: Path) -> None:
    model = Command(shlex.join([sys.executable, "-c", PRINTS_MUCH]), tmp_path / "solver")
    result = run_model(model, {"a": 1.0}, 1)
    assert "exit code 3" in result["reason"]
    assert result["reason"].endswith("it diverged")
    (log,) = (tmp_path / "solver").glob("*/log.txt")
    assert log.stat().st_size <= 3 * KEPT


def test_nobody_waits_for_what_a_program_leaves_running(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(LEAVES_SOMETHING)
    model = Command(shlex.join([sys.executable, str(tmp_path / "program.py")]), tmp_path / "solver")
    result = run_model(model, {"a": 1.0}, 1)
    assert result["outputs"] == {"height": 1.0}
    assert result["wall_s"] < 20
    (log,) = (tmp_path / "solver").glob("*/log.txt")
    assert log.read_text() == "all is well\n"


def prints_much(inputs: dict[str, float], seed: int) -> dict[str, float]:
    """A model that does not stop talking."""
    for _ in range(500):
        print("overlap", "x" * 10_000)
    return {"height": 1.0}


def test_the_log_of_a_model_is_capped_too(tmp_path: Path) -> None:
    result = run_model(prints_much, {"a": 1.0}, 1, tmp_path / "logs" / "run.log")
    assert result["outputs"] == {"height": 1.0}
    text = (tmp_path / "logs" / "run.log").read_text()
    assert len(text) <= 3 * KEPT
    assert text.startswith('{"inputs": {"a": 1.0}, "seed": 1}\noverlap xxx')
    assert '"status": "done"' in text.splitlines()[-1]
