"""Journeys on real soil: times, places, attitudes and spins go over from a touchdown to its flight and on to the next.

What goes over is worked out anew from the tables of the study: frames from the normal of the ground and the velocity
that comes in, rotations by an integrator.
"""

import math
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import lithobrake
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_run import run_study
from lithobrake.results import StudyResults
from lithobrake.smallbody import Body, Flights, fly
from lithobrake.study import StudySource, read_study

from .soil_journeys import EDGES, STUDY

TABLES = ("journeys.csv", "touchdowns.csv", "arcs.csv")
Row = dict[str, Any]


class Step(NamedTuple):
    """A touchdown, the flight after it, and the touchdown at the end of that; rows of their tables."""

    before: Row
    arc: Row
    after: Row


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    folder = tmp_path_factory.mktemp("soil")
    changed = (
        STUDY.replace("seed = 4", "seed = 5")
        .replace("emulated_count = 40", "emulated_count = 0")
        .replace("count = 6,", "count = 4,")
    )
    (folder / "soil.toml").write_text(changed)
    return lithobrake.run(folder / "soil.toml", folder / "out", workers=1, report=False)


@pytest.fixture(scope="module")
def body(study: StudyResults) -> Body:
    return Site(read_study(study.folder / "study.toml")).body


def arcs(study: StudyResults) -> list[Row]:
    table = np.genfromtxt(study.folder / "arcs.csv", delimiter=",", names=True, deletechars="")
    # A title is the name and, in brackets, the unit.
    titles = [name.split("_[")[0] for name in table.dtype.names]
    return [dict(zip(titles, map(float, row), strict=True)) for row in table.tolist()]


def rows(table: Any) -> list[Row]:
    return [{name: table[name][row] for name in table} for row in range(table.row_count)]


def steps(study: StudyResults) -> Iterator[Step]:
    touchdowns = {(row["journey"], row["touchdown"]): row for row in rows(study.touchdowns)}
    for arc in arcs(study):
        journey, number = arc["sample"], arc["arc"]
        if (journey, number + 1) in touchdowns:
            yield Step(touchdowns[journey, number], arc, touchdowns[journey, number + 1])


def vector(row: Row, name: str) -> np.ndarray:
    return np.array([row[f"{name}_{axis}"] for axis in "xyz"])


def flown(study: StudyResults, body: Body, arc: Row) -> Flights:
    gravity = read_study(study.folder / "study.toml").flight.gravity
    start = vector(arc, "position"), vector(arc, "velocity")
    return fly(body, *start, 1e5, gravity=gravity, start_time=arc["clock_s"], threads=1)


def place(body: Body, row: Row) -> np.ndarray:
    """The place on the ground of a touchdown [m]."""
    return body.shape.surface_point(row["latitude_deg"], row["longitude_deg"])


def normal(body: Body, point: np.ndarray) -> np.ndarray:
    """Outward normal of the nearest facet, [3]."""
    facet: np.ndarray = body.shape.nearest(point)[1]
    return np.asarray(body.shape.normals[int(facet)])


def test_the_same_seed_gives_the_same_bits(study: StudyResults, tmp_path: Path) -> None:
    again = tmp_path / "again"
    shutil.copytree(study.folder, again)
    for name in (*TABLES, *(path.name for path in again.glob("runs.sqlite*"))):
        (again / name).unlink()
    # The first two of the four journeys, of which the others change nothing.
    text = (study.folder / "study.toml").read_text(encoding="utf-8")
    for path in (tmp_path / "two.toml", again / "study.toml"):
        path.write_text(text.replace("count = 4,", "count = 2,"), encoding="utf-8")
    run_study(StudySource.read(tmp_path / "two.toml"), again, until="runs", worker_count=1)
    for name in TABLES:
        found, known = ((folder / name).read_bytes().splitlines() for folder in (again, study.folder))
        assert 2 < len(found) < len(known)
        assert found == known[: len(found)], name


def test_every_journey_ends_and_most_fly_between_touchdowns(study: StudyResults) -> None:
    # A lander that leaves fast may hit the partner, or leave for good: which does, chance decides.
    at_rest = study.journeys["end"] == "at_rest"
    assert at_rest.sum() >= 3
    assert study.touchdowns.row_count >= 8
    last = [row for row in rows(study.touchdowns) if row["outcome"] == "captured"]
    assert [row["journey"] for row in last] == study.journeys["journey"][at_rest].tolist()


def test_times_add_up(study: StudyResults, body: Body) -> None:
    for row in rows(study.touchdowns):
        assert row["end_s"] - row["begin_s"] == pytest.approx(row["duration"], abs=1e-9)
    count = 0
    for before, arc, after in steps(study):
        assert arc["begin_s"] == before["end_s"]
        assert after["begin_s"] == pytest.approx(before["end_s"] + flown(study, body, arc).time[0], abs=1e-9)
        count += 1
    # No touchdown but the first of each journey is without a flight before it.
    assert count == study.touchdowns.row_count - 4
    times = dict(zip(study.journeys["journey"], study.journeys["time_s"], strict=True))
    assert all(row["end_s"] == times[row["journey"]] for row in rows(study.touchdowns) if row["outcome"] == "captured")


def test_places_follow_from_one_another(study: StudyResults, body: Body) -> None:
    for before, arc, after in steps(study):
        moved = vector(arc, "position") - place(body, before)
        displacement, rise = math.hypot(before["displacement_x"], before["displacement_y"]), before["displacement_z"]
        # A flight begins where the centre of mass is, and one that has sunk on the ground.
        assert body.shape.height(vector(arc, "position")) == pytest.approx(max(rise, 0.0), abs=1e-4)
        moved -= max(rise, 0.0) * normal(body, vector(arc, "position"))
        # The displacement lies in the plane of a facet, and bends where it crosses an edge.
        assert 0.95 * displacement - 1e-6 < np.linalg.norm(moved) < 1.05 * displacement + 1e-6
        assert flown(study, body, arc).position[0] == pytest.approx(place(body, after), abs=1e-6)


