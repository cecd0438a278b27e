"""Journeys that begin with states, a release, correlated draws or a push; and what landers at rest see of the sky."""

import csv
import math
import re
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

import lithobrake
from lithobrake.cli import app
from lithobrake.export import Push, write_push
from lithobrake.geometry.naif_kernels import Reply
from lithobrake.pipeline.commands.status import study_status
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.outdated_files import stage_keys
from lithobrake.pipeline.planning.expected_width import law_before
from lithobrake.pipeline.planning.plan import plan_lines
from lithobrake.pipeline.planning.planner import plan_of
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.pipeline.sky_at_rest import Days, refuse_hidden_orbiter, rows_of, sky_dependencies, where_it_stands
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.pipeline.study_run import run_study
from lithobrake.results import StudyResults
from lithobrake.smallbody import Body, didymos, dimorphos, fly
from lithobrake.smallbody.built_in_bodies import top_shape
from lithobrake.study import Study, StudyError, StudySource, check_tables
from lithobrake.vocabulary.number_words import duration
from lithobrake.vocabulary.quantities import SIDES, SKY

from ...paper_tables import paper_tables, with_keys
from ...smallbody.kernels import write_kernels
from .bouncing_lander import bounce, journey_tables, run_without_emulator

COUNT = 24
# Above the trailing side; of two in a row of ten the speed is away from the ground.
RELEASE = {"position": [5.0, 150.0, 10.0], "velocity": [0.0, -0.03, 0.0], "position_std": 8.0, "velocity_std": 0.003}
TITLES = "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s"
CORRELATIONS = [["north_error", "east_error", 0.6], ["east_error", "speed", -0.5], ["speed", "incidence_deg", 0.4]]


def tables(**changes: dict[str, Any]) -> dict[str, Any]:
    """The tables of a study whose landers are flown to the ground."""
    found = journey_tables(journey={"count": COUNT})
    found["delivery"] = {"latitude_deg": 0.0, "longitude_deg": 90.0, "frame": "body_fixed"}
    return with_keys(found, changes)


def study_of(given: dict[str, Any]) -> Study:
    return with_site_gravity(StudySource.of_tables(given).study)


def write_states(path: Path, away: tuple[int, ...] = ()) -> np.ndarray:
    random = np.random.default_rng(4)
    states = np.column_stack([np.zeros(COUNT), random.normal(0.0, [8.0, 8.0, 8.0, 2e-3, 2e-3, 2e-3], (COUNT, 6))])
    states += [0.0, 5.0, 150.0, 10.0, 0.0, -0.03, 0.0]
    states[list(away), 5] = 0.5
    path.write_text("\n".join([TITLES, *(",".join(f"{one:.17g}" for one in row) for row in states)]) + "\n")
    return states


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> tuple[StudyResults, np.ndarray]:
    """A study of states, of which two fly away, and these."""
    folder = tmp_path_factory.mktemp("flown")
    states = write_states(folder / "states.csv", away=(3, 9))
    run_without_emulator(tables(delivery={"states": str(folder / "states.csv")}), folder / "out", report=True)
    return lithobrake.open_study(folder / "out"), states


@pytest.mark.parametrize("number", [0, 3])
def test_the_words_of_a_journey_count_from_its_delivery(flown: tuple[StudyResults, np.ndarray], number: int) -> None:
    """Lander 3 never touches down, and its table counts from delivery as well."""
    results, _ = flown
    track, begins = results.journey(number).track, results.arcs["begin_s"][results.arcs["sample"] == number]
    descent, time = -begins[0], results.journeys["time_s"][number]
    assert (descent > 60.0) == (number == 0)
    assert [one.begin for one in track.touchdowns][:1] == ([descent] if number == 0 else [])
    assert f"{track.end.label.capitalize()} {duration(descent + time)} after delivery" in track.lines()[-1]


