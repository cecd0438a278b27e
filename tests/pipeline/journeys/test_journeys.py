"""Journeys of landings on known ground, smooth and rough: their flights, frames, draws and ends."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import lithobrake
from lithobrake.campaign import read_records
from lithobrake.geometry.attitude import about_z, attitude_of, from_frame, quaternion
from lithobrake.pipeline.design.arrivals import MEAN_INCIDENCE, first_axes
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import side_down
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.pipeline.study_run import run_study
from lithobrake.smallbody import HardSurface, Impacts, fly
from lithobrake.smallbody.ground_touchdowns import Bounces
from lithobrake.smallbody.landers import follow
from lithobrake.study import Study, StudyError
from lithobrake.study.source import StudySource
from lithobrake.touchdown.touchdown_model import acceleration
from lithobrake.vocabulary.quantities import ORIENTATION

from ...paper_tables import SMALL_GROUND, with_keys
from ..few_terms import fewest_terms
from .bouncing_lander import bounce, journey_tables, run_without_emulator

JOURNEYS = 16
TABLES: dict[str, Any] = {
    "seed": 3, **SMALL_GROUND, "lander": {"shape": "box", "edges": [0.1, 0.1, 0.227], "mass": 2.0},
    "delivery": {"latitude_deg": 30.0, "longitude_deg": 200.0,
                 "speed": {"distribution": "uniform", "lower": 0.02, "upper": 0.07},
                 "incidence_deg": {"distribution": "uniform", "lower": 10.0, "upper": 40.0},
                 "heading_deg": {"distribution": "uniform", "lower": 0.0, "upper": 360.0}},
    "journey": {"count": JOURNEYS, "duration": 40000.0, "emulated_count": 0}, "site": {"body": "dimorphos"},
}  # fmt: skip
HARD = HardSurface(0.5, 0.7, math.inf, 0.05)
SPIN = ("impact.spin_x", "impact.spin_y", "impact.spin_z")


def hard_ground(values: dict[str, float], seed: int) -> dict[str, Any]:
    """A landing on hard ground, by the numbers that a landing on soil is given."""
    outward = -values["surface.gravity"] * math.cos(math.radians(values["surface.slope_deg"]))
    incidence = math.radians(values["impact.incidence_deg"])
    one = np.zeros(1, dtype=np.int64)
    impacts = Impacts(
        np.array([values["impact.speed"]]), np.array([incidence]), np.zeros((1, 3)), np.array([outward]), one
    )
    left = HARD(impacts, np.random.default_rng(0))
    if left.captured[0]:
        return {"outcome": "captured", "outputs": {"contacts": 1.0}}
    x, y, z = left.velocity[0].tolist()
    speed = math.sqrt(x * x + y * y + z * z)
    names = ("speed_out", "elevation_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z")
    return {"outcome": "clear", "outputs": dict(zip(names, (speed, math.asin(z / speed), 0.1, x, y, z), strict=True))}


def run(folder: Path, **changes: dict[str, Any]) -> Any:
    return run_without_emulator(with_keys(TABLES, changes), folder, hard_ground)


IDENTITY = function_identity(hard_ground)


def rows(folder: Path, name: str) -> dict[str, np.ndarray]:
    table = np.genfromtxt(folder / name, delimiter=",", names=True, dtype=None, encoding="utf-8")
    return {name.split("_m")[0] if name.startswith("position") else name: table[name] for name in table.dtype.names}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("journeys") / "out"
    run(folder)
    return folder


def test_landings_on_hard_ground_lead_where_bounces_lead(made: Path) -> None:
    study = with_site_gravity(StudySource.of_tables(TABLES).study)
    ends = bouncing(DrawnDesign(study))
    found = rows(made, "journeys.csv")
    assert ends.end.tolist() == found["end"].tolist()
    rests = ends.end == "at_rest"
    assert rests.sum() > 0.5 * JOURNEYS
    assert (found["touchdowns"] == ends.touchdowns).all()
    place = np.column_stack([found[f"position_{axis}"] for axis in "xyz"])
    assert np.linalg.norm(place - ends.position, axis=1)[rests].max() < 0.01
    assert np.abs(found["time_s"] - ends.time)[rests].max() < 0.2


def bouncing(design: DrawnDesign) -> StudyLanders:
    """The landers of a study by bounces off hard ground, all together and without a landing."""
    begin = Arrivals.of_rows(design.site, design.rows, 0)
    return follow(StudyLanders.of(design, begin), Bounces(HARD, 0, "hard ground"))


def test_the_summary_has_ends_that_add_up_and_numbers_of_rest(made: Path) -> None:
    results = lithobrake.open_study(made).summary["results"]
    ends = results["ends"]
    assert list(ends) == ["at_rest", "escaped", "partner", "under_way", "failed"]
    assert sum(one["share"] for one in ends.values()) == pytest.approx(1.0, abs=1e-12)
    assert all(one["lower"] <= one["share"] <= one["upper"] for one in ends.values())
    assert results["journeys"] == JOURNEYS
    assert results["touchdowns"] == len(read_records(made / "runs.sqlite"))
    found = rows(made, "journeys.csv")
    rests = found["end"] == "at_rest"
    time = results["rest"]["time_s"]["median"]
    assert time["value"] == pytest.approx(np.quantile(found["time_s"][rests], 0.5, method="hazen"))
    assert results["rest"]["regions"][0]["area_m2"] < results["rest"]["regions"][1]["area_m2"]


def test_each_touchdown_keeps_soil_and_bed_and_takes_a_fresh_place_and_direction(made: Path) -> None:
    by_journey: dict[float, list[dict[str, float]]] = {}
    for record in read_records(made / "runs.sqlite"):
        by_journey.setdefault(record.inputs["journey"], []).append(record.inputs)
    longest = max(by_journey.values(), key=len)
    longest.sort(key=lambda row: row["touchdown"])
    assert [row["touchdown"] for row in longest] == list(range(len(longest)))
    for name in ("bed", "grain.friction", "lander.mass"):
        assert len({row[name] for row in longest}) == 1
    for name in ("impact.place.x", "impact.azimuth_deg", "impact.orientation.w", "journey.time_left"):
        assert len({row[name] for row in longest}) == len(longest)
    left = [row["journey.time_left"] for row in longest]
    assert (left, left[0]) == (sorted(left, reverse=True), 40000.0)


def test_more_journeys_change_none_of_the_earlier_ones(made: Path, tmp_path: Path) -> None:
    few, source = tmp_path / "few", StudySource.of_tables(with_keys(TABLES, {"journey": {"count": 6}}), IDENTITY)
    run_study(source, few, until="runs", worker_count=1, model=hard_ground)
    lines = (few / "journeys.csv").read_text().splitlines()
    assert len(lines) == 7
    assert (made / "journeys.csv").read_text().splitlines()[:7] == lines


def test_a_study_that_goes_on_makes_no_landing_again(made: Path, tmp_path: Path) -> None:
    first = {record.key: record.ended for record in read_records(made / "runs.sqlite")}
    before = (made / "journeys.csv").read_bytes()
    (made / "journeys.csv").unlink()
    run(made)
    assert (made / "journeys.csv").read_bytes() == before
    assert {record.key: record.ended for record in read_records(made / "runs.sqlite")} == first


def test_journeys_are_added_until_the_fraction_at_rest_is_known_as_asked(tmp_path: Path) -> None:
    asked = {"half_width": 0.2, "largest_run_count": 100}
    run(tmp_path / "out", design=asked, journey={"count": 12, "duration": 2000.0})
    results = lithobrake.open_study(tmp_path / "out").summary["results"]
    at_rest = results["ends"]["at_rest"]
    # Some are still under way, so that 12 journeys tell too little.
    assert 0.0 < at_rest["share"] < 1.0
    assert 12 < results["journeys"] < 100
    assert at_rest["upper"] - at_rest["lower"] <= 2.0 * 0.2


def test_attitudes_are_turned_from_frame_to_frame_and_back() -> None:
    random = np.random.default_rng(5)
    axes = Rotation.random(random_state=random).as_matrix()
    if np.linalg.det(axes) < 0.0:
        axes[0] *= -1.0
    attitude = Rotation.random(random_state=random)
    names = ("w", "x", "y", "z")
    again = attitude_of(dict(zip(names, quaternion(attitude), strict=True)), names)
    assert (again * attitude.inv()).magnitude() < 1e-12
    vector = random.standard_normal(3)
    assert from_frame(axes).apply(axes @ vector) == pytest.approx(vector)


@pytest.mark.parametrize(
    ("turn", "side"), [((0.0, 0.0, 0.0), "-z"), ((180.0, 0.0, 0.0), "+z"), ((90.0, 0.0, 0.0), "-y")]
)
def test_the_side_that_is_down_is_the_one_along_the_plumb_line(turn: tuple[float, ...], side: str) -> None:
    attitude = Rotation.from_euler("y", 10.0, degrees=True) * Rotation.from_euler("xyz", turn, degrees=True)
    found, angle = side_down(attitude, np.array([0.0, 0.0, -3e-5]))
    assert found == side
    assert math.degrees(angle) == pytest.approx(10.0)


POINTED = {"orientation": [0.6, 0.0, 0.8, 0.0], "spin_x": 0.02, "spin_z": -0.01}


def rough_tables(roughness_deg: float, **delivery: Any) -> dict[str, Any]:
    return TABLES | {
        "site": TABLES["site"] | {"roughness_deg": roughness_deg},
        "delivery": TABLES["delivery"] | delivery,
    }


def rough_study(roughness_deg: float, **delivery: Any) -> Study:
    return with_site_gravity(StudySource.of_tables(rough_tables(roughness_deg, **delivery)).study)


def as_seen_from_the_body(row: dict[str, float], axes: np.ndarray) -> list[np.ndarray]:
    """Velocity, acceleration, spin and attitude of a touchdown, all body-fixed."""
    incidence, turn = math.radians(row["impact.incidence_deg"]), about_z(-math.radians(row["impact.azimuth_deg"]))
    incoming = row["impact.speed"] * np.array([math.sin(incidence), 0.0, -math.cos(incidence)])
    felt = turn.apply(acceleration(row, row["surface.gravity"]))
    spin = turn.apply([row[name] for name in SPIN])
    attitude = from_frame(axes) * turn * attitude_of(row, ORIENTATION)
    return [*(vector @ axes for vector in (incoming, felt, spin)), attitude.as_matrix()]


def test_a_lander_arrives_as_on_smooth_ground() -> None:
    """Way, gravity, spin and attitude stay; the ground has turned under them, by the angles that were asked for."""
    smooth, rough = rough_study(0.0, **POINTED), rough_study(8.0, **POINTED)
    rows, tilted = DrawnDesign(smooth).rows, DrawnDesign(rough).rows
    site = Site(smooth)
    _, axes = site.frames(site.sampled(JOURNEYS))
    met = first_axes(rough, axes, tilted)
    for before, after, plain, turned in zip(rows, tilted, axes, met, strict=True):
        for one, other in zip(as_seen_from_the_body(before, plain), as_seen_from_the_body(after, turned), strict=True):
            assert other == pytest.approx(one, abs=1e-9 * np.abs(one).max())
        assert after[MEAN_INCIDENCE] == before["impact.incidence_deg"]
    slopes = np.arccos((axes[:, 2] * met[:, 2]).sum(axis=1))
    assert np.sqrt(np.mean(np.tan(slopes) ** 2)) == pytest.approx(math.tan(math.radians(8.0)), rel=0.4)
    assert first_axes(rough, axes, rows) == pytest.approx(met, abs=1e-12)
    assert first_axes(smooth, axes, rows) is axes


@pytest.fixture(scope="module")
def rough_made(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Ten journeys, whose touchdowns and flights alone are looked at."""
    folder = tmp_path_factory.mktemp("rough") / "out"
    source = StudySource.of_tables(with_keys(rough_tables(25.0), {"journey": {"count": 10}}), IDENTITY)
    run_study(source, folder, until="runs", worker_count=1, model=hard_ground)
    return lithobrake.open_study(folder)