def test_the_tilt_at_rest_is_that_of_the_attitude_against_the_plumb_line(study: StudyResults, body: Body) -> None:
    ends = {row["journey"]: row for row in rows(study.touchdowns) if row["outcome"] == "captured"}
    assert ends
    for number, last in ends.items():
        journey = rows(study.journeys)[int(number)]
        slope = math.radians(last["surface.slope_deg"])
        downhill = math.radians(last["surface.slope_azimuth_deg"] - last["impact.azimuth_deg"])
        down = np.array([math.sin(slope) * math.cos(downhill), math.sin(slope) * math.sin(downhill), -math.cos(slope)])
        in_lander = matrix([last[f"orientation_out_{axis}"] for axis in "wxyz"]).T @ down
        side, axis = str(journey["face"]), "xyz".index(str(journey["face"])[1])
        down_side = in_lander[axis] * (-1.0 if side[0] == "-" else 1.0)
        # The inputs have the plumb line of the impact, and a lander that moves takes it along the curved ground.
        moved = math.hypot(last["displacement_x"], last["displacement_y"])
        turned = 2.0 * moved / np.linalg.norm(place(body, last))
        assert down_side >= np.abs(in_lander).max() - 2.0 * turned
        assert journey["tilt_deg"] == pytest.approx(math.degrees(math.acos(down_side)), abs=math.degrees(turned))


def matrix(quaternion: Any) -> np.ndarray:
    """The rotation matrix of a quaternion w, x, y, z."""
    w, x, y, z = np.asarray(quaternion) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def about_z(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def frame(body: Body, flight: Flights) -> np.ndarray:
    """Axes of a touchdown, as rows: along the horizontal velocity that comes in, to its left, outward."""
    up = body.shape.normals[flight.facet[0]]
    level = flight.velocity[0] - (flight.velocity[0] @ up) * up
    x = level / np.linalg.norm(level)
    return np.array([x, np.cross(up, x), up])


def risen(body: Body, arc: Row, velocity: np.ndarray, rise: float) -> np.ndarray:
    """Velocity [m/s] of a lander that has come back from below the ground to it, by the work of its weight there."""
    if rise >= 0.0:
        return velocity
    place = vector(arc, "position")
    up = normal(body, place)
    one = (np.array([value]) for value in (arc["clock_s"], body.mass, body.spin_period))
    felt = body.felt(place[None], *one)[0]
    paid = math.sqrt(max((velocity @ up) ** 2 - 2.0 * (felt @ up) * rise, 0.0))
    return velocity + (paid - velocity @ up) * up


def turned(attitude: np.ndarray, spin: np.ndarray, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Attitude [3, 3] and spin [rad/s] of the lander after a time without torque, in axes that do not turn.

    Euler's equations in the axes of a homogeneous box, beside the nine components of the attitude.
    """
    a, b, c = (edge * edge for edge in EDGES)
    # Differences of two moments of inertia over the third.
    share = (c - b) / (b + c), (a - c) / (a + c), (b - a) / (a + b)

    def rate(_: float, state: np.ndarray) -> np.ndarray:
        turn = state[3:].reshape(3, 3)
        x, y, z = state[:3].tolist()
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        return np.concatenate([[share[0] * y * z, share[1] * z * x, share[2] * x * y], (turn @ cross).ravel()])

    start = np.concatenate([attitude.T @ spin, attitude.ravel()])
    end = solve_ivp(rate, (0.0, duration), start, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    turn = end[3:].reshape(3, 3)
    return turn, turn @ end[:3]


def test_attitude_and_spin_at_an_impact_are_those_of_a_flight_without_torque(study: StudyResults, body: Body) -> None:
    rotation = np.array([0.0, 0.0, 2.0 * math.pi / body.spin_period])
    every = {(step.before["journey"], step.before["touchdown"]): step for step in steps(study)}
    checked = 0
    for (journey, number), (before, arc, after) in every.items():
        # Of the first touchdown no flight has the velocity that comes in; long turns would take the integrator seconds.
        if number == 0 or before["spin_out"] * (arc["end_s"] - arc["begin_s"]) > 150.0:
            continue
        axes = frame(body, flown(study, body, every[journey, number - 1].arc))
        left = vector(before, "velocity_out") @ axes
        assert vector(arc, "velocity") == pytest.approx(risen(body, arc, left, before["displacement_z"]), abs=1e-9)
        attitude = axes.T @ matrix([before[f"orientation_out_{axis}"] for axis in "wxyz"])
        flight = flown(study, body, arc)
        time = float(flight.time[0])
        turn, spin = turned(attitude, vector(before, "spin_out") @ axes + rotation, time)
        # Into axes that turn with the body, then into those of the bed, where the velocity comes in by an azimuth.
        back = about_z(-float(rotation[2]) * time)
        into_bed = about_z(math.radians(after["impact.azimuth_deg"])) @ frame(body, flight)
        given = matrix([after[f"impact.orientation.{axis}"] for axis in "wxyz"])
        assert given == pytest.approx(into_bed @ back @ turn, abs=1e-9)
        given_spin = np.array([after[f"impact.spin_{axis}"] for axis in "xyz"])
        assert given_spin == pytest.approx(into_bed @ (back @ spin - rotation), abs=1e-10)
        checked += 1
    assert checked >= 3
