"""What is shown while a study runs, on a terminal and in a log file."""

import io
import re
import time

from rich.console import Console

from lithobrake.progress import ProgressBars, ProgressLog

DETAIL = "61 runs: 22 done, 2 running, 1 failed, 2.1 runs/s, 19 s left\nspeed_out  0.2 +- 0.01"
# Words of somebody's program: rich would take the first for a closing tag, a terminal would obey the others.
ODD = "its last words: [/red] [2024-01-01] \x1b[2J\x1b]0;title\x07\x1b[31mred\r\x9b5m"


def shown_on_a_terminal(
    sentence: str = "screening: 20 of 61 runs were known and are reused", detail: str = DETAIL
) -> str:
    text = io.StringIO()
    lines = ProgressBars(Console(file=text, force_terminal=True, width=100))
    with lines:
        lines.begin("screening", 3, 9)
        lines.say(sentence)
        lines.progress(23, 61, "screening runs", detail)
        lines._progress.refresh()
    return text.getvalue()


def test_a_terminal_shows_the_bars_and_more_below_them() -> None:
    shown = shown_on_a_terminal()
    assert "23/61" in shown
    assert "61 runs: 22 done, 2 running, 1 failed" in shown
    assert "speed_out  0.2 +- 0.01" in shown
    assert "20 of 61 runs were known and are reused" in shown


def test_a_bar_swings_until_the_work_has_a_measure() -> None:
    lines = ProgressBars(Console(file=io.StringIO(), force_terminal=True, width=100))
    with lines:
        lines.begin("fit", 3, 9)
        for what in ("fit", "chances of the outcomes"):
            lines.progress(0, 1, what)
            stage, work = lines._progress.tasks
            assert (stage.completed, stage.total) == (2, 9)
            assert (work.description, work.total, work.fields["count"]) == (f"  {what}", None, "")
        lines.progress(0.25, 1, "chances of the outcomes")
        work = lines._progress.tasks[-1]
        assert (work.completed, work.total, work.fields["count"]) == (0.25, 1, "25 %")
        assert work.fields["tells_time_left"]
        lines.progress(0, 61, "runs")
        assert (lines._progress.tasks[-1].total, lines._progress.tasks[-1].fields["count"]) == (61, "0/61")


def test_words_of_a_program_are_shown_as_they_are_and_command_nothing() -> None:
    shown = shown_on_a_terminal(ODD, ODD)
    assert shown.count("its last words: [/red] [2024-01-01] red") == 2
    for command in ("\x1b[2J", "\x1b]0;", "\x1b[31m", "\x9b"):
        assert command not in shown
    file = io.StringIO()
    with ProgressLog(file) as lines:
        lines.say(ODD)
    assert "its last words: [/red] [2024-01-01] red" in file.getvalue()
    assert not set("\x1b\r\x9b\x07") & set(file.getvalue())


def logged(*works: tuple[float, float, str, str], until: str) -> str:
    """The log of a stage with these pieces of work, written until some words stand in it."""
    file = io.StringIO()
    with ProgressLog(file, first=0.02, every=0.02) as lines:
        lines.begin("screening", 3, 9)
        for work in works:
            lines.progress(*work)
            time.sleep(0.001)
        limit = time.monotonic() + 20.0
        while until not in file.getvalue() and time.monotonic() < limit:
            time.sleep(0.005)
        assert until in file.getvalue()
        lines.begin("refinement", 4, 9)
    return file.getvalue()


def test_a_log_file_has_stages_and_their_work_and_how_both_ended() -> None:
    shown = logged((23, 61, "screening runs", DETAIL), until="19 s left").splitlines()
    # One line, not all that a terminal has room for.
    line = "  screening runs: 61 runs: 22 done, 2 running, 1 failed, 2.1 runs/s, 19 s left"
    assert shown[:2] == ["stage 3 of 9: screening", line]
    assert shown[-3:] == [line, "  screening took 0 s", "stage 4 of 9: refinement"]


def test_a_log_file_tells_done_rate_and_time_left_of_work_that_gives_numbers_alone() -> None:
    shown = logged((100, 400, "flights", ""), (200, 400, "flights", ""), until="left")
    rate = r"[\d.e+]+/(s|min)"
    assert re.search(rf"^  flights: 200/400, \d+ s so far, {rate}, \d+ s left$", shown, re.MULTILINE)
    assert re.search(rf"^  flights: 200/400, {rate}, took \d+ s$", shown, re.MULTILINE)
    shown = logged((0.2, 1, "pouring", ""), (0.4, 1, "pouring", ""), until="left")
    assert re.search(r"^  pouring: 40 %, \d+ s so far, \d+ s left$", shown, re.MULTILINE)
    assert re.search(r"^  pouring: took \d+ s$", shown, re.MULTILINE)
    shown = logged((0.0, 1, "landing", ""), (0.001, 1, "landing", ""), until="so far")
    assert " left" not in shown


def test_a_log_file_shows_life_where_the_work_tells_nothing() -> None:
    shown = logged(until="so far").splitlines()
    assert shown[1] == "  screening: 0 s so far"
    assert "  screening took 0 s" in shown