def test_each_touchdown_has_the_velocity_with_which_its_flight_ends(rough_made: Any) -> None:
    """Flown again from how the lander left its ground, it arrives as the next touchdown was given it."""
    touchdowns, flights, body = rough_made.touchdowns, rough_made.arcs, Site(rough_study(25.0)).body
    where = {(one, other): row for row, (one, other) in enumerate(zip(*pairs(touchdowns, "touchdown"), strict=True))}
    steepest = 0.0
    for row, (journey, number) in enumerate(zip(*pairs(flights, "arc", "sample"), strict=True)):
        after = where.get((journey, number + 1))
        if after is None:
            continue
        state = [np.array([flights[f"{what}_{axis}"][row] for axis in "xyz"]) for what in ("position", "velocity")]
        flown = fly(body, *state, 40000.0, gravity="table", start_time=float(flights["clock_s"][row]))
        arrived = np.array([touchdowns[f"velocity_{axis}"][after] for axis in "xyz"])
        assert np.linalg.norm(flown.velocity[0] - arrived) < 1e-3 * np.linalg.norm(arrived)
        assert touchdowns[MEAN_INCIDENCE][after] == pytest.approx(math.degrees(flown.incidence[0]), abs=0.1)
        steepest = max(steepest, abs(touchdowns["impact.incidence_deg"][after] - touchdowns[MEAN_INCIDENCE][after]))
    assert steepest > 15.0


