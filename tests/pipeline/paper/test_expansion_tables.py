"""The explorer of a study in two steps evaluates the refined expansion that Python evaluates, with its scatter."""

import math
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.chaos import coefficient_changes, load
from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.paper.expansion_samples import outcome_model
from lithobrake.pipeline.paper.run_noise import Scatter
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults
from lithobrake.study import check_tables
from lithobrake.vocabulary.quantities import OUTPUTS

from ...report.browser import browser_page, needs_browser
from ...report.page_scripts import answer_of, explorer_data, needs_node
from ..synthetic_lander import synthetic_tables

EXACT = 1e-12
ALL = ("live/law.js", "live/flown.js", "live/explore.js")
TWO_STEPS = {
    "method": "paper", "run_count": None, "screening_level": 2, "screening_degree": 2, "refined_level": 2,
    "refined_degree": 2, "kept_share": 0.9, "kept_outputs": ["speed_out"], "test_count": 12,
}  # fmt: skip
UNCERTAIN: dict[str, dict[str, Any]] = {
    "grain": {"friction": {"distribution": "uniform", "lower": 0.3, "upper": 0.9},
              "restitution": {"distribution": "uniform", "lower": 0.3, "upper": 0.9},
              "young_modulus": {"distribution": "log_uniform", "lower": 1e6, "upper": 1e8}, "rolling_friction": 0.1,
              "density": 2500.0},
    "impact": {"speed": {"distribution": "uniform", "lower": 0.1, "upper": 0.2}, "region": None},
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
    return synthetic_tables(design=TWO_STEPS, monte_carlo={"scatter": True}, **UNCERTAIN)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    return lithobrake.run(tables(), tmp_path_factory.mktemp("two_steps") / "out", workers=1, model=land)


@pytest.fixture(scope="module")
def job(results: StudyResults) -> Job:
    study = check_tables(tables(), Path()).with_function("of a test")
    return Job(DrawnDesign(study), Site(study), {}, StudyFolder.only_read(results.folder), None, Silent())  # type: ignore[arg-type]


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
    share, samples = results.summary["results"]["shares"], results.samples
    left = samples["outcome"] == "clear"
    speed = samples["speed_out"][left]
    # The study has the chance of so many samples and flights; the refits of the page widen a share by less.
    flown = share["sample_count"]
    chance = [math.sqrt(0.25 / flown), math.sqrt(0.25 / len(left)), speed.std() / math.sqrt(left.sum())]
    expected = np.array([share["returns"]["share"], left.mean(), speed.mean()])
    assert np.all(np.abs(np.array(found) - expected) < 3.0 * np.array(chance) + 0.01 * expected)


def test_sliders_are_those_of_the_kept_inputs(results: StudyResults, given: dict[str, Any]) -> None:
    facts, kept = given["facts"], results.summary["results"]["kept_inputs"]
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
        page.value("new Promise((done) => setTimeout(done, 1500))")
        after = page.value(read)
        assert len(before) == 5
        assert before[0] != after[0]
        assert not any("NaN" in words for words in [*before, *after])
        assert page.complaints == []
