"""Runs in which the lander came farther than the ground repeats."""

import numpy as np
import pytest

from lithobrake.pipeline.answer.run_estimates import _farther_than_period
from lithobrake.pipeline.runs.run_table import DesignRuns


@pytest.mark.parametrize(("outputs", "count"), [
    ({"periods_travelled": np.array([0.2, 1.0, 1.7, np.nan])}, 1),
    ({"periods_travelled": np.array([0.2, 0.3, 0.4, 0.5])}, 0),
    # Beds with walls have no period.
    ({}, None),
])  # fmt: skip
def test_those_that_came_farther_than_the_period_are_counted(outputs: dict[str, np.ndarray], count: int | None) -> None:
    runs = DesignRuns([""] * 4, ["clear", "clear", "captured", "failed"], [""] * 4, {}, outputs)
    assert _farther_than_period(runs) == count
