"""Which rotation of the ground a touchdown of a study has: what its file says, or that of the body."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import Study, StudyError, check_tables, load_tables
from lithobrake.touchdown.touchdown_model import landing

SCENARIOS = Path(__file__).parents[2] / "scenarios"


def study(name: str, **sections: dict[str, Any]) -> Study:
    tables = load_tables(SCENARIOS / f"{name}.toml")
    return with_site_gravity(check_tables(tables | {key: tables.get(key, {}) | one for key, one in sections.items()},
        SCENARIOS))  # fmt: skip


def test_a_study_with_a_gravity_of_its_own_turns_as_it_says() -> None:
    still, turning = study("first_bounce"), study("first_bounce", surface={"gravity": 5e-5, "rotation_z": 1e-4})
    assert landing(still, DrawnDesign(still).rows[0]).rotation == (0.0, 0.0, 0.0)
    assert landing(turning, DrawnDesign(turning).rows[0]).rotation == (0.0, 0.0, 1e-4)


def test_a_lander_meets_ground_that_turns_with_its_body() -> None:
    """In the frame of its bed, tilted as the facet is and turned about its normal: the size is that of the body."""
    asked = study("quick")
    design = DrawnDesign(asked)
    rate = 2.0 * np.pi / design.site.body.spin_period
    turns = np.array([landing(asked, row).rotation for row in design.rows])
    assert np.linalg.norm(turns, axis=1) == pytest.approx(rate, rel=1e-9)
    # At 10 degrees north the axis lies nearly along the ground.
    assert 0.0 < np.median(turns[:, 2]) < 0.5 * rate


@pytest.mark.parametrize(
    ("surface", "said"),
    [
        ({"rotation_z": 1e-4}, r"the ground turns as the body; leave it out"),
        ({"rotation_y": 0.5}, r"surface\.rotation_y is 0\.5; allowed: at least -0\.01 and at most 0\.01"),
        ({"rotation_x": "fast"}, r"surface\.rotation_x is \"fast\""),
    ],
)
def test_a_rotation_that_cannot_be_is_refused_in_a_sentence(surface: dict[str, Any], said: str) -> None:
    with pytest.raises(StudyError, match=said):
        study("quick", surface=surface)
