"""Studies in two steps: other designs, repeated points, scatter; and the explorer of their expansions."""

import json
import math
import sys
from html import unescape
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import lithobrake
from lithobrake.chaos import coefficient_changes, load
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline import StudyFolder, stage_keys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.expansion.expansion_samples import Scatter, outcome_model
from lithobrake.pipeline.expansion.expansions import points
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.runs.landings import drawn_rows
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.stages import STAGES
from lithobrake.results import StudyResults, open_study
from lithobrake.study import Study, check_tables
from lithobrake.vocabulary.quantities import OUTPUTS, PLACE

from ...paper_tables import paper_tables
from ...report.browser import browser_page, needs_browser
from ...report.page_scripts import answer_of, explorer_data, needs_node
from ..synthetic_lander import synthetic_tables

# Two of the outputs scatter together, by a tenth of a millimetre a second along x and twice that upward.
SCATTER = 1e-4
PROGRAM = f"""
import json, random
question = json.load(open("inputs.json"))
values, chance = question["inputs"], random.Random(question["seed"]).gauss(0, {SCATTER})
x = 0.1 * values["impact.speed"] + 0.01 * values["lander.friction"] + chance
z = 0.3 * values["impact.speed"] * values["lander.restitution"] + 2 * chance
outputs = {{"velocity_out_x": x, "velocity_out_y": 0.0, "velocity_out_z": z, "spin_out": values["lander.friction"]}}
json.dump({{"outputs": outputs}}, open("outputs.json", "w"))
"""
STUDY = """
solver = { command = "PYTHON program.py" }
impact = { speed = { distribution = "uniform", lower = 0.1, upper = 0.2 }, incidence_deg = 30.0, azimuth_deg = 0.0 }
surface = { gravity = 5e-5 }
bed = { grain_count = 100, width = [0.6, 0.6], diameter = { distribution = "constant", value = 0.08 } }
grain = { density = 2500.0, young_modulus = 1e7, poisson_ratio = 0.25, restitution = 0.5, friction = 0.5 }
monte_carlo = { sample_count = 4_000, scatter = true }
flight = { flight_count = 10, duration = 3600.0 }
hard_ground = { count = 10 }
[lander]
shape = "sphere"
diameter = 0.1
mass = 1.0
restitution = { distribution = "uniform", lower = 0.4, upper = 0.8 }
friction = { distribution = "log_normal", mean = -1.0, std = 0.1 }
[journey]
touchdowns = 1
[design]
run_count = 0
[expansion]
points = "sobol_sequence"
screening_count = 20
screening_degree = 2
refined_count = 12
refined_degree = 2
replicate_count = 2
kept_outputs = ["speed_out"]
test_count = 8
"""


def changed(**expansion: Any) -> Study:
    tables = paper_tables()
    tables["expansion"].update(expansion)
    return check_tables(tables, Path())


@pytest.mark.parametrize("points_at", ["sobol_sequence", "latin_hypercube", "fekete"])
def test_designs_by_count_vary_what_they_should(points_at: str) -> None:
    study = changed(points=points_at, screening_count=60, refined_count=70)
    kept = ["grain.friction", "grain.restitution"]
    screening, refined = points(DrawnDesign(study), "screening", ()), points(DrawnDesign(study), "refined", kept)
    assert (len(screening), len(refined)) == (60, 70)
    assert (np.ptp(screening, axis=0) > 0.0).all()
    assert (np.ptp(refined, axis=0) > 0.0).tolist() == [False, False, True, True, False]
    assert np.array_equal(screening, points(DrawnDesign(study), "screening", ()))


def test_a_larger_sobol_sequence_keeps_the_points_of_a_smaller_one() -> None:
    few, many = (changed(points="sobol_sequence", screening_count=n, refined_count=60) for n in (50, 70))
    assert np.array_equal(points(DrawnDesign(few), "screening", ()), points(DrawnDesign(many), "screening", ())[:50])


def test_a_grid_of_few_inputs_reuses_the_nodes_of_the_grid_of_all() -> None:
    tables = paper_tables()
    tables["grain"]["friction"] = {"distribution": "uniform", "lower": 0.1, "upper": 0.7}
    study = check_tables(tables, Path())
    screening, refined = (
        {tuple(row) for row in points(DrawnDesign(study), design, ["grain.friction", "grain.restitution"]).tolist()}
        for design in ("screening", "refined")
    )
    # Both grids have 13 nodes on which the inputs that are not kept stand at their medians.
    assert len(screening & refined) == 13


