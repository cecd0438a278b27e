"""What a terminal gets, with colours and without, and that what is no terminal gets plain text."""

import os
import re
import subprocess
import sys

import pytest

pty = pytest.importorskip("pty")
# Foreground or background, of the first sixteen, of 256, or any.
COLOUR = re.compile(rb"\x1b\[(?:\d+;)*(?:3[0-8]|4[0-8]|9[0-7]|10[0-7])(?:;\d+)*m")
PROGRESS = """
from lithobrake.progress import study_progress
with study_progress() as shown:
    shown.begin("landing", 1, 1)
    shown.progress(1, 2, "touchdowns", "all is well")
"""
HELP = "from lithobrake.cli import app; app(['run', '--help'])"
REFUSED = "from lithobrake.cli import app; app(['run'])"


def on_a_terminal(code: str, **variables: str) -> bytes:
    """What a program writes on a terminal, error output included."""
    ours, theirs = pty.openpty()
    unset = ("NO_COLOR", "FORCE_COLOR", "COLORTERM")
    kept = {name: value for name, value in os.environ.items() if name not in unset}
    with os.fdopen(ours, "rb", buffering=0) as screen:
        process = subprocess.Popen(
            [sys.executable, "-c", code], stdin=theirs, stdout=theirs, stderr=theirs,
            env={**kept, "TERM": "xterm-256color", "COLUMNS": "100", **variables},
        )  # fmt: skip
        os.close(theirs)
        seen = b""
        while True:
            try:
                part = screen.read(4096)
            # Linux says so that nobody writes any more.
            except OSError:
                break
            if not part:
                break
            seen += part
        process.wait()
    return seen


@pytest.mark.parametrize("code", [PROGRESS, HELP, REFUSED], ids=["progress", "help", "refused"])
def test_no_color_takes_all_colours_away(code: str) -> None:
    assert COLOUR.search(on_a_terminal(code))
    without = on_a_terminal(code, NO_COLOR="1")
    assert len(without) > 100
    assert not COLOUR.search(without)


@pytest.mark.parametrize("code", [PROGRESS, HELP, REFUSED], ids=["progress", "help", "refused"])
def test_what_is_no_terminal_gets_no_escape_sequence(code: str) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "FORCE_COLOR"}
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False, env=environment)
    assert shown.stdout + shown.stderr
    assert b"\x1b" not in shown.stdout + shown.stderr


@pytest.mark.parametrize(
    "code",
    [
        "from lithobrake.cli.arguments import tell; tell(['  a study of ' + 'words ' * 30])",
        "from lithobrake.cli import app; app(['status', 'a study of ' + 'words ' * 30])",
    ],
)
def test_a_terminal_gets_whole_words(code: str) -> None:
    lines = on_a_terminal(code, COLUMNS="43").decode().splitlines()
    assert max(map(len, lines)) <= 43
    assert {word for line in lines for word in line.split()} >= {"a", "study", "of", "words"}
    assert " ".join(lines).split().count("words") == 30
