"""The page of the small study of first touchdowns says what it is known to say, word by word and number by number.

After a change that is meant: REWRITE_GOLDEN=1 python -m pytest tests/report/test_golden_page.py
"""

import os
from pathlib import Path

from .page_text import visible_text

GOLDEN = Path(__file__).with_name("golden_page.txt")


def test_the_page_has_the_words_and_numbers_that_it_is_known_to_have(first_page: str) -> None:
    found = visible_text(first_page)
    if os.environ.get("REWRITE_GOLDEN"):
        GOLDEN.write_text(found, encoding="utf-8")
    assert found.splitlines() == GOLDEN.read_text(encoding="utf-8").splitlines()
