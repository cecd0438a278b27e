"""Journeys that begin with states, a release, correlated draws or a push of landers at rest."""

import csv
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

import lithobrake
from lithobrake.cli import app
from lithobrake.export import Push, write_push
from lithobrake.pipeline.commands.status import study_status
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.outdated_files import stage_keys
from lithobrake.pipeline.planning.expected_width import law_before
from lithobrake.pipeline.planning.plan_in_words import plan_lines
from lithobrake.pipeline.planning.planner import plan_of
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.results import StudyResults
from lithobrake.smallbody import fly
from lithobrake.study.source import StudySource
from lithobrake.study.study import Study

from ...paper_tables import with_keys
from .bouncing_lander import journey_tables, run_without_emulator

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
    velocity = np.column_stack([impacts[f"velocity_{axis}"] for axis in "xyz"])
    assert np.abs(velocity - again.velocity).max() < 1e-12
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
    plan = plan_of(DrawnDesign(study), Site(study), "flown", StudyFolder.only_read(tmp_path), 1)
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
    assert "50 to 100 % of those that reach the ground come to rest" in words
    at_rest = np.mean([law.study(np.random.default_rng(seed), 100).mean() for seed in range(200)])
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
    asked = {"half_width": 0.16, "largest_run_count": 96}
    release = RELEASE | {"velocity_std": 0.04}
    results = run_without_emulator(tables(delivery={"release": release}, design=asked), tmp_path / "out").results
    at_rest = results.ends["at_rest"]
    assert results.delivery.count < results.journeys
    assert results.journeys == 96 or at_rest.upper - at_rest.lower <= 2.0 * 0.16


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
    own = {name for name in apart.rows[0] if apart.rows[0][name] != together.rows[0][name]}
    assert own == {"impact.speed"}
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
    assert speed.mean() == pytest.approx(0.05, rel=0.01)
    assert speed.std() == pytest.approx(0.005, rel=0.05)
    assert np.degrees(np.arcsin(velocity[:, 2] / speed)).std() == pytest.approx(3.0, rel=0.05)
    assert (Push(0.05, 1.0, direction_std_deg=10.0).velocities(north, up)[:, 2] > 0.0).all()


def test_pushed_landers_are_followed_to_rest_in_the_next_study(journeys_folder: Path, tmp_path: Path) -> None:
    said = CliRunner().invoke(
        app, ["push", str(journeys_folder), "--speed", "0.03", "--heading", "90", "--out", str(tmp_path / "push.csv")]
    )
    assert said.exit_code == 0, said.output
    assert "journey.count = 43" in said.output
    tables = journey_tables(journey={"count": AT_REST})
    tables["delivery"] = {
        "latitude_deg": 10.0, "longitude_deg": -60.0, "frame": "body_fixed", "states": str(tmp_path / "push.csv"),
    }  # fmt: skip
    after = run_without_emulator(tables, tmp_path / "next").journeys
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