def test_every_state_is_one_journey_with_one_end(flown: tuple[StudyResults, np.ndarray]) -> None:
    results, _ = flown
    ends = results.summary["results"]["ends"]
    assert sum(one["count"] for one in ends.values()) == COUNT
    journeys = results.journeys
    assert journeys["end"][[3, 9]].tolist() == ["escaped", "escaped"]
    assert journeys["touchdowns"][[3, 9]].tolist() == [0.0, 0.0]
    assert (np.delete(journeys["touchdowns"], [3, 9]) > 0).all()
    assert (journeys["time_s"] > 0.0).all()


def test_the_first_flight_leads_from_the_state_to_the_first_touchdown(flown: tuple[StudyResults, np.ndarray]) -> None:
    results, states = flown
    arcs, touchdowns = results.arcs, results.touchdowns
    first = arcs.where(arcs["arc"] == 0.0)
    assert first["sample"].tolist() == list(range(COUNT))
    assert np.column_stack([first[f"position_{axis}"] for axis in "xyz"]).tolist() == states[:, 1:4].tolist()
    assert (np.delete(first["begin_s"], [3, 9]) < 0.0).all()
    assert (np.delete(first["end_s"], [3, 9]) == 0.0).all()
    impacts = touchdowns.where(touchdowns["touchdown"] == 0.0)
    own = Site(study_of(tables(delivery={"release": RELEASE}))).body
    down = np.delete(np.arange(COUNT), [3, 9])
    again = fly(own, states[down, 1:4], states[down, 4:], 172800.0, gravity="table", start_time=first["clock_s"][down])
    assert np.column_stack([impacts[f"position_{axis}"] for axis in "xyz"]).tolist() == again.position.tolist()
    assert np.abs(np.column_stack([impacts[f"velocity_{axis}"] for axis in "xyz"]) - again.velocity).max() < 1e-12
    assert impacts["impact.speed"] == pytest.approx(again.impact_speed)


def test_the_delivery_stands_in_summary_page_and_status(flown: tuple[StudyResults, np.ndarray]) -> None:
    results, _ = flown
    found = results.results.delivery
    assert (found.count, found.of) == (COUNT - 2, COUNT)
    touchdowns = results.touchdowns
    speed = touchdowns["impact.speed"][touchdowns["touchdown"] == 0.0]
    assert found.speed == pytest.approx(np.quantile(speed, [0.05, 0.5, 0.95]))
    assert found.descent_s[1] > 0.0
    assert [one.share for one in found.ellipse.shares] == [0.5, 0.95]
    page = (results.folder / "report" / "index.html").read_text()
    assert "Blue: the same for the first impacts" in page
    assert f"{COUNT - 2} of {COUNT} landers touch down" in page
    assert any("escaped" in line for line in study_status(results.folder).lines())


def test_the_plan_says_how_landers_reach_the_ground(tmp_path: Path) -> None:
    study = study_of(tables(delivery={"release": RELEASE}))
    plan = plan_of(DrawnDesign(study), "flown", StudyFolder.only_read(tmp_path), 1)
    line = next(line for line in plan_lines(plan) if line.startswith("Delivery"))
    assert f"of {COUNT} landers reach the ground" in line
    # Distances along the ground, by the angles that the first touchdowns make with the aim point.
    descents, aim = DrawnDesign(study).descents, Site(study).frames(Site(study).columns(1))[0][0]
    places = descents.flights.position[descents.touches_down]
    cosines = places @ aim / (np.linalg.norm(places, axis=1) * np.linalg.norm(aim))
    median = np.median(np.linalg.norm(aim) * np.arccos(cosines))
    told = re.search(r"lie ([\d.e+]+) m from the aim point", line)
    assert told
    assert float(told[1]) == pytest.approx(median, rel=6e-3)
    x, y, z = (places / np.linalg.norm(places, axis=1)[:, None]).mean(axis=0)
    north, east = np.degrees(np.arctan2(z, np.hypot(x, y))), np.degrees(np.arctan2(y, x))
    assert f"about latitude {north:.1f} deg, longitude {east:.1f} deg" in line
    latitude, longitude = Site(study).medians["latitude_deg"], Site(study).medians["longitude_deg"]
    assert f"the aim point is at {latitude:.1f}, {longitude:.1f}." in line
    assert plan.made["journeys to rest"][1] == len(DrawnDesign(study).rows)


