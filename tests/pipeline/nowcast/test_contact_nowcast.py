"""A first contact in a study of journeys whose touchdowns follow a law that is known: friction lifts the rebound."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

from lithobrake.analysis import Estimate, Observation
from lithobrake.cli import app
from lithobrake.files.reading import hashed_seed, read_rows
from lithobrake.pipeline import InferredStudy, NowcastStudy, is_first_contact, nowcast_study
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.journeys.touchdown_emulator import TouchdownEmulator
from lithobrake.pipeline.nowcast import contact_nowcast
from lithobrake.pipeline.nowcast.contact_emulator import TITLE
from lithobrake.pipeline.nowcast.contact_landers import ContactLanders, sides_down, with_scatter
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.study_folder import FinishedFolder
from lithobrake.pipeline.study_run import run_study
from lithobrake.statements.nowcast import statement
from lithobrake.study import StudySource
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.quantities import UNKNOWN_END

from ..few_terms import few_terms
from ..journeys.bouncing_lander import bounce, journey_tables
from .first_contacts import MOTION, MOTION_ERRORS, contacts

KNOWN = "impact.speed,impact.incidence_deg"
ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module", autouse=True)
def few_landers() -> Iterator[None]:
    """Few landers are drawn and followed; the emulator of a folder is read, and fitted anew, once for all contacts."""
    read, known = TouchdownEmulator.read, dict[Path, TouchdownEmulator]()

    def once(design: DrawnDesign, folder: FinishedFolder) -> TouchdownEmulator:
        if folder.path not in known:
            known[folder.path] = read(design, folder)
        return known[folder.path]

    with few_terms(), pytest.MonkeyPatch.context() as patch:
        for name, few in (("LANDERS", 250), ("COPIES", 40), ("FOLLOWED", 100)):
            patch.setattr(contact_nowcast, name, few)
        patch.setattr(TouchdownEmulator, "read", once)
        yield


@pytest.fixture
def no_letters(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures are drawn, and not saved, which takes longer: that of the fast rebound is."""
    monkeypatch.setattr(Figure, "savefig", lambda figure, path, **how: Path(path).write_bytes(b""))


