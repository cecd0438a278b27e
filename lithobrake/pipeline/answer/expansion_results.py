"""summary.json of a paper study, with its answer in sentences."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.analysis import upper_limit
from lithobrake.chaos import smolyak_count, tensor_count
from lithobrake.pipeline.answer import dispersion_statistics
from lithobrake.pipeline.answer.run_answers import place_regions, scope
from lithobrake.pipeline.answer.run_estimates import SPLIT
from lithobrake.pipeline.answer.study_summary import bed_results, outputs_of_runs, write_summary_file
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.expansion.expansions import kept_inputs, replicate_count
from lithobrake.pipeline.flights import read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.samples import MISSING, Samples
from lithobrake.results import model_results
from lithobrake.results.dispersion import FlightResults, WithoutScatter
from lithobrake.results.run_results import ReturnFraction, SampleShares
from lithobrake.results.study_files import results_in
from lithobrake.results.summary import PaperResults
from lithobrake.statements.answers import sample_answer, sample_headline
from lithobrake.study import Study
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import REFINED_FILE, SAMPLE_FLIGHTS_FILE, SCORES_FILE, SCREENING_FILE
from lithobrake.vocabulary.number_words import QUANTILES
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import OUTPUTS, PAPER_DESIGNS, TOUCHDOWN

if TYPE_CHECKING:
    from lithobrake.chaos import Surrogate


def write_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance."""
    runs = {design: DesignRuns.load(job.folder, design) for design in PAPER_DESIGNS}
    distinct = DesignRuns.distinct(list(runs.values()))
    results = _results(job, runs, distinct)
    over = scope(job.study)
    results = replace(results, answer=tuple(sample_answer(over, results, MISSING)))
    results = replace(results, headline=tuple(sample_headline(over, results)))
    write_summary_file(job, results, sum(one.run_count for one in runs.values()), distinct)


def _results(job: Job, runs: dict[str, DesignRuns], distinct: DesignRuns) -> PaperResults:
    """What came out, without sentences."""
    from lithobrake.chaos import load

    study, screening, refined = job.study, load(job.folder / SCREENING_FILE), load(job.folder / REFINED_FILE)
    ended = Counter(outcome for outcome in distinct.outcomes if outcome in list(TouchdownOutcome))
    samples, kept, flights = (
        Samples.load(job.folder),
        kept_inputs(study, screening),
        read_table(job.folder, SAMPLE_FLIGHTS_FILE),
    )
    holds = job.site.holds
    table = replace(limited_shares(samples, flights, ended, holds=holds), why=scope(study).why)
    return PaperResults(
        units={name: TOUCHDOWN[name].units for name in OUTPUTS},
        beds=tuple(bed_results(job, name) for name in bed_files(study)),
        node_counts=_node_counts(study, len(screening.input_names)),
        designs={design: _design(runs[design], replicate_count(study, design)) for design in PAPER_DESIGNS},
        outputs_of_runs=outputs_of_runs(distinct),
        screening=_expansion(job, "screening", screening, runs["screening"]),
        refined=_expansion(job, "refined", refined, runs["refined"]),
        kept_inputs=tuple(kept),
        kept_share=_by_output(screening, np.asarray(screening.sobol_group(kept))),
        scores=_scores(job),
        monte_carlo=_monte_carlo(samples),
        site=(site := dispersion_statistics.site_results(job.site)),
        # One bed, one place and one attitude have no parts.
        variance_shares=dict.fromkeys(SPLIT),
        shares=table,
        returns=return_fraction(study, table, sum(ended.values())),
        flights=FlightResults(dispersion_statistics.impact_numbers(flights), dispersion_statistics.flight_checks(job)),
        ellipses=dispersion_statistics.ellipses(job.site, flights, FlightStatus.IMPACT),
        regions=place_regions(site, flights, FlightStatus.IMPACT),
        without_scatter=_without_scatter(job, samples, ended, holds=holds),
        rest=dispersion_statistics.rest_results(job),
        answer=(),
        headline=(),
    )


def limited_shares(
    samples: Samples, flights: dispersion_statistics.Rows, run_outcomes: Mapping[str, int], *, holds: bool
) -> SampleShares:
    """What became of the samples; run_outcomes: how often each came in the runs; holds: whether the site does.

    upper_limit: of an outcome that none of the runs had, which its share of 0 does not say (95 %).
    """
    found = dispersion_statistics.shares(samples, flights, holds=holds)
    outcomes, limit = dict(found.outcomes), upper_limit(sum(run_outcomes.values()))
    for outcome in set(TouchdownOutcome) - {TouchdownOutcome.CLEAR, *run_outcomes}:
        outcomes[outcome.value] = replace(outcomes[outcome.value], upper_limit=limit)
    return replace(found, outcomes=outcomes)


def _without_scatter(
    job: Job, samples: Samples, run_outcomes: Mapping[str, int], *, holds: bool
) -> WithoutScatter | None:
    """What becomes of the samples of the expansion alone; None where they have no scatter to leave out."""
    if samples.without_scatter is None:
        return None
    flights = read_table(job.folder, "flights_without_scatter.csv")
    found = limited_shares(samples.expansion_alone(), flights, run_outcomes, holds=holds)
    return WithoutScatter(
        found,
        dispersion_statistics.impact_numbers(flights),
        dispersion_statistics.ellipses(job.site, flights, FlightStatus.IMPACT),
    )


