"""Shares in per cent have the digits that their interval deserves, and never stand outside of it."""

import pytest

from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.percentages import LEVEL, part, percent, rare_percent, span, with_interval


def entry(share: float, lower: float | None = None, upper: float | None = None) -> Estimate:
    """A share with its interval, if it has one."""
    return Estimate(share, lower, upper)


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (entry(0.7082, 0.667, 0.749), "71 % (67-75 %)"),
        (entry(0.7449, 0.737, 0.7566), "74.5 % (73.7-75.7 %)"),
        (entry(0.7449), "74 %"),
        (entry(0.004, 0.0, 0.03), "0.4 % (0-3 %)"),
        (entry(0.0, 0.0, 0.17), "0 % (0-17 %)"),
        (entry(1.0, 0.83, 1.0), "100 % (83-100 %)"),
        (entry(0.0113, 0.0098, 0.038), "1 % (1-4 %)"),
        (entry(0.0, 0.0, 0.00027), "0 % (0-0.03 %)"),
    ],
)
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
