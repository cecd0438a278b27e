"""A study on Dimorphos whose landers reach Didymos, and go on there to rest."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.export.attitudes import turns_of
from lithobrake.export.flown import ExportOptions, Flown
from lithobrake.export.maps import point_names, write_geojson
from lithobrake.export.oem import Frame
from lithobrake.geometry.attitude import arriving
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults
from lithobrake.smallbody import didymos, dimorphos, fly
from lithobrake.smallbody.bounce import impact_frame
from lithobrake.smallbody.grounds import Moments, grounds_of
from lithobrake.study import read_study
from lithobrake.vocabulary.number_words import with_interval
from lithobrake.vocabulary.outcomes import JourneyEnd

from .bouncing_lander import bounce, journey_tables, run_without_emulator

# From the trailing side, with less than what leaves the binary [m/s].
THROWN = 0.1
TABLES = {
    "delivery": {"latitude_deg": 0.0, "longitude_deg": 60.0},
    "journey": {"count": 24, "duration": 345600.0, "emulated_count": 0},
    "sky": {"sun_latitude_deg": 0.0, "mask_deg": 0.0},
}


def thrown(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """The first touchdown throws two of three landers toward Didymos; others end as those of the bouncing lander."""
    journey, touchdown = int(inputs["journey"]), int(inputs["touchdown"])
    # None of the journeys fails here.
    found = bounce({**inputs, "journey": 1e6}, seed)
    if touchdown > 0 or journey % 3 == 0:
        return found
    up = THROWN + 0.002 * (journey % 12)
    out = {"speed_out": up, "elevation_out": 0.5 * math.pi, "velocity_out_x": 0.0, "velocity_out_z": up}
    zero = {"azimuth_out": 0.0, "velocity_out_y": 0.0, "spin_out": 1e-3, "spin_out_x": 0.0, "spin_out_y": 1e-3}
    return {"outcome": "clear", "outputs": found["outputs"] | out | zero | {"spin_out_z": 0.0}}


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    folder = tmp_path_factory.mktemp("other_body") / "out"
    return run_without_emulator(journey_tables(**TABLES), folder, thrown, report=True)


def places(table: Any, rows: np.ndarray) -> np.ndarray:
    return np.column_stack([table[f"position_{axis}"] for axis in "xyz"])[rows]


def test_ends_add_up_and_rows_name_the_body(found: StudyResults) -> None:
    journeys, ends = found.journeys, found.results.ends
    there = journeys["body"] == "didymos"
    assert sum(one.count for one in ends.values()) == journeys.row_count
    assert sum(one.share.value for one in ends.values()) == pytest.approx(1.0)
    assert (journeys["end"][there] == JourneyEnd.PARTNER).sum() == ends[JourneyEnd.PARTNER].count > 8
    assert np.abs(didymos(partner=False).shape.height(places(journeys, there))).max() < 1e-6
    # The distance from the aim point is one over the ground of Dimorphos.
    assert np.isnan(journeys["distance"][there]).all()
    assert set(journeys["body"][journeys["end"] == JourneyEnd.AT_REST].tolist()) == {"dimorphos"}
    share = with_interval(ends[JourneyEnd.PARTNER].share)
    assert f"{share} at rest on Didymos" in " ".join(str(found).split())


def test_touchdowns_lie_on_the_body_that_they_name(found: StudyResults) -> None:
    table = found.touchdowns
    for body, tide in ((dimorphos(partner=False), 7e-6), (didymos(partner=False), 4e-7)):
        rows = table["body"] == body.name
        assert rows.sum() > 10
        assert np.abs(body.shape.height(places(table, rows))).max() < 1e-6
        felt = np.linalg.norm(body.effective_acceleration(places(table, rows)), axis=1)
        # Tides at the ground [m/s2]: up to 3 G m r / d^3 of the other body, 0.6e-5 on Dimorphos and 0.03e-5 on Didymos.
        assert np.abs(table["surface.gravity"][rows]) == pytest.approx(felt, abs=tide)


def test_each_flight_leads_to_the_next_touchdown_on_either_body(found: StudyResults) -> None:
    """Flown again from arcs.csv it ends at the place, and on the body, of the next row of touchdowns.csv."""
    body, arcs, table = Site(read_study(found.folder / "study.toml")).body, found.arcs, found.touchdowns
    lasting = np.flatnonzero(arcs["end_s"] < 345600.0)
    start, speed = (
        np.column_stack([arcs[f"{of}_{axis}"][lasting] for axis in "xyz"]) for of in ("position", "velocity")
    )
    flights = fly(
        body, start, speed, 345600.0 - arcs["begin_s"][lasting], gravity="table", start_time=arcs["clock_s"][lasting]
    )
    for row, arc in enumerate(lasting.tolist()):
        next_one = (table["journey"] == arcs["sample"][arc]) & (table["touchdown"] == arcs["arc"][arc] + 1)
        (there,) = np.flatnonzero(next_one)
        assert table["body"][there] == {"impact": "dimorphos", "partner": "didymos"}[flights.status[row]]
        assert (flights.on_ground[0][row] == places(table, next_one)[0]).all()


def test_the_attitude_in_flight_is_that_of_the_touchdowns_at_both_ends(found: StudyResults) -> None:
    """As the other program gets it; from one body to the other, and on the partner alone."""
    number = int(found.journeys["journey"][found.journeys["end"] == JourneyEnd.PARTNER][0])
    flown = Flown.of(found).journeys(found, [number])
    turns = turns_of(found, flown, number)
    table = found.touchdowns.where(found.touchdowns["journey"] == number)
    axes = Frame.of(found, "fixed", "2027-01-01T00:00:00")
    assert len(turns) == table.row_count - 1 > 2
    assert set(table["body"].tolist()) == {"dimorphos", "didymos"}
    for one, turn in enumerate(turns):
        row = {name: table[name][one + 1] for name in table}
        place, incoming = (np.array([row[f"{of}_{axis}"] for axis in "xyz"]) for of in ("position", "velocity"))
        ground = grounds_of(flown.body)[int(row["body"] == "didymos")]
        up = ground.body.shape.normals[ground.body.shape.nearest(place)[1]]
        down, _ = arriving(row, impact_frame(incoming[None], up[None])[0])
        clock = flown.start_time[one] + flown.end_time[one]
        matrices = ground.turns(Moments(np.array([clock]), flown.mass[:1], flown.spin_period[:1]))
        expected = down if matrices is None else Rotation.from_matrix(matrices[0].T) * down
        assert (turn.at(np.array([turn.duration]), axes)[0].inv() * expected).magnitude() < 1e-6


def test_maps_and_sky_have_the_landers_of_either_body_apart(found: StudyResults, tmp_path: Path) -> None:
    chosen = ExportOptions()
    names = point_names(found, chosen)
    assert names == ["impacts.geojson", "rest.geojson", "impacts_didymos.geojson", "rest_didymos.geojson"]
    write_geojson(found, [tmp_path / name for name in names], chosen)
    counts = [len(json.loads((tmp_path / name).read_text())["features"]) for name in names]
    on_partner, ends = (found.touchdowns["body"] == "didymos").sum(), found.results.ends
    assert counts[2:] == [on_partner, ends[JourneyEnd.PARTNER].count]
    assert counts[:2] == [found.touchdowns.row_count - on_partner, ends[JourneyEnd.AT_REST].count]
    rows = [line.split(",") for line in (found.folder / "sky.csv").read_text().splitlines()[1:]]
    of_sun = [int(row[0]) for row in rows if row[1] == "sun"]
    assert len(of_sun) == ends[JourneyEnd.PARTNER].count + ends[JourneyEnd.AT_REST].count
    assert found.results.sky["sun"].never.count == 0
    page = (found.folder / "report" / "index.html").read_text()
    assert "Landers on the ground of Didymos" in page
    assert (found.folder / "report" / "figure_4_partner_map.png").is_file()


def test_a_journey_in_lines_says_where_it_goes(found: StudyResults) -> None:
    number = int(found.journeys["journey"][found.journeys["end"] == JourneyEnd.PARTNER][0])
    said = found.journey(number).track.lines()
    assert said[2].endswith("to Didymos")
    assert said[-1].startswith("At rest on Didymos ")
    assert "from the aim point" not in said[-1]
