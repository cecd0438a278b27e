"""The restitution that a soft surface implies, and journeys on hard ground that has it."""

from pathlib import Path

import numpy as np
import pytest

import lithobrake
from lithobrake.pipeline.first_bounces.bounce_laws import implied
from lithobrake.smallbody import HardSurface, Impacts

from ..synthetic_lander import SyntheticLander, synthetic_tables


def test_hard_ground_implies_itself() -> None:
    """The rebounds of a hard surface give back the numbers that it was made of."""
    random = np.random.default_rng(1)
    speed, incidence = random.uniform(0.01, 0.4, 200), random.uniform(0.1, 1.2, 200)
    nothing, lander = np.zeros((200, 3)), np.arange(200)
    for friction in (np.inf, 0.1):
        impacts = Impacts(speed, incidence, nothing, np.full(200, -1e-4), lander)
        left = HardSurface(0.6, 0.8, friction)(impacts, random).velocity
        found = implied(speed, incidence, left)
        assert found["normal_restitution"] == pytest.approx(0.6)
        slides = found["tangential_restitution"] > 0.8 + 1e-9
        assert found["tangential_restitution"][~slides] == pytest.approx(0.8)
        assert found["friction"][slides] == pytest.approx(friction)
        assert slides.any() == np.isfinite(friction)


def test_a_study_of_one_speed_has_no_table(tmp_path: Path) -> None:
    tables = synthetic_tables(design={"run_count": 30}, monte_carlo={"sample_count": 100}, rest={"count": 20})
    out = lithobrake.run(tables, tmp_path / "out", workers=1, model=SyntheticLander(), report=False)
    assert not (out.folder / "restitution.csv").exists()
    assert out.summary["results"]["rest"]["equivalent"] is None
