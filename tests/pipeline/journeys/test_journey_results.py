"""Journeys from Python, in the files of other programs, by commands, on their page; and what decides their ends."""

import json
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.emulator import law_tables
from lithobrake.export import ExportOptions, export_study
from lithobrake.export.flown import Flown
from lithobrake.pipeline import run_study, study_status
from lithobrake.pipeline.answer.journey_ends import JourneyTable, journey_rest
from lithobrake.pipeline.answer.run_estimates import parts_of_journeys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.journeys.touchdown_emulator import OF_TOUCHDOWN, TouchdownEmulator
from lithobrake.pipeline.runs.energy_bound import energy_bound
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.report import write_report
from lithobrake.report.figures.ground_map import round_length
from lithobrake.results import ExplorerTables, StudyResults, open_study
from lithobrake.study import StudySource, check_tables, read_study
from lithobrake.vocabulary.outcomes import JourneyEnd

from ...command_line import lithobrake
from ...report.browser import Page, browser_page, needs_browser
from ...report.page_scripts import answer_of, explorer_data, needs_node
from ...report.page_text import visible_text
from .bouncing_lander import FAILS, LEAVES, STUCK, bounce, journey_tables


def test_each_journey_has_a_row_with_its_end(journeys: StudyResults) -> None:
    table = journeys.journeys
    assert table["journey"].tolist() == list(range(48))
    expected = dict.fromkeys(range(48), JourneyEnd.AT_REST)
    for numbers, end in ((FAILS, JourneyEnd.FAILED), (STUCK, JourneyEnd.UNDER_WAY), (LEAVES, JourneyEnd.ESCAPED)):
        expected |= dict.fromkeys(numbers, end)
    assert table["end"].tolist() == list(expected.values())
    at_rest = table["end"] == JourneyEnd.AT_REST
    assert np.isfinite(table["tilt_deg"][at_rest]).all()
    assert (set(table["face"][~at_rest]), table.columns["tilt_deg"].units) == ({""}, "deg")
    assert sum(one.count for one in journeys.results.ends.values()) == table.row_count


def test_each_touchdown_has_what_went_in_and_what_came_out(journeys: StudyResults) -> None:
    table = journeys.touchdowns
    assert table.row_count == journeys.results.touchdowns == journeys.journeys["touchdowns"].sum()
    for number, count in enumerate(journeys.journeys["touchdowns"].astype(int)):
        assert table["touchdown"][table["journey"] == number].tolist() == list(range(count))
    # One soil and one bed a journey, whatever the touchdown.
    first = {number: row for row, number in reversed(list(enumerate(table["journey"].tolist())))}
    of_first = np.array([first[number] for number in table["journey"].tolist()])
    for name in ("grain.friction", "grain.young_modulus", "bed"):
        assert table[name] == pytest.approx(table[name][of_first], rel=0, abs=0)
    assert np.isfinite(table["speed_out"][table["outcome"] == "clear"]).all()
    assert np.isnan(table["speed_out"][table["outcome"] == "captured"]).all()
    assert (table["cpu_s"] >= 0.0).all()
    frame = table.to_pandas()
    assert frame.attrs["cpu_s"]["units"] == frame.attrs["begin_s"]["units"] == "s"
    assert all(column.long_name for column in table.columns.values())


def test_runs_hold_every_touchdown_once(journeys: StudyResults) -> None:
    runs = journeys.runs
    assert sorted(runs["key"]) == sorted(journeys.touchdowns["key"])
    assert (runs["design"] == "drawn").sum() == 48


def test_quantiles_of_contacts_are_counts_that_occur(journeys: StudyResults) -> None:
    table = JourneyTable.load(StudyFolder.only_read(journeys.folder))
    # All different, so that a quantile between two of them would be none of them.
    counted = replace(table, numbers=table.numbers | {"contacts": np.arange(1.0, 49.0)})
    contacts = journey_rest(read_study(journeys.folder / "study.toml"), counted).contacts
    found = [getattr(one, end) for one in (contacts.median, contacts.q95) for end in ("value", "lower", "upper")]
    assert all(one is None or one == round(one) for one in found)
    assert contacts.median.lower is not None


def test_a_notebook_offers_journeys_and_touchdowns(journeys: StudyResults) -> None:
    shown = journeys._repr_html_()
    assert "<td>journeys</td>" in shown
    assert "<td>touchdowns</td>" in shown
    assert "<td>rest</td>" not in shown


