"""Journeys of landings: their flights, frames, draws and ends, on ground that is known."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import lithobrake
from lithobrake.campaign import read_records
from lithobrake.geometry.contact_frame import attitude_of, from_frame, quaternion
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.journeys.resting_attitude import side_down
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.smallbody import HardSurface, Impacts, Launch, hop
from lithobrake.study.source import StudySource

from ...small_ground import SMALL_GROUND
from .without_emulator import run_without_emulator

JOURNEYS = 24
TABLES: dict[str, Any] = {
    "seed": 3,
    **SMALL_GROUND,
    "lander": {"shape": "box", "edges": [0.1, 0.1, 0.227], "mass": 2.0},
    "delivery": {
        "latitude_deg": 30.0, "longitude_deg": 200.0,
        "speed": {"distribution": "uniform", "lower": 0.02, "upper": 0.07},
        "incidence_deg": {"distribution": "uniform", "lower": 10.0, "upper": 40.0},
        "heading_deg": {"distribution": "uniform", "lower": 0.0, "upper": 360.0},
    },
    "journey": {"count": JOURNEYS, "duration": 40000.0, "emulated_count": 0},
    "site": {"body": "dimorphos"},
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
    tables = TABLES | {name: TABLES.get(name, {}) | keys for name, keys in changes.items()}
    return run_without_emulator(tables, folder, hard_ground)


def rows(folder: Path, name: str) -> dict[str, np.ndarray]:
    table = np.genfromtxt(folder / name, delimiter=",", names=True, dtype=None, encoding="utf-8")
    return {
        title.split("_m")[0] if title.startswith("position") else title: table[title] for title in table.dtype.names
    }


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("journeys") / "out"
    run(folder)
    return folder


def test_on_hard_ground_they_go_where_bounces_of_flights_go(made: Path) -> None:
    study = with_site_gravity(StudySource.of_tables(TABLES).study)
    site, design = Site(study), DrawnDesign(study)
    columns = site.sampled(JOURNEYS)
    origin, axes = site.frames(columns)
    first = np.array([hard_velocity(row) for row in design.rows])
    time = site.body.partner_time(columns["partner_longitude_deg"], columns["spin_period"])
    launch = Launch(origin, np.einsum("nij,ni->nj", axes, first), time=time, mass=columns["mass"])
    ends = hop(site.body, launch, HARD, 40000.0)
    found = rows(made, "journeys.csv")
    words = {"settled": "at_rest", "flying": "under_way"}
    assert [words.get(word, word) for word in ends.status.tolist()] == found["end"].tolist()
    rests = ends.status == "settled"
    assert rests.sum() > 0.5 * JOURNEYS
    assert (found["touchdowns"][rests] == ends.bounce_count[rests] + 2).all()
    place = np.column_stack([found[f"position_{axis}"] for axis in "xyz"])
    assert np.linalg.norm(place - ends.position, axis=1)[rests].max() < 0.01
    assert np.abs(found["time_s"] - ends.time)[rests].max() < 0.2


def hard_velocity(row: dict[str, float]) -> list[float]:
    outputs = hard_ground(row, 0)["outputs"]
    return [outputs[f"velocity_out_{axis}"] for axis in "xyz"]


def test_the_summary_has_ends_that_add_up_and_numbers_of_rest(made: Path) -> None:
    results = lithobrake.open_study(made).summary["results"]
    ends = results["ends"]
    assert list(ends) == ["at_rest", "escaped", "partner", "under_way", "failed"]
    assert sum(one["share"] for one in ends.values()) == pytest.approx(1.0, abs=1e-12)
    assert all(one["lower"] <= one["share"] <= one["upper"] for one in ends.values())
    assert results["journeys"] == JOURNEYS
    records = read_records(made / "runs.sqlite")
    assert results["touchdowns"] == len(records)
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
    assert left == sorted(left, reverse=True)
    assert left[0] == 40000.0


def test_more_journeys_change_none_of_the_earlier_ones(made: Path, tmp_path: Path) -> None:
    more = tmp_path / "more"
    run(more, journey={"count": JOURNEYS + 6})
    lines = (made / "journeys.csv").read_text().splitlines()
    assert (more / "journeys.csv").read_text().splitlines()[: JOURNEYS + 1] == lines


def test_a_study_that_goes_on_makes_no_landing_again(made: Path, tmp_path: Path) -> None:
    first = {record.key: record.ended for record in read_records(made / "runs.sqlite")}
    before = (made / "journeys.csv").read_bytes()
    (made / "journeys.csv").unlink()
    run(made)
    assert (made / "journeys.csv").read_bytes() == before
    assert {record.key: record.ended for record in read_records(made / "runs.sqlite")} == first


def test_journeys_are_added_until_the_fraction_at_rest_is_known_as_asked(tmp_path: Path) -> None:
    asked = {"half_width": 0.13, "largest_run_count": 200}
    run(tmp_path / "out", design=asked, journey={"count": 24, "duration": 2000.0})
    results = lithobrake.open_study(tmp_path / "out").summary["results"]
    at_rest = results["ends"]["at_rest"]
    # Some are still under way, so that 24 journeys tell too little.
    assert 0.0 < at_rest["share"] < 1.0
    assert 24 < results["journeys"] < 200
    assert at_rest["upper"] - at_rest["lower"] <= 2.0 * 0.13


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
    tilt = Rotation.from_euler("y", 10.0, degrees=True)
    attitude = tilt * Rotation.from_euler("xyz", turn, degrees=True)
    found, angle = side_down(attitude, np.array([0.0, 0.0, -3e-5]))
    assert found == side
    assert math.degrees(angle) == pytest.approx(10.0)
