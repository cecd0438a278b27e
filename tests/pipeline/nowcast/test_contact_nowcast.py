"""A first contact in a study of journeys whose touchdowns follow a law that is known: friction lifts the rebound."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.files.reading import read_rows
from lithobrake.pipeline import InferredStudy, NowcastStudy, is_first_contact, nowcast_study
from lithobrake.pipeline.nowcast import contact_nowcast
from lithobrake.pipeline.nowcast.contact_landers import ContactLanders

from ..few_terms import few_terms
from ..journeys.bouncing_lander import bounce, journey_tables, run_without_emulator

KNOWN = "impact.speed,impact.incidence_deg"


@pytest.fixture(scope="module", autouse=True)
def few_landers() -> Iterator[None]:
    with few_terms(), pytest.MonkeyPatch.context() as patch:
        for name, few in (("LANDERS", 250), ("COPIES", 40), ("FOLLOWED", 100)):
            patch.setattr(contact_nowcast, name, few)
        yield


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
    """A rebound that the law gives with a friction of 0.73 at least: 0.8 x 0.0598 x friction x at most 1 is 0.035."""
    return nowcast_study(folder, seen(folder, f"speed_out,error:speed_out,{KNOWN}\n0.035,0.0005,0.06,5\n"))


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


def test_a_faster_rebound_rests_farther_and_later(fast: dict, folder: Path, tmp_path: Path) -> None:  # type: ignore[type-arg]
    slow = nowcast_study(folder, seen(tmp_path, f"speed_out,error:speed_out,{KNOWN}\n0.022,0.0005,0.06,5\n"))
    for name in ("time_s", "from_contact_m"):
        assert slow["rest"][name]["after"][2] < fast["rest"][name]["after"][2]
        assert slow["rest"][name]["after"][1] < fast["rest"][name]["after"][1]
    lower, share, upper = fast["rest"]["at_rest"]["after"]
    assert 0.0 <= lower <= share <= upper <= 1.0


def test_a_captured_lander_rests_where_it_came_down(folder: Path, tmp_path: Path) -> None:
    content = nowcast_study(folder, seen(tmp_path, "outcome\ncaptured\n"))
    assert content["rest"]["at_rest"]["after"][1] == 1.0
    assert content["predictive_p_value"] is None
    # Each way is ten times the horizontal speed, of at most 0.08 m/s at 40 degrees.
    assert content["rest"]["from_contact_m"]["after"][1] < 0.6
    assert content["rest"]["time_s"]["after"][1] == pytest.approx(30.0)


def test_a_contact_outside_of_the_study_has_no_interval(folder: Path, tmp_path: Path) -> None:
    content = nowcast_study(folder, seen(tmp_path, "speed_out,spin_out\n0.9,40\n"))
    assert not content["is_reliable"]
    assert content["rest"]["at_rest"]["after"][0] is None
    assert content["inputs"]["grain.friction"]["after"][2] is None
    assert any("lies outside what the study simulated" in one for one in content["statement"])


@pytest.mark.parametrize(("text", "words"), [
    ("speed_out,impact.speed\n0.03,9\n", r"impact\.speed lies outside what the study simulated; allowed: 0\."),
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
    assert "Place of rest: " in lines
    assert "Nowcast: " in lines
    # Several bounces tell the soil alone, as in any study.
    assert not is_first_contact(folder, seen(tmp_path, "speed_out\n0.03\n0.04\n"))
    assert InferredStudy.open(folder).outputs == ["speed_out", "elevation_out", "spin_out"]


def test_a_study_without_emulated_journeys_to_rest_is_refused(tmp_path: Path) -> None:
    tables = journey_tables(journey={"count": 12, "emulated_count": 0})
    found = run_without_emulator(tables, tmp_path / "study", bounce)
    with pytest.raises(ValueError, match=r"the study has journey\.emulated_count = 0; raise it"):
        NowcastStudy.open(found.folder)


def test_landers_that_never_rest_have_no_numbers() -> None:
    nothing = ContactLanders(
        np.zeros(2, int), np.zeros(2, int), np.array(["escaped"] * 2), {"time_s": np.full(2, np.nan)}
    )
    assert nothing.quantiles("time_s") == [None, None, None]
    assert nothing.rows() == [[0, 0, "escaped", ""], [1, 0, "escaped", ""]]
