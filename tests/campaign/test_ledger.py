"""The ledger: its states, one writer, many readers, other formats, a disk that is full; and its table of runs."""

import csv
import io
import resource
import sqlite3
import subprocess
import sys
from functools import partial
from pathlib import Path

import campaign_models as models
import numpy as np
import pytest

from lithobrake.campaign import (
    Ledger,
    LocalExecutor,
    Record,
    RunStatus,
    Tally,
    campaign_began,
    ledger_tally,
    read_records,
    run,
    run_lines,
    write_csv,
)
from lithobrake.campaign.record import lock_path
from lithobrake.files.atomic import lock_holder

from ..ledger_rows import edit_rows

X = np.array([[1.0, 0.5], [2.0, 0.5], [3.0, 0.5]])


def fill(path: Path, model: object = models.captured_below_two) -> None:
    with Ledger(path) as ledger, LocalExecutor(1) as executor:
        run(model, X, names=("a", "b"), ledger=ledger, executor=executor, context={"version": "7"})  # type: ignore[arg-type]


def test_a_row_has_all_that_is_known_of_a_run(tmp_path: Path) -> None:
    fill(tmp_path / "runs.sqlite", models.breaks_at_two)
    entries = {entry.inputs["a"]: entry for entry in read_records(tmp_path / "runs.sqlite")}
    one, two = entries[1.0], entries[2.0]
    assert (one.status, one.outcome, one.outputs, one.version, one.attempts) == (
        "done", "clear", {"height": 1.5}, "7", 1,
    )  # fmt: skip
    assert (two.status, two.outcome, two.reason) == ("failed", None,
        "FloatingPointError: the overlap grew without bound")  # fmt: skip
    assert one.wall_s is not None
    assert one.cpu_s is not None
    assert one.host
    assert one.draws["seed"] == one.seed
    assert str(one.started) <= str(one.ended)


def test_a_run_is_queued_then_running_then_done_as_another_process_sees_it(tmp_path: Path) -> None:
    seen: set[tuple[str, ...]] = set()
    path = tmp_path / "runs.sqlite"

    def look(state: Tally) -> None:
        seen.add(tuple(sorted(entry.status for entry in read_records(path))))

    with Ledger(path) as ledger, LocalExecutor(1) as executor:
        run(models.sleeps_a_little, X, names=("a", "b"), ledger=ledger, executor=executor, progress=look)
    assert ("queued", "queued", "queued") in seen
    assert ("done", "done", "done") in seen
    assert any("running" in statuses for statuses in seen)


def test_a_second_coordinator_is_refused_with_who_is_at_work(tmp_path: Path) -> None:
    path = tmp_path / "runs.sqlite"
    code = f"from lithobrake.campaign import Ledger; Ledger({str(path)!r})"
    with Ledger(path):
        second = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        holder = lock_holder(lock_path(path))
    assert f"another campaign is at work on {path} (process {holder['process']} on {holder['host']})" in second.stderr
    assert lock_holder(lock_path(path)) is None
    Ledger(path).close()


def test_what_was_queued_and_never_ended_is_forgotten_by_the_next_campaign(tmp_path: Path) -> None:
    path = tmp_path / "runs.sqlite"
    with Ledger(path) as ledger:
        ledger.queue([("left over", {"a": 9.0}, 1, 0)], "7")
    fill(path)
    assert {entry.inputs["a"] for entry in read_records(path)} == {1.0, 2.0, 3.0}