def test_what_a_study_of_journeys_has_not_is_refused(journeys: StudyResults) -> None:
    with pytest.raises(ValueError, match="ask for journeys"):
        _ = journeys.rest


def test_flights_of_a_journey_go_from_touchdown_to_touchdown(journeys: StudyResults) -> None:
    table, number = journeys.arcs, 0
    flown = Flown.of(journeys).journeys(journeys, [number])
    assert flown.arc.tolist() == table["arc"][table["sample"] == number].tolist()
    position, _ = flown.ends()
    touchdowns = journeys.touchdowns
    there = (touchdowns["journey"] == number) & (touchdowns["touchdown"] > 0)
    latitude = np.degrees(np.arcsin(position[:, 2] / np.linalg.norm(position, axis=1)))
    assert latitude == pytest.approx(touchdowns["latitude_deg"][there], abs=1e-6)


def test_every_flight_of_the_cloud_is_the_first_of_its_journey(journeys: StudyResults) -> None:
    flown = Flown.of(journeys)
    assert flown.sample.tolist() == list(range(48))
    assert not flown.arc.any()
    assert not flown.begin.any()
    with pytest.raises(ValueError, match=r"sample 48 has no flight.*arcs\.csv"):
        flown.journeys(journeys, [48])


def test_maps_have_touchdowns_and_places_of_rest(journeys: StudyResults, tmp_path: Path) -> None:
    touchdowns, rest = export_study(journeys, tmp_path, ["geojson"])
    found = json.loads(touchdowns.read_text())["features"]
    assert len(found) == journeys.touchdowns.row_count
    assert {one["properties"]["journey"] for one in found} == set(range(48))
    lying = json.loads(rest.read_text())["features"]
    ended = journeys.journeys
    assert [one["properties"]["face"] for one in lying] == ended["face"][ended["end"] == JourneyEnd.AT_REST].tolist()


def test_an_ephemeris_of_a_journey_that_escapes_is_written(journeys: StudyResults, tmp_path: Path) -> None:
    number = min(LEAVES)
    paths = export_study(journeys, tmp_path, ["oem"], ExportOptions(samples=(number,), step=600.0))
    assert [path.name for path in paths] == ["flight_mean.oem", f"flight_{number}.oem"]
    assert paths[1].read_text().count("META_START") == 1


def test_pictures_of_a_landing_are_refused_where_a_function_makes_it(journeys: StudyResults, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"a program or function of the study.s own makes its touchdowns"):
        export_study(journeys, tmp_path, ["sheet"])
    key = journeys.touchdowns["key"][1]
    with pytest.raises(ValueError, match=f"run {key} was made by a program or function"):
        journeys.landing_bodies(str(key))


class JobOf:
    """What is asked of a job: its study, its design and its site."""

    def __init__(self, results: StudyResults) -> None:
        self.study = check_tables(journey_tables(), results.folder)
        self.design, self.site = DrawnDesign(self.study), Site(self.study)


def test_the_parts_of_each_end_add_up(journeys: StudyResults) -> None:
    found = journeys.results.end_variance_shares
    assert list(found) == ["at_rest", "time_s", "distance_m"]
    assert any(found.values())
    for one in (one for one in found.values() if one):
        assert sum(part.value for part in one.parts.values()) == pytest.approx(1.0)
        assert one.chaos is None


def test_a_distance_that_follows_the_delivery_is_the_deliverys(journeys: StudyResults) -> None:
    folder, job = StudyFolder(journeys.folder), JobOf(journeys)
    runs, table = DesignRuns.load(folder, "drawn"), JourneyTable.load(folder)
    speed = runs.inputs["impact.speed"]
    random = np.random.default_rng(0)
    numbers = {**table.numbers, "distance": speed / speed.std() + 0.2 * random.standard_normal(len(speed))}
    all_rest = JourneyTable(np.full(len(speed), "at_rest"), table.bed, numbers, table.position, table.face)
    found = parts_of_journeys(job, runs, all_rest, {"fast": (speed > np.median(speed)).astype(float)})
    assert found["at_rest"] is None
    parts = found["distance_m"]
    assert parts.arrival.value > 0.85
    assert parts.soil.value < 0.1
    assert parts.of == f"{len(speed)} of {len(speed)} journeys that ended at rest"
    # A limit state that the speed of delivery decides is the delivery's, too, as far as terms of low degree follow it.
    assert found["fast"].parts["arrival"].value > 0.5