def pairs(table: Any, number: str, journey: str = "journey") -> tuple[list[int], list[int]]:
    return [int(one) for one in table[journey]], [int(one) for one in table[number]]


def test_journeys_on_rough_ground_end_and_are_followed_by_the_emulator(tmp_path: Path) -> None:
    tables = journey_tables(site={"roughness_deg": 20.0}, journey={"count": 30, "emulated_count": 40})
    del tables["sky"]
    with fewest_terms():
        results = lithobrake.run(tables, tmp_path / "out", workers=1, model=bounce, report=False)
    assert results.results.emulated.agrees
    assert results.results.ends["at_rest"].share.value > 0.5


def test_rough_ground_is_met_at_angles_and_spins_that_follow_no_law_of_the_study() -> None:
    spin = {"spin_x": {"distribution": "uniform", "lower": 0.0, "upper": 0.02}}
    smooth, rough = (DrawnDesign(rough_study(angle, **spin)) for angle in (0.0, 12.0))
    met = ("impact.incidence_deg", "impact.spin_x")
    assert (smooth.met_on_the_way, rough.met_on_the_way) == ((), met)
    assert smooth.lawful_inputs == smooth.inputs
    assert rough.inputs.keys() - rough.lawful_inputs.keys() == set(met)
    for name in met:
        low, high = rough.inputs[name].support
        values = np.array([row[name] for row in rough.rows])
        assert ((values < low) | (values > high)).any()


def test_what_no_impact_reads_is_refused() -> None:
    one_ground = rough_tables(12.0) | {"surface": {"gravity": 5e-5}}
    one_ground["journey"] = {"count": 24, "touchdowns": 1}
    with pytest.raises(StudyError, match=r"site.roughness_deg is 12, and surface.gravity = 5e-05 gives all touchdowns"):
        StudySource.of_tables(one_ground)
    aimed = rough_tables(12.0) | {"aim": {"grid": {"delivery.incidence_deg": [10.0, 20.0]}}}
    with pytest.raises(StudyError, match=r'aim.grid has "delivery.incidence_deg", and site.roughness_deg'):
        StudySource.of_tables(aimed)
