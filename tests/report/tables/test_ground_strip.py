"""The answer on each kind of ground, on pages of landers at rest alone."""

from dataclasses import replace

from lithobrake.report.pages.study_page import study_content
from lithobrake.report.tables.ground_strip import ground_strip
from lithobrake.results.page_data import PageData

from ..pages.test_study_page import on_grounds


def test_a_page_of_first_touchdowns_has_no_strip(first: PageData, asked: PageData) -> None:
    """Such a page begins with the return fraction, and the last row would lack the fraction at rest."""
    assert first.journeys is not None
    assert ground_strip(on_grounds(first)) is None
    assert study_content(on_grounds(first)).strip is None
    assert ground_strip(on_grounds(asked)) is not None


def test_a_study_of_one_ground_has_no_strip(asked: PageData) -> None:
    assert ground_strip(asked) is None


def test_the_note_speaks_of_the_rows_that_are_there(asked: PageData) -> None:
    """The finest ground is part of the kinds, so its row adds nothing to theirs."""
    data = on_grounds(asked)
    strip = ground_strip(data)
    assert strip is not None
    assert [name for name, _ in strip.rows] == ["gravel", "rock", "finest", "one of these"]
    # Only what the page begins with has no words here.
    assert [column.shown[-1] == "" for column in strip.columns] == [True, False, False]
    assert strip.note == (
        "Marks: values; bars: 90 % intervals of the mean over beds of that ground; in the last row of one ground "
        "throughout; the finest is part of the kinds above, its journeys on the coarser beds that stand for it."
    )
    kinds = ground_strip(replace(data, results=replace(data.results, finer_ground=None, over_grounds=None)))
    assert kinds is not None
    assert [name for name, _ in kinds.rows] == ["gravel", "rock"]
    assert kinds.note == "Marks: values; bars: 90 % intervals of the mean over beds of that ground."
    assert all(kinds.columns[0].shown)
