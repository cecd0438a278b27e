"""Samples of the first touchdown, by the expansion or the emulator: shares, flights, next impacts and outputs."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lithobrake.analysis import upper_limit
from lithobrake.pipeline.answer import dispersion_statistics
from lithobrake.pipeline.answer.dispersion_statistics import Rows, proportion
from lithobrake.pipeline.answer.emulated_ends import Refits, sample_fates
from lithobrake.pipeline.answer.expansion_results import ended_runs
from lithobrake.pipeline.answer.run_answers import place_regions, scope
from lithobrake.pipeline.first_touchdown.flights import read_table
from lithobrake.pipeline.first_touchdown.samples import MISSING, SAMPLE_OUTCOMES, Samples
from lithobrake.pipeline.job import Job
from lithobrake.results.dispersion import WithoutScatter
from lithobrake.results.model_results import SampledOutput, SampleResults
from lithobrake.results.run_results import CountedShare, ReturnFraction, SampleShares
from lithobrake.results.study_files import results_in
from lithobrake.results.summary import Estimates
from lithobrake.study import Study
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import ESTIMATES_FILE, FLIGHTS_WITHOUT_SCATTER_FILE, SAMPLE_FLIGHTS_FILE
from lithobrake.vocabulary.number_words import EXPANSION_LEVEL, LEVEL, QUANTILES
from lithobrake.vocabulary.outcomes import FlightStatus, SampleOutcome, TouchdownOutcome

# In the order of the summary.
FLIGHTS = (FlightStatus.IMPACT, FlightStatus.FLYING, FlightStatus.ESCAPED, FlightStatus.PARTNER)


def sample_results(job: Job) -> SampleResults:
    """What came of the samples of a study, drawn from its expansion where it has one, otherwise from its emulator."""
    samples, flights = Samples.load(job.folder), read_table(job.folder, SAMPLE_FLIGHTS_FILE)
    of_expansion, impacts = job.study.expansion is not None, _impacts(flights)
    return SampleResults(
        model="expansion" if of_expansion else "emulator",
        sample_count=len(samples.outcome),
        leaving_count=int(samples.leaves.sum()),
        outputs=_outputs(samples),
        shares=(_expansion_shares if of_expansion else _emulator_shares)(job, samples, flights),
        flights=dispersion_statistics.impact_numbers(flights),
        ellipses=dispersion_statistics.ellipses(job.site, impacts),
        regions=place_regions(dispersion_statistics.site_results(job.site), impacts),
        without_scatter=_without_scatter(job, samples),
    )


def _impacts(flights: Rows) -> Rows:
    return [row for row in flights if row["status"] == FlightStatus.IMPACT]


def return_fraction_of_samples(job: Job, found: SampleShares) -> ReturnFraction:
    """The return fraction of a study that draws no landers: that of the samples of its expansion."""
    return return_fraction(job.study, found, sum(ended_runs(job).values()))


def return_fraction(study: Study, found: SampleShares, run_count: int) -> ReturnFraction:
    """The return fraction of samples of an expansion that was fitted to so many runs.

    Without an interval, since neither other beds nor the error of the expansion are known.
    """
    share, missing = (found.outcomes[name].share.value for name in ("returns", "missing"))
    over = scope(study)
    return ReturnFraction(
        share=Estimate(share, None, None, why_missing=over.why),
        from_=f"{found.sample_count} samples of an expansion fitted to {run_count} landings {over.landings}",
        next_bed=None,
        if_missing=(share, share + missing),
        missing=missing,
        emulator=share,
        why=over.why,
    )


def return_fraction_of_known(found: SampleShares) -> float | None:
    """The return fraction of the samples whose end is known; None where that of none is."""
    known = found.sample_count - found.outcomes["missing"].count
    return found.outcomes["returns"].count / known if known else None


def sample_counts(samples: Samples, flights: Rows, *, holds: bool) -> tuple[int, dict[str, CountedShare]]:
    """How many samples were looked at, and how many of them met each end, without intervals.

    When not all leaving samples flew, only the samples up to the last that flew are looked at: they are a random part
    of all. `returns`: impact again in time, or captured where the site `holds` the lander; `missing`: left sideways, in
    contact at the time limit, or outside, of which no place is known.
    """
    total = len(samples.outcome)
    if len(flights) < int(samples.leaves.sum()):
        total = int(flights[-1]["sample"]) + 1
    met = np.bincount(samples.outcome[:total], minlength=len(SAMPLE_OUTCOMES)).tolist()
    counts = {str(name): count for name, count in zip(SAMPLE_OUTCOMES, met, strict=True)}
    del counts[SampleOutcome.CLEAR]
    statuses = [row["status"] for row in flights]
    counts |= {str(status): statuses.count(status) for status in FLIGHTS}
    counts["returns"] = counts[FlightStatus.IMPACT] + (counts[SampleOutcome.CAPTURED] if holds else 0)
    counts["missing"] = sum(counts[name] for name in MISSING)
    return total, {name: proportion(count, total) for name, count in counts.items()}


def limited_shares(
    samples: Samples, flights: Rows, run_outcomes: Mapping[str, int], why: str | None, *, holds: bool
) -> SampleShares:
    """Ends of samples of an expansion; run_outcomes: how often each outcome came in its runs; why: no interval.

    upper_limit: of an outcome that none of the runs had, whose probability need not be 0 (95 %).
    """
    total, outcomes = sample_counts(samples, flights, holds=holds)
    limit = upper_limit(sum(run_outcomes.values()), EXPANSION_LEVEL)
    for outcome in set(TouchdownOutcome) - {TouchdownOutcome.CLEAR, *run_outcomes}:
        outcomes[outcome.value] = replace(outcomes[outcome.value], upper_limit=limit)
    return SampleShares(total, len(flights), outcomes, EXPANSION_LEVEL, why)


def _expansion_shares(job: Job, samples: Samples, flights: Rows) -> SampleShares:
    return limited_shares(samples, flights, ended_runs(job), scope(job.study).why, holds=job.site.holds)


def _emulator_shares(job: Job, samples: Samples, flights: Rows) -> SampleShares:
    """Ends of samples of the emulator, with intervals from its refits."""
    estimates = results_in(Estimates, job.folder.read_json(ESTIMATES_FILE), "estimates")
    ended = {name: count for name, count in estimates.runs.outcomes.items() if name in list(TouchdownOutcome)}
    refits = Refits(estimates.runs.beds, sum(ended.values()), estimates.returns.why)
    total, counts = sample_counts(samples, flights, holds=job.site.holds)
    fates = sample_fates(samples, flights, holds=job.site.holds)
    counts = refits.widened(refits.with_intervals(counts, np.arange(total), fates), ended)
    return SampleShares(total, len(flights), counts, LEVEL, refits.why)


def _without_scatter(job: Job, samples: Samples) -> WithoutScatter | None:
    """What came of the samples of the expansion alone; None where they have no scatter to leave out."""
    if samples.without_scatter is None:
        return None
    flights = read_table(job.folder, FLIGHTS_WITHOUT_SCATTER_FILE)
    return WithoutScatter(
        _expansion_shares(job, samples.expansion_alone(), flights),
        dispersion_statistics.impact_numbers(flights),
        dispersion_statistics.ellipses(job.site, _impacts(flights)),
    )


def _outputs(samples: Samples) -> dict[str, SampledOutput]:
    """Spread of each output over the samples that leave the surface; empty where none does."""
    leaving, found = samples.leaves, {}
    for index, name in enumerate(samples.output_names if leaving.any() else ()):
        values = samples.outputs[leaving, index]
        quantiles = {f"quantile_{level:g}": float(np.quantile(values, level)) for level in QUANTILES}
        found[name] = SampledOutput(float(values.mean()), float(values.std()), quantiles)
    return found
