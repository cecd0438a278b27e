"""Journeys on a body that librates or tumbles, and the acceleration of a touchdown where it is."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats
from scipy.spatial.transform import Rotation

import lithobrake
from lithobrake.export import Push, export_study, write_push
from lithobrake.pipeline.design.arrivals import STEEPEST_DEG, ground_inputs, turned_in_flight
from lithobrake.pipeline.design.descents import Descents
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.pipeline.stages import journey_dependencies
from lithobrake.smallbody import (
    Body,
    Flights,
    Partner,
    Shape,
    didymos,
    dimorphos,
    fly,
    rotation_history,
    tumble,
)
from lithobrake.study import StudyError
from lithobrake.study.source import StudySource
from lithobrake.touchdown.touchdown_model import acceleration

from ...paper_tables import with_keys
from ...smallbody.meshes import sphere_mesh
from ..few_terms import fewest_terms
from .bouncing_lander import journey_tables, run_without_emulator
from .test_journeys import JOURNEYS, TABLES, bouncing, hard_ground, rows

COUNT = JOURNEYS
ROTATION = {"yaw_deg": 30.0, "roll_deg": 60.0, "days": 2.0}


def turning(**changes: dict[str, Any]) -> dict[str, Any]:
    """The tables of a study on hard ground whose body tumbles."""
    given = TABLES | {"site": {"body": "dimorphos", "rotation": ROTATION}}
    given["journey"] = TABLES["journey"] | {"emulated_count": 30}
    return with_keys(given, changes)


def turning_cubesat(**changes: dict[str, Any]) -> dict[str, Any]:
    """Those of a study of a CubeSat; of what it sees of the sky none."""
    given = journey_tables(**changes)
    del given["sky"]
    given["site"] |= {"body": "dimorphos", "rotation": ROTATION}
    return given


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("turning") / "out"
    with fewest_terms():
        lithobrake.run(turning(), folder, workers=1, model=hard_ground)
    return folder


def test_landers_arrive_evenly_over_the_days_and_go_where_bounces_go(made: Path) -> None:
    study = with_site_gravity(StudySource.of_tables(turning()).study)
    site, design = Site(study), DrawnDesign(study)
    assert site.body.rotation.duration >= 2.0 * 86400.0 + 40000.0
    # Of more landers than are followed; the first of them are those.
    clock = site.clock(site.sampled(200))
    assert stats.kstest(clock / (2.0 * 86400.0), "uniform").pvalue > 0.01
    ends = bouncing(design)
    still = StudySource.of_tables(turning() | {"site": TABLES["site"]}).study
    uniform = bouncing(DrawnDesign(with_site_gravity(still)))
    found = rows(made, "journeys.csv")
    assert ends.end.tolist() == found["end"].tolist()
    rests = ends.end == "at_rest"
    assert rests.sum() > 0.5 * COUNT
    place = np.column_stack([found[f"position_{axis}"] for axis in "xyz"])
    assert np.linalg.norm(place - ends.position, axis=1)[rests].max() < 0.01
    assert np.median(np.linalg.norm(uniform.position - ends.position, axis=1)) > 1.0


def test_flights_are_noted_with_the_time_at_which_they_may_be_flown_again(made: Path) -> None:
    arcs = lithobrake.open_study(made).arcs
    body = Site(StudySource.of_tables(turning()).study).body
    position, velocity = (np.column_stack([arcs[f"{of}_{axis}"] for axis in "xyz"]) for of in ("position", "velocity"))
    lasting = arcs["end_s"] - arcs["begin_s"]
    again = fly(body, position, velocity, 40000.0 - arcs["begin_s"], gravity="table", start_time=arcs["clock_s"])
    assert again.time == pytest.approx(lasting, abs=1e-9)
    following = np.flatnonzero(arcs["sample"][1:] == arcs["sample"][:-1])
    assert len(following) > COUNT
    # A touchdown on hard ground takes no time.
    between = arcs["clock_s"][following + 1] - arcs["clock_s"][following]
    assert between == pytest.approx(lasting[following], abs=1e-6)


def test_the_same_seed_gives_the_same_journeys(made: Path, tmp_path: Path) -> None:
    # The first six, of which the others change nothing.
    run_without_emulator(turning(journey={"count": 6}), tmp_path / "again", hard_ground)
    for name in ("journeys.csv", "touchdowns.csv", "arcs.csv"):
        found, known = ((folder / name).read_bytes().splitlines() for folder in (tmp_path / "again", made))
        assert 6 < len(found) < len(known)
        assert found == known[: len(found)], name


def test_another_start_makes_the_journeys_of_before_outdated() -> None:
    others = ROTATION | {"yaw_deg": -30.0}, ROTATION | {"days": 3.0}, ROTATION | {"spin": [0.0, 1e-4, 0.0]}
    studies = [StudySource.of_tables(turning(site={"rotation": one})).study for one in (ROTATION, *others)]
    assert len({json.dumps(journey_dependencies(study), default=str) for study in studies}) == 4


def test_a_time_of_arrival_may_be_given() -> None:
    site = Site(StudySource.of_tables(turning(site={"rotation_time": 5000.0})).study)
    assert (site.clock(site.sampled(5)) == 5000.0).all()


def released(**delivery: Any) -> Flights:
    """Flights of six landers of one release."""
    release = {"position": [5.0, 150.0, 10.0], "velocity": [0.0, -0.03, 0.0]}
    given = turning_cubesat(journey={"count": 6}, site={"pole_right_ascension_deg": 60.0})
    given["site"] |= {"pole_declination_deg": -71.0, "meridian_deg": 25.0}
    given["delivery"] = {"latitude_deg": 0.0, "longitude_deg": 90.0, "release": release, **delivery}
    return Descents.flown(Site(with_site_gravity(StudySource.of_tables(given).study)), 0, np.full((6, 6), 0.5)).flights


def test_released_landers_start_along_the_axes_that_keep_pace_with_the_orbit() -> None:
    flights = released(frame="body_fixed")
    here = flights.body.rotation.at(flights.start.time)
    place, rate = here.states_into_frame(flights.start.position, flights.start.velocity)
    assert place == pytest.approx(np.tile([5.0, 150.0, 10.0], (6, 1)))
    assert rate == pytest.approx(np.tile([0.0, -0.03, 0.0], (6, 1)), abs=1e-12)
    assert len(set(flights.start.time.tolist())) == 6
    assert np.ptp(flights.time[flights.facet >= 0]) > 60.0


def test_states_of_icrf_go_through_the_pole_of_the_orbit_into_the_axes_of_the_body() -> None:
    flights = released(frame="icrf", epoch="2027-04-20T12:00:00")
    here = flights.body.rotation.at(flights.start.time)
    place, rate = here.states_into_frame(flights.start.position, flights.start.velocity)
    # At the epoch the axes of the orbit are these three turns from ICRF ([Archinal-2018]).
    turn = Rotation.from_euler("ZXZ", [60.0 + 90.0, 90.0 + 71.0, 25.0], degrees=True).inv()
    fixed = turn.apply([5.0, 150.0, 10.0])
    spin = np.array([0.0, 0.0, flights.body.spin_rate])
    assert place == pytest.approx(np.tile(fixed, (6, 1)))
    assert rate == pytest.approx(np.tile(turn.apply([0.0, -0.03, 0.0]) - np.cross(spin, fixed), (6, 1)), abs=1e-12)


def test_the_study_has_its_page_and_its_flights_are_not_passed_on(made: Path, tmp_path: Path) -> None:
    results = lithobrake.open_study(made)
    emulated = (made / "emulated.csv").read_text().splitlines()
    assert sum(row.startswith("fresh,") for row in emulated) == 30
    assert "from synchronous rotation; landers arrive over" in (made / "report" / "index.html").read_text()
    with pytest.raises(ValueError, match="no place for an attitude over time"):
        export_study(results, tmp_path, ["oem"])
    with pytest.raises(ValueError, match="follows journeys, and facets"):
        export_study(results, tmp_path, ["facets"])
    export_study(results, tmp_path, ["geojson"])
    with pytest.raises(ValueError, match="no place for an attitude over time"):
        write_push(results, tmp_path / "push.csv", Push(0.04, 45.0))


def test_what_is_felt_on_a_body_that_tumbles_is_how_a_slow_flight_begins() -> None:
    body = two_balls()
    body = replace(body, rotation=rotation_history(body, 20_000.0, yaw_deg=70.0, spin=(3e-4, -4e-4, 2e-4)))
    point = body.shape.surface_point(20.0, -40.0)[None]
    up = body.shape.normals[body.shape.locate(20.0, -40.0)[1]]
    speed, time = 2e-4, np.array([7000.0])
    own = np.array([body.mass]), np.array([body.spin_period])
    here, still = (one.felt(point, time, *own)[0] for one in (body, replace(body, rotation=None)))
    flight = fly(body, point, speed * up[None], 100.0, start_time=time)
    change = (flight.velocity[0] - speed * up) / flight.time[0]
    tide = np.linalg.norm(body.felt(point, time, *own)[0] - body.effective_acceleration(point, time=time)[0])
    bound = 2.0 * speed * np.linalg.norm(body.rotation.at(time).whole_spin(body.spin_rate)[0]) + 0.01 * tide
    assert np.linalg.norm(change - here) < bound
    assert np.linalg.norm(change - still) > 10.0 * bound


def test_a_lander_turns_among_the_stars_while_the_ground_turns_under_it() -> None:
    body = two_balls()
    ground = rotation_history(body, 20_000.0, yaw_deg=70.0, spin=(3e-4, -4e-4, 2e-4))
    inertia, spin = np.diag([0.01, 0.02, 0.03]), np.array([1e-3, -3e-3, 2e-3])
    start, time, period = 4000.0, 2500.0, body.spin_period
    attitude = Rotation.from_rotvec([0.3, 0.2, -0.5])
    found, against = turned_in_flight(inertia, attitude, spin, period, time, ground=ground, start=start)

    def among_stars(at: float) -> Rotation:
        return Rotation.from_rotvec([0.0, 0.0, body.spin_rate * at]) * Rotation.from_matrix(ground.at(at).axes[0])

    begin, end = among_stars(start), among_stars(start + time)
    quaternion = np.roll((begin * attitude).as_quat(), 1)[None]
    turned, spins = tumble(inertia, quaternion, begin.apply(spin)[None], np.array([time]))
    expected = end.inv() * Rotation.from_quat(np.roll(turned, -1, axis=1)[0])
    assert (found * expected.inv()).magnitude() < 1e-9
    own = ground.at(start + time).whole_spin(body.spin_rate)[0][0]
    assert against == pytest.approx(end.inv().apply(spins[0]) - own, abs=1e-12)


@pytest.mark.parametrize(("site", "words"), [
    ({"body": "didymos"}, 'allowed with [site.rotation]: "dimorphos" with its partner'),
    ({"partner": False}, "site.partner is false"),
    ({"spin_period": 40000.0}, "site.spin_period is given; with [site.rotation]"),
    ({"rotation_time": 2e5}, "site.rotation_time reaches 200000 s; allowed: at most 172800 s"),
    ({"rotation": None, "rotation_time": 5.0}, "site.rotation_time is a time in [site.rotation], and there is none"),
    ({"rotation": {"pitch_deg": 91.0}}, "allowed: at least -90 and at most 90"),
    ({"rotation": {"spin": [0.1, 0.0, 0.0]}}, "allowed: 3 numbers, each at least -0.002"),
    ({"rotation": {"yaw": 3.0}}, "yaw"),
])  # fmt: skip
def test_what_does_not_go_with_a_rotation_is_refused(site: dict[str, Any], words: str) -> None:
    given = turning(site=site)
    given["site"] = {key: value for key, value in given["site"].items() if value is not None}
    with pytest.raises(StudyError) as refused:
        StudySource.of_tables(given)
    assert len(refused.value.problems) == 1
    assert words in refused.value.problems[0]


def test_the_sky_of_a_day_is_refused() -> None:
    with pytest.raises(StudyError, match="no day is like another"):
        StudySource.of_tables(turning(sky={"sun_latitude_deg": 0.0}))


@pytest.mark.parametrize("azimuth_deg", [0.0, 73.0, 291.0])
@pytest.mark.parametrize("local", [(2e-6, -5e-6, -4e-5), (-3e-6, 1e-6, 2e-5), (0.0, 0.0, -1e-4)])
def test_the_bed_has_the_acceleration_turned_by_the_azimuth(local: tuple[float, ...], azimuth_deg: float) -> None:
    row = ground_inputs(local, azimuth_deg, friction=0.6)
    of_bed = acceleration(row, row["surface.gravity"])
    c, s = math.cos(math.radians(azimuth_deg)), math.sin(math.radians(azimuth_deg))
    turned = (c * local[0] - s * local[1], s * local[0] + c * local[1], local[2])
    assert of_bed == pytest.approx(turned, rel=1e-12, abs=1e-20)


def test_no_bed_is_steeper_than_soil_lies() -> None:
    steep = ground_inputs((1e-4, 0.0, -1e-4), 0.0, friction=0.6)
    assert steep["surface.slope_deg"] == pytest.approx(STEEPEST_DEG)
    assert steep["surface.gravity"] == pytest.approx(math.sqrt(2.0) * 1e-4)
    assert ground_inputs((1e-4, 0.0, -1e-4), 0.0, friction=0.2)["surface.slope_deg"] == pytest.approx(
        math.degrees(math.atan(0.5))
    )


def two_balls() -> Body:
    """A binary of two balls, of the sizes and masses of Dimorphos and Didymos: no oblateness pulls at either centre."""
    vertices, faces = sphere_mesh(12)
    inner, outer = dimorphos(), didymos()
    partner = Body(Shape(390.0 * vertices, faces), mass=outer.mass, spin_period=outer.spin_period)
    shape, period = Shape(75.0 * vertices, faces), inner.spin_period
    return Body(shape, mass=inner.mass, spin_period=period, partner=Partner(partner, period))


def test_what_is_felt_at_rest_is_how_a_slow_flight_begins() -> None:
    """A lander thrown up slowly goes back to the ground under the acceleration that one at rest feels, tide and all."""
    body = two_balls()
    point = body.shape.surface_point(20.0, -40.0)[None]
    up = body.shape.normals[body.shape.locate(20.0, -40.0)[1]]
    speed, time = 2e-4, np.array([1000.0])
    here = body.felt(point, time, np.array([body.mass]), np.array([body.spin_period]))[0]
    alone = body.effective_acceleration(point)[0]
    tide = np.linalg.norm(here - alone)
    assert 0.01 < tide / np.linalg.norm(alone) < 0.2
    flight = fly(body, point, speed * up[None], 100.0, start_time=time)
    change = (flight.velocity[0] - speed * up) / flight.time[0]
    # Until it is down again only Coriolis' acceleration comes in, and what the facets of the partner are no ball.
    assert np.linalg.norm(change - here) < 2.0 * speed * body.spin_rate + 0.01 * tide


def test_a_body_alone_has_no_tide() -> None:
    body = dimorphos(partner=False)
    point = body.shape.surface_point(20.0, -40.0)[None]
    here = body.felt(point, np.zeros(1), np.array([body.mass]), np.array([body.spin_period]))
    assert (here == body.effective_acceleration(point)).all()