def return_fraction(study: Study, table: SampleShares, run_count: int) -> ReturnFraction:
    """The return fraction, without an interval, which runs on one bed or at one place do not give."""
    share, missing = (table.outcomes[name].share.value for name in ("returns", "missing"))
    return ReturnFraction(
        share=Estimate(share, None, None, why_missing=scope(study).why),
        from_=f"{table.sample_count} samples of an expansion fitted to {run_count} landings {scope(study).landings}",
        next_bed=None,
        if_missing=(share, share + missing),
        missing=missing,
        emulator=share,
        why=scope(study).why,
    )


def _scores(job: Job) -> dict[str, dict[str, model_results.OutputErrors]]:
    """Scores by set of runs and output, less the errors of each run."""
    return {
        stage: {
            output: replace(results_in(model_results.OutputErrors, score, f"{stage}.{output}"), ape=None)
            for output, score in table.items()
        }
        for stage, table in job.folder.read_json(SCORES_FILE).items()
    }


def _monte_carlo(samples: Samples) -> model_results.ExpansionSamples:
    """Spread of each output over the samples that leave the surface."""
    leaving, outputs = samples.leaves, {}
    for index, name in enumerate(samples.output_names if leaving.any() else ()):
        values = samples.outputs[leaving, index]
        quantiles = {f"quantile_{level:g}": float(np.quantile(values, level)) for level in QUANTILES}
        outputs[name] = model_results.SampledOutput(float(values.mean()), float(values.std()), quantiles)
    return model_results.ExpansionSamples(len(leaving), int(leaving.sum()), outputs)


def _node_counts(study: Study, input_count: int) -> model_results.NodeCounts:
    """Nodes of the full tensor grid and of the Smolyak grid, by number of inputs and level: what the design saves."""
    counts = tuple(range(1, max(7, input_count) + 1))
    levels = tuple(range(1, max(5, study.design.screening_level, study.design.refined_level) + 1))
    tensor, smolyak = (
        tuple(tuple(int(count(n, level)) for level in levels) for n in counts)
        for count in (tensor_count, smolyak_count)
    )
    return model_results.NodeCounts(counts, levels, tensor, smolyak)


def _design(design: DesignRuns, replicate_count: int) -> model_results.DesignCounts:
    return model_results.DesignCounts(
        point_count=design.run_count // replicate_count,
        replicate_count=replicate_count,
        run_count=design.run_count,
        with_outputs=int(design.has_outputs.sum()),
        outcomes=design.outcome_counts(),
    )


def _expansion(job: Job, design: str, surrogate: "Surrogate", runs: DesignRuns) -> model_results.ExpansionResults:
    """What an expansion says, with its Sobol indices freed of scatter, and their 95 % intervals [lower, upper].

    An index is a share of the variance that the inputs give the expansion, not of that of the runs.
    """
    from lithobrake.chaos import sobol_estimates

    job.progress(0, 1, f"intervals of the {design} indices")
    inputs = surrogate.input_names
    estimates = sobol_estimates(surrogate, runs.columns(inputs), runs.y)

    def by_output(table: np.ndarray) -> dict[str, dict[str, Any]]:
        columns = zip(surrogate.output_names, np.moveaxis(table, 1, 0).tolist(), strict=True)
        return {output: dict(zip(inputs, column, strict=True)) for output, column in columns}

    def intervals(table: np.ndarray) -> dict[str, dict[str, tuple[float, float]]]:
        lower, upper = (by_output(end) for end in table)
        return {
            output: {name: (low, upper[output][name]) for name, low in ends.items()} for output, ends in lower.items()
        }

    return model_results.ExpansionResults(
        inputs=tuple(inputs),
        term_count=len(surrogate.multi_indices),
        degree=surrogate.degree,
        fits={name: _fit(entry) for name, entry in surrogate.report["outputs"].items()},
        mean=_by_output(surrogate, np.asarray(surrogate.mean)),
        std=_by_output(surrogate, np.sqrt(np.asarray(surrogate.variance))),
        sobol_first=by_output(estimates["first"][0]),
        sobol_total=by_output(estimates["total"][0]),
        sobol_first_interval=intervals(estimates["first"][1:]),
        sobol_total_interval=intervals(estimates["total"][1:]),
    )


def _fit(entry: dict[str, Any]) -> model_results.OutputFit:
    """How one output was fitted, the error expected at a new run and the scatter between equal runs, SI.

    noise_share: of the variance of the runs; None where the scatter is not known or the runs do not vary.
    """
    keys = ("method", "term_count", "condition_number", "rmse_estimate", "rrmse_estimate", "noise_std", "noise_from")
    table: dict[str, Any] = {key: entry.get(key) for key in keys}
    noise, share = table["noise_std"], table["rrmse_estimate"]
    known = noise is not None and bool(share)
    return model_results.OutputFit(
        **table, noise_share=min((noise * share / table["rmse_estimate"]) ** 2, 1.0) if known else None
    )


def _by_output(surrogate: "Surrogate", values: np.ndarray) -> dict[str, float]:
    return dict(zip(surrogate.output_names, values.tolist(), strict=True))
