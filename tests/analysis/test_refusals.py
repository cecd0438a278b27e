"""What cannot be is refused by name, value and range before anything is computed from it."""

from collections.abc import Callable

import numpy as np
import pytest

from lithobrake import analysis
from lithobrake.chaos import Uniform

NAN, INF = float("nan"), float("inf")
PLACES = np.random.default_rng(0).normal(10.0, 2.0, (2, 20))
INPUTS = {"a": Uniform(0.0, 1.0)}
ANSWERS, BEDS = [0.0, 1.0, 1.0, 0.0, 0.5], [0, 1, 2, 3, 4]


def next_count(half_width: float, largest: int = 100) -> int | None:
    return analysis.next_run_count(ANSWERS, BEDS, half_width, largest, lambda count: count)


def latitudes(one: float) -> list[float]:
    return [one, *PLACES[0, 1:].tolist()]


REFUSED: dict[str, tuple[Callable[[], object], str]] = {
    "no interval is so narrow": (lambda: analysis.runs_for_half_width(1e-200), "half_width is 1e-200"),
    "an infinite half width": (lambda: analysis.runs_for_half_width(INF), "half_width is inf"),
    "a spread of NaN": (lambda: analysis.runs_for_half_width(0.02, spread=NAN), "spread is nan"),
    "an infinite spread": (lambda: analysis.runs_for_half_width(0.02, spread=INF), "spread is inf"),
    "a correlation of 2": (lambda: analysis.runs_for_half_width(0.02, correlation=2.0), "correlation is 2"),
    "half a run a bed": (lambda: analysis.runs_for_half_width(0.02, 0), "runs_per_bed is 0"),
    "more beds than runs": (lambda: analysis.expected_half_width(5, 6), "bed_count is 6, .* from 1 to 5"),
    "next count for 0": (lambda: next_count(0.0), "half_width is 0.0"),
    "next count below 0": (lambda: next_count(-1.0), "half_width is -1.0"),
    "next count for NaN": (lambda: next_count(NAN), "half_width is nan"),
    "next count up to 0": (lambda: next_count(0.02, 0), "largest is 0"),
    "a quantile of NaN": (lambda: analysis.quantile_within([1.0, NAN, 3.0], 0.5, (0.1, 0.9)), "values have shape"),
    "a quantile of nothing": (lambda: analysis.quantile_within([], 0.5, (0.1, 0.9)), "at least one value"),
    "a quantile at 5": (lambda: analysis.quantile_within([1.0, 3.0], 5.0, (0.1, 0.9)), "probability is 5.0"),
    "levels of 5": (lambda: analysis.quantile_within([1.0, 3.0], 0.5, (0.1, 5.0)), "levels is 5.0"),
    "levels turned over": (lambda: analysis.quantile_within([1.0, 3.0], 0.5, (0.9, 0.1)), "lower level first"),
    "a place of NaN": (lambda: analysis.dispersion_ellipses(latitudes(NAN), PLACES[1]), "place 0 has latitude_deg nan"),
    "latitude 500": (
        lambda: analysis.dispersion_ellipses(latitudes(500.0), PLACES[1]),
        "latitude_deg 500 .* -90 to 90",
    ),
    "few longitudes": (lambda: analysis.dispersion_ellipses(PLACES[0], PLACES[1, :5]), r"both must be \[count\]"),
    "no run below 0": (lambda: analysis.upper_limit(-3), "unit_count is -3"),
    "half a run": (lambda: analysis.upper_limit(2.5), "unit_count is 2.5"),  # type: ignore[arg-type]
    "a level of 95": (lambda: analysis.upper_limit(10, 95.0), "level is 95.0"),
    "an infinite difference": (lambda: analysis.chaos_variance([INF, 1.0]), "differences .* 1 infinite"),
    "an infinite output": (lambda: analysis.mean_estimate([INF, 1.0, 2.0], [0, 1, 2]), "values .* 1 infinite"),
    "a bed of NaN": (lambda: analysis.mean_estimate([1.0, 2.0, 3.0], [0.0, NAN, 1.0]), "bed hold NaN"),
    "more met than drawn": (lambda: analysis.refit_interval([5, 9], [6, 6], 4), "counts must lie between 0"),
    "refits of NaN": (lambda: analysis.refit_interval([5, 4], [6, NAN], 4), "counts must lie between 0"),
    "an infinite choice": (lambda: analysis.best_choice(np.full((2, 3, 3), np.inf), 3, [True, True]), "must be finite"),
    "a third choice": (lambda: analysis.best_choice(np.ones((2, 3, 3)), 3, [True] * 3), "whether each choice"),
    "beds of NaN": (lambda: analysis.refit_interval([1, 2], [5, 5], NAN), "bed_count is nan"),  # type: ignore[arg-type]
    "squares that overflow": (lambda: analysis.mean_estimate([1e200, 2e200], [0, 1]), "2 infinite values or beyond"),
    "no runs": (lambda: analysis.next_run_count([], [], 0.02, 100, lambda count: count), "how many runs"),
    "a fifth refit": (lambda: analysis.drawn_counts([1, 0], [0, 5], 2), "a place from 0 to 1"),
    "met twice": (lambda: analysis.drawn_counts([1, 2], [0, 1], 2), "1, 0 or NaN"),
    "failing thrice": (lambda: analysis.failure_inputs(INPUTS, [[0.5]], [3.0], [0]), "failing must lie between"),
    "points outside": (lambda: analysis.failure_inputs(INPUTS, [[5.0]], [1.0], [0]), "a is 5, but its support"),
    "a sample below 0": (lambda: analysis.sample_inputs(INPUTS, -1, 0), "count is -1"),
    "outcomes nowhere": (lambda: analysis.OutcomeModel(INPUTS, np.array([[NAN]]), ["a"], ["a"]), "a is nan"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_is_refused(what: str) -> None:
    call, words = REFUSED[what]
    with pytest.raises(ValueError, match=words):
        call()


def test_what_is_at_the_edge_is_taken() -> None:
    assert analysis.runs_for_half_width(0.02, 10, spread=0.0) == 20
    assert analysis.quantile_within([1.0, 3.0], 0.5, (0.0, 1.0)) == (2.0, -INF, INF)
    # Beds of no run may have every probability.
    assert analysis.upper_limit(0) == 1.0


def test_masked_values_are_runs_without_an_answer() -> None:
    masked = np.ma.masked_array([0.2, 1e3, 0.4, 0.6], mask=[False, True, False, False])
    with_nan = [0.2, NAN, 0.4, 0.6]
    assert analysis.mean_estimate(masked, [0, 1, 1, 2]) == analysis.mean_estimate(with_nan, [0, 1, 1, 2])
    assert analysis.share_estimate(masked, [0, 1, 1, 2]) == analysis.share_estimate(with_nan, [0, 1, 1, 2])
    assert analysis.chaos_variance(masked) == analysis.chaos_variance(with_nan)
