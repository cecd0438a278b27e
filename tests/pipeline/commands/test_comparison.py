"""Two studies side by side, and estimates while a study runs."""

import json
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import lithobrake
from lithobrake.analysis import mean_estimate, share_estimate
from lithobrake.campaign import Ledger, Record, RunStatus
from lithobrake.cli import app
from lithobrake.pipeline import InferredStudy, StudyFolder, compare_studies, study_status
from lithobrake.pipeline.commands.comparison import OneStudy, _other_beds
from lithobrake.pipeline.commands.running_estimates import running_estimates
from lithobrake.results.questions import StudyComparison
from lithobrake.results.study_files import results_in
from lithobrake.results.table import Table
from lithobrake.statements.comparison import sentence
from lithobrake.vocabulary.quantities import BEDS

from ..coarse_bodies import coarse_bodies
from ..journeys.bouncing_lander import journey_tables, run_without_emulator
from ..journeys.test_delivered_journeys import tables, write_states

SPEEDS = np.random.default_rng(1).uniform(0.05, 0.1, 60)
OUTCOMES = ["captured" if run % 5 == 0 else "clear" for run in range(60)]


def record(run: int, bed_count: int = 6, outcome: str | None = None) -> Record:
    """A run that has ended, each on the next bed."""
    how = outcome or OUTCOMES[run]
    outputs = {"speed_out": float(SPEEDS[run])} if how == "clear" else {}
    inputs = {"bed": float(run % bed_count)}
    return Record(
        f"run {run:02d}", RunStatus.DONE, how, inputs, outputs, {}, run, 0, 1, None, 1.0, 1.0, None, "", None, None
    )


def test_estimates_are_those_of_the_runs_with_beds_as_units() -> None:
    found = running_estimates([record(run) for run in range(60)], {})
    bed, captured = np.arange(60) % 6, np.array([how == "captured" for how in OUTCOMES])
    assert found.captured == share_estimate(captured.astype(float), bed)
    assert found.speed_out == mean_estimate(np.where(captured, np.nan, SPEEDS), bed)
    first, share, speed, last = found.lines()
    assert first == "so far, from 60 landings on 6 beds:"
    assert share.startswith("  captured: 20 % (90 % interval ")
    assert speed.startswith(f"  mean rebound speed: {100 * SPEEDS[~captured].mean():.3g} cm/s (90 % interval ")
    assert "The return fraction is not known yet" in last
    content = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert content["captured"]["from"] == "60 landings on 6 beds"
    assert (content["returns"], content["speed_out"]["level"]) == (None, 0.9)
    shares = np.where(captured, 1.0, 0.25)
    flown = running_estimates([record(run) for run in range(60)], {f"run {run:02d}": shares[run] for run in range(60)})
    assert flown.returns == share_estimate(shares, bed)
    assert flown.lines()[-1].startswith("  return fraction: 40 % (90 % interval ")


def test_the_order_in_which_runs_end_changes_no_digit() -> None:
    records, orders = [record(run) for run in range(40)], np.random.default_rng(2)
    found = {running_estimates([records[row] for row in orders.permutation(40)], {}) for _ in range(20)}
    assert found == {running_estimates(records, {})}


def test_runs_without_an_answer_widen_it_and_one_bed_has_no_interval() -> None:
    runs = [record(run) for run in range(59)] + [record(59, outcome="left_sideways")]
    found = running_estimates(runs, {})
    assert found.captured.if_missing == pytest.approx((12 / 60, 13 / 60))
    assert found.captured.share.lower < 12 / 60 < 13 / 60 < found.captured.share.upper
    assert "59 of 60 landings" in found.lines()[0]
    one_bed = running_estimates([record(run, bed_count=1) for run in range(60)], {})
    assert one_bed.speed_out is None
    assert "20 %, without an interval: all runs landed on one bed" in one_bed.lines()[1]


def test_too_few_runs_say_nothing() -> None:
    assert running_estimates([record(0)], {}) is None
    lost = running_estimates([record(run, outcome="time_limit") for run in range(3)], {})
    assert (lost.captured, lost.lines()) == (None, [])


@pytest.fixture
def under_way(tmp_path: Path) -> Path:
    """The folder of a sequence of 60 runs of which 40 have ended, with runs beside it and one of another setting."""
    folder, keys = StudyFolder(tmp_path), [record(run).key for run in range(60)]
    folder.begin(None, b"", {"bed": {"title": "bed", "key": "", "files": []}}, print)
    folder.note_runs("drawn", keys)
    folder.note_runs("twins", ["twin"])
    with Ledger(folder / "runs.sqlite") as ledger:
        asked = [record(run) for run in range(60)]
        entries = [(one.key, one.inputs, one.seed, 0) for one in asked]
        entries += [(name, {"bed": 0.0}, 0, 0) for name in ("twin", "other")]
        ledger.queue(entries, version="")
        for one in asked[:40]:
            ledger.finish(one.key, {"status": "done", "outcome": one.outcome, "outputs": one.outputs, "attempts": 1})
        for name in ("twin", "other"):
            ledger.finish(name, {"status": "done", "outcome": "captured", "outputs": {}, "attempts": 1})
    return tmp_path