@pytest.fixture(scope="module")
def folder(journeys_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("nowcast") / "study"
    shutil.copytree(journeys_folder, found)
    return found


def seen(folder: Path, text: str) -> Path:
    path = folder / "contact.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def fast(folder: Path) -> dict[str, object]:
    """A rebound that the law gives with a friction of 0.84 at least: 0.8 x 0.0598 x friction x at most 1 is 0.040."""
    return nowcast_study(folder, seen(folder, f"speed_out,error:speed_out,{KNOWN}\n0.040,0.0005,0.06,5\n"))


def test_a_fast_rebound_tells_a_high_friction(fast: dict, folder: Path) -> None:  # type: ignore[type-arg]
    friction = fast["inputs"]["grain.friction"]
    lower, middle, upper = friction["after"]
    assert fast["is_reliable"]
    assert middle > friction["before"][1] + 0.03
    assert lower < middle < upper <= 0.9
    assert friction["sd_ratio"] < 1.0
    # It has no part in the law.
    assert fast["inputs"]["grain.young_modulus"]["sd_ratio"] > 0.85
    assert json.loads((folder / "nowcast.json").read_text(encoding="utf-8")) == json.loads(json.dumps(fast))
    assert len(read_rows(folder / "nowcast.csv", ("sample", "refit", "end"), "")) == 100
    assert (folder / "nowcast.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.usefixtures("no_letters")
def test_a_faster_rebound_rests_farther_and_later(fast: dict, folder: Path, tmp_path: Path) -> None:  # type: ignore[type-arg]
    moves: list[tuple[float, str]] = []
    contact = seen(tmp_path, f"speed_out,error:speed_out,{KNOWN}\n0.022,0.0005,0.06,5\n")
    slow = nowcast_study(folder, contact, lambda *move: moves.append(move))
    assert [done for done, _ in moves] == sorted({done for done, _ in moves})
    assert [what for _, what in moves if "landers" in what] == [
        f"following landers from {when} the contact" for when in ("before", "after")
    ]
    for name in ("time_s", "from_contact_m"):
        assert slow["rest"][name]["after"][2] < fast["rest"][name]["after"][2]
        assert slow["rest"][name]["after"][1] < fast["rest"][name]["after"][1]
    lower, share, upper = fast["rest"]["at_rest"]["after"]
    assert 0.0 <= lower <= share <= upper <= 1.0


@pytest.mark.usefixtures("no_letters")
def test_a_captured_lander_rests_where_it_came_down(folder: Path, tmp_path: Path) -> None:
    content = nowcast_study(folder, seen(tmp_path, "outcome,contact_duration\ncaptured,0.3\n"))
    assert "Not used, as the emulator has no law of it for captured landers: contact_duration." in content["statement"]
    assert content["rest"]["at_rest"]["after"][1] == 1.0
    assert content["predictive_p_value"] is None
    # Each way is ten times the horizontal speed, of at most 0.08 m/s at 40 degrees.
    assert content["rest"]["from_contact_m"]["after"][1] < 0.6
    assert content["rest"]["time_s"]["after"][1] == pytest.approx(30.0)


def test_a_contact_outside_of_the_study_has_no_interval(folder: Path, tmp_path: Path) -> None:
    moves: list[str] = []
    content = nowcast_study(
        folder, seen(tmp_path, "speed_out,spin_out\n0.9,40\n"), lambda done, what: moves.append(what)
    )
    assert not content["is_reliable"]
    assert not [what for what in moves if "landers" in what]
    assert (content["rest"], content["inputs"], content["ground"]) == (None, {}, {})
    assert len(content["statement"]) == 1
    assert "lies outside what the study simulated, so nothing is said" in content["statement"][0]
    # Those of the contact before would stand for this one.
    assert not (folder / "nowcast.csv").exists()
    assert not (folder / "nowcast.png").exists()


@pytest.mark.parametrize(("text", "words"), [
    ("speed_out,impact.speed\n0.03,9\n", r"of 100 % of the landers impact\.speed lies outside what the study"),
    ("speed_out,impact.speed\n0.03,-0.05\n", r"has -0\.05 m/s for impact\.speed; allowed: 0 or more"),
    ("speed_out,impact.speed\n0.03,nan\n", r"has nan for impact\.speed; allowed: a finite number"),
    ("speed_out,impact.spin_x\n0.03,5000\n", r"gives a spin of 5000 rad/s; allowed: at most "),
    ("speed_out,bed\n0.03,a\n", "has the bed a; a nowcast is of one contact; leave the column out"),
    ("contact_duration\n20\n", "has contact_duration and no outcome; say in a column outcome"),
    ("speed_out,grain.friction\n0.03,0.5\n", r"gives grain\.friction of the contact; allowed: impact\.speed"),
    ("speed_out,impact.orientation.w\n0.03,1\n", "gives a part of the attitude; allowed: "),
    ("speed_out\n-0.03\n", r"contact\.csv has -0\.03 for speed_out; allowed: 0 or more"),
    ("azimuth_out\n0.1\n", "has azimuth_out; outputs that may be observed: speed_out"),
    ("outcome\ntime_limit\n", "has the outcome time_limit; allowed: clear, captured"),
])  # fmt: skip
def test_what_the_study_cannot_answer_is_refused(folder: Path, tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        nowcast_study(folder, seen(tmp_path, text))


def test_a_known_attitude_takes_the_place_of_the_draw(folder: Path) -> None:
    study = NowcastStudy.open(folder)
    names = [f"impact.orientation.{part}" for part in "wxyz"]
    known = dict(zip(names, (2.0, 0.0, 0.0, 0.0), strict=True))
    begin = contact_nowcast.with_known(study.arrivals(), known, "seen.csv")
    assert np.allclose([[row[name] for name in names] for row in begin.rows], [1.0, 0.0, 0.0, 0.0])
    # The frame of the bed is that of the touchdown, and spins are as large as before.
    drawn = study.arrivals()
    assert np.allclose(np.linalg.norm(begin.spin, axis=1), np.linalg.norm(drawn.spin, axis=1))
    assert np.allclose(begin.spin, drawn.spin)
    assert {row["impact.azimuth_deg"] for row in begin.rows} == {0.0}


def test_the_command_says_ground_and_place(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lithobrake.report.figures.nowcast_figure.write_nowcast_figure", lambda *given: None)
    found = CliRunner().invoke(app, ["infer", str(folder), "--bounce", str(seen(tmp_path, "speed_out\n0.03\n"))])
    assert found.exit_code == 0, found.output
    lines = " ".join(found.output.split())
    assert "simulated journeys on 12 beds" in lines
    assert re.search(r"The first contacts of \d+ of 250 drawn landers are like this one", lines)
    assert "Place of rest: " in lines
    assert "Nowcast: " in lines
    # Several bounces tell the soil alone, as in any study.
    assert not is_first_contact(folder, seen(tmp_path, "speed_out\n0.03\n0.04\n"))
    assert InferredStudy.open(folder).outputs == ["speed_out", "elevation_out", "spin_out"]


def test_a_study_without_emulated_journeys_to_rest_is_refused(tmp_path: Path) -> None:
    tables = journey_tables(journey={"count": 12, "emulated_count": 0})
    source = StudySource.of_tables(tables, function_identity(bounce))
    run_study(source, tmp_path / "study", until="runs", worker_count=1, model=bounce)
    with pytest.raises(ValueError, match=r"the study has journey\.emulated_count = 0; raise it"):
        NowcastStudy.open(tmp_path / "study")


def landers(ends: list[str], times: np.ndarray, refit: np.ndarray | None = None) -> ContactLanders:
    count = len(ends)
    refits = np.zeros(count, int) if refit is None else refit
    return ContactLanders(np.arange(count), refits, np.array(ends), {"time_s": times})


def test_landers_that_never_rest_have_no_numbers() -> None:
    nothing = landers(["escaped"] * 2, np.full(2, np.nan))
    assert nothing.quantiles("time_s") == [None, None, None]
    assert nothing.rows() == [[0, 0, "escaped", ""], [1, 0, "escaped", ""]]


def test_a_share_at_rest_is_that_of_known_ends_and_holds_for_all() -> None:
    """Of 20 landers 9 rest, 9 escape and 2 have no known end: a half of the known, 0.45 to 0.55 of all."""
    ends = (["at_rest"] * 9 + ["escaped"] * 9 + [UNKNOWN_END] * 2) * REFIT_COUNT
    refit = np.arange(len(ends)) // 20
    found = landers(ends, np.zeros(len(ends)), refit).at_rest(Refits(12, 48, None))
    assert found.value == 0.5
    lower, upper = found.lower, found.upper
    assert lower is not None
    assert upper is not None
    assert lower < 0.45 < 0.55 < upper


def test_times_are_told_of_nine_in_ten_known_ends_at_least() -> None:
    times = np.where(np.arange(100) < 80, 7.0, np.nan)
    ends = ["at_rest"] * 80 + ["escaped"] * 10
    assert landers([*ends, *[UNKNOWN_END] * 10], times).quantiles("time_s") == [7.0, 7.0, 7.0]
    too_many = landers([*ends[:89], *[UNKNOWN_END] * 11], times)
    assert too_many.quantiles("time_s") == [None, None, None]
    assert np.isnan(too_many.told["time_s"]).all()


def test_few_landers_widen_a_share() -> None:
    """A normal interval of a half of 100 is 1.645 x 0.05 wide to each side, beside 0.1 of beds, in quadrature."""
    found = with_scatter(Estimate(0.5, 0.4, 0.6), 100.0)
    assert (found.lower, found.upper) == pytest.approx((0.5 - 0.12948, 0.5 + 0.12948), abs=1e-4)
    assert with_scatter(Estimate(0.5, None, None), 100.0).lower is None


def test_observed_motion_takes_its_errors_in_one_order() -> None:
    found = contacts([""] * 4).answers(np.arange(4), MOTION, MOTION_ERRORS)
    random = np.random.default_rng(hashed_seed(3, TITLE, "errors"))
    speed, elevation, spin = (
        value + error * random.standard_normal(4) for value, error in ((0.3, 0.02), (0.7, 0.01), (2.0, 0.1))
    )
    assert np.allclose(found.velocity[:, 2], speed * np.sin(elevation))
    assert np.allclose(found.spin[:, 1], spin)


def test_the_order_is_that_of_every_process() -> None:
    """The order of a set of words changes with the seed of their hashes: by 2 these three stand the other way round."""
    code = (
        f"from {contacts.__module__} import MOTION, MOTION_ERRORS, contacts\n"
        "import numpy as np\n"
        "print(contacts([''] * 4).answers(np.arange(4), MOTION, MOTION_ERRORS).velocity.tolist())"
    )
    said = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONHASHSEED": "2", "PYTHONPATH": str(ROOT)},
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    assert json.loads(said) == contacts([""] * 4).answers(np.arange(4), MOTION, MOTION_ERRORS).velocity.tolist()


def test_landers_beyond_the_ranges_are_said_and_more_than_a_tenth_refused() -> None:
    contacts([*[""] * 90, *["impact.speed"] * 10]).refuse_beyond("seen.csv")
    with pytest.raises(
        ValueError, match=r"of 11 % of the landers impact\.speed lies outside .* allowed: 0\.01 to 0\.1"
    ):
        contacts([*[""] * 89, *["impact.speed"] * 11]).refuse_beyond("seen.csv")


def test_sides_are_of_contacts_alike_in_all_that_was_observed(folder: Path) -> None:
    """No run has the change of velocity; without it all that left are alike."""
    study = NowcastStudy.open(folder)
    table = replace(study.journeys, face=np.where(np.arange(len(study.journeys.end)) % 2 == 0, "+z", "-z"))
    whole = sides_down(study.folder, table, Observation({}, outcome="clear"))
    assert set(whole) == {"+z", "-z"}
    assert sides_down(study.folder, table, Observation({"speed_change": 0.05}, outcome="clear")) == {}
    # What lies outside of all journeys is like none of them.
    assert sides_down(study.folder, table, Observation({"speed_out": 9.0}, outcome="clear")) == {}


def test_a_sequential_study_has_the_runs_that_it_grew_to(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact_nowcast, "grown", lambda design, path: design.with_run_count(60))
    assert len(NowcastStudy.open(folder).design.rows) == 60


FOUND: dict[str, Any] = {
    "is_reliable": True, "effective_count": 1366.4, "fewest": 100.0, "landers": 2000, "journeys": 96, "beds": 24,
    "predictive_p_value": 0.4, "beyond": 0.031, "beyond_input": "impact.speed", "not_used": [], "ground": {},
    "inputs": {}, "level": 0.9,
    "rest": {"at_rest": {"before": 0.9, "after": [0.5, 0.8, 0.95]}, "unknown": 0.2, "sides": {}} | {
        name: {"before": [None] * 3, "after": [None] * 3} for name in ("time_s", "distance_m", "from_contact_m")},
}  # fmt: skip


def test_landers_are_counted_and_what_is_left_out_is_said() -> None:
    said = statement(FOUND)
    assert said[0].startswith("The first contacts of 1366 of 2000 drawn landers are like this one; they stand on 96")
    assert said[1].startswith("Left out are 3.1 % of the drawn landers, ")
    assert said[-1] == "These are more than 10 %, so no time and place of rest are given."


def test_a_refusal_stands_alone() -> None:
    (said,) = statement(FOUND | {"is_reliable": False, "effective_count": 46.0, "rest": None})
    assert said.startswith(
        "The first contacts of 46 of 2000 drawn landers are like this one, fewer than 100, so nothing"
    )
