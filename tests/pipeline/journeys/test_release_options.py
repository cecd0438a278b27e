"""Options of a release and of states: offsets in their directions, the same landers in all, and what misses."""

from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.released_states import local_axes
from lithobrake.pipeline.journeys.delivered_landers import DeliveredLanders
from lithobrake.pipeline.journeys.delivery_options import option_landers
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import Study, StudyError, StudySource, check_tables
from lithobrake.vocabulary.quantities import UNKNOWN_END

from ..few_terms import REFITS
from .test_delivered_journeys import COUNT, RELEASE, tables, write_states

GRID = {"delivery.offset_north": [-10.0, 0.0, 10.0]}


def study_of(**delivery: Any) -> Study:
    begins = {} if "states" in delivery else {"release": deepcopy(RELEASE)}
    given = tables(delivery={**begins, **delivery}, aim={"grid": GRID, "lander_count": 2})
    return with_site_gravity(StudySource.of_tables(given).study)


def test_offsets_go_up_north_and_east_of_the_mean_release() -> None:
    up, north, east = local_axes(np.array(RELEASE["position"]), np.array([0.0, 0.0, 1.0]))
    plain = DrawnDesign(study_of()).flown_landers(0, 10)[0].flights.start
    moved = DrawnDesign(study_of(offset_up=3.0, offset_east=-7.0, velocity_offset_north=0.004))
    start = moved.flown_landers(0, 10)[0].flights.start
    assert start.position - plain.position == pytest.approx(np.tile(3.0 * up - 7.0 * east, (10, 1)), abs=1e-9)
    assert start.velocity - plain.velocity == pytest.approx(np.tile(0.004 * north, (10, 1)), abs=1e-12)


def test_all_options_have_the_same_landers_and_move_as_the_offsets() -> None:
    design, count = DrawnDesign(study_of()), 2 * REFITS
    landers = option_landers(design, design.study.aim.aims(), count)
    assert len(landers.end) == 3 * count
    # Landers that the study has not followed, each with its refit.
    assert (landers.number.reshape(3, count) == COUNT + np.arange(count)).all()
    assert (landers.refit.reshape(3, count) == np.arange(count) % REFITS).all()
    alone = DeliveredLanders.flown(design, count)
    middle = (landers.place >= count) & (landers.place < 2 * count)
    assert landers.begin.origin[middle] == pytest.approx(alone.begin.origin, abs=1e-9)
    latitude = design.site.body.shape.latitude_longitude(landers.begin.origin)[0]
    means = [latitude[(landers.place // count == one) & (landers.begin.ground == 0)].mean() for one in range(3)]
    # Ten metres at 150 m from the centre are 3.8 degrees, and more where they fall inward.
    assert 2.0 < means[1] - means[0] < 12.0
    assert 2.0 < means[2] - means[1] < 12.0


def test_landers_that_miss_the_ground_keep_the_end_of_their_flight(tmp_path: Path) -> None:
    """Rows 3 and 9 of the file fly away; a file with fewer rows than landers gives each row again."""
    write_states(tmp_path / "states.csv", away=(3, 9))
    study = study_of(states=str(tmp_path / "states.csv"))
    found = DeliveredLanders.flown(DrawnDesign(study), 2 * REFITS)
    misses = np.isin(np.arange(2 * REFITS) % COUNT, (3, 9))
    assert (found.end != "").tolist() == misses.tolist()
    assert set(found.end[misses]) <= {"escaped", "under_way", "partner"}
    assert set(found.ends(None)[~misses]) == {UNKNOWN_END}
    assert found.number.tolist() == (np.arange(2 * REFITS) % COUNT).tolist()
    rows = found.rest_rows([[one] for one in range(len(found.place))])
    assert [row[0] for row, miss in zip(rows, misses, strict=True) if not miss] == list(range(len(found.place)))


def test_the_errors_of_a_release_are_an_option_and_states_have_none(tmp_path: Path) -> None:
    """The factor of all of them, as one value of a grid like any other."""
    grid = {"delivery.errors": [0.0, 1.0]}
    study = check_tables(tables(delivery={"release": deepcopy(RELEASE)}, aim={"grid": grid}), Path())
    begin = option_landers(DrawnDesign(with_site_gravity(study)), study.aim.aims(), 2 * REFITS).begin
    same, apart = (begin.origin[:REFITS], begin.origin[-REFITS:])
    assert np.ptp(same, axis=0).max() < 1e-6
    assert np.ptp(apart, axis=0).max() > 1.0
    write_states(tmp_path / "states.csv")
    with pytest.raises(StudyError, match=r'"delivery\.errors" is no aim; allowed: delivery\.offset_up'):
        check_tables(tables(delivery={"states": str(tmp_path / "states.csv")}, aim={"grid": grid}), Path())


@pytest.mark.parametrize(("changes", "words"), [
    ({"aim": {"grid": {"delivery.speed": [0.05]}}}, r'"delivery\.speed" is no aim; allowed: delivery\.offset_up'),
    ({"aim": {"grid": GRID, "sides": ["z"]}}, "aim.sides chooses the side down at the first touchdown"),
    ({"aim": {"grid": {"delivery.offset_north": [1e10]}}}, "ascending values from -1e"),
])  # fmt: skip
def test_options_that_a_release_does_not_have_are_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(StudyError, match=words):
        check_tables(tables(delivery={"release": deepcopy(RELEASE)}, **changes), Path())


def test_what_arrives_at_the_surface_has_no_offset() -> None:
    from .bouncing_lander import journey_tables

    with pytest.raises(StudyError, match=r"delivery\.offset_east goes with states or \[delivery\.release\]"):
        check_tables(journey_tables(delivery={"offset_east": 5.0}), Path())
