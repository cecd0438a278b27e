"""Designs other than the sparse grid, points that are run several times, and scatter in the samples."""

import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from lithobrake.pipeline import stage_keys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.paper.paper_designs import points
from lithobrake.results import open_study
from lithobrake.study import Study, check_tables
from lithobrake.vocabulary.quantities import OUTPUTS

from ...command_line import lithobrake
from ...paper_tables import paper_tables

# Two of the outputs scatter together, by a tenth of a millimetre a second along x and twice that upward.
SCATTER = 1e-4
PROGRAM = f"""
import json, random
from pathlib import Path
question = json.loads(Path("inputs.json").read_text())
values, chance = question["inputs"], random.Random(question["seed"]).gauss(0, {SCATTER})
x = 0.1 * values["impact.speed"] + 0.01 * values["lander.friction"] + chance
z = 0.3 * values["impact.speed"] * values["lander.restitution"] + 2 * chance
outputs = {{"velocity_out_x": x, "velocity_out_y": 0.0, "velocity_out_z": z, "spin_out": values["lander.friction"]}}
Path("outputs.json").write_text(json.dumps({{"outputs": outputs}}))
"""
STUDY = """
solver = { command = "PYTHON program.py" }
impact = { speed = { distribution = "uniform", lower = 0.1, upper = 0.2 }, incidence_deg = 30.0 }
surface = { gravity = 5e-5 }
bed = { grain_count = 100, width = [0.6, 0.6], diameter = { distribution = "constant", value = 0.08 } }
grain = { density = 2500.0, young_modulus = 1e7, poisson_ratio = 0.25, restitution = 0.5, friction = 0.5 }
monte_carlo = { sample_count = 20_000, scatter = true }
flight = { flight_count = 10, duration = 3600.0 }
[lander]
shape = "sphere"
diameter = 0.1
mass = 1.0
restitution = { distribution = "uniform", lower = 0.4, upper = 0.8 }
friction = { distribution = "log_normal", mean = -1.0, std = 0.1 }
[design]
method = "paper"
points = "sobol_sequence"
screening_count = 20
screening_degree = 2
refined_count = 12
refined_degree = 2
replicate_count = 2
kept_outputs = ["speed_out"]
test_count = 8
"""


def changed(**design: Any) -> Study:
    """The template with another design."""
    tables = paper_tables()
    tables["design"].update(design)
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


def test_another_number_of_runs_a_point_makes_again_from_the_screening_on() -> None:
    tables = paper_tables()
    tables["impact"]["orientation"] = "random"
    before = stage_keys(check_tables(tables, Path()))
    tables["design"]["replicate_count"] = 3
    after = stage_keys(check_tables(tables, Path()))
    assert [name for name in before if before[name] == after[name]] == ["bed", "landing"]


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished study of a program that scatters."""
    folder = tmp_path_factory.mktemp("scatter")
    (folder / "program.py").write_text(PROGRAM)
    (folder / "study.toml").write_text(STUDY.replace("PYTHON", f"{sys.executable} -S"))
    ended = lithobrake("run", folder / "study.toml", "--out", folder / "out", "--workers", 2)
    assert ended.returncode == 0, ended.stderr
    return folder / "out"


def test_points_run_twice_tell_the_scatter(out: Path) -> None:
    results = open_study(out).summary["results"]
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


def test_the_page_gives_no_interval_that_would_hold_for_these_runs_only(out: Path) -> None:
    results = open_study(out).summary["results"]
    shares = [value for value in results["shares"].values() if isinstance(value, dict)]
    shares += [
        value for value in (results["rest"]["soil"] or {}).values() if isinstance(value, dict) and "share" in value
    ]
    assert len(shares) > 9
    assert results["returns"]["missing"] == results["shares"]["missing"]["share"]
    # What bounces on hard ground has met neither the bed nor the expansion: its shares have the sampling error alone.
    settled = results["rest"]["hard"]["settled"]
    assert settled["lower"] <= settled["share"] <= settled["upper"]
    assert all(share["lower"] is share["upper"] is None for share in shares)
    assert results["shares"]["why"] == results["returns"]["why"]
    assert results["headline"][0].startswith("With the touchdowns of this study's own program: ")
    assert results["headline"][1] == results["returns"]["why"]
    refined = results["refined"]["sobol_total"]["speed_out"]
    main = max(refined, key=lambda name: refined[name])
    (said,) = (one for one in results["headline"] if "truncation error" in one)
    assert f" {main}, " in said
    assert f"{refined[main]:.2f}" in said
    total, bounds = (results["screening"][key]["speed_out"] for key in ("sobol_total", "sobol_total_interval"))
    assert all(bounds[name][0] <= total[name] <= bounds[name][1] for name in total)
    assert all("q2_interval" in score for table in results["scores"].values() for score in table.values())
