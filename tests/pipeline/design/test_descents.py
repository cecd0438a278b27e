"""Flights from delivered states to the first touchdown; and runs out of one sequence: laws, beds, attitudes."""

import math
import tomllib
from collections import Counter
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import ndtri

from lithobrake.files.oem_reader import message_states
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline import stage_keys
from lithobrake.pipeline.design.arrivals import against_ground, icrf_to_body, place_region, smallest_width, turned
from lithobrake.pipeline.design.bed_order import beds_of_runs
from lithobrake.pipeline.design.dependencies import bed_dependencies, bed_files, bed_setting, pour_seed, touchdown_keys
from lithobrake.pipeline.design.descents import Descents, descents_in_words
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import attitude_terms, independent_terms, seen, with_side_down
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.design.released_states import spread, spread_root
from lithobrake.pipeline.planning.study_warnings import study_warnings
from lithobrake.pipeline.site import Site
from lithobrake.smallbody import didymos, fly, tumble
from lithobrake.smallbody.body import GRAVITATIONAL_CONSTANT
from lithobrake.study import Study, StudyError, check_tables, read_study
from lithobrake.study.delivery_sections import ReleaseSection
from lithobrake.study.ground_sections import LANDINGS_A_BED, default_bed_count
from lithobrake.study.impact_sections import SiteSection
from lithobrake.study.lander_section import directions_of_sides, side_words, sides_down
from lithobrake.study.source import StudySource
from lithobrake.study.template import template
from lithobrake.vocabulary.outcomes import FlightStatus
from lithobrake.vocabulary.quantities import ORIENTATION, PLACE

from ...paper_tables import SMALL_GROUND, with_keys
from ...smallbody.meshes import sphere_mesh
from ..journeys.soil_journeys import STUDY

TABLES: dict[str, Any] = {
    "seed": 5, **SMALL_GROUND, "lander": {"shape": "box", "edges": [0.1, 0.1, 0.227], "mass": 2.0},
    "delivery": {"latitude_deg": 0.0, "longitude_deg": 90.0, "frame": "body_fixed"},
    "journey": {"count": 8, "duration": 40000.0}, "site": {"body": "dimorphos", "partner": False, "mass": 4.3e9},
    "flight": {"gravity": "exact"},
}  # fmt: skip
# Above the trailing side of Dimorphos, some 3 cm/s towards it.
POSITION, VELOCITY = [5.0, 140.0, 10.0], [0.002, -0.03, 0.001]
POLE = {"pole_right_ascension_deg": 60.0, "pole_declination_deg": -71.0, "meridian_deg": 25.0}
EPOCH = "2027-04-20T12:00:00"
SPIN_PERIOD = 40922.64
# Of the ball: radius, where landers are released and how fast towards it, its mass.
RADIUS, HEIGHT, DOWN, MASS = 80.0, 40.0, 0.02, 4.0e9


def study(**changes: dict[str, Any]) -> Study:
    return StudySource.of_tables(with_keys(deepcopy(TABLES), changes)).study


def released(**release: Any) -> dict[str, Any]:
    return {"release": {"position": POSITION, "velocity": VELOCITY} | release}


def write_table(path: Path, table: np.ndarray, titles: str) -> str:
    path.write_text("\n".join([titles, *(",".join(f"{value:.17g}" for value in row) for row in table)]) + "\n")
    return str(path)


TITLES = "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s"


def some_states(count: int = 8) -> np.ndarray:
    """Times and body-fixed states, [count, 7]."""
    off = np.random.default_rng(1).standard_normal((count, 6)) * [5.0, 5.0, 5.0, 1e-3, 1e-3, 1e-3]
    return np.column_stack([100.0 * np.arange(count), np.array([*POSITION, *VELOCITY]) + off])


def test_a_release_without_spread_is_the_flight_of_that_one_state() -> None:
    found = DrawnDesign(study(delivery=released(covariance=[[0.0] * 6] * 6))).descents
    alone = fly(Site(study(delivery=released())).body, POSITION, VELOCITY, 40000.0)
    assert (found.flights.status == "impact").all()
    assert (found.flights.position == alone.position).all()
    assert (found.flights.velocity == alone.velocity).all()
    assert (found.flights.time == alone.time).all()


def test_a_run_alone_is_the_same_as_among_others() -> None:
    design = DrawnDesign(study(delivery=released(position_std=5.0, velocity_std=1e-3)))
    assert [design.row(run) for run in range(8)] == design.rows
    assert design.with_run_count(12).rows[:8] == design.rows
    assert len({row["impact.speed"] for row in design.rows}) == 8