def test_a_plan_counts_none_at_rest_that_misses_the_ground() -> None:
    law, words = law_before(study_of(tables(delivery={"release": RELEASE})), reach=0.25)
    assert "50-100 % of those that reach the ground come to rest" in words
    at_rest = np.mean([law(np.random.default_rng(seed), 100).mean() for seed in range(200)])
    # A quarter to an eighth, a third of the way on average.
    assert at_rest == pytest.approx(0.25 - 0.125 / 3.0, abs=0.01)


def test_an_edited_table_makes_the_journeys_outdated(tmp_path: Path) -> None:
    path = tmp_path / "states.csv"
    write_states(path)
    study = study_of(tables(delivery={"states": str(path)}))
    before = stage_keys(study)
    moved = path.rename(tmp_path / "elsewhere.csv")
    assert stage_keys(study_of(tables(delivery={"states": str(moved)})))["runs"] == before["runs"]
    write_states(path, away=(COUNT - 1,))
    after = stage_keys(study)
    assert after["runs"] != before["runs"]
    assert after["bed"] == before["bed"]


def test_journeys_are_added_also_where_some_never_touch_down(tmp_path: Path) -> None:
    asked = {"half_width": 0.16, "largest_run_count": 40}
    release = RELEASE | {"velocity_std": 0.04}
    results = run_without_emulator(tables(delivery={"release": release}, design=asked), tmp_path / "out").results
    at_rest = results.ends["at_rest"]
    assert results.delivery.count < results.journeys
    assert results.journeys == 40 or at_rest.share.half_width <= 0.16


def correlated(count: int, pairs: list[list[Any]] | None = None) -> tuple[DrawnDesign, Site]:
    """The design and the site of a study at the surface, with these correlations."""
    error = {"distribution": "normal", "mean": 0.0, "std": 10.0}
    given = journey_tables(delivery={"north_error": error, "east_error": error}, journey={"count": count})
    if pairs is not None:
        given["delivery"]["correlations"] = pairs
    study = study_of(given)
    return DrawnDesign(study), Site(study)


def drawn(design: DrawnDesign, site: Site) -> dict[str, np.ndarray]:
    columns = site.sampled(len(design.beds))
    keys = ("speed", "incidence_deg")
    return {key: columns[key] for key in ("north_error", "east_error", "heading_deg")} | {
        key: np.array([row[f"impact.{key}"] for row in design.rows]) for key in keys
    }


def test_draws_of_the_delivery_have_the_correlations_of_the_file() -> None:
    count = 1000
    found = drawn(*correlated(count, CORRELATIONS))
    expected = {frozenset(pair[:2]): pair[2] for pair in CORRELATIONS}
    names = list(found)
    for row, one in enumerate(names):
        for other in names[:row]:
            rank = stats.spearmanr(found[one], found[other]).statistic
            # A rank correlation of so many draws errs by at most 1 / sqrt(count); four times that.
            assert rank == pytest.approx(expected.get(frozenset((one, other)), 0.0), abs=4.0 / np.sqrt(count))
    assert np.abs(np.sort(found["speed"]) - np.linspace(0.04, 0.08, count)).max() < 0.002


def test_correlations_change_only_what_they_name() -> None:
    (apart, site), (together, other) = correlated(COUNT), correlated(COUNT, [["north_error", "speed", 0.7]])
    before, after = drawn(apart, site), drawn(together, other)
    # The first of the two stays too: the other follows it.
    for key in ("north_error", "east_error", "heading_deg", "incidence_deg"):
        assert (before[key] == after[key]).all()
    assert (before["speed"] != after["speed"]).all()
    assert {name for name in apart.rows[0] if apart.rows[0][name] != together.rows[0][name]} == {"impact.speed"}
    assert [together.row(run) for run in (0, 7)] == [together.rows[0], together.rows[7]]
    assert together.with_run_count(COUNT + 5).rows[:COUNT] == together.rows