def test_status_says_them_while_runs_come_in(under_way: Path) -> None:
    said = CliRunner().invoke(app, ["status", str(under_way)])
    assert said.exit_code == 0, said.output
    assert "\n".join(running_estimates([record(run) for run in range(40)], {}).lines()) in said.stdout
    assert "61 runs: 41 done, 0 running, 0 failed" in said.stdout
    assert "1 more runs in the ledger are of earlier settings of the study" in said.stdout
    assert said.stdout.splitlines() == study_status(under_way).lines()


def test_status_gives_all_of_it_as_json(under_way: Path) -> None:
    content = json.loads(CliRunner().invoke(app, ["status", str(under_way), "--json"]).stdout)
    assert content["folder"] == str(under_way)
    assert (content["at_work"], content["campaign_began"], content["unknown"]) == (None, None, None)
    runs = content["runs"]
    assert [runs[name] for name in ("total", "done", "running", "failed", "of_earlier_settings")] == [61, 41, 0, 0, 1]
    assert (runs["rate"], runs["seconds_left"]) == (None, None)
    assert (runs["outcomes"], runs["spreads"]["speed_out"]["count"]) == ({"captured": 9, "clear": 32}, 32)
    expected = running_estimates([record(run) for run in range(40)], {})
    assert runs["estimates"] == json.loads(json.dumps(expected.to_json()))


def test_status_of_a_campaign_that_is_no_study_is_json_too(tmp_path: Path) -> None:
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        ledger.queue([("first", {"height": 1.0}, 0, 0)], version="")
    content = json.loads(CliRunner().invoke(app, ["status", str(tmp_path), "--json"]).stdout)
    assert (content["stages"], content["runs"]["total"], content["runs"]["estimates"]) == ([], 1, None)


PAIRS = 24
FASTER = {"speed": {"distribution": "uniform", "lower": 0.08, "upper": 0.16}}


def made(folder: Path, seed: int = 2, **changes: dict[str, object]) -> Path:
    run_without_emulator(journey_tables(**changes) | {"seed": seed}, folder)
    return folder


@pytest.fixture(scope="module", autouse=True)
def coarse() -> Iterator[None]:
    with coarse_bodies():
        yield


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Journeys of 30 landers, and of the first 24 of them at twice the speed."""
    place = tmp_path_factory.mktemp("comparison")
    slow = made(place / "slow", journey={"count": 30})
    return slow, made(place / "fast", delivery=FASTER, journey={"count": PAIRS})


def test_differences_are_those_of_the_pairs(pair: tuple[Path, Path]) -> None:
    found = compare_studies(*pair)
    slow, fast = (lithobrake.open_study(path).journeys for path in pair)
    rests = [table["end"][:PAIRS] == "at_rest" for table in (slow, fast)]
    failed = [table["end"][:PAIRS] == "failed" for table in (slow, fast)]
    answer = found.answers["at_rest"]
    assert (answer.pairs, answer.is_fraction) == ((~failed[0] & ~failed[1]).sum(), True)
    # A failed journey is none of those that do not rest.
    assert answer.missing == tuple(one.mean() for one in failed)
    means = [one[~out].mean() for one, out in zip(rests, failed, strict=True)]
    assert answer.difference.value == pytest.approx(means[1] - means[0])
    assert "have an unknown outcome, and bounds hold whatever became of them" in sentence(found, "at_rest")
    assert answer.difference.lower < answer.difference.value < answer.difference.upper
    time = found.answers["time_s_median"]
    medians = [np.median(table["time_s"][:PAIRS][rest]) for table, rest in zip((slow, fast), rests, strict=True)]
    assert time.difference.value == pytest.approx(medians[1] - medians[0])
    assert time.difference.lower > 0.0
    both = rests[0] & rests[1]
    times = [table["time_s"][:PAIRS][both] for table in (slow, fast)]
    ratio = found.answers["time_s_ratio"]
    assert (ratio.is_ratio, ratio.pairs, ratio.unit) == (True, both.sum(), "s")
    assert ratio.difference.value == pytest.approx(np.exp(np.log(times[1] / times[0]).mean()) - 1.0)
    assert f"{PAIRS} pairs on 12 beds" in found.of
    assert list(found.settings) == ["delivery.speed"]


def test_landers_that_miss_the_ground_keep_their_number(tmp_path: Path) -> None:
    """Two of the first study's landers fly away, and have journeys without a run: the pairs behind them stay pairs."""
    folders = []
    for name, away in (("some", (3, 9)), ("all", ())):
        states = tmp_path / f"{name}.csv"
        write_states(states, away)
        run_without_emulator(tables(delivery={"states": str(states)}), tmp_path / name)
        folders.append(tmp_path / name)
    found = compare_studies(*folders)
    ends = [lithobrake.open_study(folder).journeys["end"] for folder in folders]
    assert f"{len(ends[0])} pairs" in found.of
    answer, known = found.answers["at_rest"], [one != "failed" for one in ends]
    rests = [(one == "at_rest")[told].mean() for one, told in zip(ends, known, strict=True)]
    both = (known[0] & known[1]).sum()
    assert (answer.difference.value, answer.pairs) == (pytest.approx(rests[1] - rests[0]), both)
    assert both < len(ends[0])
    assert found.answers["captured"].pairs == len(ends[0]) - 2


