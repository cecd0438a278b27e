"""Journeys in the files of other programs."""

import json
from pathlib import Path

import numpy as np
import pytest

from lithobrake.export import ExportOptions, export_study
from lithobrake.export.flown import Flown
from lithobrake.results import StudyResults
from lithobrake.vocabulary.outcomes import JourneyEnd

from .bouncing_lander import LEAVES


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
