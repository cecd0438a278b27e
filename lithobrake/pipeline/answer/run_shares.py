"""How the landings of a drawn study end, by the flights of its runs: shares that add up to 1, times and speeds."""

from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL, IntervalEstimate, quantile_estimates, regression_terms, share_estimate
from lithobrake.pipeline.answer.missing_landings import KNOWN, LOST, left_in_flight
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.fly.flights import QUANTILES
from lithobrake.pipeline.fly.run_flights import FATES, FLIGHT_COUNT, RunFlights, RunImpacts
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome

RETURNS, MISSING = "returns", "missing"
CAPTURED = TouchdownOutcome.CAPTURED.value
SETTLED, LOFTED = JourneyStatus.SETTLED.value, JourneyStatus.LOFTED.value
# These add up to 1; every other share holds some of them.
PARTS = (*FlightStatus, CAPTURED)


def return_fraction(study: Study, runs: DesignRuns, flights: RunFlights) -> dict[str, Any]:
    """The return fraction with its interval, which covers whatever became of the landings without an outcome."""
    return _share(study, runs, flights.returns)


def run_shares(study: Study, runs: DesignRuns, flights: RunFlights, returns: dict[str, Any]) -> dict[str, Any]:
    """Every fate of all landings as a share of 1, by one estimator; returns: the estimate of the return fraction.

    count: flights that ended so, of FLIGHT_COUNT a landing; one that was captured, or has no outcome, counts as so
    many. The parts of PARTS add up to 1: landings without an outcome, which `missing` counts, are taken as like those
    that left in flight across the edge of the bed, and the interval of each part covers all that they may have done.
    """
    table: dict[str, Any] = {
        "sample_count": FLIGHT_COUNT * runs.run_count,
        "flight_count": int(flights.fates[:, : len(FlightStatus)].sum()),
        "level": LEVEL,
        "why": why_no_interval(study),
    }
    counts = flights.fates.sum(axis=1)
    for name, ended in _events(flights.fates).items():
        share = np.where(counts > 0, ended / np.maximum(counts, 1), np.nan)
        table[name] = _entry(int(ended.sum()), _share(study, runs, share))
    table[RETURNS] = _entry(round(float(np.nansum(flights.returns * FLIGHT_COUNT))), returns)
    _balance(table)
    for outcome in (*LOST, MISSING):
        met = ~np.isin(runs.outcomes, KNOWN) if outcome == MISSING else np.array(runs.outcomes) == outcome
        found = share_estimate(met.astype(float), runs.inputs["bed"], why=why_no_interval(study))
        table[str(outcome)] = _entry(FLIGHT_COUNT * int(met.sum()), found.summary())
    return table


def flight_estimates(impacts: RunImpacts, runs: DesignRuns, why: str | None) -> dict[str, Any]:
    """Quantiles of time, speed and incidence of the impacts that end the flights of the runs, beds as units.

    intervals: of each quantile, lower and upper; None where the runs give none.
    """
    bed, table = runs.inputs["bed"].astype(int)[impacts.run], {}
    several = len(np.unique(bed)) > 1
    landings = f"the flights of {len(np.unique(impacts.run))} of {runs.run_count} landings that return"
    for name, values in impacts.numbers.items() if len(bed) else ():
        points = np.quantile(values, QUANTILES, method="hazen").tolist()
        ends: list[list[float] | None] = [None] * len(QUANTILES)
        if why is None and several:
            found = quantile_estimates(values, bed, QUANTILES)
            points, ends = [one.value for one in found], [_bounds(one) for one in found]
        keys = [f"quantile_{level:g}" for level in QUANTILES]
        table[name] = dict(zip(keys, points, strict=True)) | {"intervals": dict(zip(keys, ends, strict=True))}
        table[name]["of"] = landings
    return table


def _bounds(one: IntervalEstimate) -> list[float] | None:
    """Bounds of a quantile; few beds give none of a tail."""
    return [one.lower, one.upper] if np.isfinite([one.lower, one.upper]).all() else None


def _events(fates: np.ndarray) -> dict[str, np.ndarray]:
    """Flights of each run that ended in each way, [run_count]."""
    by_fate = {str(fate): fates[:, column] for column, fate in enumerate(FATES)}
    return by_fate | {CAPTURED: by_fate[SETTLED] + by_fate[LOFTED]}


def _balance(table: dict[str, Any]) -> None:
    """Let the parts add up to the return fraction and to 1: each has a regression on the inputs of its own.

    What is left over goes to the parts in proportion to their variances (least-squares adjustment to a known total).
    Source: [Deming-1940].
    """
    others = [table[name] for name in PARTS if name not in (FlightStatus.IMPACT, CAPTURED)] + [table[LOFTED]]
    weights = np.array([one["share"] * (1.0 - one["share"]) for one in others])
    left = 1.0 - table[RETURNS]["share"] - sum(one["share"] for one in others)
    if weights.sum() > 0.0:
        for one, part in zip(others, (left * weights / weights.sum()).tolist(), strict=True):
            _move(one, max(one["share"] + part, 0.0))
    _move(table[FlightStatus.IMPACT], max(table[RETURNS]["share"] - table[SETTLED]["share"], 0.0))
    _move(table[CAPTURED], table[SETTLED]["share"] + table[LOFTED]["share"])


def _move(entry: dict[str, Any], share: float) -> None:
    """Set a share, which its interval always holds."""
    entry["share"] = share
    if entry["lower"] is not None:
        entry |= {"lower": min(entry["lower"], share), "upper": max(entry["upper"], share)}


def _share(study: Study, runs: DesignRuns, share: np.ndarray) -> dict[str, Any]:
    """The estimate of an event from its share of the flights of each run [run_count], NaN where that is not known."""
    inputs = DrawnDesign(study).inputs
    terms = regression_terms(inputs, runs.columns(list(inputs)))
    bed, why = runs.inputs["bed"], why_no_interval(study)
    return share_estimate(share, bed, terms=terms, like_missing=left_in_flight(runs), why=why).summary()


def _entry(count: int, found: dict[str, Any]) -> dict[str, Any]:
    return {"count": count, **{key: found[key] for key in ("share", "lower", "upper")}}
