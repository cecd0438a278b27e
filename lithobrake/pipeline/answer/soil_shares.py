"""What becomes of the landers by the region of the body, with a soil of its own, that they come down in."""

import numpy as np

from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_share
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.folder.study_folder import AGAIN
from lithobrake.pipeline.job import Job
from lithobrake.results.soil_results import SoilResults
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import SOIL, TOUCHDOWNS_FILE


def soil_shares(job: Job, table: JourneyTable) -> dict[str, SoilResults]:
    """By region, in the order of the study file and elsewhere last; empty for a study that has one soil."""
    if not job.study.soil:
        return {}
    rows = read_rows(job.folder / TOUCHDOWNS_FILE, ("journey", "outcome", *SOIL), AGAIN)
    journey, soil = np.array([int(row["journey"]) for row in rows]), np.array([row["soil"] for row in rows])
    captured = np.array([row["outcome"] for row in rows]) == TouchdownOutcome.CAPTURED
    soils, why, found = Soils(job.site), why_no_interval(job.study), {}
    for name, area in soils.area_shares().items():
        there = soil == name
        rests = np.isin(np.arange(len(table.end)), journey[there & captured])
        found[name] = SoilResults(
            area_share=area,
            touchdowns=int(there.sum()),
            rests=end_share(captured[there], table.bed[journey[there]], why) if there.any() else None,
            at_rest=end_share(rests, table.bed, why),
            outlines=soils.outlines(name),
        )
    return found
