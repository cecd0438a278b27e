"""How the landings of a drawn study end, by the flights of its runs: shares that add up to 1, times and speeds."""

from dataclasses import replace

import numpy as np

from lithobrake.analysis import LEVEL, IntervalEstimate, quantile_estimates, regression_terms, share_estimate
from lithobrake.pipeline.answer.missing_landings import KNOWN, LOST, left_in_flight
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.answer.typed_estimates import counted, fraction
from lithobrake.pipeline.design.drawn_design import GRAIN, DrawnDesign
from lithobrake.pipeline.fly.flights import QUANTILES
from lithobrake.pipeline.fly.run_flights import FATES, RunFlights, RunImpacts
from lithobrake.pipeline.fly.run_sites import FLIGHT_COUNT
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.dispersion import ImpactNumber, ImpactNumbers
from lithobrake.results.shares import CountedShare, ReturnFraction, RunShares
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome

RETURNS, MISSING = "returns", "missing"
CAPTURED = TouchdownOutcome.CAPTURED.value
SETTLED, LOFTED = JourneyStatus.SETTLED.value, JourneyStatus.LOFTED.value
# These add up to 1; every other share holds some of them.
PARTS = (*FlightStatus, CAPTURED)


def return_fraction(study: Study, runs: DesignRuns, flights: RunFlights) -> ReturnFraction:
    """The return fraction with its interval, which covers whatever became of the landings without an outcome."""
    return _share(study, runs, flights.returns)


def run_shares(study: Study, runs: DesignRuns, flights: RunFlights, returns: ReturnFraction) -> RunShares:
    """Every fate of all landings as a share of 1, by one estimator; returns: the estimate of the return fraction.

    count: flights that ended so, of FLIGHT_COUNT a landing; one that was captured, or has no outcome, counts as so
    many. The parts of PARTS add up to 1: landings without an outcome, which `missing` counts, are taken as like those
    that left in flight across the edge of the bed, and the interval of each part covers all that they may have done.
    """
    counts, found = flights.fates.sum(axis=1), {}
    for name, ended in _events(flights.fates).items():
        share = np.where(counts > 0, ended / np.maximum(counts, 1), np.nan)
        found[name] = counted(int(ended.sum()), _share(study, runs, share))
    found[RETURNS] = counted(round(float(np.nansum(flights.returns * FLIGHT_COUNT))), returns)
    _balance(found)
    why = why_no_interval(study)
    for outcome in (*LOST, MISSING):
        met = ~np.isin(runs.outcomes, KNOWN) if outcome == MISSING else np.array(runs.outcomes) == outcome
        known = fraction(share_estimate(met.astype(float), runs.inputs["bed"], why=why))
        found[str(outcome)] = counted(FLIGHT_COUNT * int(met.sum()), known)
    flown = int(flights.fates[:, : len(FlightStatus)].sum())
    return RunShares(FLIGHT_COUNT * runs.run_count, flown, LEVEL, why, found)


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
            found = quantile_estimates(values, bed, QUANTILES)
            points, ends = [one.value for one in found], [_bounds(one) for one in found]
        quantiles, intervals = (dict(zip(keys, one, strict=True)) for one in (points, ends))
        table[name] = ImpactNumber(quantiles, intervals, landings)
    return ImpactNumbers(**table)


def _bounds(one: IntervalEstimate) -> tuple[float, float] | None:
    """Bounds of a quantile; few beds give none of a tail."""
    return (one.lower, one.upper) if np.isfinite([one.lower, one.upper]).all() else None


def _events(fates: np.ndarray) -> dict[str, np.ndarray]:
    """Flights of each run that ended in each way, [run_count]."""
    by_fate = {str(fate): fates[:, column] for column, fate in enumerate(FATES)}
    return by_fate | {CAPTURED: by_fate[SETTLED] + by_fate[LOFTED]}


def _balance(table: dict[str, CountedShare]) -> None:
    """Let the parts add up to the return fraction and to 1: each has a regression on the inputs of its own.

    What is left over goes to the parts in proportion to their variances (least-squares adjustment to a known total).
    Source: [Deming-1940].
    """
    names = [*(str(name) for name in PARTS if name not in (FlightStatus.IMPACT, CAPTURED)), LOFTED]
    weights = np.array([table[name].share * (1.0 - table[name].share) for name in names])
    left = 1.0 - table[RETURNS].share - sum(table[name].share for name in names)
    if weights.sum() > 0.0:
        for name, part in zip(names, (left * weights / weights.sum()).tolist(), strict=True):
            table[name] = _moved(table[name], max(table[name].share + part, 0.0))
    impact, settled = FlightStatus.IMPACT.value, table[SETTLED].share
    table[impact] = _moved(table[impact], max(table[RETURNS].share - settled, 0.0))
    table[CAPTURED] = _moved(table[CAPTURED], settled + table[LOFTED].share)


def _moved(one: CountedShare, share: float) -> CountedShare:
    """Another share, which its interval always holds."""
    if one.lower is None or one.upper is None:
        return replace(one, share=share)
    return replace(one, share=share, lower=min(one.lower, share), upper=max(one.upper, share))


def _share(study: Study, runs: DesignRuns, share: np.ndarray) -> ReturnFraction:
    """The estimate of an event from its share of the flights of each run [run_count], NaN where that is not known."""
    inputs = DrawnDesign(study).inputs
    if study.soil:
        # On the soils of regions the grains of a run follow another law than the study gives for [grain].
        inputs = {name: law for name, law in inputs.items() if not name.startswith(GRAIN)}
    terms = regression_terms(inputs, runs.columns(list(inputs)))
    bed, why = runs.inputs["bed"], why_no_interval(study)
    return fraction(share_estimate(share, bed, terms=terms, like_missing=left_in_flight(runs), why=why))
