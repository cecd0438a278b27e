"""The attitude of a study's lander: its terms by shape and attitude law, and the side that faces the ground."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.pipeline.design.design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import attitude_terms, independent_terms, seen, with_side_down
from lithobrake.study import Study, check_tables
from lithobrake.study.lander_section import directions_of_sides, side_words, sides_down
from lithobrake.vocabulary.quantities import ORIENTATION

from ..journeys.soil_journeys import STUDY


def study_of(text: str) -> Study:
    return check_tables(tomllib.loads(text), Path())


def lander(words: str) -> Study:
    """The study with another lander."""
    return study_of(STUDY.replace('shape = "box"\nedges = [0.12, 0.1, 0.08]', words))


BOX, PRISM = lander('shape = "box"\nedges = [0.12, 0.1, 0.08]'), lander('shape = "box"\nedges = [0.08, 0.14, 0.08]')
BALL = lander('shape = "sphere"\ndiameter = 0.1')


def test_terms_follow_the_shape_and_a_ball_has_none() -> None:
    assert [attitude_terms(one).names for one in (BOX, PRISM)] == [("x", "z"), ("y",)]
    assert attitude_terms(BALL) is None
    assert independent_terms(DrawnDesign(BALL), {}) is None


def columns(turned: Rotation) -> dict[str, np.ndarray]:
    """Inputs of touchdowns of these attitudes in the bed."""
    quaternions = np.roll(turned.as_quat(), 1, axis=1)
    return dict(zip(ORIENTATION, quaternions.T, strict=True)) | {"impact.azimuth_deg": np.zeros(len(quaternions))}


def test_drawn_attitudes_have_independent_terms() -> None:
    found = independent_terms(DrawnDesign(BOX), columns(Rotation.random(20_000, rng=0)))
    assert found.mean(axis=0) == pytest.approx(np.zeros(6), abs=0.03)
    assert np.cov(found.T) == pytest.approx(np.eye(6), abs=0.04)


def test_one_attitude_has_no_terms_and_a_pointed_one_has_those_of_its_cone() -> None:
    one = study_of(STUDY.replace("[delivery]", "[delivery]\norientation = [1.0, 0.0, 0.0, 0.0]"))
    assert independent_terms(DrawnDesign(one), columns(Rotation.identity(20))) is None
    tilts = 0.1 * np.random.default_rng(1).standard_normal((400, 3))
    found = independent_terms(DrawnDesign(one), columns(Rotation.from_rotvec(tilts)))
    # Over the runs themselves they are exactly independent, however small the cone.
    assert found.mean(axis=0) == pytest.approx(np.zeros(found.shape[1]), abs=1e-9)
    assert found.T @ found / 400 == pytest.approx(np.eye(found.shape[1]), abs=1e-6)


def test_the_side_is_that_of_the_axis_nearest_to_the_normal() -> None:
    normal = np.array([[0.9, 0.3, -0.3], [-0.2, 0.8, 0.5], [0.1, 0.2, -0.9]])
    assert sides_down(BOX.lander, normal).tolist() == ["x", "y", "z"]
    assert sides_down(PRISM.lander, normal).tolist() == ["x or z", "y", "x or z"]
    assert sides_down(BALL.lander, normal).tolist() == ["", "", ""]
    assert side_words(BOX.lander, "z") == "z, 0.12 m x 0.1 m"
    assert side_words(PRISM.lander, "x or z") == "x or z, 0.14 m x 0.08 m"


@pytest.mark.parametrize("study", [BOX, PRISM])
def test_a_chosen_side_is_down_whatever_the_azimuth(study: Study) -> None:
    random = np.random.default_rng(2)
    for side, downs in directions_of_sides(study.lander).items():
        down, azimuth = np.array(downs)[random.integers(len(downs), size=40)], 360.0 * random.random(40)
        turned = with_side_down(down, azimuth, random.random(40))
        normal, travel = seen(dict(zip(ORIENTATION, turned.T, strict=True)) | {"impact.azimuth_deg": azimuth})
        assert normal == pytest.approx(-down, abs=1e-12)
        assert set(sides_down(study.lander, normal)) == {side}
        # It comes from all sides.
        assert np.linalg.norm(travel.mean(axis=0)) < 0.35
