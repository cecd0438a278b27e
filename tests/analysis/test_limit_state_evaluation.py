"""Which landings meet a limit state, how far others are from it, and what is not known."""

import numpy as np
import pytest

from lithobrake.analysis.subset_simulation import FAR, NEAR, limit_state_margin, limit_state_met
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.outcomes import FATES

NAN = np.nan
# Four landings: fast and gone, slow and down again, captured, and one of which nobody knows.
LANDINGS = {
    "speed_out": [0.2, 0.05, NAN, NAN], "peak_acceleration": [30.0, 60.0, 70.0, NAN], "captured": [0.0, 0.0, 1.0, NAN],
    "returns": [0.0, 1.0, 1.0, NAN], "escaped": [1.0, 0.0, 0.0, NAN],
}  # fmt: skip
MET: list[tuple[str, list[float]]] = [
    ("speed_out > 0.1", [1, 0, 0, NAN]),
    # What is captured has no speed, so it is neither above nor below any.
    ("speed_out <= 0.1", [0, 1, 0, NAN]),
    ("not speed_out > 0.1", [0, 1, 1, NAN]),
    ("peak_acceleration > 50", [0, 1, 1, NAN]),
    ("returns == false", [1, 0, 0, NAN]),
    ("returns != true", [1, 0, 0, NAN]),
    ("not returns", [1, 0, 0, NAN]),
    ("captured or 0.01 < speed_out < 1e-1", [0, 1, 1, NAN]),
    ("(escaped or captured) and peak_acceleration > 50", [0, 0, 1, NAN]),
    ("speed_out > -1 and not returns", [1, 0, 0, NAN]),
]
# How far the same landings are from meeting conditions, speeds counted in 0.1 m/s and accelerations in 10 m/s2.
SCALE = {"speed_out": 0.1, "peak_acceleration": 10.0}
MARGINS: list[tuple[str, list[float]]] = [
    ("speed_out > 0.1", [-1.0, 0.5, FAR, FAR]), ("not speed_out > 0.1", [1.0, -0.5, -FAR, FAR]),
    ("0.05 < speed_out <= 0.3", [-1.0, NEAR, FAR, FAR]),
    ("speed_out > 0.1 and peak_acceleration > 50", [2.0, 0.5, FAR, FAR]),
    ("speed_out > 0.3 or peak_acceleration > 50", [1.0, -1.0, -2.0, FAR]),
    ("speed_out > 0.1 and not captured", [-1.0, 0.5, FAR, FAR]), ("0 < 0.1 < speed_out", [-1.0, 0.5, FAR, FAR]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "margins"), MARGINS)
def test_a_margin_says_how_far_a_landing_is_from_meeting_it(text: str, margins: list[float]) -> None:
    values = {name: np.array(numbers) for name, numbers in LANDINGS.items()}
    found = limit_state_margin(LimitState.of(text), values, SCALE)
    assert found == pytest.approx(np.array(margins), rel=1e-12)
    assert np.array_equal(found <= 0.0, limit_state_met(LimitState.of(text), values) == 1.0)


@pytest.mark.parametrize(("text", "expected"), MET)
def test_landings_meet_a_condition_or_not_or_nobody_knows(text: str, expected: list[float]) -> None:
    values = {name: np.array(value) for name, value in LANDINGS.items()}
    assert limit_state_met(LimitState.of(text), values).tolist() == pytest.approx(expected, nan_ok=True)


def test_what_is_known_decides_where_it_can() -> None:
    unknown = {name: np.array([NAN]) for name in FATES} | {"speed_out": np.array([0.2])}
    assert limit_state_met(LimitState.of("speed_out > 0.1 or returns"), unknown).tolist() == [1.0]
    assert limit_state_met(LimitState.of("speed_out < 0.1 and returns"), unknown).tolist() == [0.0]
    assert np.isnan(limit_state_met(LimitState.of("speed_out > 0.1 and returns"), unknown)).all()