def test_beds_that_differ_are_named(pair: tuple[Path, Path]) -> None:
    one, two = (replace(OneStudy.open(pair[0]), results=WithBeds(height)) for height in (0.3, 0.31))
    used = np.arange(3)
    assert _other_beds(one, one, used) is None
    assert "1 of 3 beds differ between the studies" in (_other_beds(one, two, used) or "")
    assert _other_beds(OneStudy.open(pair[0]), OneStudy.open(pair[1]), used) is None


class WithBeds:
    """Results with three beds, the last of this surface height [m]."""

    def __init__(self, height: float) -> None:
        numbers = {"solid_fraction": [0.6, 0.61, 0.62], "surface_height_m": [0.3, 0.3, height]}
        self.beds = Table.of("bed", {name: (BEDS[name], values) for name, values in numbers.items()})


def test_the_command_writes_a_page_and_its_numbers(pair: tuple[Path, Path], tmp_path: Path) -> None:
    out = tmp_path / "compared"
    said = CliRunner().invoke(app, ["compare", *map(str, pair), "--out", str(out)])
    assert said.exit_code == 0, said.output
    assert f"A: {pair[0]}" in said.stdout
    assert "Time to rest, median: A " in said.stdout
    # One lander of A has an unknown end.
    assert re.search(r"Time to rest, typical ratio: A .* s; B over A \+\d.* %: no interval .*their ratio", said.stdout)
    numbers = json.loads((out / "comparison.json").read_text())
    assert results_in(StudyComparison, numbers) == compare_studies(*pair)
    page = (out / "index.html").read_text()
    assert "Comparison of two studies" in page
    assert "delivery.speed" in page
    assert (out / "figure_1_differences.svg").is_file()
    again = CliRunner().invoke(app, ["compare", *map(str, pair), "--out", str(out)])
    assert again.exit_code == 2
    assert "--force" in again.output
    shown = CliRunner().invoke(app, ["compare", *map(str, pair), "--out", str(out), "--force", "--json"])
    assert json.loads(shown.stdout) == numbers


def test_a_table_that_was_edited_is_refused(pair: tuple[Path, Path], tmp_path: Path) -> None:
    edited = shutil.copytree(pair[0], tmp_path / "edited")
    path = edited / "journeys.csv"
    path.write_text(path.read_text().replace("at_rest", "escaped", 3))
    with pytest.raises(ValueError, match=r"edited/journeys\.csv changed after it was made"):
        compare_studies(pair[1], edited)


@pytest.mark.parametrize(("out", "said"), [
    ("", "omit --out to use comparison"),
    ("file/compared", r"cannot be written \(.*\); choose another folder with --out"),
])  # fmt: skip
def test_a_folder_that_cannot_be_made_is_one_sentence(
    out: str, said: str, pair: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("no folder")
    ended = CliRunner().invoke(app, ["compare", *map(str, pair), "--out", out])
    assert ended.exit_code == 2
    assert ended.stderr.count("\n") == 1
    assert re.search(said, ended.stderr)


def test_soil_is_inferred_with_an_emulator(pair: tuple[Path, Path], tmp_path: Path) -> None:
    folder = shutil.copytree(pair[0], tmp_path / "unfinished")
    (folder / "emulator.json").unlink()
    with pytest.raises(ValueError, match=r"has no emulator\.json; finish the study there with: lithobrake run"):
        InferredStudy.open(folder)


def test_studies_that_cannot_be_paired_are_refused(pair: tuple[Path, Path], tmp_path: Path) -> None:
    other = made(tmp_path / "other", seed=3, journey={"count": 14})
    with pytest.raises(
        ValueError, match=r"cannot be paired: run 12 has bed 1 in A and 3 in B .* give both the same seed"
    ):
        compare_studies(pair[0], other)
    with pytest.raises(ValueError, match="holds no results of a study"):
        compare_studies(pair[0], tmp_path)