AT_REST = 43


def states(path: Path) -> dict[str, np.ndarray]:
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_a_push_has_its_speed_elevation_and_heading_at_every_place(journeys: StudyResults, tmp_path: Path) -> None:
    count = write_push(journeys, tmp_path / "push.csv", Push(0.05, 30.0, 90.0, spin=0.2))
    table = states(tmp_path / "push.csv")
    assert count == len(table["x_m"]) == AT_REST
    place, velocity = (np.column_stack([table[name] for name in names]) for names in (
        ("x_m", "y_m", "z_m"), ("vx_m_s", "vy_m_s", "vz_m_s")))  # fmt: skip
    assert np.allclose(np.linalg.norm(velocity, axis=1), 0.05)
    shape = lithobrake.smallbody.Shape(*journeys.body_shape)
    up = shape.normals[shape.nearest(place)[1]]
    assert np.allclose((velocity * up).sum(axis=1), 0.05 * np.sin(np.radians(30.0)))
    east = np.cross([0.0, 0.0, 1.0], up)
    east /= np.linalg.norm(east, axis=1)[:, None]
    assert np.allclose((velocity * east).sum(axis=1), 0.05 * np.cos(np.radians(30.0)), rtol=1e-6)
    rates = np.column_stack([table[f"rate_{axis}_rad_s"] for axis in "xyz"])
    assert np.linalg.norm(rates, axis=1) == pytest.approx(0.2, abs=2e-4)


def test_errors_scatter_speed_and_direction_and_none_points_down() -> None:
    north, up = np.tile([0.0, 1.0, 0.0], (4000, 1)), np.tile([0.0, 0.0, 1.0], (4000, 1))
    velocity = Push(0.05, 45.0, 0.0, speed_std=0.005, direction_std_deg=3.0).velocities(north, up)
    speed = np.linalg.norm(velocity, axis=1)
    assert (speed.mean(), speed.std()) == (pytest.approx(0.05, rel=0.01), pytest.approx(0.005, rel=0.05))
    assert np.degrees(np.arcsin(velocity[:, 2] / speed)).std() == pytest.approx(3.0, rel=0.05)
    assert (Push(0.05, 1.0, direction_std_deg=10.0).velocities(north, up)[:, 2] > 0.0).all()


def test_pushed_landers_are_followed_to_rest_in_the_next_study(journeys_folder: Path, tmp_path: Path) -> None:
    said = CliRunner().invoke(
        app, ["push", str(journeys_folder), "--speed", "0.03", "--heading", "90", "--out", str(tmp_path / "push.csv")]
    )
    assert said.exit_code == 0, said.output
    assert "journey.count = 43" in said.output
    tables = journey_tables(journey={"count": AT_REST})
    tables["delivery"] = {"latitude_deg": 10.0, "longitude_deg": -60.0, "frame": "body_fixed",
        "states": str(tmp_path / "push.csv")}  # fmt: skip
    source = StudySource.of_tables(tables, function_identity(bounce))
    run_study(source, tmp_path / "next", until="runs", worker_count=1, model=bounce)
    after = lithobrake.open_study(tmp_path / "next").journeys
    before = lithobrake.open_study(journeys_folder).journeys
    east = np.nanmedian(after["longitude_deg"]) - np.nanmedian(before["longitude_deg"])
    assert 0.5 < east < 60.0, "a push to the east takes them east"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["--speed", "0"], "speed is 0.0"), (["--speed", "0.1", "--elevation", "91"], "elevation_deg is 91.0"),
     (["--speed", "0.1", "--speed-std", "-1"], "speed_std is -1.0")],
)  # fmt: skip
def test_what_no_push_has_is_refused(journeys_folder: Path, tmp_path: Path, arguments: list[str], words: str) -> None:
    said = CliRunner().invoke(app, ["push", str(journeys_folder), *arguments, "--out", str(tmp_path / "p.csv")])
    assert said.exit_code == 2
    assert words in said.stderr
    assert not (tmp_path / "p.csv").exists()


