"""What the page's own script makes of the cells of a table."""

import math

import pytest

from ..page_scripts import answer_of, needs_node


@needs_node
@pytest.mark.parametrize(("cell", "value"), [
    ("71 % (68 to 73)", 71.0),
    ("0.0754", 0.0754),
    ("-3.2", -3.2),
    ("5.3 × 10¹¹", 5.3e11),
    ("2.5 × 10⁻⁵ m/s2", 2.5e-5),
    ("100 000", 1e5),
    ("Uniform", math.nan),
])  # fmt: skip
def test_a_cell_is_sorted_by_the_number_that_it_begins_with(cell: str, value: float) -> None:
    # The part that listens to a window is for browsers.
    program = "return cellNumber(given.cell);"
    found = answer_of(("pages/page.js",), program, {"cell": cell})
    assert (found is None) if math.isnan(value) else (found == pytest.approx(value, rel=1e-12))
