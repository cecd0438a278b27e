"""Thirty synthetic studies of journeys: the intervals hold the truth as often as they say, as far as thirty can tell.

Two hundred studies a setting, and more settings: `validation/journey_coverage.py`, from which the studies come.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "validation"))
from journey_coverage import AT_REST, CONTACTS, ENDS, Truth, exact, kept_rows, page_table, setting

STUDIES = 30
# Of so many nominal 90 % intervals: three standard deviations of the share that holds.
LEAST = 0.9 - 3.0 * np.sqrt(0.09 / STUDIES)


@pytest.mark.parametrize("rho", [0.0, 0.2])
def test_intervals_of_journeys_hold_the_truth(rho: float) -> None:
    rows = list(setting(Truth(rho=rho), 96, 12, STUDIES))
    # A count or a rare event cannot but be held more often.
    assert {row["quantity"]: row["held"] for row in rows if row["held"] < LEAST} == {}
    assert all(row["held"] < 1.0 for row in rows if "time_s" in row["quantity"])
    for row in rows:
        if row["quantity"] in ENDS:
            # The mean of 30 studies scatters by a fifth of an error, a ninth of the half width.
            assert abs(row["bias"]) < 0.25 * row["half_width"]


def test_the_ends_of_synthetic_journeys_add_up_and_beds_matter() -> None:
    plain, strong = Truth(rho=0.0), Truth(rho=0.2)
    found = plain.study(960, 12, 1)
    assert (np.isfinite(found["time_s"]) == (found["end"] == AT_REST)).all()
    assert found[CONTACTS][found["end"] == AT_REST].min() >= 1
    assert sum(exact(plain)[end] for end in ENDS) == pytest.approx(1.0)
    assert 0.005 < exact(plain)["escaped"] < 0.02
    # The bed that all touchdowns of a journey share shows in what differs between beds.
    means = [
        np.array([np.nanmean(one["time_s"][one["bed"] == bed]) for bed in range(12)])
        for one in (found, strong.study(960, 12, 1))
    ]
    assert means[1].std() > 1.5 * means[0].std()


def test_the_page_has_the_table_that_was_made() -> None:
    page = Path(__file__).parents[2] / "docs" / "validation" / "interval_coverage.md"
    lines = page.read_text(encoding="utf-8").splitlines()
    assert [line for line in page_table(kept_rows()).splitlines() if line not in lines] == []
