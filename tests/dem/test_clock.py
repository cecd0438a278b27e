"""Steps that were given, and steps that are chosen."""

import math

import pytest

from lithobrake.dem.stepping.time_step_stability import Clock


def test_a_chosen_step_is_made_to_fit_the_duration_and_holds() -> None:
    clock = Clock(0.0, None, None)
    assert clock.steps_in(1.0, lambda: 0.3) == 4
    assert clock.time_step == 0.25
    assert clock.steps_in(0.5, lambda: math.nan) == 2


def test_only_a_step_that_was_given_outlasts_a_change() -> None:
    chosen, given = Clock(0.0, None, 0.25), Clock(0.0, None, 0.25)
    given.give(0.1)
    for clock in (chosen, given):
        clock.choose_anew()
    assert (chosen.time_step, given.time_step) == (None, 0.1)


def test_no_duration_takes_no_step_and_chooses_none() -> None:
    clock = Clock(0.0, None, None)
    assert clock.steps_in(0.0, lambda: 0.3) == 0
    assert clock.time_step is None


@pytest.mark.parametrize("duration", [-1.0, math.inf, math.nan])
def test_a_duration_that_is_none_is_refused(duration: float) -> None:
    with pytest.raises(ValueError, match="duration"):
        Clock(0.0, 0.1, 0.1).steps_in(duration, lambda: 0.1)
