"""A small study of a lander with parts, from its file to its runs."""

from pathlib import Path

import numpy as np
import pytest

from lithobrake.pipeline import StudyFolder, run_study
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import attitude_terms
from lithobrake.pipeline.runs.energy_bound import gyrations
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results import open_study
from lithobrake.study import StudySource
from lithobrake.study.touchdown_model import lander

from ...few_grains import few_grains

LAW = '{ distribution = "uniform", lower = 0.2, upper = 0.8 }'
PARTS = f"""
[lander.centre_of_mass]
z = {{ distribution = "uniform", lower = -0.005, upper = 0.005 }}
[lander.part.foot]
shape = "sphere"
diameter = 0.02
centre = [0.0, 0.0, -0.04]
mass = 0.01
restitution = {LAW}
[lander.part.boom]
shape = "box"
edges = [0.1, 0.01, 0.01]
centre = [0.075, 0.0, 0.0]
density = 500.0
"""


def test_gyration_and_attitude_are_those_of_all_parts(tmp_path: Path) -> None:
    """A sphere alone is the same from all sides; a boom gives it axes, and its inertia to the bound of the spin."""
    path = tmp_path / "study.toml"
    path.write_text(few_grains(30, 0.8, 0.05).replace("[surface]", PARTS + "[surface]"))
    study = StudySource.read(path).study
    design = DrawnDesign(study)
    masses = np.array([0.1, 0.2, 0.1])
    smallest, largest = gyrations(design, {**{key: np.full(3, 1.0) for key in design.medians}, "lander.mass": masses})
    for k, mass in enumerate(masses):
        moments = np.linalg.eigvalsh(lander(study, {**design.medians, "lander.mass": mass}).body.inertia) / mass
        assert (smallest[k], largest[k]) == pytest.approx((moments[0], moments[2]))
    # A heavier ball with the same boom turns more easily for its mass.
    assert largest[1] < largest[0]
    terms = attitude_terms(study)
    assert terms.has_sides
    # The easiest axis is that along the boom.
    assert abs(terms.axes[0, 0]) > 0.9


def test_a_study_of_a_lander_with_parts_has_their_numbers_among_its_inputs(tmp_path: Path) -> None:
    text = few_grains(30, 0.8, 0.05, "0.6").replace("[surface]", PARTS + "[surface]")
    text = text.replace('restitution = { distribution = "uniform", lower = 0.5, upper = 0.8 }', "restitution = 0.7")
    path = tmp_path / "study.toml"
    path.write_text(f"seed = 5\n{text}[design]\nrun_count = 3\n")
    run_study(StudySource.read(path), tmp_path / "out", until="runs", worker_count=1)
    runs = DesignRuns.load(StudyFolder.only_read(tmp_path / "out"), "drawn")
    assert runs.run_count == 3
    assert set(runs.outcomes) <= {"clear", "captured", "left_sideways", "time_limit"}
    foot, centre = runs.inputs["lander.part.foot.restitution"], runs.inputs["lander.centre_of_mass.z"]
    assert len(np.unique(foot)) == 3
    assert (np.abs(centre) <= 0.005).all()
    assert (foot >= 0.2).all()
    assert (foot <= 0.8).all()
    assert len(open_study(tmp_path / "out").runs["key"]) >= 3
