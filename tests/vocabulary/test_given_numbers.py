"""What a public function was given is checked in one place, in one sentence."""

import warnings

import numpy as np
import pytest

from lithobrake.vocabulary.given_numbers import (
    finite_number,
    labels,
    numbers,
    numbers_or_nan,
    random_numbers,
    whole_number,
)


@pytest.mark.parametrize("value", [1.5, "3", None, True, float("nan"), float("inf"), -1, 8, [3]])
def test_a_whole_number_is_whole_and_in_its_range(value: object) -> None:
    with pytest.raises(ValueError, match=r"count is .*, but must be a whole number from 0 to 7"):
        whole_number("count", value, 0, 7)


def test_a_whole_number_comes_back_as_an_integer() -> None:
    assert [whole_number("count", value, 1) for value in (3, 3.0, np.int64(3), np.float32(3.0))] == [3] * 4
    assert type(whole_number("count", 3.0, 1)) is int


@pytest.mark.parametrize("value", ["0.5", None, True, float("nan"), float("inf"), 0.0, 1.0, 10**400, 1j, [0.5]])
def test_a_number_is_finite_and_within_its_limits(value: object) -> None:
    with pytest.raises(ValueError, match=r"level is .*, but must be a finite number above 0 and below 1$"):
        finite_number("level", value, above=0.0, below=1.0)


def test_limits_may_be_reached_or_not() -> None:
    assert finite_number("share", 1, at_least=0.0, at_most=1.0) == 1.0
    assert finite_number("share", np.float64(0.0), at_least=0.0, at_most=1.0) == 0.0
    with pytest.raises(ValueError, match=r"share is 1.1, but must be a finite number of at least 0 and of at most 1$"):
        finite_number("share", 1.1, at_least=0.0, at_most=1.0)
    with pytest.raises(ValueError, match=r"x is nan, but must be a finite number$"):
        finite_number("x", float("nan"))


@pytest.mark.parametrize("seed", ["x", None, 1.5, -1, [1, 2]])
def test_a_seed_is_a_whole_number(seed: object) -> None:
    with pytest.raises(ValueError, match=r"seed is .* whole number of at least 0"):
        random_numbers(seed)


def test_the_same_seed_gives_the_numbers_of_numpy() -> None:
    assert random_numbers(7).random(3).tolist() == np.random.default_rng(7).random(3).tolist()


def test_masked_values_are_refused_or_count_as_nan() -> None:
    masked = np.ma.masked_array([1.0, 1e3, 3.0], mask=[False, True, False])
    with pytest.raises(ValueError, match=r"x has 1 masked values"):
        numbers("x", masked)
    assert np.isnan(numbers_or_nan("y", masked)).tolist() == [False, True, False]
    whole = np.ma.masked_array([1, 1000], mask=[False, True])
    assert np.isnan(numbers_or_nan("y", whole)).tolist() == [False, True]
    nothing_masked = np.ma.masked_array([1.0, 2.0])
    assert type(numbers("x", nothing_masked)) is np.ndarray


@pytest.mark.parametrize("values", [[1j], ["a"], [[1.0], [1.0, 2.0]], [{}], [np.datetime64("2020-01-01")]])
def test_what_is_no_real_number_is_named(values: object) -> None:
    with pytest.raises(ValueError, match=r"x must be an array of real numbers"):
        numbers("x", values)  # type: ignore[arg-type]


def test_floats_are_not_copied() -> None:
    values = np.arange(3.0)
    assert numbers("x", values) is values
    assert numbers_or_nan("y", values) is values


@pytest.mark.parametrize("given", [[1.0, np.nan], [1.0, np.inf], np.ma.masked_array([1, 2], mask=[False, True]), [1]])
def test_labels_are_one_for_each_run(given: object) -> None:
    with pytest.raises(ValueError, match=r"groups .* one label for each run"):
        labels("groups", given, 2, "each run")  # type: ignore[arg-type]
    assert labels("groups", ["a", "b"], 2, "each run").tolist() == ["a", "b"]


@pytest.mark.parametrize("given", [[None, None], [1, "a", None]])
def test_labels_without_an_order_are_refused(given: list[object]) -> None:
    with pytest.raises(ValueError, match="groups hold labels that cannot be told apart"):
        labels("groups", np.array(given, dtype=object), len(given), "each run")


def test_numbers_of_single_precision_are_checked_without_a_warning() -> None:
    with np.errstate(all="raise"), warnings.catch_warnings():
        warnings.simplefilter("error")
        assert finite_number("level", np.float32(0.5), above=0.0, below=1.0) == 0.5
    with pytest.raises(ValueError, match=r"level is .*inf.*, but must be a finite number"):
        finite_number("level", np.float32("inf"))
