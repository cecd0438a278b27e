"""What landers at rest see of the sky: the table, the results, the page, and what is refused."""

import csv
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest

from lithobrake.pipeline.sky.seen_from_rest import _rows
from lithobrake.results import StudyResults
from lithobrake.smallbody.built_in_bodies import top_shape
from lithobrake.study import StudyError, check_tables
from lithobrake.study.lander_sides import SIDES

from ...paper_tables import paper_tables


def sky_rows(folder: Path, body: str) -> list[dict[str, str]]:
    with (folder / "sky.csv").open(newline="") as file:
        return [row for row in csv.DictReader(file) if row["body"] == body]


def test_every_lander_at_rest_has_a_row_for_each_body(journeys: StudyResults, journeys_folder: Path) -> None:
    at_rest = np.flatnonzero(journeys.journeys["end"] == "at_rest")
    for body in ("sun", "earth"):
        assert [int(row["journey"]) for row in sky_rows(journeys_folder, body)] == at_rest.tolist()


def test_latitudes_are_drawn_from_their_distribution(journeys_folder: Path) -> None:
    sun = np.array([float(row["latitude_deg"]) for row in sky_rows(journeys_folder, "sun")])
    assert -10.0 <= sun.min() < -5.0 < 5.0 < sun.max() <= 10.0
    assert {float(row["latitude_deg"]) for row in sky_rows(journeys_folder, "earth")} == {0.0}


def test_sides_see_a_part_of_what_the_lander_sees(journeys_folder: Path) -> None:
    """A side and the one opposite never face a body at once, and three of six do where it is seen."""
    for row in sky_rows(journeys_folder, "sun"):
        seen, sides = float(row["day_fraction"]), [float(row[f"side_{side}"]) for side in SIDES]
        assert 0.3 < seen < 0.56, "below 45 degrees of latitude, with the Sun within 10 of the equator"
        for first, second in zip(sides[::2], sides[1::2], strict=True):
            assert first + second == pytest.approx(seen)


def test_a_mask_of_thirty_degrees_leaves_a_third_of_the_day(journeys_folder: Path) -> None:
    earth = np.array([float(row["day_fraction"]) for row in sky_rows(journeys_folder, "earth")])
    assert np.median(earth) == pytest.approx(1.0 / 3.0, abs=0.03)


def test_the_side_that_looks_up_faces_a_body_over_the_equator() -> None:
    """Axes of the lander along those of the body, at longitude 0: +x looks up, +y to the east, -x into the ground."""
    ball = top_shape((200.0, 200.0, 200.0), ridge_height=0.0, name="ball")
    lander = {"journey": 0.0, "position_x": 100.0, "position_y": 0.0, "position_z": 0.0}
    lander |= {"attitude_w": 1.0, "attitude_x": 0.0, "attitude_y": 0.0, "attitude_z": 0.0}
    (row,) = _rows(ball, [lander], "sun", np.zeros(1), 0.0)
    found = dict(zip(SIDES, row[4:], strict=True))
    assert row[3] == found["+x"] == pytest.approx(0.5, abs=0.01)
    assert found["-x"] == 0.0
    assert found["+y"] == found["-y"] == pytest.approx(0.25, abs=0.01)
    assert found["+z"] == found["-z"] == 0.0


def test_the_summary_and_the_page_have_it(journeys: StudyResults, journeys_folder: Path) -> None:
    found = journeys.results.sky
    seen = [float(row["day_fraction"]) for row in sky_rows(journeys_folder, "sun")]
    assert found["sun"].day_fraction.value == pytest.approx(np.median(seen), abs=0.01)
    assert found["sun"].day_fraction_q05.value <= found["sun"].day_fraction.value
    assert found["sun"].never.count == 0
    assert set(found["earth"].sides) == set(SIDES)


def test_the_sky_without_journeys_is_refused() -> None:
    tables = deepcopy(paper_tables())
    tables["sky"] = {"sun_latitude_deg": 0.0}
    with pytest.raises(StudyError, match="leave one out or add the other"):
        check_tables(tables, Path())
    tables["sky"] = {"mask_deg": 10.0}
    with pytest.raises(StudyError, match="leave it out, or ask for Earth"):
        check_tables(tables, Path())
    tables["sky"] = {"sun_latitude_deg": 91.0}
    with pytest.raises(StudyError, match="at least -90 and at most 90"):
        check_tables(tables, Path())