TABLES = ("journeys.csv", "touchdowns.csv", "arcs.csv")


def test_status_counts_the_ends_of_the_journeys(journeys: StudyResults) -> None:
    found = study_status(journeys.folder)
    touchdowns = journeys.touchdowns.row_count
    assert found.runs.journeys.lines() == [
        f"journeys: 48 of 48 ended: 43 at rest, 3 escaped, 1 under way, 1 failed; {touchdowns} touchdowns"
    ]
    assert (found.runs.tally.total, found.runs.others) == (touchdowns, 0)
    assert "first touchdowns:" in found.runs.lines()
    assert json.loads(json.dumps(found.to_json()))["runs"]["journeys"]["ends"][JourneyEnd.AT_REST] == 43


def test_status_counts_what_the_ledger_has_while_journeys_are_followed(journeys: StudyResults, tmp_path: Path) -> None:
    folder = tmp_path / "half"
    shutil.copytree(journeys.folder, folder)
    for name in TABLES:
        (folder / name).unlink()
    found = study_status(folder).runs
    # A lander that left is under way until its flight has an end.
    known = 48 - len(LEAVES)
    at_rest = known - len(FAILS) - len(STUCK)
    assert found.journeys.lines() == [
        f"journeys: {known} of 48 ended so far: {at_rest} at rest, 1 under way, 1 failed; "
        f"{journeys.touchdowns.row_count} touchdowns"
    ]
    assert found.others == 0


def test_status_counts_no_touchdown_of_an_earlier_delivery(journeys: StudyResults, tmp_path: Path) -> None:
    folder = tmp_path / "edited"
    shutil.copytree(journeys.folder, folder)
    edited = journey_tables(delivery={"incidence_deg": 25.0}, journey={"count": 12})
    source = StudySource.of_tables(edited, function_identity(bounce))
    run_study(source, folder, until="runs", worker_count=1, model=bounce)
    made = open_study(folder).touchdowns.row_count
    for name in TABLES:
        (folder / name).unlink()
    found = study_status(folder).runs
    assert (found.journeys.touchdowns, found.others) == (made, journeys.touchdowns.row_count)


