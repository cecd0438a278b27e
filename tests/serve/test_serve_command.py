"""The command that serves a study: it says where, answers, and ends with Ctrl-C."""

import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lithobrake.cli import app

BALL = Path(__file__).parents[2] / "examples" / "ball_on_plate.toml"


def test_a_server_says_where_it_is_and_ends_with_an_interrupt(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "lithobrake", "serve", str(BALL), "--out", str(tmp_path / "out"), "--port", "0"]
    # Where the tests run in the background they ignore interrupts, and so would what they start.
    with subprocess.Popen(
        words,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as server:
        said = server.stdout.readline()
        found = re.fullmatch(r"Serving flight, landing at (http://127\.0\.0\.1:\d+); Ctrl-C ends it\.\n", said)
        with urllib.request.urlopen(f"{found[1]}/Info") as response:
            assert response.read() == b'{"protocolVersion": 1.0, "models": ["flight", "landing"]}'
        server.send_signal(signal.SIGINT)
        assert server.wait(timeout=30) == 0
    assert not (tmp_path / "out").exists()


def test_an_address_that_is_not_to_be_had_is_told(tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["serve", str(BALL), "--out", str(tmp_path / "out"), "--host", "203.0.113.1"])
    assert found.exit_code == 2
    assert len(found.stderr.splitlines()) == 1


@pytest.mark.parametrize(("options", "said"), [
    (["--host", ""], "host is '' (an unset variable?) and would open the server to every network"),
    (["--host", " \t"], "host is ' \\t' (an unset variable?)"),
    (["--host", "a" * 70], "is no address of this machine"),
    (["--time-limit", "0"], "the time limit is 0 s; allowed: above 0"),
    (["--time-limit", "nan"], "--time-limit is nan; allowed: a finite number"),
])  # fmt: skip
def test_what_cannot_be_served_is_one_sentence(options: list[str], said: str, tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["serve", str(BALL), "--out", str(tmp_path / "out"), "--port", "0", *options])
    assert found.exit_code == 2
    assert said in found.stderr
    assert len(found.stderr.splitlines()) == 1
