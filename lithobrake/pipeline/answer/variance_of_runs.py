"""Where the scatter of a number of the drawn runs comes from, or of their journeys."""

import numpy as np

from lithobrake.analysis import variance_shares
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.typed_estimates import variance_parts
from lithobrake.pipeline.design.lander_attitude import independent_terms
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.run_results import VarianceParts
from lithobrake.study.touchdown_model import SURFACE

# Numbers that say what the ground is, the lander's side of its contacts among them; all others say how it arrives.
SOIL = ("grain.", "surface.", "solver.inputs.", *(f"lander.{name}" for name in SURFACE))


def parts_of_variance(
    job: Job, runs: DesignRuns, y: np.ndarray, of: str, twins: np.ndarray | None = None
) -> VarianceParts | None:
    """Parts of the variance of y [run_count], NaN where a run has none; None where the runs cannot tell.

    of: which runs it describes, in words. twins [pair_count]: differences of y between twins, where there are any.
    """
    # A place that is drawn by a law of its own is a place like any other.
    inputs = job.design.soil_inputs
    if not inputs:
        return None
    soil = [key for key in inputs if key.startswith(SOIL)]
    attitude = independent_terms(job.design, runs.inputs)
    found = variance_shares(
        inputs, runs.columns(list(inputs)), y, runs.inputs["bed"], soil=soil, attitude=attitude, twins=twins
    )
    return None if found is None else variance_parts(found, of)


def parts_of_journeys(job: Job, runs: DesignRuns, table: JourneyTable) -> dict[str, VarianceParts | None]:
    """Parts of the variance of how and where journeys end, by the inputs of their first touchdowns, runs.

    Whether a lander comes to rest is 1 or 0.
    """
    rests, everything = table.rests, f"all {len(table.end)} journeys"
    of_rest = f"{int(rests.sum())} of {len(rests)} journeys that ended at rest"
    numbers = {
        "at_rest": (rests.astype(float), everything),
        "time_s": (np.where(rests, table.numbers["time_s"], np.nan), of_rest),
        "distance_m": (np.where(rests, table.numbers["distance"], np.nan), of_rest),
    }
    return {name: parts_of_variance(job, runs, y, of) for name, (y, of) in numbers.items()}
