"""The tables of journeys and touchdowns from Python."""

from dataclasses import replace

import numpy as np
import pytest

from lithobrake.pipeline.answer.journey_ends import JourneyTable, journey_rest
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.results import StudyResults
from lithobrake.study import read_study
from lithobrake.vocabulary.outcomes import JourneyEnd

from .bouncing_lander import FAILS, LEAVES, STUCK


def test_each_journey_has_a_row_with_its_end(journeys: StudyResults) -> None:
    table = journeys.journeys
    assert table["journey"].tolist() == list(range(48))
    expected = dict.fromkeys(range(48), JourneyEnd.AT_REST)
    for numbers, end in ((FAILS, JourneyEnd.FAILED), (STUCK, JourneyEnd.UNDER_WAY), (LEAVES, JourneyEnd.ESCAPED)):
        expected |= dict.fromkeys(numbers, end)
    assert table["end"].tolist() == list(expected.values())
    at_rest = table["end"] == JourneyEnd.AT_REST
    assert np.isfinite(table["tilt_deg"][at_rest]).all()
    assert set(table["face"][~at_rest]) == {""}
    assert table.columns["tilt_deg"].units == "deg"
    assert sum(one.count for one in journeys.results.ends.values()) == table.row_count


def test_each_touchdown_has_what_went_in_and_what_came_out(journeys: StudyResults) -> None:
    table = journeys.touchdowns
    assert table.row_count == journeys.results.touchdowns == journeys.journeys["touchdowns"].sum()
    for number, count in enumerate(journeys.journeys["touchdowns"].astype(int)):
        assert table["touchdown"][table["journey"] == number].tolist() == list(range(count))
    # One soil and one bed a journey, whatever the touchdown.
    first = {number: row for row, number in reversed(list(enumerate(table["journey"].tolist())))}
    of_first = np.array([first[number] for number in table["journey"].tolist()])
    for name in ("grain.friction", "grain.young_modulus", "bed"):
        assert table[name] == pytest.approx(table[name][of_first], rel=0, abs=0)
    assert np.isfinite(table["speed_out"][table["outcome"] == "clear"]).all()
    assert np.isnan(table["speed_out"][table["outcome"] == "captured"]).all()
    assert (table["cpu_s"] >= 0.0).all()
    frame = table.to_pandas()
    assert frame.attrs["cpu_s"]["units"] == frame.attrs["begin_s"]["units"] == "s"
    assert all(column.long_name for column in table.columns.values())


def test_runs_hold_every_touchdown_once(journeys: StudyResults) -> None:
    runs = journeys.runs
    assert sorted(runs["key"]) == sorted(journeys.touchdowns["key"])
    assert (runs["design"] == "drawn").sum() == 48


def test_quantiles_of_contacts_are_counts_that_occur(journeys: StudyResults) -> None:
    table = JourneyTable.load(StudyFolder.only_read(journeys.folder))
    # All different, so that a quantile between two of them would be none of them.
    counted = replace(table, numbers=table.numbers | {"contacts": np.arange(1.0, 49.0)})
    contacts = journey_rest(read_study(journeys.folder / "study.toml"), counted).contacts
    found = [getattr(one, end) for one in (contacts.median, contacts.q95) for end in ("value", "lower", "upper")]
    assert all(one is None or one == round(one) for one in found)
    assert contacts.median.lower is not None


def test_a_notebook_offers_journeys_and_touchdowns(journeys: StudyResults) -> None:
    shown = journeys._repr_html_()
    assert "<td>journeys</td>" in shown
    assert "<td>touchdowns</td>" in shown
    assert "<td>rest</td>" not in shown


def test_what_a_study_of_journeys_has_not_is_refused(journeys: StudyResults) -> None:
    with pytest.raises(ValueError, match="ask for journeys"):
        _ = journeys.rest
