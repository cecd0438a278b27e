"""Bounce after bounce of a study: what the soil answers to later impacts, and where samples end."""

import json
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lithobrake.pipeline.first_bounces.bounces_to_rest import COLUMNS as REST
from lithobrake.pipeline.first_bounces.bounces_to_rest import Sites, arc_rows, rest_dependencies, sliding_friction

from lithobrake.analysis import OutcomeModel, wilson_interval
from lithobrake.chaos import Uniform, fit, smolyak
from lithobrake.pipeline import Job, StudyFolder
from lithobrake.pipeline.answer.dispersion_statistics import NORMAL_QUANTILE_90, proportion, rest_results
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.expansion.expansion_journeys import SoilBounce, follow_expansion_samples
from lithobrake.pipeline.expansion.expansion_samples import Scatter
from lithobrake.pipeline.expansion.expansions import points
from lithobrake.pipeline.first_bounces.bounce_laws import (
    FRICTIONS,
    INTERCEPT,
    SLOPE,
    SlowArrivals,
    effective_friction,
    why_no_soil,
)
from lithobrake.pipeline.flights import COLUMNS, read_table, write_table
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.samples import SAMPLE_OUTCOMES, Samples, rolling_spin
from lithobrake.pipeline.site import Site
from lithobrake.smallbody import Arcs, HardSurface, Impacts, Rebounds
from lithobrake.study import Study, check_tables
from lithobrake.vocabulary.outcomes import JourneyStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import ARC, OUTPUTS

from ...paper_tables import paper_tables, with_keys

ROOT = Path(__file__).parents[3]
# Grains so small that nothing is known of how they hold a lander.
FINE = {"distribution": "constant", "value": 0.02}
INPUTS = {
    "grain.friction": Uniform(0.2, 0.8),
    "impact.speed": Uniform(0.0, 0.4),
    "impact.incidence_deg": Uniform(0.0, 80.0),
}
RANGES = {"grain.friction": (0.2, 0.8), "impact.speed": (0.0, 0.4), "impact.incidence_deg": (0.0, 80.0)}


def rebound(x: np.ndarray) -> np.ndarray:
    """Outputs [count, 6] that are polynomials of the inputs: half the speed, higher up the less the friction, to the
    right of the incoming direction."""
    friction, speed, incidence = x.T
    return np.column_stack([0.5 * speed, 1.2 - friction, 2.0 * speed, np.zeros_like(speed), -speed, incidence])


def bounce(friction: list[float], scatter: Scatter | None = None, outcome: str = "clear") -> SoilBounce:
    x = smolyak(INPUTS, level=2)
    surrogate = fit(INPUTS, x, rebound(x), degree=2, method="ols", output_names=OUTPUTS)
    outcomes = OutcomeModel(INPUTS, x, [outcome] * len(x), tuple(TouchdownOutcome))
    values = np.array(friction)
    inputs = {name: values if name == "grain.friction" else np.full(len(values), 0.3) for name in INPUTS}
    return SoilBounce(surrogate, outcomes, inputs, RANGES, scatter)


def impacts(speed: list[float], incidence_deg: list[float], lander: list[int]) -> Impacts:
    count = len(speed)
    degrees = np.radians(incidence_deg)
    return Impacts(np.array(speed), degrees, np.zeros((count, 3)), np.full(count, -1e-5), np.array(lander))