def test_runs_of_expansions_draw_what_the_study_leaves_open() -> None:
    tables = paper_tables()
    del tables["impact"]["place"], tables["impact"]["azimuth_deg"]
    tables["bed"] |= {"sides": "periodic", "bed_count": 3, "width": [0.56, 0.6]}
    design = DrawnDesign(check_tables(tables, Path()))
    rows = drawn_rows(design, points(design, "screening", ()), 0)
    places = np.array([[row[name] for name in PLACE] for row in rows])
    # The grid over five inputs has 61 nodes.
    assert np.ptp(places, axis=0) == pytest.approx([0.56, 0.6], rel=0.1)
    assert {row["bed"] for row in rows} == {0.0, 1.0, 2.0}
    assert np.ptp([row["impact.azimuth_deg"] for row in rows]) > 300.0
    assert {row["impact.orientation.w"] for row in rows} == {1.0}


def test_another_number_of_runs_a_point_makes_again_from_the_screening_on() -> None:
    tables = paper_tables()
    tables["impact"]["orientation"] = "random"
    study = check_tables(tables, Path())
    before = stage_keys(study)
    tables["expansion"]["replicate_count"] = 3
    after = stage_keys(check_tables(tables, Path()))
    names = [stage.name for stage in STAGES if stage.files(study)]
    assert [name for name in names if before[name] == after[name]] == ["bed", "landing"]


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("scatter")
    (folder / "program.py").write_text(PROGRAM)
    (folder / "study.toml").write_text(STUDY.replace("PYTHON", f"{sys.executable} -S"))
    return lithobrake.run(folder / "study.toml", folder / "out", workers=1).folder


def test_points_run_twice_tell_the_scatter(out: Path) -> None:
    results = open_study(out).summary["results"]["expansion"]
    screening = results["designs"]["screening"]
    assert (screening["point_count"], screening["replicate_count"], screening["run_count"]) == (20, 2, 40)
    assert results["designs"]["test_all"]["run_count"] == 8
    fit = results["screening"]["fits"]["velocity_out_z"]
    # Twenty pairs: the estimate has a standard deviation of 16 %.
    assert fit["noise_std"] == pytest.approx(2.0 * SCATTER, rel=0.5)
    assert fit["noise_from"] == "repeated points, 20 degrees of freedom"
    assert fit["condition_number"] < 20.0
    # The quadratic is exact: all that is expected at a new run is scatter, its own and, through ten terms from twenty
    # points, that of the fit.
    assert 0.8 < fit["rmse_estimate"] / fit["noise_std"] < 4.0
    page = (out / "report" / "index.html").read_text()
    assert "takes 40 runs (20 points, 2 times each) of a Sobol sequence" in page
    assert "scatter between repeated runs" in page


def test_samples_have_the_scatter_and_are_kept_without_it(out: Path) -> None:
    with h5py.File(out / "samples.h5") as file:
        outputs, alone, names = file["outputs"][:], file["without_scatter"][:], list(file.attrs["output_names"])
        clear, outside = (list(file.attrs["outcomes"]).index(name) for name in ("clear", "outside"))
        outcome, inputs = file["outcome"][:], file["inputs"][:]
        impact_speed = inputs[:, list(file.attrs["input_names"]).index("impact.speed")]
    assert names == list(OUTPUTS)
    assert set(np.unique(outcome)) <= {clear, outside}
    assert np.array_equal(outcome == outside, outputs[:, OUTPUTS.index("velocity_out_z")] <= 0.0)
    for values in (outputs, alone):
        speed = values[:, OUTPUTS.index("speed_out")]
        assert np.linalg.norm(values[:, 3:], axis=1) == pytest.approx(np.abs(speed), rel=1e-12)
    # Drawn jointly, in whole rows: with each elevation comes one speed, in proportion to that of the impact.
    scatter = outputs - alone
    rows = np.column_stack([scatter[:, 1], scatter[:, 0] / impact_speed]).round(9)
    assert len(np.unique(rows[:, 0])) == len(np.unique(rows, axis=0)) <= 24
    assert scatter[:, 0].std() > 0.5 * SCATTER


def test_no_share_has_an_interval_that_would_hold_for_these_runs_only(out: Path) -> None:
    results = open_study(out).summary["results"]
    table, analysis = results["samples"]["shares"], results["expansion"]
    shares = [value for value in table.values() if isinstance(value, dict)]
    assert len(shares) > 9
    assert results["returns"]["missing"] == table["missing"]["share"]
    assert (results["samples"]["model"], table["level"]) == ("expansion", 0.95)
    # What bounces on hard ground has met neither the bed nor the expansion: its shares have the sampling error alone.
    at_rest = results["hard_ground"]["hard"]["ends"]["at_rest"]
    assert at_rest["lower"] <= at_rest["share"] <= at_rest["upper"]
    assert all(share["lower"] is share["upper"] is None for share in shares)
    assert table["why"] == results["returns"]["why"]
    assert results["headline"][0].startswith("With the touchdowns of this study's own program: ")
    assert results["headline"][1] == results["returns"]["why"]
    refined = analysis["refined"]["sobol_total"]["speed_out"]
    main = max(refined, key=lambda name: refined[name])
    (said,) = (one for one in results["headline"] if "truncation error" in one)
    assert f" {main}, " in said
    assert f"{refined[main]:.2f}" in said
    total, bounds = (analysis["screening"][key]["speed_out"] for key in ("sobol_total", "sobol_total_interval"))
    assert all(bounds[name][0] <= total[name] <= bounds[name][1] for name in total)
    assert all("q2_interval" in score for one in analysis["scores"].values() for score in one.values())


