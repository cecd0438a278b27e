"""The rows of the README's table of validation are those of the pages that they link."""

import re

import pytest
from blocks import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| \[[^\]]+\]\((docs/validation/\w+\.md)\)(.*)\|$", README, flags=re.MULTILINE)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def test_six_rows_stand_there_two_of_which_disagree() -> None:
    verdicts = [cells.split("|")[-1].strip() for _, cells in ROWS]
    assert len(verdicts) == 6
    assert verdicts.count("no") == 2


@pytest.mark.parametrize(("page", "cells"), ROWS)
def test_numbers_of_a_row_stand_on_its_page(page: str, cells: str) -> None:
    here = cells.split("|")[-2]
    known = set(NUMBER.findall((ROOT / page).read_text(encoding="utf-8")))
    assert set(NUMBER.findall(here)) <= known


def test_the_count_of_agreements_is_that_of_the_page() -> None:
    page = (ROOT / "docs" / "validation" / "experiments.md").read_text(encoding="utf-8")
    count = re.search(r"\d+ of \d+ quantities agree", page)
    assert count.group().removesuffix(" agree") in README
    assert count.group() in (ROOT / "docs" / "how_it_works.md").read_text(encoding="utf-8")
