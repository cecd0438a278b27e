"""Shares in per cent have the digits that their interval deserves, and never stand outside of it."""

import pytest

from lithobrake.vocabulary.percentages import part, percent, span, with_interval


def entry(share: float, lower: float | None = None, upper: float | None = None) -> dict[str, float | None]:
    return {"share": share, "lower": lower, "upper": upper}


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
def test_tenths_stand_only_where_the_interval_is_narrower_than_two_points(
    found: dict[str, float | None], words: str
) -> None:
    assert with_interval(found) == words


def test_a_share_without_an_interval_has_the_digits_of_its_answer() -> None:
    assert with_interval(entry(0.31683), 1) == "31.7 %"


def test_what_cannot_be_told_from_nothing_is_not_detected_and_no_bound_passes_the_whole() -> None:
    assert part({"share": -0.007, "lower": 0.0, "upper": 0.03}) == "not detected (0-3 %)"
    assert part({"share": 0.0, "lower": 0.0, "upper": 0.03}) == "not detected (0-3 %)"
    assert part({"share": 1.26, "lower": 0.4, "upper": 3.95}, "; of pairs") == "100 % (40-100 %; of pairs)"
    assert span(-0.2, 1.27) == "0-100 %"
    assert percent(0.999) == "99.9 %"
