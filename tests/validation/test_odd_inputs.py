"""Odd inputs: some of the studies and files that the script makes of a seed, and how it tells the classes apart."""

import random
import sys
import time
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "validation" / "odd_inputs"


@pytest.fixture(scope="module", autouse=True)
def scripts() -> Iterator[None]:
    """The scripts import each other by name, as they do from the command line."""
    before = list(sys.path)
    sys.path[:0] = [str(FOLDER)]
    yield
    sys.path[:] = before


def test_odd_studies_and_files_are_right_or_refused(tmp_path: Path) -> None:
    from judge import FAULTS, judged
    from odd_files import input_cases
    from odd_studies import study_cases

    # A run of each takes seconds, and is for the script, as are studies whose gravity has to be computed first.
    studies = [replace(case, run=None) for case in study_cases(random.Random(4), 12, ("first_bounce", "asked"))]
    found = {}
    for number, case in enumerate([*studies, *input_cases(random.Random(4), 4)]):
        folder = tmp_path / str(number)
        folder.mkdir()
        found[case.words] = judged(case, folder)
    assert {words: verdict for words, verdict in found.items() if verdict.name in FAULTS} == {}
    assert {verdict.name for verdict in found.values()} == {"right", "refused"}


def _refused(_: Path) -> None:
    raise ValueError("bed.width is 0; allowed: above 0; write another")


def _bare(_: Path) -> None:
    raise ValueError("Matrix is not positive definite")


def _broken(_: Path) -> None:
    raise KeyError("x")


def _warned(_: Path) -> None:
    warnings.warn("divide by zero", RuntimeWarning, stacklevel=1)


def _endless(_: Path) -> None:
    time.sleep(10.0)


@pytest.mark.parametrize(("never", "stages", "name"), [
    (False, (print, print), "right"),
    (True, (print, None), "silent"),
    (True, (_refused, None), "refused"),
    (False, (_warned, None), "silent"),
    (False, (print, _warned), "silent"),
    (False, (print, _refused), "late"),
    (False, (_bare, None), "traceback"),
    (False, (_broken, None), "traceback"),
    (False, (print, _broken), "traceback"),
    (False, (_endless, None), "endless"),
])  # fmt: skip
def test_each_class_is_told_by_what_happens(never: bool, stages: tuple, name: str, tmp_path: Path) -> None:
    from judge import Case, judged

    assert judged(Case("", "", never, *stages), tmp_path, longest=0.1).name == name


def test_numbers_that_are_not_finite_are_named() -> None:
    from judge import Silent, refuse_nonfinite

    refuse_nonfinite({"a": [1.0, {"b": None}]})
    with pytest.raises(Silent, match=r"not finite: a\.1\.b$"):
        refuse_nonfinite({"a": [1.0, {"b": float("nan")}]})


def test_every_key_of_a_study_has_its_turn() -> None:
    from base_studies import keys_of
    from odd_studies import study_cases

    keys = [path for path, _ in keys_of()]
    assert ("soil", "NAME", "grain", "friction") in keys
    assert ("sky", "orbit", "epoch") in keys
    said = " ".join(case.words for case in study_cases(random.Random(1), 700))
    assert [path for path in keys if f"{path[-1]}: " not in said and f"{path[-1]}." not in said] == []