class Looks(Silent):
    """Looks at the status of a study once, while its journeys are followed."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.told, self.seen = folder, "", list[str]()

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        if what == "journeys" and done >= 12 and not self.seen:
            self.told, self.seen = detail.splitlines()[0], study_status(self.folder).lines()


def test_status_says_how_far_the_process_is_that_follows_journeys(tmp_path: Path) -> None:
    looks = Looks(tmp_path / "out")
    source = StudySource.of_tables(journey_tables(journey={"count": 24}), function_identity(bounce))
    run_study(source, looks.folder, until="runs", worker_count=1, model=bounce, shown=looks)
    assert re.fullmatch(r"1[2-9] of 24 journeys, \d+ touchdowns, at rest so far \d+ \+- \d+ %", looks.told)
    assert looks.told in looks.seen


def test_runs_have_columns_of_journey_and_touchdown(journeys_folder: Path) -> None:
    shown = lithobrake("runs", journeys_folder)
    assert shown.returncode == 0
    lines = shown.stdout.splitlines()
    assert "touch-" in lines[0]
    assert lines[1].split()[:3] == ["wall", "journey", "down"]


@pytest.mark.parametrize(("most", "length"), [(7.3, 5.0), (5.0, 5.0), (1.99, 1.0), (0.3, 0.2), (250.0, 200.0)])
def test_a_bar_of_lengths_is_a_round_one(most: float, length: float) -> None:
    assert round_length(most) == pytest.approx(length, rel=1e-12)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with browser_page(tmp_path_factory.mktemp("browser")) as opened:
        yield opened


@needs_browser
def test_the_page_takes_three_sheets_of_paper_at_most(page: Path, browser: Page) -> None:
    browser.open(page, 1280)
    assert 2 <= browser.sheets() <= 3
    assert browser.complaints == []


SCRIPTS = ("live/law.js", "live/attitude.js", "live/flown.js", "live/explore.js")
BEGIN = "const { facts } = given, law = new Law(unpack(given.law), facts);"
REST = "const shares = (found) => [found.returns, found.known].map((list) => list.reduce((all, one) => all + one, 0));"
SHARE = "document.querySelector('#touchdown-explorer .share').textContent"
PHONE = 390


@pytest.fixture(scope="module")
def model(journeys_folder: Path) -> TouchdownEmulator:
    with pytest.MonkeyPatch.context() as patch:
        # A function has no beds.
        patch.setattr("lithobrake.pipeline.journeys.touchdown_emulator.height_of_beds", lambda study, folder: 0.0)
        return TouchdownEmulator.read(DrawnDesign(check_tables(journey_tables(), Path())), StudyFolder(journeys_folder))


@pytest.fixture
def explorer(journeys: StudyResults) -> ExplorerTables:
    found = journeys.touchdown_explorer
    assert found is not None
    return found


@pytest.fixture(scope="module")
def page(journeys_folder: Path) -> Path:
    return write_report(journeys_folder)


@pytest.fixture
def explored(page: Path) -> dict[str, Any]:
    return explorer_data(page.read_text(encoding="utf-8"), "touchdown-explorer")


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
    model: TouchdownEmulator, explored: dict[str, Any], journeys: StudyResults
) -> None:
    spin = np.median(np.linalg.norm([journeys.touchdowns[f"impact.spin_{axis}"] for axis in "xyz"], axis=0))
    assert spin > 0.0
    moved = dict(zip(OF_TOUCHDOWN, (0.05, 20.0, 4e-5, 9.0), strict=True))
    values = moved | {"impact.spin_x": 0.0, "impact.spin_y": spin, "impact.spin_z": 0.0}
    at = {name: np.array([value]) for name, value in values.items()}
    bound = energy_bound(model.design, model.bed_height, at, 1, model.across)
    given = explored | {"values": [*(0.0 for _ in model.inputs[:-7]), *moved.values(), 0.0, 0.0, 0.0]}
    found = answer_of(SCRIPTS, f"{BEGIN} return law.energyBoundAt(given.values);", given)
    assert found == pytest.approx([bound.speed[0], bound.gyration[0]], rel=1e-12)


@needs_node
def test_the_fraction_at_rest_is_the_chance_of_the_refits(model: TouchdownEmulator, explored: dict[str, Any]) -> None:
    place = model.inputs.index(OF_TOUCHDOWN[0])
    program = f"""{BEGIN} {REST}
      const explorer = new Explorer(law, null, facts), ranges = facts.inputs.map(() => [0, 1]);
      return [[0, 1], [0, 0.3], [0.9, 1]].map((range) => {{
        ranges[given.place] = range;
        return shares(explorer.at(ranges));
      }});"""
    found = answer_of(SCRIPTS, program, explored | {"place": place})
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


def test_the_page_says_of_how_many_it_is_one(page: Path, explored: dict[str, Any], journeys: StudyResults) -> None:
    lines = visible_text(page.read_text(encoding="utf-8")).splitlines()
    words = next(line for line in lines if line.startswith("Any touchdown of a journey"))
    fitted = int(np.sum(journeys.touchdowns["outcome"] != "failed"))
    assert fitted < journeys.touchdowns.row_count
    assert f"fitted to {fitted} touchdowns on 12 beds" in words
    slope = journeys.touchdowns["surface.slope_deg"]
    assert f"slope from {slope.min():.2g} to {slope.max():.2g} deg" in words
    assert explored["flown"] is None
    assert {one["words"] for one in explored["facts"]["inputs"]} >= {"impact speed", "incidence at impact", "gravity"}
    assert [one["unit"] for one in explored["facts"]["inputs"][-7:]] == ["m/s", "deg", "m/s²", "deg", "", "", ""]


@needs_browser
def test_slower_impacts_come_to_rest_more_often(page: Path, model: TouchdownEmulator, browser: Page) -> None:
    number = 2 * model.inputs.index(OF_TOUCHDOWN[0]) + 1
    browser.open(page, PHONE)
    assert browser.value("document.documentElement.scrollWidth") == PHONE
    assert browser.value("document.querySelectorAll('#touchdown-explorer figure').length") == 3
    before = browser.value(SHARE)
    browser.value(
        f"(() => {{ const end = document.querySelectorAll('#touchdown-explorer input')[{number}]; end.value = 0.3;"
        "end.dispatchEvent(new Event('input')); })()"
    )
    after = browser.value(
        "new Promise((done) => { const look = () => "
        f"{SHARE} !== {before!r} ? done({SHARE}) : setTimeout(look, 50); look(); }})"
    )
    assert browser.complaints == []
    for said in (before, after):
        assert " % come to rest at this touchdown (90 % interval of the emulator: " in said
    assert float(after.split(" ")[0]) > float(before.split(" ")[0])