@pytest.mark.parametrize("change", [
    "outputs = json_set(outputs, '$.height', 9.0)", "inputs = json_set(inputs, '$.a', 9.0)", "outcome = 'captured'",
    "status = 'failed'", "status = 'lost'", "seed = seed + 1", "outputs = '{'", "outputs = x'00'", "sha256 = NULL",
    "wall_s = 9.0",
])  # fmt: skip
def test_an_edited_row_is_named_and_made_again(tmp_path: Path, caplog: pytest.LogCaptureFixture, change: str) -> None:
    path = tmp_path / "runs.sqlite"
    fill(path, models.parabola)
    before = {entry.key: entry for entry in read_records(path)}
    (key,) = [entry.key for entry in before.values() if entry.inputs["a"] == 2.0]
    with sqlite3.connect(path) as database:
        database.execute(f"UPDATE runs SET {change} WHERE key = ?", [key])
    database.close()
    assert [entry.inputs["a"] for entry in read_records(path)] == [1.0, 3.0]
    words = f"{path} has 1 row edited after the run was made (key {key[:12]}), left out here and made again"
    assert caplog.messages[0].startswith(words)
    with Ledger(path) as ledger, LocalExecutor(1) as executor:
        runs = run(models.parabola, X, names=("a", "b"), ledger=ledger, executor=executor, context={"version": "7"})
    assert runs.reused_count == 2
    after = {entry.key: entry for entry in read_records(path)}
    assert {one.key: (one.inputs, one.outputs, one.seed, one.outcome) for one in after.values()} == {
        one.key: (one.inputs, one.outputs, one.seed, one.outcome) for one in before.values()
    }


@pytest.mark.parametrize("version", [-1, 2, 4])
def test_a_ledger_of_another_format_is_neither_read_nor_written(tmp_path: Path, version: int) -> None:
    path = tmp_path / "runs.sqlite"
    fill(path)
    with sqlite3.connect(path) as database:
        database.execute(f"PRAGMA user_version = {version}")
    database.close()
    for look in (read_records, Ledger):
        with pytest.raises(ValueError, match=f"has ledger format {version}; this version reads 3: move the file"):
            look(path)


def test_a_row_has_one_of_four_statuses(tmp_path: Path) -> None:
    path = tmp_path / "runs.sqlite"
    fill(path)
    assert all(entry.status is RunStatus.DONE for entry in read_records(path))
    edit_rows(path, "status = 'lost' WHERE json_extract(inputs, '$.a') = 2.0")
    with pytest.raises(ValueError, match=r"status is 'lost'; allowed: queued, running, done, failed"):
        read_records(path)


def test_the_words_of_a_model_enter_as_plain_text_on_one_line(tmp_path: Path) -> None:
    path, red = tmp_path / "runs.sqlite", "\x1b[31m[/red]\x1b]0;title\x07 no\n licence\x00 \udce4\u202e"
    with Ledger(path) as ledger:
        ledger.queue([("first", {"a": 1.0}, 1, 0), ("second", {"a": 2.0}, 1, 0)], "7")
        ledger.finish("first", {"status": "failed", "reason": red})
        ledger.finish("second", {"status": "done", "outcome": red + "x" * 2000})
    first, second = read_records(path)
    assert (first.outcome, first.reason) == (None, "[/red] no licence")
    assert second.outcome == f"[/red] no licence {'x' * 79}..."


def test_runs_as_csv(tmp_path: Path) -> None:
    fill(tmp_path / "runs.sqlite")
    text = io.StringIO()
    write_csv(read_records(tmp_path / "runs.sqlite"), text)
    lines = text.getvalue().splitlines()
    titles = lines[0].split(",")
    assert titles[-5:] == ["input:a", "input:b", "output:depth", "output:height", "draw:seed"]
    rows = sorted((dict(zip(titles, line.split(","), strict=True)) for line in lines[1:]), key=lambda a: a["input:a"])
    assert [(row["input:a"], row["outcome"], row["output:height"], row["output:depth"]) for row in rows] == [
        ("1.0", "captured", "", "0.1"), ("2.0", "clear", "4.5", ""), ("3.0", "clear", "9.5", "")
    ]  # fmt: skip


def test_a_folder_without_a_ledger_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"runs\.sqlite is not there"):
        read_records(tmp_path / "runs.sqlite")