BALL = Body(top_shape((200.0, 200.0, 200.0), ridge_height=0.0, name="ball"), 1e9, 1e4)


def sky_rows(folder: Path, body: str) -> list[dict[str, str]]:
    with (folder / "sky.csv").open(newline="") as file:
        return [row for row in csv.DictReader(file) if row["body"] == body]


def test_every_lander_at_rest_has_a_row_for_each_body(journeys: StudyResults, journeys_folder: Path) -> None:
    at_rest = np.flatnonzero(journeys.journeys["end"] == "at_rest")
    for body in ("sun", "earth"):
        assert [int(row["journey"]) for row in sky_rows(journeys_folder, body)] == at_rest.tolist()


def test_latitudes_are_drawn_from_their_distribution(journeys_folder: Path) -> None:
    sun = np.array([float(row["latitude_deg"]) for row in sky_rows(journeys_folder, "sun")])
    assert -10.0 <= sun.min() < -5.0 < 5.0 < sun.max() <= 10.0
    assert {float(row["latitude_deg"]) for row in sky_rows(journeys_folder, "earth")} == {0.0}


def test_sides_see_a_part_of_what_the_lander_sees(journeys_folder: Path) -> None:
    """A side and the one opposite never face a body at once, and three of six do where it is seen."""
    for row in sky_rows(journeys_folder, "sun"):
        seen, sides = float(row["day_fraction"]), [float(row[f"side_{side}"]) for side in SIDES]
        assert 0.3 < seen < 0.56, "below 45 degrees of latitude, with the Sun within 10 of the equator"
        for first, second in zip(sides[::2], sides[1::2], strict=True):
            assert first + second == pytest.approx(seen)


def lander(
    x: float, y: float = 0.0, z: float = 0.0, turn: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)
) -> dict[str, float]:
    """A lander at rest at a place [m], its axes turned against those of the body by a quaternion."""
    found = {"journey": 0.0, "position_x": x, "position_y": y, "position_z": z}
    return found | dict(zip((f"attitude_{part}" for part in "wxyz"), turn, strict=True))


def equator(body: Body, one: dict[str, float], mask: float = 0.0, beam: float = 90.0) -> dict[str, float]:
    """What a lander sees of a body over the equator, by column."""
    (row,) = rows_of(body, [one], "earth", Days(np.zeros((1, 1))), mask, beam)
    return dict(zip(SKY, row, strict=True))


def test_the_side_that_looks_up_faces_a_body_over_the_equator() -> None:
    """Axes of the lander along those of the body, at longitude 0: +x looks up, +y to the east, -x into the ground."""
    found = equator(BALL, lander(100.0))
    assert found["day_fraction"] == found["least_day_fraction"] == pytest.approx(0.5, abs=0.01)
    assert (found["side_+x"], found["side_-x"]) == (pytest.approx(found["day_fraction"]), 0.0)
    assert found["side_+y"] == found["side_-y"] == pytest.approx(0.25, abs=0.01)
    assert found["side_+z"] == found["side_-z"] == 0.0


def test_a_mask_and_a_beam_leave_a_part_of_the_day() -> None:
    found = equator(BALL, lander(100.0), mask=30.0, beam=45.0)
    assert found["day_fraction"] == pytest.approx(1.0 / 3.0, abs=0.01)
    assert found["side_+x"] == pytest.approx(90.0 / 360.0, abs=0.01)
    # East is reached by what stands lower than 45 degrees, and is seen above 30.
    assert found["side_+y"] == pytest.approx(15.0 / 360.0, abs=0.01)


