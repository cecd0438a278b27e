"""Journeys from Python, in the files of other programs, by commands; and what decides their ends."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lithobrake.export import ExportOptions, export_study
from lithobrake.export.flown import Flown
from lithobrake.pipeline import run_study, study_status
from lithobrake.pipeline.answer.journey_ends import JourneyTable, journey_rest
from lithobrake.pipeline.answer.variance_of_runs import parts_of_journeys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults
from lithobrake.study import StudySource, check_tables, read_study
from lithobrake.vocabulary.outcomes import JourneyEnd

from ...command_line import lithobrake
from .bouncing_lander import FAILS, LEAVES, STUCK, bounce, journey_tables, run_without_emulator


def test_each_journey_has_a_row_with_its_end(journeys: StudyResults) -> None:
    table = journeys.journeys
    assert table["journey"].tolist() == list(range(48))
    expected = dict.fromkeys(range(48), JourneyEnd.AT_REST)
    for numbers, end in ((FAILS, JourneyEnd.FAILED), (STUCK, JourneyEnd.UNDER_WAY), (LEAVES, JourneyEnd.ESCAPED)):
        expected |= dict.fromkeys(numbers, end)
    assert table["end"].tolist() == list(expected.values())
    at_rest = table["end"] == JourneyEnd.AT_REST
    assert np.isfinite(table["tilt_deg"][at_rest]).all()
    assert set(table["face"][~at_rest]) == {""}
    assert table.columns["tilt_deg"].units == "deg"
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
    with pytest.raises(ValueError, match="a program or function of its own makes its touchdowns"):
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
        assert sum(part.share for part in one.parts.values()) == pytest.approx(1.0)
        assert one.chaos is None


def test_a_distance_that_follows_the_delivery_is_the_deliverys(journeys: StudyResults) -> None:
    folder, job = StudyFolder(journeys.folder), JobOf(journeys)
    runs, table = DesignRuns.load(folder, "drawn"), JourneyTable.load(folder)
    speed = runs.inputs["impact.speed"]
    random = np.random.default_rng(0)
    numbers = {**table.numbers, "distance": speed / speed.std() + 0.2 * random.standard_normal(len(speed))}
    all_rest = JourneyTable(np.full(len(speed), "at_rest"), table.bed, numbers, table.position, table.face)
    found = parts_of_journeys(job, runs, all_rest)
    assert found["at_rest"] is None
    parts = found["distance_m"]
    assert parts.arrival.share > 0.85
    assert parts.soil.share < 0.1
    assert parts.of == f"{len(speed)} of {len(speed)} journeys that ended at rest"


TABLES = ("journeys.csv", "touchdowns.csv", "arcs.csv")


def test_status_counts_the_ends_of_the_journeys(journeys: StudyResults) -> None:
    found = study_status(journeys.folder)
    touchdowns = journeys.touchdowns.row_count
    assert found.runs.journeys.lines() == [
        f"journeys: 48 of 48 ended: 43 at rest, 3 escaped, 1 under way, 1 failed; {touchdowns} touchdowns"
    ]
    assert found.runs.tally.total == touchdowns
    assert found.runs.others == 0
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
    made = run_without_emulator(journey_tables(delivery={"incidence_deg": 25.0}), folder).touchdowns.row_count
    for name in TABLES:
        (folder / name).unlink()
    found = study_status(folder).runs
    assert found.journeys.touchdowns == made
    assert found.others == journeys.touchdowns.row_count


class Looks(Silent):
    """Looks at the status of a study once, while its journeys are followed."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.told, self.seen = folder, "", list[str]()

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Look when half of the journeys have ended."""
        if what == "journeys" and done >= 24 and not self.seen:
            self.told, self.seen = detail.splitlines()[0], study_status(self.folder).lines()


def test_status_says_how_far_the_process_is_that_follows_journeys(tmp_path: Path) -> None:
    looks = Looks(tmp_path / "out")
    source = StudySource.of_tables(journey_tables(), function_identity(bounce))
    run_study(source, looks.folder, until="runs", worker_count=1, model=bounce, shown=looks)
    assert re.fullmatch(r"(2[4-9]|3\d) of 48 journeys, \d+ touchdowns, at rest so far \d+ \+- \d+ %", looks.told)
    assert looks.told in looks.seen


def test_runs_have_columns_of_journey_and_touchdown(journeys_folder: Path) -> None:
    shown = lithobrake("runs", journeys_folder)
    assert shown.returncode == 0
    lines = shown.stdout.splitlines()
    assert "touch-" in lines[0]
    assert lines[1].split()[:3] == ["wall", "journey", "down"]
