"""summary.json of a study of journeys: how they end, and what their first touchdowns say."""

from dataclasses import replace

import numpy as np

from lithobrake.pipeline.answer.aim_results import aim_results
from lithobrake.pipeline.answer.delivery_results import delivery_results
from lithobrake.pipeline.answer.emulated_ends import emulated_ends
from lithobrake.pipeline.answer.first_sides import with_journeys
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_shares, journey_rest
from lithobrake.pipeline.answer.landing_results import write_results
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.answer.shares_over_refits import Refits
from lithobrake.pipeline.answer.sky_results import sky_results
from lithobrake.pipeline.answer.soil_shares import soil_shares
from lithobrake.pipeline.answer.variance_of_runs import parts_of_journeys
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.summary import DrawnResults, Estimates
from lithobrake.vocabulary.quantities import JOURNEY_DESIGN


def write_journey_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance."""
    write_results(job, _with_journeys)


def _with_journeys(job: Job, found: DrawnResults, runs: DesignRuns, estimates: Estimates) -> DrawnResults:
    """What the first touchdowns say, and how the journeys ended."""
    table = JourneyTable.load(job.folder)
    emulated, ends = emulated_ends(job, table, end_shares(job.study, table))
    # A lander that is flown to the ground may miss it: the first touchdowns are of those that do not.
    landed = table.taken(runs.inputs["journey"].astype(int))
    touchdowns = DesignRuns.load(job.folder, JOURNEY_DESIGN)
    fitted = Refits(len(np.unique(table.bed)), table.touchdowns, why_no_interval(job.study))
    return replace(
        found,
        aim=aim_results(job.study, job.folder, fitted),
        rest=journey_rest(job.study, table),
        ends=ends,
        sky=sky_results(job.study, job.folder, table),
        delivery=delivery_results(job, runs, len(table.end)),
        journeys=len(table.end),
        touchdowns=table.touchdowns,
        emulated=emulated,
        soils=soil_shares(job, table),
        sides=with_journeys(job.study, dict(found.sides), runs, touchdowns, landed),
        end_variance_shares=parts_of_journeys(job, runs, landed),
    )