def test_the_expansion_answers_with_the_soil_of_the_lander_and_the_impact_that_came() -> None:
    found = bounce([0.2, 0.5, 0.7])(impacts([0.1, 0.3], [40.0, 20.0], [2, 0]), np.random.default_rng(0))
    along, up = np.cos([0.5, 1.0]), np.sin([0.5, 1.0])
    expected = np.array([0.05, 0.15])[:, None] * np.column_stack([np.zeros(2), -along, up])
    assert found.velocity == pytest.approx(expected, abs=1e-12)
    assert np.linalg.norm(found.spin, axis=1) == pytest.approx([0.2, 0.6])
    # The lowest point of a rolling ball is at rest: spin cross (0, 0, -1) runs against the horizontal velocity.
    backwards = np.cross(found.spin, [0.0, 0.0, -1.0])[:, :2]
    assert np.einsum("ni,ni->n", backwards, found.velocity[:, :2]) == pytest.approx(
        -np.linalg.norm(found.spin, axis=1) * np.linalg.norm(found.velocity[:, :2], axis=1)
    )
    assert not found.captured.any()
    assert not found.outside.any()


def test_what_the_runs_do_not_reach_is_not_answered() -> None:
    soil = bounce([0.5])
    found = soil(impacts([0.3, 0.41, 0.3, 0.3], [79.9, 10.0, 80.1, 10.0], [0] * 4), np.random.default_rng(0))
    assert found.outside.tolist() == [False, True, True, False]
    limited = replace(soil, ranges=RANGES | {"impact.speed": (0.1, 0.2)})
    found = limited(impacts([0.05, 0.15], [10.0, 10.0], [0, 0]), np.random.default_rng(0))
    assert found.outside.tolist() == [True, False]


def test_scatter_is_drawn_anew_in_proportion_to_the_speed_and_the_outcome_with_its_chance() -> None:
    rows = np.zeros((2, 6))
    rows[:, OUTPUTS.index("speed_out")] = [0.02, -0.02]
    rows[:, OUTPUTS.index("elevation_out")] = 0.3
    scatter = Scatter(rows, 0.2, np.array([name != "elevation_out" for name in OUTPUTS]))
    angles = scatter.draw(np.array([0.1, 0.4]), np.random.default_rng(1))[:, OUTPUTS.index("elevation_out")]
    assert angles.tolist() == [0.3, 0.3]
    soil = bounce([0.5], scatter)
    fast, slow = (
        np.linalg.norm(soil(impacts([speed] * 200, [0.0] * 200, [0] * 200), np.random.default_rng(1)).velocity, axis=1)
        for speed in (0.4, 0.1)
    )
    assert sorted(set(np.round(fast, 9))) == [0.16, 0.24]
    assert slow == pytest.approx(fast / 4.0)
    assert 60 < (fast > 0.2).sum() < 140
    captured = bounce([0.5], scatter, "captured")(impacts([0.4], [0.0], [0]), np.random.default_rng(1))
    assert (captured.captured.all(), captured.outside.any()) == (True, False)


def test_what_has_no_answer_is_neither_captured_nor_sent_on() -> None:
    """Over the rim, in contact at the time limit, or drawn with an elevation that there is not."""
    one = impacts([0.4], [0.0], [0])
    for outcome in ("left_sideways", "time_limit"):
        found = bounce([0.5], outcome=outcome)(one, np.random.default_rng(1))
        assert (found.captured.tolist(), found.outside.tolist()) == ([False], [True])
    rows = np.zeros((2, 6))
    rows[:, OUTPUTS.index("elevation_out")] = [-0.8, 0.1]
    steep = Scatter(rows, 0.2, np.zeros(6, dtype=bool))
    many = bounce([0.5], steep)(impacts([0.4] * 100, [0.0] * 100, [0] * 100), np.random.default_rng(1))
    assert 20 < many.outside.sum() < 80
    assert not many.captured.any()
    assert (many.velocity[~many.outside, 2] > 0.0).all()


def test_a_spin_straight_up_has_a_level_axis() -> None:
    assert rolling_spin(np.array([[0.0, 0.0, 1.0]]), np.array([2.0])).tolist() == [[0.0, 2.0, 0.0]]


def changed(**sections: dict[str, Any]) -> Study:
    return check_tables(with_keys(paper_tables(), sections), Path())