def test_the_first_touchdown_has_what_the_flight_tells() -> None:
    design = DrawnDesign(study(delivery=released(position_std=5.0, velocity_std=1e-3)))
    flights = design.descents.flights
    speeds = [row["impact.speed"] for row in design.rows]
    assert speeds == flights.impact_speed.tolist()
    incidence = np.radians([row["impact.incidence_deg"] for row in design.rows])
    outward = np.einsum("ni,ni->n", flights.velocity, design.descents.axes[:, 2])
    assert np.cos(incidence) == pytest.approx(-outward / speeds)
    along = np.einsum("ni,ni->n", flights.velocity, design.descents.axes[:, 0])
    assert np.sin(incidence) == pytest.approx(along / speeds)
    assert design.medians["impact.speed"] == np.median(speeds)


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A ball, next to a point mass outside of it."""
    path = tmp_path_factory.mktemp("ball") / "ball.obj"
    directions, faces = sphere_mesh(8)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (RADIUS * directions).tolist()]
    path.write_text("\n".join([*lines, *(f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist())]) + "\n")
    return path


def test_the_spread_at_the_ground_is_that_of_the_linear_propagation(ball: Path) -> None:
    """A fall straight down to a point mass that does not turn.

    The angular momentum r^2 d(angle)/dt is kept, so an angle off the vertical grows by that over r^2, to first order
    along the undisturbed fall: on the ground R (dy / r0 + r0 w I), I the integral of dt / r^2, where u = 1 / r and
    dt / r^2 = -du / v(u), v^2 = v0^2 + 2 mu (u - u0). The velocity across is w = dv + v0 dy / r0: beside the vertical
    the way down is not that to the centre.
    """
    count, high, mu = 400, RADIUS + HEIGHT, GRAVITATIONAL_CONSTANT * MASS
    integral = (math.sqrt(DOWN**2 + 2.0 * mu * (1.0 / RADIUS - 1.0 / high)) - DOWN) / mu
    # Small, and each correlated with another: along x up, y and z level.
    sizes = np.array([0.2, 0.3, 0.2, 1e-5, 2e-5, 1e-5])
    correlation = np.eye(6)
    for row, column, value in ((1, 4, 0.6), (2, 1, -0.4), (5, 2, 0.3)):
        correlation[row, column] = correlation[column, row] = value
    covariance = correlation * np.outer(sizes, sizes)
    one = study(
        delivery={
            "latitude_deg": 0.0, "longitude_deg": 0.0,
            "release": {"position": [high, 0.0, 0.0], "velocity": [-DOWN, 0.0, 0.0], "covariance": covariance.tolist()},
        },
        site={"body": str(ball), "mass": MASS, "spin_period": 1e12, "partner": True},
    )  # fmt: skip
    uniforms = np.random.default_rng(3).random((count, 6))
    found = Descents.flown(Site(one), 0, uniforms)
    assert found.touches_down.all()
    on_ground = RADIUS * np.arctan2(found.flights.position[:, 1:], found.flights.position[:, :1])
    gain = np.zeros((2, 6))
    gain[0, 1] = gain[1, 2] = RADIUS / high + RADIUS * integral * DOWN
    gain[0, 4] = gain[1, 5] = RADIUS * high * integral
    # The same landers one by one, then all of them as a sample.
    off = spread(one.delivery.release, np.array([0.0, 0.0, 1.0]), ndtri(uniforms))
    assert np.abs(on_ground - off @ gain.T).max() < 0.01 * np.abs(on_ground).max()
    expected = gain @ covariance @ gain.T
    normal = on_ground @ np.linalg.inv(np.linalg.cholesky(expected)).T
    # Variances of so many normal numbers scatter by sqrt(2 / count), their products by sqrt(1 / count): four times.
    assert np.abs(np.cov(normal.T) - np.eye(2)).max() < 4.0 * math.sqrt(2.0 / count)


def test_the_root_of_a_covariance_gives_it_back() -> None:
    factor = np.random.default_rng(2).standard_normal((6, 4)) * np.array([[30.0]] * 3 + [[0.007]] * 3)
    covariance = factor @ factor.T
    release = ReleaseSection(position=POSITION, velocity=VELOCITY, covariance=covariance.tolist())
    root = spread_root(release, np.array([0.0, 0.0, 1.0]))
    scale = np.sqrt(np.diag(covariance))
    assert np.abs(root @ root.T - covariance) / np.outer(scale, scale) == pytest.approx(0.0, abs=1e-12)


def test_standard_deviations_are_up_north_and_east() -> None:
    release = ReleaseSection(
        position=[0.0, 200.0, 0.0], velocity=[0.0, 0.0, 0.0], position_std=[1.0, 2.0, 3.0], velocity_std=0.01
    )
    root = spread_root(release, np.array([0.0, 0.0, 1.0]))
    # At 90 deg east: up is y, north is z, east is -x.
    assert np.diag(root @ root.T) == pytest.approx([9.0, 1.0, 4.0, 1e-4, 1e-4, 1e-4])


def test_axes_of_icrf_go_through_pole_and_meridian() -> None:
    site = SiteSection(**POLE)
    time = np.array([0.0, 0.25 * SPIN_PERIOD, 7.0])
    found = icrf_to_body(site, time, np.full(3, SPIN_PERIOD))
    for rotation, seconds in zip(found, time, strict=True):
        angle = POLE["meridian_deg"] + 360.0 * seconds / SPIN_PERIOD
        right_ascension, declination = POLE["pole_right_ascension_deg"], POLE["pole_declination_deg"]
        # The usual three turns of the frame: about z, x, z.
        turns = [90.0 + right_ascension, 90.0 - declination, angle]
        assert rotation == pytest.approx(Rotation.from_euler("ZXZ", turns, degrees=True).inv().as_matrix(), abs=1e-12)


def to_icrf(table: np.ndarray) -> np.ndarray:
    """Body-fixed states [count, 7] in ICRF."""
    time, place, velocity = table[:, 0], table[:, 1:4], table[:, 4:]
    period = np.full(len(time), SPIN_PERIOD)
    back = np.transpose(icrf_to_body(SiteSection(**POLE), time, period), (0, 2, 1))
    inertial = 2.0 * velocity - against_ground(place, velocity, period)
    return np.column_stack([time, turned(back, place), turned(back, inertial)])


def test_icrf_and_body_fixed_give_the_same_touchdown(tmp_path: Path) -> None:
    fixed = write_table(tmp_path / "fixed.csv", some_states(), TITLES)
    icrf = write_table(tmp_path / "icrf.csv", to_icrf(some_states()), TITLES)
    one = DrawnDesign(study(delivery={"states": fixed})).descents
    other = DrawnDesign(study(delivery={"states": icrf, "frame": "icrf", "epoch": EPOCH}, site=POLE)).descents
    assert one.touches_down.all()
    # Positions of 140 m lose some digits on the way.
    assert np.abs(one.flights.position - other.flights.position).max() < 1e-8
    assert np.abs(one.flights.time - other.flights.time).max() < 1e-6
    assert one.flights.impact_speed == pytest.approx(other.flights.impact_speed, rel=1e-9)


def test_a_message_of_two_segments_gives_the_touchdowns_of_the_table(tmp_path: Path) -> None:
    states = some_states()
    table = write_table(tmp_path / "states.csv", states, TITLES)
    path = tmp_path / "states.oem"
    path.write_text(message(states[:3]) + message(states[3:], head=""))
    by_table = DrawnDesign(study(delivery={"states": table})).descents
    by_message = DrawnDesign(study(delivery={"states": str(path), "epoch": EPOCH})).descents
    assert np.abs(by_table.flights.position - by_message.flights.position).max() < 1e-9
    assert by_table.clock == pytest.approx(by_message.clock)
    # Without an epoch the earliest state is at 0, as it is here.
    alike = DrawnDesign(study(delivery={"states": str(path)})).descents
    assert (alike.flights.position == by_message.flights.position).all()


HEAD = "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2027-01-01T00:00:00\nORIGINATOR = TOOL\n\n"


def message(states: np.ndarray, frame: str = "DIMORPHOS_FIXED", centre: str = "DIMORPHOS", head: str = HEAD) -> str:
    lines = [f"2027-04-20T12:{int(row[0]) // 60:02d}:{row[0] % 60.0:09.6f} " for row in states]
    numbers = [" ".join(f"{1e-3 * value:.17g}" for value in row[1:]) for row in states]
    meta = (
        f"META_START\nOBJECT_NAME = CUBESAT\nOBJECT_ID = 1\nCENTER_NAME = {centre}\nREF_FRAME = {frame}\n"
        f"TIME_SYSTEM = UTC\nSTART_TIME = {EPOCH}\nSTOP_TIME = {EPOCH}\nMETA_STOP\n"
    )
    rows = "\n".join(line + row for line, row in zip(lines, numbers, strict=True))
    return f"{head}{meta}COMMENT one state a lander\n{rows}\nCOVARIANCE_START\nEPOCH = {EPOCH}\n1.0\nCOVARIANCE_STOP\n"


def test_states_of_a_message_know_their_line_and_segment(tmp_path: Path) -> None:
    found = list(message_states(tmp_path / "a.oem", message(some_states(2))))
    assert [state.line for state in found] == [15, 16]
    assert (found[0].segment["REF_FRAME"], found[1].epoch.text(0)[-2:]) == ("DIMORPHOS_FIXED", "40")
    by_day = message(some_states(1)).replace("2027-04-20T12:00:00.", "2027-110T12:00:00.")
    assert next(message_states(tmp_path / "a.oem", by_day)).epoch == found[0].epoch


def test_an_attitude_turns_on_until_the_touchdown(tmp_path: Path) -> None:
    """About an axis of inertia, at the rate of the body: it does not turn against the ground."""
    turn = Rotation.from_euler("xyz", [20.0, -30.0, 40.0], degrees=True)
    quaternions = np.roll(turn.as_quat(), 1)
    # About z of the frame, in the axes of the lander; a cube, which any axis is one of.
    rates = turn.inv().apply([0.0, 0.0, 2.0 * math.pi / SPIN_PERIOD])
    table = np.column_stack([some_states(), np.tile([*quaternions, *rates], (8, 1))])
    titles = f"{TITLES},q_w,q_x,q_y,q_z,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s"
    path = write_table(tmp_path / "states.csv", table, titles)
    design = DrawnDesign(study(delivery={"states": path}, lander={"edges": [0.1, 0.1, 0.1]}))
    for row, axes in zip(design.rows, design.descents.axes, strict=True):
        azimuth = math.radians(row["impact.azimuth_deg"])
        into_bed = Rotation.from_rotvec([0.0, 0.0, azimuth]) * Rotation.from_matrix(axes)
        given = [row[f"impact.orientation.{part}"] for part in "xyzw"]
        assert (Rotation.from_quat(given) * (into_bed * turn).inv()).magnitude() < 1e-7
        assert [row[f"impact.spin_{axis}"] for axis in "xyz"] == pytest.approx([0.0] * 3, abs=1e-12)


def test_a_spin_of_a_lander_is_told_in_the_frame_of_its_bed(tmp_path: Path) -> None:
    turn, rates = Rotation.from_euler("xyz", [20.0, -30.0, 40.0], degrees=True), np.array([0.01, 0.02, -0.005])
    quaternion = np.roll(turn.as_quat(), 1)
    table = np.column_stack([some_states(), np.tile([*quaternion, *rates], (8, 1))])
    titles = f"{TITLES},q_w,q_x,q_y,q_z,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s"
    design = DrawnDesign(study(delivery={"states": write_table(tmp_path / "states.csv", table, titles)}))
    time = float(design.descents.flights.time[0])
    edges, mass = TABLES["lander"]["edges"], TABLES["lander"]["mass"]
    inertia = np.diag([mass / 12.0 * (sum(edge**2 for edge in edges) - own**2) for own in edges])
    _, after = tumble(inertia, quaternion[None], turn.apply(rates)[None], np.array([time]))
    against = after[0] - [0.0, 0.0, 2.0 * math.pi / SPIN_PERIOD]
    # Its size against the ground is the same in every frame that turns with the ground.
    back = Rotation.from_rotvec([0.0, 0.0, -2.0 * math.pi / SPIN_PERIOD * time]).apply(after[0])
    against = back - [0.0, 0.0, 2.0 * math.pi / SPIN_PERIOD]
    row = design.rows[0]
    assert np.linalg.norm([row[f"impact.spin_{axis}"] for axis in "xyz"]) == pytest.approx(np.linalg.norm(against))
    assert row["impact.spin_z"] == pytest.approx(float(design.descents.axes[0, 2] @ against))


def test_landers_that_never_touch_down_are_no_runs(tmp_path: Path) -> None:
    states = some_states()
    states[[0, 5], 4:] *= -20.0
    path = write_table(tmp_path / "states.csv", states, TITLES)
    design = DrawnDesign(study(delivery={"states": path}))
    assert np.flatnonzero(~design.descents.touches_down).tolist() == [0, 5]
    assert [row["journey"] for row in design.rows] == [1.0, 2.0, 3.0, 4.0, 6.0, 7.0]
    assert design.shown_row == design.rows[0]
    assert (design.descents.flights.status[[0, 5]] == FlightStatus.ESCAPED).all()
    with pytest.raises(ValueError, match="lander 6 of the study never touches down"):
        design.row(5)
    states[:, 4:] = np.abs(states[:, 4:]) * 20.0
    write_table(tmp_path / "states.csv", states, TITLES)
    with pytest.raises(StudyError, match="none of 8 landers reaches the ground"):
        _ = DrawnDesign(study(delivery={"states": path})).rows


def test_a_state_below_the_ground_is_refused_with_its_line(tmp_path: Path) -> None:
    states = some_states()
    states[3, 1:4] = [0.0, 60.0, 0.0]
    path = write_table(tmp_path / "states.csv", states, TITLES)
    with pytest.raises(StudyError, match=r"states\.csv, line 5 lies .* m below the ground; allowed"):
        _ = DrawnDesign(study(delivery={"states": path})).descents
    with pytest.raises(StudyError, match=r"delivery\.release: the release of journey 0 lies"):
        _ = DrawnDesign(study(delivery=released(position=[0.0, 60.0, 0.0]))).descents


def test_states_along_one_path_are_warned_of_in_plan_and_run(tmp_path: Path) -> None:
    """A fall at constant speed: eight states a second apart."""
    fall = np.column_stack([np.arange(8.0), np.array([*POSITION, *VELOCITY]) + np.zeros((8, 6))])
    fall[:, 1:4] += fall[:, :1] * VELOCITY
    design = DrawnDesign(study(delivery={"states": write_table(tmp_path / "states.csv", fall, TITLES)}))
    (words,) = design.site.cautions
    assert "The 8 states of delivery.states lie on one path (states.csv, line 2 to states.csv, line 9)" in words
    assert words in study_warnings(design, None)
    assert design.site.remarks[0] == words
    assert Site(study(delivery={"states": write_table(tmp_path / "other.csv", some_states(), TITLES)})).cautions == ()


def test_a_state_within_the_partner_is_refused_with_its_line(tmp_path: Path) -> None:
    """Didymos stands 1157 m from Dimorphos, over longitude 0, and reaches 425 m."""
    states = some_states()
    states[2, 1:4] = [1180.0, 0.0, 0.0]
    path = write_table(tmp_path / "states.csv", states, TITLES)
    with pytest.raises(StudyError, match=r"states\.csv, line 4 lies 30\d m below the surface of didymos; allowed"):
        _ = DrawnDesign(study(delivery={"states": path}, site={"partner": True})).descents


def test_a_lander_that_falls_on_the_partner_touches_down_there(tmp_path: Path) -> None:
    """From rest between both bodies, on the side of Didymos; gravity and spin of the touchdown are those there."""
    states = some_states()
    states[3, 1:] = [600.0, 20.0, 150.0, 0.0, 0.0, 0.0]
    path = write_table(tmp_path / "states.csv", states, TITLES)
    design = DrawnDesign(study(delivery={"states": path}, site={"partner": True}))
    descents, body = design.descents, didymos(partner=False)
    assert descents.ground.tolist() == [0, 0, 0, 1, 0, 0, 0, 0]
    assert descents.touches_down.all()
    assert "8 of 8 landers reach the ground" in descents_in_words(descents)
    assert ", 1 of them on Didymos" in descents_in_words(descents)
    place, axes = descents.position[3], descents.axes[3]
    height, facet = body.shape.nearest(place)
    assert abs(height) < 1e-6
    assert axes[2] == pytest.approx(body.shape.normals[facet], abs=1e-12)
    row = design.rows[3]
    felt = body.effective_acceleration(place)
    # The tide of Dimorphos, and the ground of the bed that is no steeper than its soil lies.
    sign = -1.0 if axes[2] @ felt > 0.0 else 1.0
    assert row["surface.gravity"] == pytest.approx(sign * np.linalg.norm(felt), rel=1e-3)
    turning = np.linalg.norm([row[f"surface.rotation_{axis}"] for axis in "xyz"])
    assert turning == pytest.approx(2.0 * math.pi / body.spin_period, rel=1e-12)
    assert row["impact.speed"] == pytest.approx(descents.flights.impact_speed[3])
    assert 0.1 < row["impact.speed"] < 0.6


def test_a_lander_too_fast_for_any_contact_is_refused() -> None:
    said = r"study\.toml: delivery\.release: the release of journey \d comes down at 20 m/s .*lower its velocity"
    with pytest.raises(StudyError, match=said):
        _ = DrawnDesign(study(delivery=released(velocity=[0.0, -20.0, 0.0]))).descents


@pytest.mark.parametrize(("rate", "words"), [
    (1e300, r'rate_z is "1.*e\+300"; allowed: a finite number, at most 1000 rad/s in size'),
    (1e3, "its rates are 1000 rad/s, .*m deep"),
])  # fmt: skip
def test_rates_that_no_contact_carries_are_refused_with_their_line(rate: float, words: str, tmp_path: Path) -> None:
    table = np.hstack([some_states(3), np.tile([1.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0], (3, 1))])
    table[1, -1] = rate
    titles = f"{TITLES},q_w,q_x,q_y,q_z,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s"
    path = write_table(tmp_path / "states.csv", table, titles)
    with pytest.raises(StudyError, match=rf"states\.csv, line 3: {words}"):
        _ = DrawnDesign(study(delivery={"states": path}, journey={"count": 3}))._descents(0, np.full((3, 6), 0.5))


QUICK: dict[str, Any] = tomllib.loads(template()) | {"design": {}, "journey": {"touchdowns": 1}}
SOIL = ("grain.young_modulus", "grain.friction", "lander.restitution")
ARRIVAL = ("bed", *PLACE, "impact.azimuth_deg", *ORIENTATION)
REGION = {"x": [-0.1, 0.05], "y": [0.0, 0.02]}


def drawn(run_count: int = 240, seed: int = 1, **changes: dict[str, Any]) -> Study:
    """The template with so many runs out of the sequence, and with other keys in its tables."""
    tables = QUICK | {name: {**QUICK.get(name, {}), **keys} for name, keys in changes.items()}
    tables["design"], tables["monte_carlo"] = {**tables["design"], "run_count": run_count}, {"sample_count": 0}
    return check_tables(tables | {"seed": seed}, Path())


def columns(rows: list[dict[str, float]], *names: str) -> np.ndarray:
    return np.array([[row[name] for name in names] for row in rows])


@pytest.mark.parametrize(("few", "many"), [(2, 13), (12, 144), (115, 240), (240, 241), (599, 1200)])
@pytest.mark.parametrize("beds", [{}, {"bed": {"bed_count": 2}}], ids=["beds grow", "two beds"])
def test_more_runs_leave_every_run_its_bed_and_its_key(few: int, many: int, beds: dict[str, dict[str, Any]]) -> None:
    first, second = drawn(few, **beds), drawn(many, **beds)
    before, after = DrawnDesign(first).rows, DrawnDesign(second).rows
    assert (len(before), len(after)) == (few, many)
    assert before == after[:few]
    assert touchdown_keys(first, before, 0) == touchdown_keys(second, after[:few], 0)
    assert set(bed_files(first)) <= set(bed_files(second))
    # A bed is poured from the same seed, however many there are.
    assert stage_keys(first)["bed"] == stage_keys(second)["bed"]
    assert stage_keys(first)["runs"] != stage_keys(second)["runs"]


@pytest.mark.parametrize("beds", [1, 5, 12, 24, 60])
def test_beds_that_are_given_have_equally_many_runs(beds: int) -> None:
    for run_count in (max(beds, 2), 60, 120, 143, 240):
        counts = Counter(beds_of_runs(drawn(run_count, bed={"bed_count": beds}), run_count))
        assert len(counts) == beds
        assert max(counts.values()) - min(counts.values()) <= 1


def test_beds_that_grow_with_the_runs_are_all_used_and_full_at_each_twenty() -> None:
    study = drawn(240)
    # All at which beds begin to grow, some of those behind them, and those that fill the beds.
    for run_count in (*range(2, 300), *range(307, 800, 31), *range(300, 800, LANDINGS_A_BED)):
        counts = Counter(beds_of_runs(study, run_count))
        assert set(counts) == set(range(default_bed_count(run_count, LANDINGS_A_BED)))
        # The newest bed fills next, and only where one has yet to be filled are the others ahead of it.
        *filled, newest = (counts[bed] for bed in range(len(counts)))
        assert max(filled) - min(filled) <= 1
        assert newest <= max(filled) or max(counts.values()) - min(counts.values()) <= 1
        if run_count % LANDINGS_A_BED == 0 and run_count >= 12 * LANDINGS_A_BED:
            assert set(counts.values()) == {LANDINGS_A_BED}


def test_blocks_of_beds_have_an_order_of_their_own_that_the_seed_decides() -> None:
    first, other = (np.array(beds_of_runs(drawn(96, seed), 96)).reshape(8, 12) for seed in (1, 2))
    assert first[0].tolist() == list(range(12))
    assert len({tuple(block) for block in first.tolist()}) == 8
    assert not np.array_equal(first[1:], other[1:])


def test_every_coordinate_is_spread_evenly_over_its_law() -> None:
    study = drawn(256, impact={"region": REGION})
    rows = DrawnDesign(study).rows
    names = (*SOIL, *PLACE, "impact.azimuth_deg")
    laws = [study.grain.young_modulus, study.grain.friction, study.lander.restitution]
    probability = [law.to_chaos().cdf(columns(rows, name)[:, 0]) for law, name in zip(laws, names, strict=False)]
    probability += [(columns(rows, PLACE[0])[:, 0] + 0.1) / 0.15, columns(rows, PLACE[1])[:, 0] / 0.02]
    probability += [columns(rows, "impact.azimuth_deg")[:, 0] / 360.0]
    for one in probability:
        # 256 points of a Sobol sequence: exactly one in each of 256 equal parts.
        assert np.array_equal(np.sort(np.floor(one * 256)), np.arange(256))
    assert np.abs(np.corrcoef(probability) - np.eye(len(names))).max() < 0.1
    attitudes = columns(rows, *ORIENTATION)
    assert np.linalg.norm(attitudes, axis=1) == pytest.approx(1.0, abs=1e-12)
    assert np.abs(attitudes.T @ attitudes / 256 - np.eye(4) / 4).max() < 0.03


def test_what_is_given_is_not_drawn_and_leaves_the_rest_as_it_was() -> None:
    free = DrawnDesign(drawn(40, impact={"region": REGION})).rows
    held = {"azimuth_deg": 30.0, "place": {"x": 0.01, "y": 0.02}, "orientation": [2, 0, 0, 0]}
    rows = DrawnDesign(drawn(40, impact=held)).rows
    assert np.array_equal(columns(free, "bed", *SOIL), columns(rows, "bed", *SOIL))
    assert np.array_equal(columns(rows, *ARRIVAL[1:]), np.tile([0.01, 0.02, 30.0, 1.0, 0.0, 0.0, 0.0], (40, 1)))


def test_an_uncertain_place_or_azimuth_is_an_input_like_any_other() -> None:
    rows = DrawnDesign(drawn(64, impact={"azimuth_deg": {"distribution": "uniform", "lower": 0.0, "upper": 10.0}})).rows
    assert np.array_equal(np.sort(np.floor(columns(rows, "impact.azimuth_deg")[:, 0] * 6.4)), np.arange(64))


def test_an_error_of_pointing_tilts_each_run_within_its_cone() -> None:
    rows = DrawnDesign(drawn(64, impact={"orientation": [1, 0, 0, 0], "pointing_error_deg": 10.0})).rows
    assert 9.0 < np.degrees(2.0 * np.arccos(columns(rows, ORIENTATION[0])[:, 0])).max() <= 10.0
    assert np.all(columns(rows, ORIENTATION[3]) == 0.0)


def test_the_papers_runs_take_an_error_of_pointing_too() -> None:
    arrival = {"orientation": [1, 0, 0, 0], "pointing_error_deg": 10.0}
    study = check_tables(QUICK | {"impact": {**QUICK["impact"], **arrival}}, Path())
    draws = [draw(study, study.touchdown_medians(), seed, None) for seed in range(50)]
    assert 8.0 < np.degrees(2.0 * np.arccos(columns(draws, ORIENTATION[0])[:, 0])).max() <= 10.0
    # The error is drawn after all else, which is as it was without it.
    given = {**QUICK["impact"], "orientation": [1, 0, 0, 0]}
    without = check_tables(QUICK | {"impact": given}, Path())
    before, no_attitude = draw(without, without.touchdown_medians(), 3, None), dict.fromkeys(ORIENTATION, 0.0)
    assert before | no_attitude == draws[3] | no_attitude


def test_places_are_drawn_where_the_smallest_bed_leaves_room() -> None:
    study = drawn(64, bed={"width": [0.8, 1.0], "grain_count": 400, "sides": "walls"})
    region, width = place_region(study), smallest_width(study)
    assert region == ((-0.5 * (0.8 - width), 0.5 * (0.8 - width)), (-0.5 * (1.0 - width), 0.5 * (1.0 - width)))
    places = columns(DrawnDesign(study).rows, *PLACE)
    assert np.all(np.abs(places) <= [region[0][1], region[1][1]])
    # Half of 64 parts of the way to each end.
    assert np.all(np.abs(places).max(axis=0) > 0.9 * np.array([region[0][1], region[1][1]]))


def test_places_are_drawn_all_over_ground_that_repeats() -> None:
    study = drawn(64, bed={"width": [0.8, 1.0], "grain_count": 400})
    assert place_region(study) == ((-0.4, 0.4), (-0.5, 0.5))
    assert np.all(np.abs(columns(DrawnDesign(study).rows, *PLACE)).max(axis=0) > 0.9 * np.array([0.4, 0.5]))


def test_a_bed_that_is_too_narrow_for_its_rule_is_landed_on_in_the_middle() -> None:
    # A heavy little ball is long in touch with a grain, and a wave goes far in that time.
    ball = {"shape": "sphere", "diameter": 0.05, "mass": 50.0, "restitution": QUICK["lander"]["restitution"]}
    narrow = {**QUICK["bed"], "width": [0.25, 2.0], "sides": "walls"}
    study = check_tables(QUICK | {"lander": ball, "bed": narrow}, Path())
    assert 0.25 < smallest_width(study) < 2.0
    along, across = place_region(study) or ()
    assert along == (0.0, 0.0)
    assert across[0] < 0.0 < across[1]


def test_two_seeds_share_no_pour_and_one_seed_repeats_its_own() -> None:
    few, many = ([drawn(*count, seed=seed) for seed in range(40)] for count in ((), (700,)))
    seeds = {(seed, bed): pour_seed(few[seed], bed) for seed in range(40) for bed in range(60)}
    assert len(set(seeds.values())) == len(seeds)
    assert seeds == {(seed, bed): pour_seed(many[seed], bed) for seed, bed in seeds}
    assert all(0 <= seed < 2**53 for seed in seeds.values())


@pytest.mark.parametrize("path", ["scenarios/paper.toml", "showcase/paper/study.toml", "scenarios/one_place.toml"])
def test_the_beds_of_the_papers_studies_are_those_of_their_committed_landings(path: str) -> None:
    study = read_study(Path(__file__).parents[3] / path)
    assert pour_seed(study, 0) == hashed_seed(study.seed, "bed", 0)
    assert study.bed_count == 1


def test_a_study_may_give_the_seed_of_its_first_bed() -> None:
    study = drawn(bed={"seed": 7})
    assert [pour_seed(study, bed) for bed in range(3)] == [7, 8, 9]
    assert pour_seed(drawn(seed=5, bed={"seed": 7}), 0) == 7
    assert bed_dependencies(study)["seed"] == 7
    assert bed_setting(study) == bed_setting(drawn())


def test_soil_pairs_have_another_soil_and_arrive_alike() -> None:
    study = drawn(50)
    rows, pairs = DrawnDesign(study).rows, DrawnDesign(study).rows_of("soil_pairs")
    assert len(pairs) == 20
    assert np.array_equal(columns(rows[:20], *ARRIVAL), columns(pairs, *ARRIVAL))
    assert np.all(columns(rows[:20], *SOIL) != columns(pairs, *SOIL))
    assert len(DrawnDesign(drawn(7)).rows_of("soil_pairs")) == 7
    assert DrawnDesign(drawn(500)).rows_of("soil_pairs") == pairs


def test_twins_come_down_a_little_beside_and_nothing_else_differs() -> None:
    study = drawn(50, design={"side_runs": True, "twin_shift": 2e-4})
    rows, pairs = DrawnDesign(study).rows[:12], DrawnDesign(study).rows_of("twins")
    assert len(pairs) == 12
    shift = columns(pairs, *PLACE) - columns(rows, *PLACE)
    assert np.linalg.norm(shift, axis=1) == pytest.approx(2e-4)
    # In all directions, but for those toward a wall.
    assert len(np.unique(np.round(np.arctan2(shift[:, 1], shift[:, 0]), 6))) == 12
    assert np.all((shift * columns(rows, *PLACE)).sum(axis=1) <= 0.0)
    names = [name for name in rows[0] if name not in PLACE]
    assert np.array_equal(columns(rows, *names), columns(pairs, *names))


def study_of(text: str) -> Study:
    return check_tables(tomllib.loads(text), Path())


BOX = study_of(STUDY)
PRISM = study_of(STUDY.replace("[0.12, 0.1, 0.08]", "[0.08, 0.14, 0.08]"))
BALL = study_of(STUDY.replace('"box", edges = [0.12, 0.1, 0.08]', '"sphere", diameter = 0.1'))


def test_terms_follow_the_shape_and_a_ball_has_none() -> None:
    assert [attitude_terms(one).names for one in (BOX, PRISM)] == [("x", "z"), ("y",)]
    assert attitude_terms(BALL) is None
    assert independent_terms(DrawnDesign(BALL), {}) is None


def attitude_columns(turned: Rotation) -> dict[str, np.ndarray]:
    """Inputs of touchdowns of these attitudes in the bed."""
    quaternions = np.roll(turned.as_quat(), 1, axis=1)
    return dict(zip(ORIENTATION, quaternions.T, strict=True)) | {"impact.azimuth_deg": np.zeros(len(quaternions))}


def test_drawn_attitudes_have_independent_terms() -> None:
    found = independent_terms(DrawnDesign(BOX), attitude_columns(Rotation.random(20_000, rng=0)))
    assert found.mean(axis=0) == pytest.approx(np.zeros(6), abs=0.03)
    assert np.cov(found.T) == pytest.approx(np.eye(6), abs=0.04)


def test_one_attitude_has_no_terms_and_a_pointed_one_has_those_of_its_cone() -> None:
    one = study_of(STUDY.replace("[delivery]", "[delivery]\norientation = [1.0, 0.0, 0.0, 0.0]"))
    assert independent_terms(DrawnDesign(one), attitude_columns(Rotation.identity(20))) is None
    tilts = 0.1 * np.random.default_rng(1).standard_normal((400, 3))
    found = independent_terms(DrawnDesign(one), attitude_columns(Rotation.from_rotvec(tilts)))
    # Over the runs themselves they are exactly independent, however small the cone.
    assert found.mean(axis=0) == pytest.approx(np.zeros(found.shape[1]), abs=1e-9)
    assert found.T @ found / 400 == pytest.approx(np.eye(found.shape[1]), abs=1e-6)


def test_the_side_is_that_of_the_axis_nearest_to_the_normal() -> None:
    normal = np.array([[0.9, 0.3, -0.3], [-0.2, 0.8, 0.5], [0.1, 0.2, -0.9]])
    assert sides_down(BOX.lander, normal).tolist() == ["x", "y", "z"]
    assert sides_down(PRISM.lander, normal).tolist() == ["x or z", "y", "x or z"]
    assert sides_down(BALL.lander, normal).tolist() == ["", "", ""]
    assert side_words(BOX.lander, "z") == "z, 0.12 m x 0.1 m"
    assert side_words(PRISM.lander, "x or z") == "x or z, 0.14 m x 0.08 m"


@pytest.mark.parametrize("study", [BOX, PRISM])
def test_a_chosen_side_is_down_whatever_the_azimuth(study: Study) -> None:
    random = np.random.default_rng(2)
    for side, downs in directions_of_sides(study.lander).items():
        down, azimuth = np.array(downs)[random.integers(len(downs), size=40)], 360.0 * random.random(40)
        turned = with_side_down(down, azimuth, random.random(40))
        normal, travel = seen(dict(zip(ORIENTATION, turned.T, strict=True)) | {"impact.azimuth_deg": azimuth})
        assert normal == pytest.approx(-down, abs=1e-12)
        assert set(sides_down(study.lander, normal)) == {side}
        # It comes from all sides.
        assert np.linalg.norm(travel.mean(axis=0)) < 0.35
