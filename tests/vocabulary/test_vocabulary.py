"""Given numbers, names that are imported late, words for ends, and shares in per cent."""

import ast
import subprocess
import sys
import warnings
from importlib import import_module
from pathlib import Path
from typing import get_origin

import numpy as np
import pytest

from lithobrake.smallbody.flight_results import STATUSES
from lithobrake.smallbody.integration import ESCAPED, FLYING, IMPACT, PARTNER
from lithobrake.vocabulary import outcomes
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import (
    finite_number,
    labels,
    numbers,
    numbers_or_nan,
    random_numbers,
    whole_number,
)
from lithobrake.vocabulary.number_words import LEVEL, part, percent, rare_percent, span, with_interval
from lithobrake.vocabulary.outcomes import CapturedFate, FlightStatus, JourneyEnd, SampleOutcome, TouchdownOutcome

from ..syntax_trees import syntax_tree


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
    assert np.isnan(numbers_or_nan("y", np.ma.masked_array([1, 1000], mask=[False, True]))).tolist() == [False, True]
    assert type(numbers("x", np.ma.masked_array([1.0, 2.0]))) is np.ndarray


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


PACKAGE = Path(__file__).parents[2] / "lithobrake"
FACES = sorted(
    ".".join(path.relative_to(PACKAGE.parent).parts[:-1])
    for path in PACKAGE.rglob("__init__.py")
    if "lazy_loader.attach_stub" in path.read_text(encoding="utf-8")
)
IMPORT_FACES = f"""
import sys
import {", ".join(FACES)}
known = set(sys.modules)
for face in {FACES}:
    assert not hasattr(sys.modules[face], "a_file_of_the_part")
print({{name for name in set(sys.modules) - known if name.startswith("lithobrake")}})
print({{"numpy", "scipy", "sklearn", "numba", "pydantic", "h5py", "matplotlib"}} & set(sys.modules))
"""


def test_faces_import_nothing_until_a_name_is_used() -> None:
    # Neither does a name that is not theirs, as that of a file which is about to be imported.
    finished = subprocess.run([sys.executable, "-c", IMPORT_FACES], capture_output=True, text=True)
    assert (finished.stdout, finished.stderr) == ("set()\nset()\n", "")


@pytest.mark.parametrize("face", FACES)
def test_every_listed_name_is_found(face: str) -> None:
    module = import_module(face)
    names = [name for name in module.__all__ if name != "__version__"]
    assert names == dir(module) == sorted(names)
    found = {name: getattr(module, name) for name in names}
    # An alias of a type has the name of what it stands for.
    own = {name: one for name, one in found.items() if get_origin(one) is None}
    assert [name for name, one in own.items() if getattr(one, "__name__", name) != name] == []


def test_all_names_come_with_a_star() -> None:
    found: dict[str, object] = {}
    exec("from lithobrake.chaos import *", found)
    assert set(import_module("lithobrake.chaos").__all__) <= set(found)


def test_words_are_plain_text_and_each_has_its_sentence():
    assert FlightStatus.IMPACT == "impact"
    assert f"{CapturedFate.SETTLED}" == "settled"
    assert [*TouchdownOutcome] == ["clear", "captured", "left_sideways", "time_limit"]
    assert [*SampleOutcome] == [*TouchdownOutcome, "outside"]
    assert [*FlightStatus] == ["flying", "impact", "escaped", "partner"]
    assert [*CapturedFate] == ["settled", "lofted"]
    assert [*JourneyEnd] == ["at_rest", "escaped", "partner", "under_way", "failed"]
    for status in (*TouchdownOutcome, *SampleOutcome, *FlightStatus, *CapturedFate, *JourneyEnd):
        assert status.sentence.startswith(("The ", "A "))
        assert status.sentence.endswith(".")
        assert type(status.value) is str


def test_the_numbers_of_the_kernels_are_in_the_order_of_the_words():
    assert STATUSES[[FLYING, IMPACT, ESCAPED, PARTNER]].tolist() == ["flying", "impact", "escaped", "partner"]
    found = STATUSES == FlightStatus.IMPACT
    assert found.tolist() == [False, True, False, False]
    assert STATUSES.dtype == np.dtype("<U7")


def test_no_other_file_types_such_a_word():
    words = {str(word) for word in (*TouchdownOutcome, *FlightStatus, *CapturedFate)}
    # These also name a table of the study file, a table of the site, and a setting of a landing.
    words -= {"impact", "partner", "time_limit"}
    for path in (Path(__file__).parents[2] / "lithobrake").rglob("*.py"):
        texts = {node.value for node in ast.walk(syntax_tree(path)) if isinstance(node, ast.Constant)}
        assert path == Path(outcomes.__file__) or not words & texts, path


def entry(share: float, lower: float | None = None, upper: float | None = None) -> Estimate:
    """A share with its interval, if it has one."""
    return Estimate(share, lower, upper)


@pytest.mark.parametrize(("found", "words"), [
    (entry(0.7082, 0.667, 0.749), "71 % (67-75 %)"),
    (entry(0.7449, 0.737, 0.7566), "74.5 % (73.7-75.7 %)"),
    (entry(0.7449), "74 %"),
    (entry(0.004, 0.0, 0.03), "0.4 % (0-3 %)"),
    (entry(0.0, 0.0, 0.17), "0 % (0-17 %)"),
    (entry(1.0, 0.83, 1.0), "100 % (83-100 %)"),
    (entry(0.0113, 0.0098, 0.038), "1 % (1-4 %)"),
    (entry(0.0, 0.0, 0.00027), "0 % (0-0.03 %)"),
])  # fmt: skip
def test_tenths_stand_only_where_the_interval_is_narrower_than_two_points(found: Estimate, words: str) -> None:
    assert with_interval(found) == words


def test_a_share_without_an_interval_has_the_digits_of_its_answer() -> None:
    assert with_interval(entry(0.31683), 1) == "31.7 %"


def test_the_level_of_an_interval_is_named_where_it_is_asked_for() -> None:
    assert with_interval(entry(0.7082, 0.667, 0.749), level=LEVEL) == "71 % (90 % interval 67-75 %)"
    assert with_interval(entry(0.7082), level=LEVEL) == "71 %"


def test_what_cannot_be_told_from_nothing_is_not_detected_and_no_bound_passes_the_whole() -> None:
    assert part(entry(-0.007, 0.0, 0.03)) == "not detected (0-3 %)"
    assert part(entry(0.0, 0.0, 0.03)) == "not detected (0-3 %)"
    assert part(entry(1.26, 0.4, 3.95), "; of pairs") == "100 % (40-100 %; of pairs)"
    assert span(-0.2, 1.27) == "0-100 %"
    assert percent(0.999) == "99.9 %"


@pytest.mark.parametrize(
    ("share", "words"),
    [(0.42, "42 %"), (0.0, "0 %"), (1.0, "100 %"), (0.042, "4.2 %"), (0.00317, "0.32 %"), (0.9987, "99.87 %")],
)
def test_what_is_rare_or_nearly_certain_has_two_digits(share: float, words: str) -> None:
    assert rare_percent(share) == words