def test_didymos_hides_what_is_behind_it_from_the_side_that_faces_it() -> None:
    """2 arcsin(R / d) of the day, with the extents of Didymos along its equator; nothing on the other side."""
    assert equator(dimorphos(partner=False), lander(88.5))["day_fraction"] == pytest.approx(0.5, abs=0.01)
    body = dimorphos()
    hidden = 2.0 * math.asin(425.0 / (body.orbit.distance - 88.5)) / (2.0 * math.pi)
    assert hidden > 0.12
    assert equator(body, lander(88.5))["day_fraction"] == pytest.approx(0.5 - hidden, abs=0.01)
    assert equator(body, lander(-88.5))["day_fraction"] == pytest.approx(0.5, abs=0.01)


def test_dimorphos_goes_round_and_hides_little_of_any_sky_of_didymos() -> None:
    """Seen from its middle, 2 arcsin(R / d) of all that is up half the day."""
    body = didymos()
    hidden = 2.0 * math.asin(87.75 / 2.0 / body.orbit.distance) / (2.0 * math.pi)
    assert 0.5 - 3.0 * hidden - 0.01 < equator(body, lander(425.5))["day_fraction"] < 0.5


def sky_study(**changes: dict[str, Any]) -> tuple[Study, Site]:
    tables = journey_tables(**changes)
    tables["sky"] = changes.get("sky", {})
    study = StudySource.of_tables(tables).study
    return study, Site(study)


POLE = {"pole_right_ascension_deg": 0.0, "pole_declination_deg": 90.0}
ORBIT = {"semi_major_axis_au": 2.0, "eccentricity": 0.0, "inclination_deg": 0.0, "node_deg": 0.0, "perihelion_deg": 0.0,
    "mean_anomaly_deg": 0.0, "epoch": "2027-04-20T00:00:00"}  # fmt: skip


def test_a_year_has_days_of_all_seasons(tmp_path: Path) -> None:
    """Over a year of a circle the Sun goes once to either side, by the obliquity of the pole; and its mean day at a
    latitude is half a day, its worst day the shortest."""
    pytest.importorskip("spiceypy")
    pytest.importorskip("erfa")
    span = {"date": "2027-04-20T00:00:00", "until": "2030-02-16T02:32:00", "orbit": ORBIT}
    study, site = sky_study(site=POLE, sky=span)
    assert study.sky.bodies == ("sun", "earth")
    days = where_it_stands(study, site, "sun")
    assert days.latitude.shape == (48, 24)
    parts = 2.0 * np.pi * (np.arange(24) + 0.5) / 24
    expected = -np.degrees(np.arcsin(np.sin(np.radians(84381.448 / 3600.0)) * np.sin(parts)))
    assert days.latitude[0] == pytest.approx(expected, abs=0.05)
    north = math.radians(50.0)
    place = [100.0 * math.cos(north), 0.0, 100.0 * math.sin(north)]
    (row,) = rows_of(BALL, [lander(*place)], "sun", days, 0.0, 90.0)
    found, up = dict(zip(SKY, row, strict=True)), BALL.shape.normals[BALL.shape.nearest(np.array([place]))[1]][0]
    lit = np.arccos(np.clip(-math.tan(math.asin(up[2])) * np.tan(np.radians(expected)), -1.0, 1.0)) / np.pi
    assert found["day_fraction"] == pytest.approx(lit.mean(), abs=0.005)
    assert found["least_day_fraction"] == pytest.approx(lit.min(), abs=0.01)