EXACT = 1e-12
ALL = ("live/law.js", "live/flown.js", "live/explore.js")
TWO_STEPS = {
    "screening_level": 2, "screening_degree": 2, "refined_level": 2,
    "refined_degree": 2, "kept_share": 0.9, "kept_outputs": ["speed_out"], "test_count": 12,
}  # fmt: skip
UNCERTAIN: dict[str, dict[str, Any]] = {
    "grain": {"friction": {"distribution": "uniform", "lower": 0.3, "upper": 0.9},
              "restitution": {"distribution": "uniform", "lower": 0.3, "upper": 0.9},
              "young_modulus": {"distribution": "log_uniform", "lower": 1e6, "upper": 1e8}, "rolling_friction": 0.1,
              "density": 2500.0},
    "impact": {"speed": {"distribution": "uniform", "lower": 0.1, "upper": 0.2}, "region": None, "azimuth_deg": 0.0,
               "place": {"x": 0.0, "y": 0.0}, "orientation": [1.0, 0.0, 0.0, 0.0]},
}  # fmt: skip


def land(values: dict[str, float], seed: int) -> dict[str, Any]:
    """Land on a soil that captures the rough and soft, and of which the stiffness hardly counts."""
    random = np.random.default_rng(seed)
    if values["grain.friction"] - values["grain.restitution"] > 0.35:
        return {"outcome": "captured"}
    elevation = 0.6 + 0.3 * values["grain.friction"] + 0.02 * random.standard_normal()
    speed = values["impact.speed"] * (0.3 + 0.5 * values["grain.restitution"] ** 2 + 0.02 * random.standard_normal())
    azimuth = 0.1 * random.standard_normal()
    level = speed * math.cos(elevation)
    leaving = {"velocity_out_x": level * math.cos(azimuth), "velocity_out_y": level * math.sin(azimuth)}
    spin = {"spin_out_x": 0.0, "spin_out_y": 3.0 * speed + 1e-9 * values["grain.young_modulus"], "spin_out_z": 0.0}
    return {"outcome": "clear", "outputs": leaving | spin | {"velocity_out_z": speed * math.sin(elevation)}}


def tables() -> dict[str, Any]:
    changes = {"design": {"run_count": 0}, "monte_carlo": {"scatter": True}, "hard_ground": {"count": 0}}
    return synthetic_tables(expansion=TWO_STEPS, **changes, **UNCERTAIN)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    return lithobrake.run(tables(), tmp_path_factory.mktemp("two_steps") / "out", workers=1, model=land)


@pytest.fixture(scope="module")
def job(results: StudyResults) -> Job:
    study = check_tables(tables(), Path()).with_function("of a test")
    return Job(DrawnDesign(study), {}, StudyFolder.only_read(results.folder), None, Silent())  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def given(results: StudyResults) -> dict[str, Any]:
    """What the page's explorer has."""
    return explorer_data((results.folder / "report" / "index.html").read_text(encoding="utf-8"))


