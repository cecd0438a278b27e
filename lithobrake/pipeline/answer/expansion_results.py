"""The analysis of first touchdowns by polynomial chaos: designs, expansions with their Sobol indices, and errors."""

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.chaos import smolyak_count, tensor_count
from lithobrake.pipeline.answer.run_answers import output_ranges
from lithobrake.pipeline.expansion.expansions import kept_inputs, replicate_count, runs_of_designs, section_of
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results import model_results
from lithobrake.results.study_files import results_in
from lithobrake.study.design_sections import ExpansionSection
from lithobrake.vocabulary.file_names import REFINED_FILE, SCORES_FILE, SCREENING_FILE
from lithobrake.vocabulary.outcomes import TouchdownOutcome

if TYPE_CHECKING:
    from lithobrake.chaos import Surrogate


def expansion_results(job: Job) -> model_results.ExpansionAnalysis | None:
    """The designs, expansions and errors of a study; None without [expansion]."""
    from lithobrake.chaos import load

    if job.study.expansion is None:
        return None
    screening, refined = load(job.folder / SCREENING_FILE), load(job.folder / REFINED_FILE)
    runs, kept = runs_of_designs(job), kept_inputs(job.study, screening)
    return model_results.ExpansionAnalysis(
        node_counts=_node_counts(section_of(job.study), len(screening.input_names)),
        designs={design: _design(one, replicate_count(job.study, design)) for design, one in runs.items()},
        outputs_of_runs=output_ranges(DesignRuns.distinct(list(runs.values()))),
        screening=_expansion(job, "screening", screening, runs["screening"]),
        refined=_expansion(job, "refined", refined, runs["refined"]),
        kept_inputs=kept,
        kept_share=_by_output(screening, np.asarray(screening.sobol_group(kept))),
        scores=_scores(job),
    )


def ended_runs(job: Job) -> Counter[str]:
    """How many distinct runs of the designs of the expansions ended in each way, without those that failed."""
    distinct = DesignRuns.distinct(list(runs_of_designs(job).values()))
    return Counter(outcome for outcome in distinct.outcomes if outcome in list(TouchdownOutcome))


def _scores(job: Job) -> dict[str, dict[str, model_results.OutputErrors]]:
    """Scores by set of runs and output, less the errors of each run."""
    return {
        stage: {
            output: replace(results_in(model_results.OutputErrors, score, f"{stage}.{output}"), ape=None)
            for output, score in table.items()
        }
        for stage, table in job.folder.read_json(SCORES_FILE).items()
    }


def _node_counts(section: ExpansionSection, input_count: int) -> model_results.NodeCounts:
    """Nodes of the full tensor grid and of the Smolyak grid, by number of inputs and level: what the design saves."""
    counts = tuple(range(1, max(7, input_count) + 1))
    levels = tuple(range(1, max(5, section.screening_level, section.refined_level) + 1))
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
