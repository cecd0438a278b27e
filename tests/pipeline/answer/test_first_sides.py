"""What becomes of the landers by the side that faces the ground, from touchdowns whose answer is known."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from lithobrake.pipeline.answer.journey_ends import JourneyTable, first_sides, with_journeys
from lithobrake.pipeline.design.lander_attitude import with_side_down
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study, check_tables
from lithobrake.vocabulary.quantities import ORIENTATION

from ..journeys.soil_journeys import STUDY

COUNT = 120
RANDOM = np.random.default_rng(0)
AXIS = RANDOM.integers(3, size=COUNT)
BED = np.arange(COUNT) % 12


@pytest.fixture(scope="module")
def study() -> Study:
    return check_tables(tomllib.loads(STUDY), Path())


def touchdowns(told: bool = True) -> DesignRuns:
    """One with each axis upright at random: rebounds at 0.2, 0.3 and 0.4 of the speed; captured where z is upright."""
    azimuth = 360.0 * RANDOM.random(COUNT)
    turned = with_side_down(np.eye(3)[AXIS], azimuth, RANDOM.random(COUNT))
    attitude = dict(zip(ORIENTATION, turned.T, strict=True)) | {"impact.azimuth_deg": azimuth}
    inputs = {"bed": BED.astype(float), "impact.speed": np.full(COUNT, 0.1)} | (attitude if told else {})
    outcomes = np.where(AXIS == 2, "captured", "clear").tolist()
    return DesignRuns([""] * COUNT, outcomes, [""] * COUNT, inputs, {"speed_out": 0.1 * (0.2 + 0.1 * AXIS)})


def test_sides_have_the_landings_that_came_down_on_them(study: Study) -> None:
    returns = np.where(AXIS == 0, 0.5, 1.0)
    found = first_sides(study, touchdowns(), returns)
    assert list(found) == ["x", "y", "z"]
    for axis, one in enumerate(found.values()):
        assert one.landings == int((axis == AXIS).sum())
        assert one.speed_ratio.value == pytest.approx(0.2 + 0.1 * axis)
    assert [one.returns.share.value for one in found.values()] == pytest.approx([0.5, 1.0, 1.0])
    assert found["x"].returns.count == 0
    assert found["x"].words == "x, 0.1 m x 0.08 m"
    assert first_sides(study, touchdowns(told=False), returns) == {}


def test_journeys_and_all_touchdowns_stand_beside_the_first_ones(study: Study) -> None:
    runs = touchdowns()
    # Those that come down on x first do not rest; the others after as many seconds as their number.
    end = np.where(AXIS == 0, "escaped", "at_rest")
    numbers = {"time_s": np.arange(COUNT, dtype=float)}
    table = JourneyTable(end, BED, numbers, np.zeros((COUNT, 3)), np.full(COUNT, ""))
    found = with_journeys(study, first_sides(study, runs, np.ones(COUNT)), runs, runs, table)
    assert [one.at_rest.share.value for one in found.values()] == [0.0, 1.0, 1.0]
    assert not found["x"].time_s.is_known
    assert found["z"].time_s.value == pytest.approx(np.median(np.flatnonzero(AXIS == 2)), abs=3.0)
    assert [one.rests.share.value for one in found.values()] == [0.0, 0.0, 1.0]
    assert sum(one.touchdowns for one in found.values()) == COUNT
    # Those of other numbers, as of landers that never touch down, change which is which.
    part = table.taken(np.arange(60, COUNT))
    assert part.numbers["time_s"][0] == 60.0
    assert part.rests.tolist() == table.rests[60:].tolist()
