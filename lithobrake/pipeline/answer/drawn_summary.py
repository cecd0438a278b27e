"""summary.json of a drawn study: what its runs and its emulator say, with intervals that hold for new beds."""

from dataclasses import replace

import numpy as np

from lithobrake.analysis import LEVEL
from lithobrake.pipeline.answer.aim_results import aim_results
from lithobrake.pipeline.answer.dispersion_statistics import Rows, ellipses, flight_checks, rest_results, shares
from lithobrake.pipeline.answer.drawn_answer import drawn_answer, drawn_headline
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_shares, journey_rest
from lithobrake.pipeline.answer.limit_states import limit_state_results
from lithobrake.pipeline.answer.missing_landings import described
from lithobrake.pipeline.answer.run_estimates import FILE as ESTIMATES
from lithobrake.pipeline.answer.shares_over_refits import Refits, journey_ends, sample_fates
from lithobrake.pipeline.answer.site_summary import site_results
from lithobrake.pipeline.answer.summary_parts import bed_results, outputs_of_runs, write_summary_file
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.emulate.fitted_emulator import FILE as EMULATOR
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.fly.flights import read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.dispersion import FlightResults, RestResults
from lithobrake.results.emulator_results import EmulatorResults, EmulatorScores, JointScore, OutputScore
from lithobrake.results.expansions import MonteCarlo
from lithobrake.results.json_values import from_json
from lithobrake.results.shares import EmulatorShares, LandingShares, Level, ReturnFraction
from lithobrake.results.summary import DrawnResults, Estimates
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.percentages import percent
from lithobrake.vocabulary.quantities import DRAWN_DESIGNS, OUTPUTS, TOUCHDOWN

PIT_BINS = 10


def write_drawn_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance."""
    side = job.study.design.side_runs
    runs = [DesignRuns.load(job.folder, design) for design in (DRAWN_DESIGNS if side else DRAWN_DESIGNS[:1])]
    distinct = DesignRuns.distinct(runs)
    results = _results(job, runs[0], distinct)
    results = replace(results, answer=tuple(drawn_answer(job.study, results)))
    results = replace(results, headline=tuple(drawn_headline(results)))
    for part in (results.runs, results.emulator):
        if part is not None and part.warning:
            job.say(part.warning)
    write_summary_file(job, results, sum(one.run_count for one in runs), distinct)


def _results(job: Job, runs: DesignRuns, distinct: DesignRuns) -> DrawnResults:
    """What came out, without sentences: of journeys of landings, or of landings and the samples of their emulator."""
    estimates = from_json(Estimates, job.folder.read_json(ESTIMATES), "estimates")
    found = _of_runs(job, estimates, distinct)
    return _with_samples(job, found, runs, estimates) if job.study.journey is None else _with_journeys(job, found)


def _of_runs(job: Job, estimates: Estimates, distinct: DesignRuns) -> DrawnResults:
    """What the landings say, or the first ones of journeys."""
    return DrawnResults(
        units={name: TOUCHDOWN[name].units for name in OUTPUTS},
        beds=tuple(bed_results(job, name) for name in bed_files(job.study)),
        returns=estimates.returns,
        shares=LandingShares(**vars(estimates.shares), emulator=None),
        flights=FlightResults(estimates.flights, None),
        variance_shares=estimates.variance_shares,
        outputs=estimates.outputs,
        runs=estimates.runs,
        outputs_of_runs=outputs_of_runs(distinct),
        site=site_results(job.site),
        monte_carlo=None,
        ellipses=None,
        without_scatter=None,
        rest=RestResults(None, {}, None, None, None),
        limit_states={},
        aim=None,
        emulator=None,
        answer=(),
        headline=(),
    )


def _with_journeys(job: Job, found: DrawnResults) -> DrawnResults:
    """The same with how the journeys ended."""
    table = JourneyTable.load(job.folder)
    return replace(
        found,
        rest=journey_rest(job.study, table),
        ends=end_shares(job.study, table),
        journeys=len(table.end),
        touchdowns=table.touchdowns,
    )


def _with_samples(job: Job, found: DrawnResults, runs: DesignRuns, estimates: Estimates) -> DrawnResults:
    """The same with what became of the samples of the emulator."""
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
        f"The emulator gives a share of {percent(returns.emulator, 1)}, outside the interval of the runs ({low} to "
        f"{high} %): do not trust what rests on it (flights, ellipses, rest), and make more runs"
    )
