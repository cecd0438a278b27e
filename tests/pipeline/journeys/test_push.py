"""A hop: landers at rest are pushed, and their states are the delivery of the next study."""

import csv
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import lithobrake
from lithobrake.cli import app
from lithobrake.export import Push, write_push
from lithobrake.results import StudyResults

from .bouncing_lander import journey_tables
from .without_emulator import run_without_emulator

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
    flat = Push(0.05, 1.0, direction_std_deg=10.0).velocities(north, up)
    assert (flat[:, 2] > 0.0).all()


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
