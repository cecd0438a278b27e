"""What the drawn runs say of themselves: shares, parts of the variance, means and quantiles, with intervals."""

from collections.abc import Mapping

import numpy as np

from lithobrake.analysis import (
    chaos_variance,
    direction_estimate,
    mean_estimate,
    quantile_estimates,
    soil_total_effect,
)
from lithobrake.pipeline.answer.first_sides import first_sides
from lithobrake.pipeline.answer.missing_landings import described, missing_landings, missing_warning
from lithobrake.pipeline.answer.run_shares import flight_estimates, return_fraction, run_shares
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.answer.typed_estimates import direction, finite_estimate, variance_part
from lithobrake.pipeline.answer.variance_of_runs import parts_of_variance
from lithobrake.pipeline.fly.flights import QUANTILES
from lithobrake.pipeline.fly.run_flights import RunFlights, RunImpacts
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.json_values import to_json
from lithobrake.results.run_results import OutputDirection, OutputEstimate, RunResults, SideRuns, VarianceParts
from lithobrake.results.shares import Estimate
from lithobrake.results.summary import Estimates
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import OVER_RIM, PERIODS_TRAVELLED, TOUCHDOWN

FILE, AZIMUTH_OUT = "estimates.json", "azimuth_out"
RETURNS = "returns"
SPLIT = ("speed_out", "elevation_out", "spin_out", RETURNS)


def estimate(job: Job) -> None:
    """Write what the runs say of the return fraction, of where scatter comes from, and of their outputs."""
    study, runs = job.study, DesignRuns.load(job.folder, "drawn")
    flights = RunFlights.load(job.folder, "drawn")
    returns = flights.returns
    if not np.isfinite(returns).any():
        raise ValueError(
            f"none of the {runs.run_count} runs left the surface or was captured (runs.sqlite lists how each ended), "
            "so there is no result; correct the outcomes of the runs, or widen the bed"
        )
    bed, why = runs.inputs["bed"].astype(int), why_no_interval(study)
    values = {name: runs.output(name) for name in SPLIT if name != RETURNS} | {RETURNS: returns}
    found = return_fraction(study, runs, flights)
    estimates = Estimates(
        returns=found,
        shares=run_shares(study, runs, flights, found),
        flights=flight_estimates(RunImpacts.load(job.folder), runs, why),
        variance_shares={name: _split(job, runs, name, y) for name, y in values.items()},
        outputs={
            name: _spread(name, y, bed, why, described(np.isfinite(y), runs.outcomes))
            for name, y in _outputs(runs).items()
        },
        runs=_counts(job, runs, values),
        sides=first_sides(study, runs, returns),
    )
    job.folder.write_json(FILE, to_json(estimates))


def _outputs(runs: DesignRuns) -> dict[str, np.ndarray]:
    """Outputs of which at least two runs have a number [run_count]."""
    known = {name: runs.output(name) for name in TOUCHDOWN if not name.startswith(("orientation_out", OVER_RIM))}
    return {name: y for name, y in known.items() if np.isfinite(y).sum() >= 2}


def _spread(name: str, y: np.ndarray, bed: np.ndarray, why: str | None, of: str) -> OutputEstimate | OutputDirection:
    """Mean and quantiles of an output over the runs that have it, with intervals where beds and places give them.

    Of the azimuth, which has neither beginning nor end, mean direction and resultant length. of: landings it describes.
    """
    if name == AZIMUTH_OUT:
        return direction(direction_estimate(y, bed, why=why), of)
    known = y[np.isfinite(y)]
    several = len(np.unique(bed[np.isfinite(y)])) > 1
    if why is None and several:
        mean, *quantiles = map(finite_estimate, (mean_estimate(y, bed), *quantile_estimates(y, bed, QUANTILES)))
    else:
        points = [known.mean(), *np.quantile(known, QUANTILES, method="hazen")]
        mean, *quantiles = (Estimate(float(point), None, None) for point in points)
    levels = (f"{level:g}" for level in QUANTILES)
    return OutputEstimate(mean, dict(zip(levels, quantiles, strict=True)), float(known.std(ddof=1)), of)


def _split(job: Job, runs: DesignRuns, name: str, y: np.ndarray) -> VarianceParts | None:
    """Parts of the variance of an output; None where the runs cannot tell."""
    twins = _differences(job, "twins", name, y)
    known = twins if np.isfinite(twins).any() else None
    return parts_of_variance(job, runs, y, described(np.isfinite(y), runs.outcomes), known)


def _differences(job: Job, design: str, name: str, y: np.ndarray) -> np.ndarray:
    """What an output differs by between the runs of a side design and the drawn runs beside them, [pair_count]."""
    if not job.study.design.side_runs:
        return np.empty(0)
    beside = DesignRuns.load(job.folder, design).output(name) if name != RETURNS else None
    other = RunFlights.load(job.folder, design).returns if beside is None else beside
    difference: np.ndarray = other - y[: len(other)]
    return difference


def _counts(job: Job, runs: DesignRuns, values: Mapping[str, np.ndarray]) -> RunResults:
    """How many runs ended how, and what the side runs say that the parts of the variance do not hold."""
    left, outcomes = np.array(runs.outcomes) == TouchdownOutcome.CLEAR, runs.outcome_counts()
    return RunResults(
        count=runs.run_count,
        beds=len(np.unique(runs.inputs["bed"])),
        outcomes=outcomes,
        missing=missing_landings(outcomes),
        warning=missing_warning(job.study, outcomes),
        # A lander that clearly flies beyond the rim has left; one that does not is left_sideways.
        over_rim=int((runs.output(OVER_RIM) == 1.0)[left].sum()),
        farther_than_period=_farther_than_period(runs),
        side_runs=_side_runs(job, values) if job.study.design.side_runs else None,
    )


def _farther_than_period(runs: DesignRuns) -> int | None:
    """Runs in which the lander travelled farther in contact than the period of its bed; None where none has one."""
    travelled = runs.output(PERIODS_TRAVELLED)
    return int((travelled > 1.0).sum()) if np.isfinite(travelled).any() else None


def _side_runs(job: Job, values: Mapping[str, np.ndarray]) -> SideRuns:
    """Numbers of pairs, the total effect of the soil, and the standard deviation that chaos gives an output."""
    soil_pairs, twin_count = (DesignRuns.load(job.folder, design).run_count for design in ("soil_pairs", "twins"))
    effects, chaos = {}, {}
    for name, y in values.items():
        pairs, twins = (_differences(job, design, name, y) for design in ("soil_pairs", "twins"))
        known = np.isfinite(y)
        if np.isfinite(pairs).sum() >= 2 and known.sum() >= 2 and np.ptp(y[known]) > 0.0:
            effects[name] = variance_part(soil_total_effect(pairs, y))
        if np.isfinite(twins).any():
            one = chaos_variance(twins)
            chaos[name] = Estimate(one.value**0.5, one.lower**0.5, one.upper**0.5)
    return SideRuns(soil_pairs, twin_count, job.study.design.twin_shift, effects, chaos)
