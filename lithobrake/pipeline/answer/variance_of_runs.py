"""Where the scatter of a number of the drawn runs comes from, or of their journeys."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.analysis import variance_shares
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.typed_estimates import variance_parts
from lithobrake.pipeline.design.drawn_design import FLOWN, GRAIN
from lithobrake.pipeline.design.lander_attitude import independent_terms
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.run_results import VarianceParts
from lithobrake.study.touchdown_model import SURFACE

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

# Numbers that say what the ground is, the lander's side of its contacts among them; all others say how it arrives.
SOIL = ("grain.", "soil.", "surface.", "solver.inputs.", *(f"lander.{name}" for name in SURFACE))
Inputs = dict[str, tuple["Distribution", np.ndarray]]


def parts_of_variance(
    job: Job, runs: DesignRuns, y: np.ndarray, of: str, twins: np.ndarray | None = None
) -> VarianceParts | None:
    """Parts of the variance of y [run_count], NaN where a run has none; None where the runs cannot tell.

    of: which runs it describes, in words. twins [pair_count]: differences of y between twins, where there are any.
    """
    return _parts(job, runs, _touchdown_inputs(job, runs), y, of, twins)


def parts_of_journeys(job: Job, runs: DesignRuns, table: JourneyTable) -> dict[str, VarianceParts | None]:
    """Parts of the variance of how and where journeys end, by their delivery and first touchdowns, runs.

    table: of the journeys of these runs, in their order. Whether a lander comes to rest is 1 or 0.
    """
    rests, everything = table.rests, f"{len(table.end)} journeys"
    of_rest = f"{int(rests.sum())} of {len(rests)} journeys that ended at rest"
    numbers = {
        "at_rest": (rests.astype(float), everything),
        "time_s": (np.where(rests, table.numbers["time_s"], np.nan), of_rest),
        "distance_m": (np.where(rests, table.numbers["distance"], np.nan), of_rest),
    }
    inputs = _touchdown_inputs(job, runs) | _delivery_inputs(job, runs)
    return {name: _parts(job, runs, inputs, y, of, None) for name, (y, of) in numbers.items()}


def _touchdown_inputs(job: Job, runs: DesignRuns) -> Inputs:
    """The uncertain inputs of the touchdowns with their laws, and their values [run_count].

    A place that is drawn by a law of its own is a place like any other.
    """
    from lithobrake.chaos import Empirical

    flown = [name for name in FLOWN if job.design.is_flown and np.ptp(runs.inputs[name]) > 0.0]
    told = {name: Empirical(runs.inputs[name].tolist()) for name in flown}
    values = dict(runs.inputs)
    if job.design.study.site.roughness_deg and not job.design.is_flown:
        # Seen from the ground that each lander meets, its impact has another distribution than the study gives.
        drawn = job.design.delivered_rows
        values |= {name: np.array([row[name] for row in drawn]) for name in job.design.soil_inputs}
    found = {name: (law, values[name]) for name, law in (job.design.soil_inputs | told).items()}
    return found | _soil_inputs(job, runs)


def _soil_inputs(job: Job, runs: DesignRuns) -> Inputs:
    """The soils that each journey draws, whatever the regions of its touchdowns; nothing where there is one soil."""
    if not job.study.soil:
        return {}
    journeys, soils = runs.inputs["journey"].astype(int).tolist(), Soils(job.site)
    own, drawn = [job.design.delivered_rows[journey] for journey in journeys], soils.drawn(journeys)
    of_grain = {name: law for name, law in job.design.soil_inputs.items() if name.startswith(GRAIN)}
    elsewhere = {name: (law, np.array([one[name] for one in own])) for name, law in of_grain.items()}
    return elsewhere | {name: (law, drawn[name]) for name, law in soils.inputs.items()}


def _delivery_inputs(job: Job, runs: DesignRuns) -> Inputs:
    """Where each journey is delivered, likewise; what flies landers to the ground tells that by their impacts alone."""
    if job.design.is_flown:
        return {}
    sites = job.site.sampled(runs.run_count)
    return {f"site.{key}": (law, sites[key]) for key, law in job.site.distributions.items()}


def _parts(
    job: Job, runs: DesignRuns, inputs: Inputs, y: np.ndarray, of: str, twins: np.ndarray | None
) -> VarianceParts | None:
    if not inputs:
        return None
    laws = {name: law for name, (law, _) in inputs.items()}
    x = np.column_stack([values for _, values in inputs.values()])
    soil = [key for key in laws if key.startswith(SOIL)]
    attitude = independent_terms(job.design, runs.inputs)
    found = variance_shares(laws, x, y, runs.inputs["bed"], soil=soil, attitude=attitude, twins=twins)
    return None if found is None else variance_parts(found, of)
