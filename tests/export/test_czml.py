"""The document for Cesium, as the field's library reads it, against the journeys of the study."""

import json
import warnings
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.export import write_czml
from lithobrake.export.czml import SHOWN
from lithobrake.results import StudyResults

from .delivered import EPOCH


@pytest.fixture(scope="module")
def packets(delivered: StudyResults, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """All landers of the study, after the library has read the document."""
    czml3 = pytest.importorskip("czml3")
    path = tmp_path_factory.mktemp("czml") / "landers.czml"
    write_czml(delivered, path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        document = czml3.Document.load(path)
    found: list[dict[str, Any]] = json.loads(document.dumps())
    assert len(found) == len(json.loads(path.read_text()))
    return found


def seconds(text: str) -> float:
    return (datetime.fromisoformat(text) - datetime.fromisoformat(f"{EPOCH}+00:00")).total_seconds()


def at(parts: list[dict[str, Any]], name: str, time: float, count: int) -> np.ndarray:
    """The sample of a property nearest to a time [s] in the last interval that holds it."""
    part = [one for one in parts if seconds(one["interval"].split("/")[0]) <= time + 1e-5][-1]
    values = np.array(part[name])
    if len(values) == count:
        return values
    table = values.reshape(-1, count + 1)
    row = int(np.argmin(np.abs(table[:, 0] - time)))
    assert table[row, 0] == pytest.approx(time, abs=1e-5)
    assert part["epoch"] == f"{EPOCH}.000000Z"
    return table[row, 1:]


def test_each_lander_is_where_and_turned_as_the_tables_have_it(
    delivered: StudyResults, packets: list[dict[str, Any]]
) -> None:
    """Seven come to rest; the model of one fails in its second touchdown, of which nothing is shown."""
    arcs, journeys = delivered.arcs, delivered.journeys
    assert (journeys["end"] == "at_rest").sum() == 7
    assert [one["id"] for one in packets[2:]] == [f"SAMPLE_{number}" for number in range(8)]
    for number, packet in enumerate(packets[2:]):
        own = arcs.where(arcs["sample"] == number)
        # Each lander is delivered a hundred seconds after the one before.
        shift = 100.0 * number - own["begin_s"][0]
        for row in range(own.row_count):
            place = [own[f"position_{axis}"][row] for axis in "xyz"]
            assert at(packet["position"], "cartesian", own["begin_s"][row] + shift, 3) == pytest.approx(place, abs=1e-9)
        if journeys["end"][number] != "at_rest":
            continue
        end = journeys["time_s"][number] + shift
        rest = [journeys[f"position_{axis}"][number] for axis in "xyz"]
        assert at(packet["position"], "cartesian", end, 3).tolist() == rest
        known = Rotation.from_quat([journeys[f"attitude_{part}"][number] for part in "wxyz"], scalar_first=True)
        found = Rotation.from_quat(at(packet["orientation"], "unitQuaternion", end, 4))
        assert (known.inv() * found).magnitude() < 1e-9


def test_intervals_follow_each_other_and_clock_and_colour_are_those_of_the_study(packets: list[dict[str, Any]]) -> None:
    clock = packets[0]["clock"]
    begin, end = (seconds(one) for one in clock["interval"].split("/"))
    assert (begin, clock["currentTime"]) == (0.0, f"{EPOCH}.000000Z")
    assert clock["multiplier"] == pytest.approx((end - begin) / 60.0)
    for packet in packets[2:]:
        ways = [[seconds(one) for one in part["interval"].split("/")] for part in packet["position"]]
        assert all(before[1] == after[0] for before, after in pairwise(ways))
        rests = packet["name"].endswith(": at rest")
        assert (ways[-1][1] == pytest.approx(end, abs=1e-5)) == rests
        assert packet["point"]["color"]["rgba"] == [42, 168, 132, 255] if rests else [178, 58, 46, 255]
        assert all(part["referenceFrame"] == "FIXED" for part in packet["position"])


def test_the_body_has_its_extents(packets: list[dict[str, Any]]) -> None:
    assert packets[1]["ellipsoid"]["radii"]["cartesian"] == pytest.approx([88.5, 87.0, 58.0])


def test_flights_of_samples_are_shown_without_attitude(results: StudyResults, tmp_path: Path) -> None:
    pytest.importorskip("czml3")
    write_czml(results, tmp_path / "flights.czml")
    found = json.loads((tmp_path / "flights.czml").read_text())
    assert len(found) == 2 + min(SHOWN, 16)
    assert all("orientation" not in one for one in found[2:])
    assert {one["name"].split(": ")[1] for one in found[2:]} == {"impact"}