def test_an_orbiter_on_a_circle_or_in_a_table_is_seen_from_below_it(tmp_path: Path) -> None:
    """A table over one place sees all of the time that its rows there stand for."""
    study, site = sky_study(sky={"orbiter": {"altitude": 200.0, "inclination_deg": 0.0}})
    places = where_it_stands(study, site, "orbiter")
    radius = site.body.shape.radius + 200.0
    assert np.linalg.norm(places.position, axis=1) == pytest.approx(np.full(720, radius))
    (row,) = rows_of(BALL, [lander(100.0)], "orbiter", places, 0.0, 90.0)
    found = dict(zip(SKY, row, strict=True))
    assert found["day_fraction"] == pytest.approx(math.acos(100.0 / radius) / math.pi, abs=0.01)
    assert found["latitude_deg"] == ""
    table = tmp_path / "orbiter.csv"
    table.write_text("time_s,x_km,y_km,z_km,vx_m_s,vy_m_s,vz_m_s\n0,1,0,0,0,0,0\n100,-1,0,0,0,0,0\n400,1,0.1,0,0,0,0\n")
    study, site = sky_study(sky={"orbiter": {"states": str(table)}})
    (row,) = rows_of(BALL, [lander(100.0)], "orbiter", where_it_stands(study, site, "orbiter"), 0.0, 90.0)
    assert row[3] == pytest.approx((50.0 + 150.0) / 400.0)
    refuse_hidden_orbiter(site)
    before = sky_dependencies(study)
    table.write_text(table.read_text().replace("400,", "500,"))
    assert sky_dependencies(study) != before
    table.write_text(table.read_text().replace("500,1,0.1,", "500,0.01,0.01,"))
    with pytest.raises(StudyError, match=r"orbiter\.csv, line 4 lies .* m below the ground; allowed: above it"):
        refuse_hidden_orbiter(Site(study))


def write_sky_kernel(path: Path) -> dict[int, np.ndarray]:
    """An ephemeris in which Sun, Earth and an orbiter stand still about Didymos; their places [km] by number."""
    spice = pytest.importorskip("spiceypy")
    places = {10: np.array([1e8, 2e8, -3e7]), 399: np.array([1e8, 5e7, 4e7]), -91: np.array([3.0, -4.0, 5.0])}
    times = np.array([8.4e8, 8.5e8, 8.6e8, 8.7e8])
    handle = spice.spkopn(str(path), "test", 0)
    for number, place in places.items():
        states = np.tile([*place, 0.0, 0.0, 0.0], (4, 1))
        spice.spkw09(handle, number, 920065803, "J2000", times[0], times[-1], "still", 3, 4, states, times)
    spice.spkcls(handle)
    return places


def read_here(function: Callable[..., Any], *arguments: Any, kernels: Any) -> Reply:
    """What another process would say of kernels; tests/smallbody starts one."""
    try:
        return Reply([np.asarray(one) for one in function(*arguments)], None, [])
    except ValueError as error:
        return Reply([], str(error), [])


