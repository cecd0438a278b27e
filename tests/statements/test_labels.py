"""Labels of single results in words."""

import pytest

from lithobrake.results.dispersion import RestRegion
from lithobrake.statements.labels import extent


@pytest.mark.parametrize(("islands", "words"), [
    ((159.2,), "159 m across"),
    ((55.9, 31.0, 12.0), "159 m across in 3 separate parts, the largest of which is 56 m across"),
])  # fmt: skip
def test_a_region_of_several_islands_says_so(islands: tuple[float, ...], words: str) -> None:
    assert extent(RestRegion(0.95, 4000.0, 159.2, (), islands)) == words
