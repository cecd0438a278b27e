"""What decides the ends of journeys: the parts of their variance add up, and know where the lander is delivered."""

import numpy as np
import pytest

from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.variance_of_runs import parts_of_journeys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults
from lithobrake.study import check_tables

from .bouncing_lander import journey_tables


class JobOf:
    """What is asked of a job: its study, its design and its site."""

    def __init__(self, results: StudyResults) -> None:
        self.study = check_tables(journey_tables(), results.folder)
        self.design, self.site = DrawnDesign(self.study), Site(self.study)


def test_the_parts_of_each_end_add_up(journeys: StudyResults) -> None:
    found = journeys.results.end_variance_shares
    assert list(found) == ["at_rest", "time_s", "distance_m"]
    assert any(found.values())
    for one in (one for one in found.values() if one):
        assert sum(part.share for part in one.parts.values()) == pytest.approx(1.0)
        assert one.chaos is None


def test_a_distance_that_follows_the_delivery_is_the_deliverys(journeys: StudyResults) -> None:
    folder, job = StudyFolder(journeys.folder), JobOf(journeys)
    runs, table = DesignRuns.load(folder, "drawn"), JourneyTable.load(folder)
    speed = runs.inputs["impact.speed"]
    random = np.random.default_rng(0)
    numbers = {**table.numbers, "distance": speed / speed.std() + 0.2 * random.standard_normal(len(speed))}
    all_rest = JourneyTable(np.full(len(speed), "at_rest"), table.bed, numbers, table.position, table.face)
    found = parts_of_journeys(job, runs, all_rest)
    assert found["at_rest"] is None
    parts = found["distance_m"]
    assert parts.arrival.share > 0.85
    assert parts.soil.share < 0.1
    assert parts.of == f"{len(speed)} of {len(speed)} journeys that ended at rest"
