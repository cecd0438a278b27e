"""What is said of delivery options, by landers whose ends are given."""

import numpy as np
import pytest

from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.answer.option_answers import OptionLanders, _on_ground
from lithobrake.study.design_sections import AimLimit
from lithobrake.vocabulary.limit_state import LimitState

from ..few_terms import REFITS

COUNT = 4 * REFITS


@pytest.mark.parametrize("limit", ["lost < 0.05", "lost > 0.05"])
def test_an_option_of_which_no_end_is_known_keeps_no_limit(limit: str) -> None:
    """Of the first option no end is known; of the second all rest, or a tenth escapes where more is asked."""
    few = np.where(np.arange(COUNT) < COUNT // 10 * (">" in limit), "escaped", "at_rest")
    status = np.array([["unknown"] * COUNT, few], dtype=object)
    numbers = {name: np.ones(status.shape) for name in ("distance", "time_s")}
    refit = np.tile(np.arange(COUNT) % REFITS, (2, 1))
    landers = OptionLanders(status, refit, numbers, {"lost": LimitState.of("not at_rest")}, None)
    asked = [one for one in (AimLimit.of(limit),) if one is not None]
    (nothing, known), best = _on_ground(landers, [{}, {}], asked, Refits(12, 60, None), "soil")
    assert not nothing.limit_states["lost"].is_known
    assert nothing.limit_states["lost"].bounds == (0.0, 1.0)
    assert (nothing.allowed, known.allowed) == (False, True)
    assert known.limit_states["lost"].value == (few == "escaped").mean()
    assert best is not None
    assert best.aim == 1