def test_what_a_tally_tells(tmp_path: Path) -> None:
    fill(tmp_path / "runs.sqlite", models.breaks_at_two)
    state = ledger_tally(read_records(tmp_path / "runs.sqlite"), began="2000-01-01T00:00:00+00:00")
    assert (state.total, state.done, state.failed, state.running, state.reused) == (3, 2, 1, 0, 0)
    assert state.spreads["height"].mean == 5.5
    assert (state.spreads["height"].std, state.time_left) == (pytest.approx(np.std([1.5, 9.5], ddof=1)), 0.0)
    assert state.sentence().startswith("3 runs: 2 done, 0 running, 1 failed, ")


def test_runs_that_were_under_way_when_their_coordinator_died_count_as_running_no_more(tmp_path: Path) -> None:
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        ledger.queue([("first", {"a": 1.0}, 1, 0), ("second", {"a": 2.0}, 1, 0)], "7")
        ledger.start(["first"])
        assert ledger_tally(read_records(ledger.path), campaign_began(ledger.path)).running == 1
    assert campaign_began(ledger.path) is None
    assert ledger_tally(read_records(ledger.path), None).running == 0


def test_a_ledger_that_another_program_holds_is_one_sentence_and_goes_on_when_it_is_free(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "runs.sqlite"
    # SQLite waits five seconds for a file that is held, unless it is told another time.
    monkeypatch.setattr(sqlite3, "connect", partial(sqlite3.connect, timeout=0.2))
    said = r"runs\.sqlite cannot be written \(database is locked\).*end what holds the file"
    with Ledger(path) as ledger, LocalExecutor(1) as executor:
        shell = sqlite3.connect(path, isolation_level=None)

        def hold(state: Tally) -> None:
            if state.done == 1 and not shell.in_transaction:
                shell.execute("BEGIN IMMEDIATE")

        with pytest.raises(OSError, match=said):
            run(models.sleeps_a_little, X, names=("a", "b"), ledger=ledger, executor=executor, progress=hold)
        shell.close()
        runs = run(models.sleeps_a_little, X, names=("a", "b"), ledger=ledger, executor=executor)
    assert runs.reused_count >= 1
    assert runs.outcomes == ["clear"] * 3


FULL_DISK = """
import resource, sys
import numpy as np
import campaign_models as models
from lithobrake.campaign import Ledger, run

class Here:
    def submit(self, function, *args):
        from concurrent.futures import Future
        future = Future()
        future.set_result(function(*args))
        return future

# As with a full disk, the log cannot grow any more at some run.
def fill(state):
    if state.done >= 5:
        resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))

x = np.column_stack([np.arange(400.0), np.ones(400)])
with Ledger(sys.argv[1]) as ledger:
    run(models.parabola, x, names=("a", "b"), ledger=ledger, executor=Here(), progress=fill)
"""


@pytest.mark.skipif(not hasattr(resource, "RLIMIT_FSIZE"), reason="this system does not limit the size of files")
def test_a_disk_that_is_full_is_one_sentence_and_spoils_nothing(tmp_path: Path) -> None:
    path = tmp_path / "runs.sqlite"
    folder = str(Path(models.__file__).parent)
    code = f"import sys; sys.path.insert(0, {folder!r})\n{FULL_DISK}"
    full = subprocess.run([sys.executable, "-c", code, path, "200000"], capture_output=True, text=True, check=False)
    assert full.returncode == 1
    assert "OSError: " in full.stderr
    assert "runs.sqlite cannot be written (" in full.stderr
    assert "every run that had ended before is kept" in full.stderr
    with sqlite3.connect(path) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    database.close()
    kept = sum(entry.status == "done" for entry in read_records(path))
    assert 5 <= kept < 400
    x = np.column_stack([np.arange(400.0), np.ones(400)])
    with Ledger(path) as ledger, LocalExecutor(1) as executor:
        runs = run(models.parabola, x, names=("a", "b"), ledger=ledger, executor=executor)
    assert runs.reused_count == kept
    assert runs.outputs(["height"])[:, 0].tolist() == (x[:, 0] ** 2 + 1).tolist()


UNITS = {"grain.young_modulus": "Pa", "grain.friction": "-", "height": "m"}
REASON = "RuntimeError: the program ended with exit code 3; its last words: the overlap grew without bound"


@pytest.fixture
def records(tmp_path: Path) -> list[Record]:
    """Two runs that differ in two of three inputs, the second failed."""
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        for key, young, friction in (("first", 1e6, 0.5), ("second", 3.16228e7, 0.25)):
            inputs = {"grain.young_modulus": young, "grain.density": 2500.0, "grain.friction": friction}
            ledger.queue([(key, inputs, 1, 0)], "7")
            failed = {"status": "failed", "reason": REASON, "wall_s": 12.0}
            done = {"status": "done", "outcome": "clear", "outputs": {"height": 0.1}, "wall_s": 0.04321}
            ledger.finish(key, done if key == "first" else failed)
    return read_records(tmp_path / "runs.sqlite")


def test_runs_are_told_with_the_inputs_that_differ_and_their_units(records: list[Record]) -> None:
    assert run_lines(records, UNITS, None) == [
        "                                 grain     grain",
        "                   wall  young_modulus  friction",
        "key     status      [s]           [Pa]       [-]  outcome or reason",
        "first   done    0.04321          1e+06       0.5  clear",
        f"second  failed       12      3.162e+07      0.25  {REASON}",
    ]


def test_a_table_fits_its_terminal_and_names_what_it_leaves_out(records: list[Record]) -> None:
    wide = run_lines(records, UNITS, 90)
    assert max(map(len, wide)) == 90
    assert wide[-1].endswith("...")
    narrow = run_lines(records, UNITS, 66)
    assert "friction" not in "".join(narrow[:-1])
    assert "grain.friction" in narrow[-1]
    assert "--csv" in narrow[-1]
    heads = {"height": ("rebound", "height"), "grain.friction": ("", "friction"), "grain.density": ("", "the same")}
    shown = run_lines(records, UNITS, 72, heads)
    assert [line.split() for line in shown[:4]] == [
        ["rebound"], ["wall", "height", "friction"], ["key", "status", "[s]", "[m]", "[-]", "outcome", "or", "reason"],
        ["first", "done", "0.04321", "0.1", "0.5", "clear"],
    ]  # fmt: skip
    assert shown[-1].startswith("Differ too: grain.young_modulus")
    assert max(map(len, shown)) <= 72
    assert max(map(len, narrow)) <= 66
    none = run_lines(records, UNITS, 40)
    assert none[0].split() == ["wall"]
    assert " ".join(none[-2:]).startswith("Differ too: grain.young_modulus, grain.friction")
    assert max(map(len, none[-2:])) <= 40


def test_a_ledger_without_runs_is_a_head_alone() -> None:
    assert run_lines([], {}, 80) == ["             wall", "key  status   [s]  outcome or reason"]


def test_names_without_a_unit_stand_alone_in_csv(records: list[Record]) -> None:
    text = io.StringIO()
    write_csv(records, text, UNITS)
    titles = next(csv.reader(io.StringIO(text.getvalue())))
    assert titles[-4:] == ["input:grain.young_modulus [Pa]", "input:grain.density", "input:grain.friction [-]",
        "output:height [m]"]  # fmt: skip


def test_names_and_draws_of_a_program_enter_the_csv_as_plain_text(tmp_path: Path) -> None:
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        ledger.queue([("first", {"a": 1.0}, 1, 0)], "7")
        outputs, draws = {"\x1b[31mheight\ud800": 1.0}, {"licence": "\x1b]0;title\x07B"}
        ledger.finish("first", {"status": "done", "outcome": "clear", "outputs": outputs, "draws": draws})
    text = io.StringIO()
    write_csv(read_records(tmp_path / "runs.sqlite"), text)
    (row,) = csv.DictReader(io.StringIO(text.getvalue()))
    assert (row["output:height "], row["draw:licence"]) == ("1.0", "B")
    assert text.getvalue().isascii()
