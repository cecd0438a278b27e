"""What the drawn runs say of themselves: shares, parts of the variance, means and quantiles, with intervals."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from lithobrake import analysis
from lithobrake.analysis.missing_runs import Limits
from lithobrake.chaos import Empirical
from lithobrake.pipeline.answer import run_answers
from lithobrake.pipeline.answer.correlated_inputs import independent_columns
from lithobrake.pipeline.answer.journey_ends import JourneyTable, first_sides
from lithobrake.pipeline.answer.output_limits import output_limits
from lithobrake.pipeline.answer.run_answers import described, unknown_runs
from lithobrake.pipeline.design.drawn_design import GRAIN, DrawnDesign
from lithobrake.pipeline.design.lander_attitude import independent_terms
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.first_touchdown.run_flights import FATES, FLIGHT_COUNT, RunFlights, RunImpacts
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results import run_results
from lithobrake.results.dispersion import ImpactNumber, ImpactNumbers
from lithobrake.results.study_files import json_values
from lithobrake.results.summary import Estimates
from lithobrake.statements.ends import journeys_at_rest
from lithobrake.study import Study
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import ESTIMATES_FILE
from lithobrake.vocabulary.landing_fraction import LandingFraction
from lithobrake.vocabulary.material_properties import SURFACE_PROPERTIES
from lithobrake.vocabulary.number_words import QUANTILES
from lithobrake.vocabulary.outcomes import (
    CAPTURED,
    LOFTED,
    RETURNS,
    SETTLED,
    FlightStatus,
    TouchdownOutcome,
)
from lithobrake.vocabulary.quantities import ARRIVAL, GROUND_KIND, GROUND_SIZE, OVER_RIM, PERIODS_TRAVELLED, TOUCHDOWN

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

MISSING = "missing"
# These add up to 1; every other share holds some of them.
PARTS = (*FlightStatus, CAPTURED)
# Numbers that say what the ground is, the lander's side of its contacts among them; all others say how it arrives.
SOIL = ("ground.", "grain.", "soil.", "surface.", "solver.inputs.", *(f"lander.{name}" for name in SURFACE_PROPERTIES))
Inputs = dict[str, tuple["Distribution", np.ndarray]]
ESTIMATES_FILE, AZIMUTH_OUT = ESTIMATES_FILE, "azimuth_out"
SPLIT = ("speed_out", "elevation_out", "spin_out", RETURNS)


def return_fraction(study: Study, runs: DesignRuns, flights: RunFlights) -> run_results.ReturnFraction:
    """The return fraction with its interval, which covers whatever became of the landings without an outcome."""
    return run_results.ReturnFraction.of(_share(study, runs, flights.returns))


def no_return_fraction(study: Study) -> run_results.ReturnFraction:
    """That of a study that draws no lander."""
    why = run_answers.why_no_interval(study)
    return run_results.ReturnFraction(
        share=Estimate(math.nan, None, None, why_missing=why),
        from_="no landings",
        next_bed=None,
        if_missing=(0.0, 1.0),
        missing=0.0,
        emulator=None,
        why=why,
    )


def run_shares(
    study: Study, runs: DesignRuns, flights: RunFlights, returns: run_results.ReturnFraction
) -> run_results.RunShares:
    """Every fate of all landings as a share of 1, by one estimator; returns: the estimate of the return fraction.

    count: flights that ended so, of FLIGHT_COUNT a landing; one that was captured, or has no outcome, counts as so
    many. The parts of PARTS add up to 1: landings without an outcome, which `missing` counts, are taken as like those
    that left in flight across the edge of the bed, and the interval of each part covers all that they may have done.
    """
    counts, found = flights.fates.sum(axis=1), {}
    for name, ended in _events(flights.fates).items():
        share = np.where(counts > 0, ended / np.maximum(counts, 1), np.nan)
        found[name] = _counted(int(ended.sum()), _share(study, runs, share))
    found[RETURNS] = _counted(round(float(np.nansum(flights.returns * FLIGHT_COUNT))), returns)
    _balance(found)
    why = run_answers.why_no_interval(study)
    for outcome in (*run_answers.LOST, MISSING):
        met = ~np.isin(runs.outcomes, run_answers.KNOWN) if outcome == MISSING else np.array(runs.outcomes) == outcome
        known = analysis.share_estimate(met.astype(float), runs.inputs["bed"], why=why)
        found[str(outcome)] = _counted(FLIGHT_COUNT * int(met.sum()), known)
    flown = int(flights.fates[:, : len(FlightStatus)].sum())
    return run_results.RunShares(FLIGHT_COUNT * runs.run_count, flown, analysis.LEVEL, why, found)


def flight_estimates(impacts: RunImpacts, runs: DesignRuns, why: str | None) -> ImpactNumbers:
    """Quantiles of time, speed and incidence of the impacts that end the flights of the runs, beds as units."""
    bed, table = runs.inputs["bed"].astype(int)[impacts.run], {}
    several = len(np.unique(bed)) > 1
    landings = f"the flights of {len(np.unique(impacts.run))} of {runs.run_count} landings that return"
    keys = [f"quantile_{level:g}" for level in QUANTILES]
    for name, values in impacts.numbers.items() if len(bed) else ():
        points = np.quantile(values, QUANTILES, method="hazen").tolist()
        ends: list[tuple[float, float] | None] = [None] * len(QUANTILES)
        if why is None and several:
            # A run without an outcome may have any flights, or none.
            lost = np.repeat(np.flatnonzero(unknown_runs(runs)), FLIGHT_COUNT)
            found = analysis.quantile_estimates(
                np.concatenate([values, np.full(len(lost), np.nan)]),
                np.concatenate([bed, runs.inputs["bed"].astype(int)[lost]]),
                QUANTILES,
                missing=np.arange(len(values) + len(lost)) >= len(values),
            )
            points, ends = [one.value for one in found], [one.bounds for one in found]
        quantiles, intervals = (dict(zip(keys, one, strict=True)) for one in (points, ends))
        table[name] = ImpactNumber(quantiles, intervals, landings)
    return ImpactNumbers(**table)


def _counted(count: int, found: LandingFraction) -> run_results.CountedShare:
    """A fraction of the landings beside the flights that it comes from; the table says why it has no interval."""
    return run_results.CountedShare(count, found.share.without_reason)


def _events(fates: np.ndarray) -> dict[str, np.ndarray]:
    """Flights of each run that ended in each way, [run_count]."""
    by_fate = {str(fate): fates[:, column] for column, fate in enumerate(FATES)}
    return by_fate | {CAPTURED: by_fate[SETTLED] + by_fate[LOFTED]}


def _balance(table: dict[str, run_results.CountedShare]) -> None:
    """Let the parts add up to the return fraction and to 1: each has a regression on the inputs of its own.

    What is left over goes to the parts in proportion to their variances (least-squares adjustment to a known total).
    Source: [Deming-1940].
    """
    names = [*(str(name) for name in PARTS if name not in (FlightStatus.IMPACT, CAPTURED)), LOFTED]
    weights = np.array([table[name].share.value * (1.0 - table[name].share.value) for name in names])
    left = 1.0 - table[RETURNS].share.value - sum(table[name].share.value for name in names)
    if weights.sum() > 0.0:
        for name, part in zip(names, (left * weights / weights.sum()).tolist(), strict=True):
            table[name] = _moved(table[name], max(table[name].share.value + part, 0.0))
    impact, settled = FlightStatus.IMPACT.value, table[SETTLED].share.value
    table[impact] = _moved(table[impact], max(table[RETURNS].share.value - settled, 0.0))
    table[CAPTURED] = _moved(table[CAPTURED], settled + table[LOFTED].share.value)


def _moved(one: run_results.CountedShare, share: float) -> run_results.CountedShare:
    """Another share, which its interval always holds."""
    bounds = one.share.bounds
    lower, upper = (None, None) if bounds is None else (min(bounds[0], share), max(bounds[1], share))
    return replace(one, share=replace(one.share, value=share, lower=lower, upper=upper))


def _share(study: Study, runs: DesignRuns, share: np.ndarray) -> LandingFraction:
    """The estimate of an event from its share of the flights of each run [run_count], NaN where that is not known."""
    inputs = DrawnDesign(study).lawful_inputs
    x = independent_columns(study, {name: runs.inputs[name] for name in inputs})
    terms = analysis.regression_terms(inputs, x)
    bed, why = runs.inputs["bed"], run_answers.why_no_interval(study)
    return analysis.share_estimate(share, bed, terms=terms, like_missing=run_answers.left_in_flight(runs), why=why)


def parts_of_variance(
    job: Job, runs: DesignRuns, y: np.ndarray, of: str, twins: np.ndarray | None = None, limits: Limits | None = None
) -> run_results.VarianceParts | None:
    """Parts of the variance of y [run_count], NaN where a run has none; None where the runs cannot tell.

    of: which runs it describes, in words. twins [pair_count]: differences of y between twins, where there are any.
    limits: of y, for the runs without an outcome.
    """
    lost = unknown_runs(runs) & np.isnan(y)
    return _parts(job, runs, _touchdown_inputs(job, runs), Split(y, of, lost, limits, twins))


def parts_of_journeys(
    job: Job, runs: DesignRuns, table: JourneyTable, limit_states: Mapping[str, np.ndarray]
) -> dict[str, run_results.VarianceParts | None]:
    """Parts of the variance of how and where journeys end, by their delivery and first touchdowns, runs.

    table: of the journeys of these runs, in their order. Whether a lander comes to rest is 1 or 0, and so is whether it
    meets each of the limit states, by name [run_count], NaN where that is not known.
    """
    rests, everything = table.rests, f"{len(table.end)} journeys"
    of_rest = journeys_at_rest(int(rests.sum()), len(rests))
    lost, event = table.unknown, (0.0, 1.0)
    # A lander of unknown end may rest anywhere on the body, at any time until the limit.
    numbers = {
        "at_rest": Split(table.told(rests), everything, lost, event),
        "time_s": Split(table.of_rest("time_s"), of_rest, lost, (0.0, job.study.journey.duration)),
        "distance_m": Split(table.of_rest("distance"), of_rest, lost, (0.0, math.pi * job.site.aim_radius)),
    }
    numbers |= {name: Split(met, everything, np.isnan(met), event) for name, met in limit_states.items()}
    inputs = _touchdown_inputs(job, runs) | _delivery_inputs(job, runs)
    return {name: _parts(job, runs, inputs, one) for name, one in numbers.items()}


def inputs_of_journeys(job: Job, runs: DesignRuns) -> Inputs:
    """What is drawn for each journey, with its law and its values at the first touchdowns [run_count].

    Without the ground of its bed, which is not drawn for each.
    """
    found = _touchdown_inputs(job, runs) | _delivery_inputs(job, runs)
    return {name: one for name, one in found.items() if name not in (GROUND_KIND, GROUND_SIZE)}


def _touchdown_inputs(job: Job, runs: DesignRuns) -> Inputs:
    """The uncertain inputs of the touchdowns with their laws, and their values [run_count].

    A place that is drawn by a law of its own is a place like any other.
    """
    flown = [name for name in ARRIVAL if job.design.is_flown and np.ptp(runs.inputs[name]) > 0.0]
    told = {name: Empirical(runs.inputs[name].tolist()) for name in flown}
    values = dict(runs.inputs)
    if job.design.study.site.roughness_deg and not job.design.is_flown:
        # Seen from the ground that each lander meets, its impact has another distribution than the study gives.
        drawn = job.design.delivered_rows
        values |= {name: np.array([row[name] for row in drawn]) for name in job.design.soil_inputs}
    found = {name: (law, values[name]) for name, law in (job.design.soil_inputs | told).items()}
    return _ground_inputs(job, runs) | found | _soil_inputs(job, runs)


def _ground_inputs(job: Job, runs: DesignRuns) -> Inputs:
    """Kind and grain size of the ground of the beds, with their laws; nothing where there is one ground."""
    # Terms of first and second degree tell up to three kinds apart, whatever their numbers.
    return {
        name: (Empirical(values), runs.inputs[name])
        for name, values in job.design.grounds.numbers.items()
        if np.ptp(runs.inputs[name]) > 0.0
    }


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


@dataclass(frozen=True)
class Split:
    """What is split into the parts of its variance: y [run_count], NaN where a run has none, and of which runs it is.

    lost [run_count]: whether it is not known what became of a run; limits: of y for these; None: nothing limits them.
    twins [pair_count]: differences of y between twins.
    """

    y: np.ndarray
    of: str
    lost: np.ndarray
    limits: Limits | None
    twins: np.ndarray | None = None


def _parts(job: Job, runs: DesignRuns, inputs: Inputs, one: Split) -> run_results.VarianceParts | None:
    if not inputs:
        return None
    laws = {name: law for name, (law, _) in inputs.items()}
    # What goes together is one input: the arrival as a whole has the variance of all its terms.
    x = independent_columns(job.study, {name: values for name, (_, values) in inputs.items()})
    soil = [key for key in laws if key.startswith(SOIL)]
    attitude = independent_terms(job.design, runs.inputs)
    found = analysis.variance_shares(
        laws, x, one.y, runs.inputs["bed"], soil=soil, attitude=attitude, twins=one.twins, missing=one.lost,
        limits=one.limits,
    )  # fmt: skip
    return None if found is None else run_results.VarianceParts.of_shares(found, one.of)


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
    why = run_answers.why_no_interval(study)
    values = {name: runs.output(name) for name in SPLIT if name != RETURNS} | {RETURNS: returns}
    limits, found = output_limits(job, runs), return_fraction(study, runs, flights)
    estimates = Estimates(
        returns=found,
        shares=run_shares(study, runs, flights, found),
        flights=flight_estimates(RunImpacts.load(job.folder), runs, why),
        variance_shares={name: _split(job, runs, name, y, limits.get(name)) for name, y in values.items()},
        outputs={name: _spread(name, y, runs, why, limits.get(name)) for name, y in _outputs(runs).items()},
        runs=_counts(job, runs, values),
        sides=first_sides(study, runs, returns),
    )
    job.folder.write_json(ESTIMATES_FILE, json_values(estimates))


def _outputs(runs: DesignRuns) -> dict[str, np.ndarray]:
    """Outputs of which at least two runs have a number [run_count]."""
    known = {name: runs.output(name) for name in TOUCHDOWN if not name.startswith(("orientation_out", OVER_RIM))}
    return {name: y for name, y in known.items() if np.isfinite(y).sum() >= 2}


def _spread(
    name: str, y: np.ndarray, runs: DesignRuns, why: str | None, limits: Limits | None
) -> run_results.OutputEstimate | run_results.OutputDirection:
    """Mean and quantiles of an output over the runs that have it, with intervals where beds and places give them.

    Of the azimuth, which has neither beginning nor end, mean direction and resultant length. limits: of the output, for
    runs without an outcome.
    """
    bed, lost, of = (
        runs.inputs["bed"].astype(int),
        unknown_runs(runs) & np.isnan(y),
        described(np.isfinite(y), runs.outcomes),
    )
    if name == AZIMUTH_OUT:
        return run_results.OutputDirection(**vars(analysis.direction_estimate(y, bed, why=why, missing=lost)), of=of)
    known = y[np.isfinite(y)]
    several = len(np.unique(bed[np.isfinite(y)])) > 1
    if why is None and several:
        mean = analysis.mean_estimate(y, bed, missing=lost, limits=limits)
        quantiles = analysis.quantile_estimates(y, bed, QUANTILES, missing=lost, limits=limits)
    else:
        points = [known.mean(), *np.quantile(known, QUANTILES, method="hazen")]
        mean, *quantiles = (Estimate(float(point), None, None) for point in points)
    levels = (f"{level:g}" for level in QUANTILES)
    return run_results.OutputEstimate(mean, dict(zip(levels, quantiles, strict=True)), float(known.std(ddof=1)), of)


def _split(
    job: Job, runs: DesignRuns, name: str, y: np.ndarray, limits: Limits | None
) -> run_results.VarianceParts | None:
    """Parts of the variance of an output; None where the runs cannot tell. limits: for runs without an outcome."""
    twins = _differences(job, "twins", name, y)
    known = twins if np.isfinite(twins).any() else None
    return parts_of_variance(job, runs, y, described(np.isfinite(y), runs.outcomes), known, limits)


def _differences(job: Job, design: str, name: str, y: np.ndarray) -> np.ndarray:
    """What an output differs by between the runs of a side design and the drawn runs beside them, [pair_count]."""
    if not job.study.design.side_runs:
        return np.empty(0)
    beside = DesignRuns.load(job.folder, design).output(name) if name != RETURNS else None
    other = RunFlights.load(job.folder, design).returns if beside is None else beside
    difference: np.ndarray = other - y[: len(other)]
    return difference


def _counts(job: Job, runs: DesignRuns, values: Mapping[str, np.ndarray]) -> run_results.RunResults:
    """How many runs ended how, and what the side runs say that the parts of the variance do not hold."""
    left, outcomes = np.array(runs.outcomes) == TouchdownOutcome.CLEAR, runs.outcome_counts()
    return run_results.RunResults(
        count=runs.run_count,
        beds=len(np.unique(runs.inputs["bed"])),
        outcomes=outcomes,
        missing=run_answers.missing_landings(outcomes),
        warning=run_answers.missing_warning(job.study, outcomes),
        # A lander that clearly flies beyond the rim has left; one that does not is left_sideways.
        over_rim=int((runs.output(OVER_RIM) == 1.0)[left].sum()),
        farther_than_period=_farther_than_period(runs),
        side_runs=_side_runs(job, values) if job.study.design.side_runs else None,
    )


def _farther_than_period(runs: DesignRuns) -> int | None:
    """Runs in which the lander travelled farther in contact than the period of its bed; None where none has one."""
    travelled = runs.output(PERIODS_TRAVELLED)
    return int((travelled > 1.0).sum()) if np.isfinite(travelled).any() else None


def _side_runs(job: Job, values: Mapping[str, np.ndarray]) -> run_results.SideRuns:
    """Numbers of pairs, the total effect of the soil, and the standard deviation that chaos gives an output."""
    soil_pairs, twin_count = (DesignRuns.load(job.folder, design).run_count for design in ("soil_pairs", "twins"))
    effects, chaos = {}, {}
    for name, y in values.items():
        pairs, twins = (_differences(job, design, name, y) for design in ("soil_pairs", "twins"))
        known = np.isfinite(y)
        if np.isfinite(pairs).sum() >= 2 and known.sum() >= 2 and np.ptp(y[known]) > 0.0:
            effects[name] = analysis.soil_total_effect(pairs, y)
        if np.isfinite(twins).any():
            chaos[name] = analysis.chaos_variance(twins).on_scale(lambda variance: variance**0.5)
    return run_results.SideRuns(soil_pairs, twin_count, job.study.design.twin_shift, effects, chaos)