def test_the_soil_is_asked_where_speed_and_incidence_are_uncertain() -> None:
    speed = {"distribution": "uniform", "lower": 0.05, "upper": 0.4}
    assert "impact.speed and impact.incidence_deg are no uncertain input" in str(why_no_soil(changed()))
    assert "impact.incidence_deg is no uncertain" in str(why_no_soil(changed(impact={"speed": speed})))
    both = changed(impact={"speed": speed, "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 70.0}})
    assert why_no_soil(both) is None
    design = DrawnDesign(both)
    speeds = points(design, "screening", ())[:, list(design.inputs).index("impact.speed")]
    assert (speeds.min(), speeds.max()) == pytest.approx((0.05, 0.4))


def test_hard_ground_is_followed_from_the_first_impact_and_the_summary_adds_up(tmp_path: Path) -> None:
    """Near a pole, at a fixed speed: only hard ground can be followed, and nothing ends without a name."""
    site = {"latitude_deg": 75.0, "partner": False}
    study = changed(site=site, rest={"count": 60}, impact={"speed": 0.1}, flight={"gravity": "exact"})
    folder = StudyFolder(tmp_path / "out")
    drawn = np.full(100, SAMPLE_OUTCOMES.index("captured"))
    outputs = np.tile([0.05, 1.0, 0.5, 0.03, 0.0, 0.04], (100, 1))
    Samples.of([], OUTPUTS, np.zeros((100, 0)), outputs, drawn).save(folder)
    said: list[str] = []
    with ThreadPoolExecutor(1) as executor:
        shown = Silent()
        shown.say = said.append  # type: ignore[method-assign]
        job = Job(DrawnDesign(study), {}, folder, executor, shown)
        inputs = {name: np.array([1.0, 2.0]) for name in job.design.inputs}
        DesignRuns(["a", "b"], ["clear"] * 2, [""] * 2, inputs, {}).save(folder, "screening")
        follow_expansion_samples(job)
        assert folder.read_json("rest.json")["trained_ranges"] == {key: [1.0, 2.0] for key in inputs}
        write_table(folder, "flights.csv", COLUMNS, [])
        folder.write_json("flights.json", {})
        table = rest_results(job)
    assert "on hard ground only: impact.speed and" in said[0]
    assert table.soil is None
    assert table.hard.sample_count == 60
    assert sum(table.hard.outcomes[name].count for name in JourneyStatus) == 60
    lower, upper = wilson_interval(60, 60, NORMAL_QUANTILE_90)
    assert table.hard.outcomes["settled"] == proportion(60, 60).within(lower, upper)
    assert (folder / "rest.csv").read_text().splitlines()[0] == (
        "ground,sample,status,time_s,latitude_deg,longitude_deg,rebounds,path_length [m],slid_length [m],slid_time_s,"
        "impact_speed [m/s],impact_incidence_deg"
    )
    # Flights on the soil are noted, and there are none.
    assert (folder / "arcs.csv").read_text().strip().split(",")[:6] == (
        ["sample", "arc", "begin_s", "end_s", "clock_s", "position_x [m]"]
    )
    titles = (folder / "flights.csv").read_text().strip().split(",")
    assert titles[1:4] == ["start_speed [m/s]", "start_elevation_deg", "velocity_x [m/s]"]
    assert {"site_mass [kg]", "site_spin_period [s]", "site_north_error [m]", "time_s"} <= set(titles)
    rows = read_table(folder, "rest.csv")
    assert [row["sample"] for row in rows] == [str(sample) for sample in range(60)]
    # Every sample has the same first impact, and hard ground no scatter.
    assert {tuple(row.items())[2:] for row in rows} == {tuple(rows[0].items())[2:]}
    down, along = 0.1 * math.cos(math.radians(30.0)), 0.1 * math.sin(math.radians(30.0))
    hop = 2.0 * 0.6 * down / 2.3e-4 * max(0.8 * along, along - 0.6 * 1.6 * down)
    assert 0.5 * hop < float(rows[0]["path_length"]) < 3.0 * hop
    # Where bounces rise no more than a centimetre the rest is slid, some speed squared over twice the friction.
    along = max(0.8 * along, along - 0.6 * 1.6 * down)
    assert 0.0 < float(rows[0]["slid_length"]) < along**2 / (2.0 * 0.6 * 2e-4)
    assert 0.0 < float(rows[0]["slid_time_s"]) < float(rows[0]["time_s"])
    assert table.hard.slid.count == 60
    assert table.hard.quantiles["slid_length"]["quantile_0.5"] == float(rows[0]["slid_length"])


def test_a_flight_is_noted_by_its_sample_and_its_number_in_the_journey() -> None:
    """The second sample has left the runs' range at its first impact and is no lander of the journeys."""
    lander, begin = np.array([0, 0, 1]), np.array([0.0, 5.0, 1.0])
    vectors = np.arange(9.0).reshape(3, 3)
    arcs = Arcs(lander, begin, begin + 2.0, begin + 100.0, vectors, -vectors, np.full(3, 4e9), np.full(3, 3e4))
    rows = [dict(zip(ARC, row, strict=True)) for row in arc_rows(arcs, np.array([0, 2, 3]))]
    assert [(row["sample"], row["arc"]) for row in rows] == [(0, 0), (0, 1), (2, 0)]
    assert rows[1] == {"sample": 0, "arc": 1, "begin_s": 5.0, "end_s": 7.0, "clock_s": 105.0, "position_x": 3.0,
        "position_y": 4.0, "position_z": 5.0, "velocity_x": -3.0, "velocity_y": -4.0, "velocity_z": -5.0,
        "site_mass": 4e9, "site_spin_period": 3e4}  # fmt: skip


def captured_sites(study: Study, latitude: float) -> tuple[Sites, Rebounds]:
    """Two captured landers and one of which nobody knows, at a latitude."""
    names = ["captured", "captured", "time_limit"]
    outcome = np.array([SAMPLE_OUTCOMES.index(name) for name in names], dtype=np.uint8)
    samples = Samples(["grain.friction"], list(OUTPUTS), np.array([[0.9], [0.05], [0.9]]), np.zeros((3, 6)), outcome)
    site = {key: np.full(3, one) for key, one in Site(study).medians.items()} | {"latitude_deg": np.full(3, latitude)}
    first = Rebounds(np.zeros((3, 3)), np.zeros((3, 3)), np.array([True, True, False]), ~samples.known)
    return Sites.of(Site(study), samples, site), first


def test_a_captured_lander_rests_or_slides_by_the_friction_of_its_soil(tmp_path: Path) -> None:
    """On a slope of Didymos the rough one rests where it is, the smooth one goes downhill; at the equator both lift."""
    rest, flight = {"duration": 20000.0}, {"gravity": "exact"}
    study = changed(bed={"diameter": FINE}, site={"partner": False}, rest=rest, flight=flight)
    sites, first = captured_sites(study, 40.0)
    assert 0.05 < math.tan(float(sites.body.slope(40.0, 0.0))) < 0.9
    with ThreadPoolExecutor(1) as executor:
        job = Job(DrawnDesign(study), {}, StudyFolder(tmp_path / "out"), executor, Silent())
        rough, smooth, unknown = (
            dict(zip(REST, row, strict=True)) for row in sites.follow(job, "soil", first, HardSurface(0.0))
        )
        lifted = captured_sites(study, 0.0)
        ends = [row[2] for row in lifted[0].follow(job, "soil", lifted[1], HardSurface(0.0))]
    assert (rough["status"], rough["time_s"], rough["slid_length"], rough["rebounds"]) == ("settled", 0.0, 0.0, 0)
    assert smooth["slid_length"] > 1.0
    assert smooth["slid_time_s"] > math.sqrt(2.0 * smooth["slid_length"] / 1e-3)
    # Downhill on a body that spins at its limit is toward the equator.
    assert abs(smooth["latitude_deg"]) < 40.0
    assert (unknown["status"], unknown["slid_length"], unknown["latitude_deg"]) == ("outside", 0.0, pytest.approx(40.0))
    assert ends == ["lofted", "lofted", "outside"]


def test_the_friction_of_a_slide_is_that_of_hull_and_grain_or_of_rolling() -> None:
    samples = captured_sites(changed(), 40.0)[0].samples
    drawn = changed(lander={"friction": 0.4}, bed={"diameter": FINE})
    assert sliding_friction(DrawnDesign(drawn), samples, "soil").tolist() == [0.4, 0.05, 0.4]
    assert sliding_friction(DrawnDesign(drawn), samples, "hard").tolist() == [0.6] * 3
    rolls = changed(rest={"rolling_friction": 0.1})
    assert sliding_friction(DrawnDesign(rolls), samples, "soil").tolist() == [0.1] * 3
    assert sliding_friction(DrawnDesign(rolls), samples, "hard").tolist() == [0.1] * 3


def test_stones_as_large_as_the_lander_hold_it_more_than_its_contacts_do() -> None:
    samples, drawn = captured_sites(changed(), 40.0)[0].samples, changed(lander={"friction": 0.4})
    at_ends = INTERCEPT + SLOPE * np.array([0.4, 0.2, 0.4])
    for ground in ("soil", "equivalent"):
        assert sliding_friction(DrawnDesign(drawn), samples, ground) == pytest.approx(at_ends)
    assert sliding_friction(DrawnDesign(drawn), samples, "hard").tolist() == [0.6] * 3
    assert rest_dependencies(drawn)["sliding_law"] == (INTERCEPT, SLOPE)
    ball = {"shape": "sphere", "diameter": 0.1, "edges": None, "friction": 0.4}
    assert sliding_friction(DrawnDesign(changed(lander=ball)), samples, "soil").tolist() == [0.4, 0.05, 0.4]


def test_the_law_of_sliding_is_that_of_its_measurement() -> None:
    found = json.loads((ROOT / "validation" / "sliding_law.json").read_text(encoding="utf-8"))["law"]
    assert pytest.approx((found["intercept"], found["slope"]), abs=0.005) == (INTERCEPT, SLOPE)
    low, high = FRICTIONS
    assert found["scatter"] < found["scatter_about_coulomb"]
    assert (effective_friction(np.array([0.0, 2.0])) == effective_friction(np.array([low, high]))).all()


def test_what_comes_too_slowly_to_leave_is_captured_where_the_soil_has_no_answer() -> None:
    """Below the square root of g times the smallest edge, which half of that edge's lift is the energy of."""
    limit = math.sqrt(1e-5 * 0.1)

    def silent(hits: Impacts, random: np.random.Generator) -> Rebounds:
        nothing = np.zeros(len(hits.speed), dtype=bool)
        return Rebounds(np.full((len(hits.speed), 3), np.nan), hits.spin, nothing, hits.speed < 0.5)

    ground = SlowArrivals(silent, np.array([0.1]), np.array([0.002]))
    hits = impacts([0.99 * limit, 1.01 * limit, 0.6], [60.0] * 3, [0] * 3)
    found = ground(hits, np.random.default_rng(0))
    assert (found.captured.tolist(), found.outside.tolist()) == ([True, False, False], [False, True, False])
    assert found.velocity[0] == pytest.approx([0.99 * limit * math.sin(math.radians(60.0)), 0.0, 0.0])
    turning = replace(hits, spin=np.tile([0.0, limit / 0.05, 0.0], (3, 1)))
    assert not ground(turning, np.random.default_rng(0)).captured.any()
    assert not ground(replace(hits, effective_acceleration=np.full(3, 1e-5)), np.random.default_rng(0)).captured.any()