def test_kernels_tell_where_sun_earth_and_orbiter_stand(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lithobrake.smallbody.body_rotation.read_apart", read_here)
    kernels = write_kernels(tmp_path)
    places = write_sky_kernel(tmp_path / "sky.bsp")
    names = [str(path) for path in (*kernels, tmp_path / "sky.bsp")]
    date = "2026-11-22T12:00:00"
    tables = {"site": {"body": "didymos", "kernels": names}, "sky": {"date": date, "until": "2026-11-24T00:00:00"}}
    tables["sky"]["orbiter"] = {"kernel_name": "-91"}
    study, site = sky_study(**tables)
    right_ascension, declination = np.radians([69.327, -72.725])
    pole = np.array(
        [
            math.cos(declination) * math.cos(right_ascension),
            math.cos(declination) * math.sin(right_ascension),
            math.sin(declination),
        ]
    )
    for name, number in (("sun", 10), ("earth", 399)):
        place = places[number]
        latitude = math.degrees(math.asin(place @ pole / np.linalg.norm(place)))
        assert where_it_stands(study, site, name).latitude == pytest.approx(np.full((48, 24), latitude), abs=1e-9)
    orbiter = where_it_stands(study, site, "orbiter").position
    assert orbiter[:, 2] == pytest.approx(np.full(720, 1e3 * places[-91] @ pole), abs=1e-6)
    assert np.linalg.norm(orbiter, axis=1) == pytest.approx(np.full(720, 1e3 * math.sqrt(50.0)))
    tables["site"]["kernels"] = names[:-1]
    with pytest.raises(StudyError, match=r"sky\.date: kernels .*add the kernel that has it"):
        sky_study(**tables)


@pytest.mark.parametrize(("sky", "words"), [
    ({"date": "soon"}, "allowed: a date and time of the years 1900 to 2999 such as"),
    ({"date": "2027-04-20", "orbit": ORBIT}, "site.pole_right_ascension_deg is missing"),
    ({"date": "2027-04-20"}, "sky.orbit is missing"),
    ({"date": "2027-04-20", "until": "2027-04-19", "orbit": ORBIT}, "allowed: later than sky.date"),
    ({"date": "2027-04-20", "sun_latitude_deg": 3.0, "orbit": ORBIT}, "leave one of the two out"),
    ({"until": "2027-04-20"}, "sky.until goes with sky.date"),
    ({"orbiter": {}}, r"\[sky.orbiter\] has nothing; allowed: one of altitude, states, kernel_name"),
    ({"orbiter": {"altitude": 1.0, "kernel_name": "HERA"}}, "sky.orbiter.altitude and sky.orbiter.kernel_name"),
    ({"orbiter": {"kernel_name": "HERA"}}, "site.kernels is missing"),
    ({"orbiter": {"states": "nowhere.csv"}}, "cannot be read"),
    ({"orbiter": {"states": str(Path(__file__))}}, "sky.orbiter.states: test_delivered_journeys.py, line 1"),
    ({"orbiter": {"states": "x", "inclination_deg": 3.0}}, "is that of a circle"),
    ({"sun_latitude_deg": 3.0, "beam_deg": 30.0}, "sky.beam_deg is of Earth and the orbiter"),
    ({"earth_latitude_deg": 3.0, "beam_deg": 91.0}, "above 0 and at most 90"),
])  # fmt: skip
def test_a_sky_that_cannot_be_is_refused(sky: dict[str, Any], words: str) -> None:
    pytest.importorskip("spiceypy")
    pytest.importorskip("erfa")
    with pytest.raises(StudyError, match=words):
        sky_study(sky=sky)


def test_the_summary_and_the_page_have_it(journeys: StudyResults, journeys_folder: Path) -> None:
    found = journeys.results.sky
    seen = [float(row["day_fraction"]) for row in sky_rows(journeys_folder, "sun")]
    assert found["sun"].day_fraction.value == pytest.approx(np.median(seen), abs=0.01)
    assert found["sun"].day_fraction_q05.value <= found["sun"].day_fraction.value
    assert (found["sun"].never.count, set(found["earth"].sides)) == (0, set(SIDES))
    assert found["sun"].probability.value == pytest.approx(np.mean(seen), abs=1e-9)
    assert found["sun"].probability.lower < found["sun"].probability.value < found["sun"].probability.upper
    up = np.mean([float(row["side_+z"]) for row in sky_rows(journeys_folder, "sun")])
    assert found["sun"].side_probabilities["+z"].value == pytest.approx(up, abs=1e-9)
    said = next(line for line in journeys.results.answer if line.startswith("Visible from the place of rest"))
    median = re.search(r"the Sun (\d+) \(\d+-\d+\) % of the time, Earth ", said)
    assert median
    assert int(median[1]) == pytest.approx(100.0 * np.median(seen), abs=1.0)


def test_the_sky_without_journeys_is_refused() -> None:
    tables = deepcopy(paper_tables())
    tables["sky"] = {"sun_latitude_deg": 0.0}
    with pytest.raises(StudyError, match=r"design.run_count is 0; raise it, or leave \[sky\] out"):
        check_tables(tables, Path())
    tables["sky"] = {"mask_deg": 10.0}
    with pytest.raises(StudyError, match="leave it out, or ask for one"):
        check_tables(tables, Path())
    tables["sky"] = {"sun_latitude_deg": 91.0}
    with pytest.raises(StudyError, match="at least -90 and at most 90"):
        check_tables(tables, Path())
