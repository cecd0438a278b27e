"""The explorer of journeys: one touchdown, with the refits that landers follow, on the page and in a browser."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.emulator import law_tables
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.emulated.touchdown_emulator import OF_TOUCHDOWN, TouchdownEmulator
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.runs.energy_bound import energy_bound
from lithobrake.report import write_report
from lithobrake.results import ExplorerTables, StudyResults
from lithobrake.study import check_tables

from ...report.browser import browser_page, needs_browser
from ...report.page_scripts import answer_of, explorer_data, needs_node
from ...report.page_text import visible_text
from .bouncing_lander import journey_tables

SCRIPTS = ("live/law.js", "live/attitude.js", "live/flown.js", "live/explore.js")
BEGIN = "const { facts } = given, law = new Law(unpack(given.law), facts);"
REST = "const shares = (found) => [found.returns, found.known].map((list) => list.reduce((all, one) => all + one, 0));"
SHARE = "document.querySelector('#explorer .share').textContent"
PHONE = 390


@pytest.fixture
def model(journeys: StudyResults, monkeypatch: pytest.MonkeyPatch) -> TouchdownEmulator:
    # A function has no beds.
    monkeypatch.setattr("lithobrake.pipeline.emulated.touchdown_emulator.height_of_beds", lambda study, folder: 0.0)
    return TouchdownEmulator.read(DrawnDesign(check_tables(journey_tables(), Path())), StudyFolder(journeys.folder))


@pytest.fixture
def explorer(journeys: StudyResults) -> ExplorerTables:
    found = journeys.touchdown_explorer
    assert found is not None
    return found


@pytest.fixture(scope="module")
def page(journeys_folder: Path) -> Path:
    return write_report(journeys_folder)


@pytest.fixture
def data(page: Path) -> dict[str, Any]:
    return explorer_data(page.read_text(encoding="utf-8"))


def test_the_tables_are_those_of_the_refits(model: TouchdownEmulator, explorer: ExplorerTables) -> None:
    assert explorer.input_names == model.inputs
    # A prism: its axis, upright, leaning and along the travel.
    terms = tuple(f"attitude.{term}_z" for term in ("upright", "lean", "along"))
    assert explorer.input_names[-7:] == (*OF_TOUCHDOWN, *terms)
    assert explorer.attitude.input_names == explorer.input_names[-3:]
    assert [len(downs) for downs in explorer.attitude.sides.values()] == [4, 2]
    assert explorer.group_count == len(set(model.bed))
    for name, table in law_tables(model.refits).items():
        assert np.array_equal(explorer.tables[name], table), name


@needs_node
def test_the_energy_bound_is_that_of_the_longest_way_and_the_median_spin(
    model: TouchdownEmulator, data: dict[str, Any], journeys: StudyResults
) -> None:
    spin = np.median(np.linalg.norm([journeys.touchdowns[f"impact.spin_{axis}"] for axis in "xyz"], axis=0))
    assert spin > 0.0
    moved = dict(zip(OF_TOUCHDOWN, (0.05, 20.0, 4e-5, 9.0), strict=True))
    values = moved | {"impact.spin_x": 0.0, "impact.spin_y": spin, "impact.spin_z": 0.0}
    at = {name: np.array([value]) for name, value in values.items()}
    bound = energy_bound(model.design, model.bed_height, at, 1, model.across)
    given = data | {"values": [*(0.0 for _ in model.inputs[:-7]), *moved.values(), 0.0, 0.0, 0.0]}
    found = answer_of(SCRIPTS, f"{BEGIN} return law.energyBoundAt(given.values);", given)
    assert found == pytest.approx([bound.speed[0], bound.gyration[0]], rel=1e-12)


@needs_node
def test_the_fraction_at_rest_is_the_chance_of_the_refits(model: TouchdownEmulator, data: dict[str, Any]) -> None:
    place = model.inputs.index(OF_TOUCHDOWN[0])
    program = f"""{BEGIN} {REST}
      const explorer = new Explorer(law, null, facts), ranges = facts.inputs.map(() => [0, 1]);
      return [[0, 1], [0, 0.3], [0.9, 1]].map((range) => {{
        ranges[given.place] = range;
        return shares(explorer.at(ranges));
      }});"""
    found = answer_of(SCRIPTS, program, data | {"place": place})
    captured = model.refits[0].outcome_names.index("captured")
    laws = model.refits[0].runs.inputs.values()
    shares = []
    for (low, high), (rest, known) in zip([(0.0, 1.0), (0.0, 0.3), (0.9, 1.0)], found, strict=True):
        assert known == len(model.refits) * 500
        u = np.random.default_rng(4).random((4000, len(model.inputs)))
        u[:, place] = low + (high - low) * u[:, place]
        x = np.column_stack([law.ppf(column) for law, column in zip(laws, u.T, strict=True)])
        # Attitudes are uniform over rotations.
        x[:, -3:] = np.column_stack(list(model.attitude_of(Rotation.random(4000, rng=5)).values()))
        shares.append(float(np.mean([one.outcome_probability(x)[:, captured].mean() for one in model.refits])))
        # All refits share the 500 points of the inputs, and the 4000 are a plain sample.
        error = np.sqrt(shares[-1] * (1.0 - shares[-1]) * (1.0 / 500 + 1.0 / 4000))
        assert abs(rest / known - shares[-1]) < 3.0 * error
    assert shares[1] > shares[0] > shares[2]


def test_the_page_says_that_it_is_one_touchdown_and_of_how_many(
    page: Path, data: dict[str, Any], journeys: StudyResults
) -> None:
    lines = visible_text(page.read_text(encoding="utf-8")).splitlines()
    words = next(line for line in lines if line.startswith("Any touchdown of a journey"))
    fitted = int(np.sum(journeys.touchdowns["outcome"] != "failed"))
    assert fitted < journeys.touchdowns.row_count
    assert f"fitted to {fitted} touchdowns on 12 beds" in words
    slope = journeys.touchdowns["surface.slope_deg"]
    assert f"slope from {slope.min():.2g} to {slope.max():.2g} deg" in words
    assert data["flown"] is None
    assert {one["words"] for one in data["facts"]["inputs"]} >= {"impact speed", "incidence at impact", "gravity"}
    assert [one["unit"] for one in data["facts"]["inputs"][-7:]] == ["m/s", "deg", "m/s²", "deg", "", "", ""]


@needs_browser
def test_slower_impacts_come_to_rest_more_often(page: Path, model: TouchdownEmulator, tmp_path: Path) -> None:
    number = 2 * model.inputs.index(OF_TOUCHDOWN[0]) + 1
    with browser_page(tmp_path) as browser:
        browser.open(page, PHONE)
        assert browser.value("document.documentElement.scrollWidth") == PHONE
        assert browser.value("document.querySelectorAll('#explorer figure').length") == 3
        before = browser.value(SHARE)
        browser.value(
            f"(() => {{ const end = document.querySelectorAll('#explorer input')[{number}]; end.value = 0.3;"
            "end.dispatchEvent(new Event('input')); })()"
        )
        after = browser.value(
            "new Promise((done) => { const look = () => "
            f"{SHARE} !== {before!r} ? done({SHARE}) : setTimeout(look, 50); look(); }})"
        )
        assert browser.complaints == []
    for words in (before, after):
        assert " % come to rest at this touchdown (90 % interval of the emulator: " in words
    assert float(after.split(" ")[0]) > float(before.split(" ")[0])