@needs_node
def test_draws_of_the_browser_are_the_expansion_and_a_row_of_its_scatter(job: Job, given: dict[str, Any]) -> None:
    inputs, refined = DrawnDesign(job.study).inputs, load(job.folder / "refined.json")
    assert set(refined.input_names) < set(inputs), "an input has to be left out by the screening"
    random, scatter = np.random.default_rng(2), Scatter.of(job, refined)
    x = np.column_stack([law.ppf(random.random(40)) for law in inputs.values()])
    rows = random.integers(len(scatter.rows), size=40)
    found = np.array(answer_of(ALL, """const law = new Law(unpack(given.law), given.facts);
      return [0, 1].map((refit) => given.x.map((x, p) => {
        const point = law.pointAt(Float64Array.from(x, (one, input) => law.germOf(input, one)));
        const y = new Float64Array(law.outputs), chances = law.chancesAt(refit, point.terms, new Float64Array(4));
        // A row is drawn by its place; the outcome that has outputs is the first.
        law.chancesAt = () => Float64Array.of(1, 0, 0, 0);
        law.draw(refit, point, 0, (given.rows[p] + 0.5) / law.rowCount, new Float64Array(9), 0, y);
        delete law.chancesAt;
        return [...y, ...chances];
      }));""", given | {"x": x.tolist(), "rows": rows.tolist()}))  # fmt: skip
    kept = x[:, [list(inputs).index(name) for name in refined.input_names]]
    growth = np.where(scatter.grows, x[:, [list(inputs).index("impact.speed")]] / scatter.speed, 1.0)
    expected = refined(kept) + scatter.rows[rows] * growth
    largest = np.abs(expected).max(axis=0)
    assert np.abs((found[0, :, : len(OUTPUTS)] - expected) / largest).max() < EXACT
    assert np.abs(found[0, :, len(OUTPUTS) :] - outcome_model(job).probability(x)).max() < EXACT
    # The second one is the expansion with other coefficients.
    runs = DesignRuns.load(job.folder, "refined")
    indices, changes = coefficient_changes(
        refined, runs.columns(refined.input_names), runs.y, count=49, seed=hashed_seed(job.study.seed, "refits")
    )
    change = type(refined)(
        refined.inputs, indices, changes[0], output_names=refined.output_names, one_dimensional=False
    )(kept)
    assert np.abs(change / largest).max() > 1e-6
    assert np.abs((found[1, :, : len(OUTPUTS)] - expected - change) / largest).max() < EXACT


@needs_node
def test_the_whole_law_of_the_explorer_is_that_of_the_samples(results: StudyResults, given: dict[str, Any]) -> None:
    found = answer_of(ALL, """const { facts, law: packedLaw, flown: packedFlown } = given, starts = unpack(packedFlown);
      const flown = new Flown(starts.starts, starts.status), law = new Law(unpack(packedLaw), facts);
      flown.cells = new Uint16Array(starts.status.length);
      const explorer = new Explorer(law, flown, facts), { returns, known, left } = explorer.whole;
      const sum = (list) => list.reduce((all, one) => all + one, 0);
      let speed = 0;
      explorer.eachDraw(facts.inputs.map(() => [0, 1]), POINTS, (refit, row) => {
        if (row >= 0 && explorer.canLeave()) speed += explorer.y[facts.speed];
      });
      return [sum(returns) / sum(known), sum(left) / sum(known), speed / sum(left)];""", given)  # fmt: skip
    share, samples = results.summary["results"]["samples"]["shares"], results.samples
    left = samples["outcome"] == "clear"
    speed = samples["speed_out"][left]
    # The study has the chance of so many samples and flights; the refits of the page widen a share by less.
    chance = [math.sqrt(0.25 / share["sample_count"]), math.sqrt(0.25 / len(left)), speed.std() / math.sqrt(left.sum())]
    expected = np.array([share["returns"]["share"], left.mean(), speed.mean()])
    assert np.all(np.abs(np.array(found) - expected) < 3.0 * np.array(chance) + 0.01 * expected)


def test_sliders_are_those_of_the_kept_inputs(results: StudyResults, given: dict[str, Any]) -> None:
    facts, kept = given["facts"], list(results.results.expansion.kept_inputs)
    assert [facts["inputNames"][place] for place in facts["moved"]] == kept
    assert kept == ["grain.restitution", "impact.speed"]
    page = unescape((results.folder / "report" / "index.html").read_text(encoding="utf-8"))
    others = "Young's modulus of the grains and friction of the grains"
    assert f"Removed by the screening and always over their whole distribution: {others}." in page
    assert "residuals that fall on other runs; no other bed" in page


@needs_browser
def test_a_slider_moves_the_explorer_of_two_steps(results: StudyResults, tmp_path: Path) -> None:
    with browser_page(tmp_path) as page:
        page.open(results.folder / "report" / "index.html", 1366)
        assert page.value("document.querySelectorAll('#explorer input[type=range]').length") == 4
        read = "[...document.querySelectorAll('#explorer figcaption, #explorer .share')].map((one) => one.textContent)"
        before = page.value(read)
        # The slow half of the speeds of impact.
        moved = "(() => { const end = document.querySelectorAll('#explorer input')[3]; end.value = 0.5;"
        page.value(f"{moved} end.dispatchEvent(new Event('input')); }})()")
        # Until the explorer has answered, or has had time enough.
        page.value(f"""new Promise((done) => {{
          const first = () => document.querySelector('#explorer figcaption, #explorer .share').textContent;
          const was = {json.dumps(before[0])}, end = Date.now() + 5000;
          const look = () => first() !== was || Date.now() > end ? setTimeout(done, 200) : setTimeout(look, 50);
          look();
        }})""")
        after = page.value(read)
        assert len(before) == 5
        assert before[0] != after[0]
        assert not any("NaN" in words for words in [*before, *after])
        assert page.complaints == []
