"""summary.json of a drawn study: what its runs and its emulator say, with intervals that hold for new beds."""

from dataclasses import replace

import numpy as np

from lithobrake.analysis import LEVEL
from lithobrake.pipeline.answer.aim_results import aim_results
from lithobrake.pipeline.answer.dispersion_statistics import Rows, ellipses, flight_checks, rest_results, shares
from lithobrake.pipeline.answer.landing_results import write_results
from lithobrake.pipeline.answer.limit_states import limit_state_results
from lithobrake.pipeline.answer.missing_landings import described
from lithobrake.pipeline.answer.regions import place_regions
from lithobrake.pipeline.answer.shares_over_refits import Refits, journey_ends, sample_fates
from lithobrake.pipeline.emulate.fitted_emulator import FILE as EMULATOR
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.fly.flights import read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.dispersion import RestResults
from lithobrake.results.emulator_results import EmulatorResults, EmulatorScores, JointScore, OutputScore
from lithobrake.results.expansions import MonteCarlo
from lithobrake.results.shares import EmulatorShares, Level, ReturnFraction
from lithobrake.results.summary import DrawnResults, Estimates
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.percentages import percent

PIT_BINS = 10


def write_drawn_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance."""
    write_results(job, _with_samples)


def _with_samples(job: Job, found: DrawnResults, runs: DesignRuns, estimates: Estimates) -> DrawnResults:
    """What the landings say, and what became of the samples of the emulator."""
    study, holds, refits = job.study, job.site.holds, _refits(estimates)
    samples, flights = Samples.load(job.folder), read_table(job.folder, "flights.csv")
    table = _emulator_shares(samples, flights, estimates, refits, holds=holds)
    known = table.sample_count - table.outcomes["missing"].count
    returns = replace(found.returns, emulator=table.outcomes["returns"].count / known if known else None)
    shares = replace(found.shares, emulator=table)
    return replace(
        found,
        returns=returns,
        shares=shares,
        flights=replace(found.flights, checks=flight_checks(job)),
        # Its outputs are those of the runs, of which results.outputs speaks.
        monte_carlo=MonteCarlo(len(samples.leaves), int(samples.leaves.sum())),
        ellipses=ellipses(study, flights, FlightStatus.IMPACT),
        regions=place_regions(found.site, flights, FlightStatus.IMPACT),
        rest=_rest(job, refits),
        limit_states=limit_state_results(study, job.folder, flights, shares.outcomes, holds=holds),
        aim=aim_results(study, job.folder, refits),
        emulator=_emulator(job, runs, returns),
    )


def _ended(estimates: Estimates) -> dict[str, int]:
    """How many runs ended in each way, without those that failed."""
    return {name: count for name, count in estimates.runs.outcomes.items() if name in list(TouchdownOutcome)}


def _refits(estimates: Estimates) -> Refits:
    """What the emulator was fitted to."""
    return Refits(estimates.runs.beds, sum(_ended(estimates).values()), estimates.returns.why)


def _rest(job: Job, refits: Refits) -> RestResults:
    """What became of the samples that were followed, on the soil with intervals from refits."""
    rest = rest_results(job)
    if rest.soil is None:
        return rest
    rows = [row for row in read_table(job.folder, "rest.csv") if row["ground"] == "soil"]
    sample = np.array([int(row["sample"]) for row in rows])
    counts = refits.with_intervals(rest.soil.counts, sample, journey_ends(rows))
    return replace(rest, soil=rest.soil.with_counts(counts, Level(LEVEL, refits.why)))


def _emulator_shares(
    samples: Samples, flights: Rows, estimates: Estimates, refits: Refits, *, holds: bool
) -> EmulatorShares:
    """What became of the samples of the emulator, as shares of all that were looked at, with intervals from refits."""
    found = shares(samples, flights, holds=holds)
    fates = sample_fates(samples, flights, holds=holds)
    counts = refits.with_intervals(found.outcomes, np.arange(found.sample_count), fates)
    counts = refits.widened(counts, _ended(estimates))
    return EmulatorShares(found.sample_count, found.flight_count, counts, LEVEL, refits.why)


def _emulator(job: Job, runs: DesignRuns, returns: ReturnFraction) -> EmulatorResults:
    """What the emulator is worth on beds left out, and whether it agrees with the runs."""
    from lithobrake.emulator import load

    model = load(job.folder / EMULATOR)
    scores, modelled = model.scores, [model.output_names[column] for column in model.runs.modelled]
    table = {}
    for column, name in enumerate(modelled):
        pit = np.histogram(scores.pit[:, column], PIT_BINS, (0.0, 1.0))[0]
        table[name] = OutputScore(
            float(scores.crps_skill[column]), float(scores.band_90[column]), tuple(pit.tolist())
        )  # fmt: skip
    return EmulatorResults(
        of=described(runs.has_outputs, runs.outcomes),
        statement=model.statement_on("beds"),
        follows_inputs=model.follows_inputs,
        found_inputs=tuple(name for name, found in model.found_inputs().items() if found),
        scores=EmulatorScores(JointScore(scores.gain / scores.energy_of_rows), table),
        warning=_disagreement(returns),
    )


def _disagreement(returns: ReturnFraction) -> str | None:
    """That runs and emulator disagree, in a sentence; None where they agree, or no interval says how far they may."""
    if returns.lower is None or returns.upper is None or returns.emulator is None:
        return None
    if returns.lower <= returns.emulator <= returns.upper:
        return None
    low, high = (f"{100 * end:.1f}" for end in (returns.lower, returns.upper))
    return (
        f"The emulator gives a return fraction of {percent(returns.emulator, 1)}, outside the interval of the runs "
        f"({low} to {high} %): do not rely on results of the emulator (flights, landing regions, rest); make more runs"
    )
