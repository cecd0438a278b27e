"""Journeys on ground that is rough: a lander arrives as it would, on ground that faces another way."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.geometry.contact_frame import about_z, attitude_of, from_frame
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.rough_ground import MEAN_INCIDENCE, first_axes
from lithobrake.pipeline.rest.journeys import hard_surface, on_rough
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.smallbody import RoughGround, fly
from lithobrake.study import Study, StudyError
from lithobrake.study.source import StudySource
from lithobrake.study.touchdown_model import acceleration
from lithobrake.vocabulary.quantities import ORIENTATION

from .test_journeys import JOURNEYS, SPIN, TABLES, hard_ground
from .without_emulator import run_without_emulator

POINTED = {"orientation": [0.6, 0.0, 0.8, 0.0], "spin_x": 0.02, "spin_z": -0.01}


def tables(roughness_deg: float, **delivery: Any) -> dict[str, Any]:
    return TABLES | {
        "site": TABLES["site"] | {"roughness_deg": roughness_deg},
        "delivery": TABLES["delivery"] | delivery,
    }


def study(roughness_deg: float, **delivery: Any) -> Study:
    return with_site_gravity(StudySource.of_tables(tables(roughness_deg, **delivery)).study)


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
    smooth, rough = study(0.0, **POINTED), study(8.0, **POINTED)
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
def made(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("rough") / "out"
    return run_without_emulator(tables(25.0), folder, hard_ground)


def test_each_touchdown_has_the_velocity_with_which_its_flight_ends(made: Any) -> None:
    """Flown again from how the lander left its ground, it arrives as the next touchdown was given it."""
    touchdowns, flights, body = made.touchdowns, made.arcs, Site(study(25.0)).body
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
    from .bouncing_lander import bounce, journey_tables

    results = lithobrake.run(
        journey_tables(site={"roughness_deg": 20.0}), tmp_path / "out", workers=1, model=bounce, report=False
    )
    found = results.results.emulated
    assert found.agrees
    assert results.results.ends["at_rest"].share > 0.5


def test_hard_ground_of_a_study_is_as_rough_as_its_site() -> None:
    drawn = {key: table for key, table in tables(12.0).items() if key not in ("journey", "delivery")}
    drawn |= {"impact": {"speed": 0.05, "incidence_deg": 10.0}, "surface": {"gravity": 5e-5}}
    read = StudySource.of_tables(drawn).study
    hard = hard_surface(read)
    rough = on_rough(read, hard)
    assert rough == RoughGround(hard, math.radians(12.0))
    drawn["site"] = {"body": "dimorphos"}
    assert on_rough(StudySource.of_tables(drawn).study, hard) is hard


def test_what_no_impact_reads_is_refused() -> None:
    lonely = {key: table for key, table in tables(12.0).items() if key not in ("journey", "delivery")}
    lonely |= {"impact": {"speed": 0.05, "incidence_deg": 10.0}, "surface": {"gravity": 5e-5}, "rest": {"count": 0}}
    with pytest.raises(StudyError, match=r"site.roughness_deg is 12, and no impact of the study reads it"):
        StudySource.of_tables(lonely)
    aimed = tables(12.0) | {"aim": {"grid": {"delivery.incidence_deg": [10.0, 20.0]}}}
    with pytest.raises(StudyError, match=r'aim.grid has "delivery.incidence_deg", and site.roughness_deg'):
        StudySource.of_tables(aimed)
