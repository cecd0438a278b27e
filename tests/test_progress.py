"""What is shown while a study runs."""

import io

from rich.console import Console

from lithobrake.progress import StudyProgress


def shown_by(lines: StudyProgress, terminal: bool) -> str:
    text = io.StringIO()
    lines._progress.live.console = Console(file=text, force_terminal=terminal, width=100)
    with lines:
        lines.begin("screening", 3, 9)
        lines.say("screening: 20 of 61 runs were known and are reused")
        lines.progress(23, 61, "screening runs", "61 runs: 22 done, 2 running, 1 failed\nspeed_out  0.2 +- 0.01")
        lines._progress.refresh()
    return text.getvalue()


def test_a_terminal_shows_the_bars_and_more_below_them() -> None:
    shown = shown_by(StudyProgress(), terminal=True)
    assert "23/61" in shown
    assert "61 runs: 22 done, 2 running, 1 failed" in shown
    assert "speed_out  0.2 +- 0.01" in shown
    assert "20 of 61 runs were known and are reused" in shown


def test_a_log_file_has_stages_and_sentences() -> None:
    shown = shown_by(StudyProgress(), terminal=False)
    assert "stage 3 of 9: screening" in shown
    assert "20 of 61 runs were known and are reused" in shown
