"""summary.json of a paper study: designs, expansions, their scores, and what becomes of the samples."""

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.pipeline.answer.dispersion_statistics import dispersion_results
from lithobrake.pipeline.answer.run_estimates import SPLIT
from lithobrake.pipeline.answer.site_summary import site_results
from lithobrake.pipeline.answer.summary_parts import (
    bed_results,
    monte_carlo_results,
    outputs_of_runs,
    provenance,
    study_tables,
)
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.fly.flights import read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper.paper_designs import kept_inputs, replicate_count
from lithobrake.pipeline.paper.paper_statements import answer, headline
from lithobrake.pipeline.runs.beds import bed_files
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.study_results import SUMMARY_FORMAT
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import OUTPUTS, PAPER_DESIGNS, TOUCHDOWN

if TYPE_CHECKING:
    from lithobrake.chaos import Surrogate


def _without_runs(table: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Scores by output, less the errors of each run."""
    return {output: {name: value for name, value in score.items() if name != "ape"} for output, score in table.items()}


def write_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance. Times, host, folders and versions stand in provenance only."""
    from lithobrake.chaos import load

    screening, refined = load(job.folder / "screening.json"), load(job.folder / "refined.json")
    runs = {design: DesignRuns.load(job.folder, design) for design in PAPER_DESIGNS}
    distinct = DesignRuns.distinct(list(runs.values()))
    ended = Counter(outcome for outcome in distinct.outcomes if outcome in list(TouchdownOutcome))
    samples, scores = Samples.load(job.folder), job.folder.read_json("scores.json")
    kept, flights = kept_inputs(job.study, screening), read_table(job.folder, "flights.csv")
    results = {
        "units": {name: TOUCHDOWN[name].units for name in OUTPUTS},
        "beds": [bed_results(job, name) for name in bed_files(job.study)],
        "node_counts": _node_counts(job.study, len(screening.input_names)),
        "designs": {design: _design(runs[design], replicate_count(job.study, design)) for design in PAPER_DESIGNS},
        "outputs_of_runs": outputs_of_runs(distinct),
        "screening": _expansion(job, "screening", screening, runs["screening"]),
        "refined": _expansion(job, "refined", refined, runs["refined"]),
        "kept_inputs": list(kept),
        "kept_share": _by_output(screening, np.asarray(screening.sobol_group(kept))),
        "scores": {stage: _without_runs(table) for stage, table in scores.items()},
        "monte_carlo": monte_carlo_results(samples),
        "site": site_results(job.site),
        # One bed, one place and one attitude have no parts.
        "variance_shares": dict.fromkeys(SPLIT),
        **dispersion_results(job, samples, flights, ended),
    }
    results["answer"] = answer(job.study, results)
    results["headline"] = headline(job.study, results)
    job.folder.write_json(
        "summary.json",
        {
            "format_version": SUMMARY_FORMAT,
            "study": study_tables(job.study, job.tables),
            "results": results,
            "provenance": provenance(job, sum(one.run_count for one in runs.values()), distinct),
        },
    )


def _node_counts(study: Study, input_count: int) -> dict[str, Any]:
    """Nodes of the full tensor grid and of the Smolyak grid, by number of inputs and level: what the design saves."""
    from lithobrake.chaos import smolyak_count, tensor_count

    counts = list(range(1, max(7, input_count) + 1))
    levels = list(range(1, max(5, study.design.screening_level, study.design.refined_level) + 1))
    grids = {"tensor": tensor_count, "smolyak": smolyak_count}
    table = {name: [[int(count(n, level)) for level in levels] for n in counts] for name, count in grids.items()}
    return {"input_counts": counts, "levels": levels, **table}


def _design(design: DesignRuns, replicate_count: int) -> dict[str, Any]:
    return {
        "point_count": design.run_count // replicate_count,
        "replicate_count": replicate_count,
        "run_count": design.run_count,
        "with_outputs": int(design.has_outputs.sum()),
        "outcomes": design.outcome_counts(),
    }


def _expansion(job: Job, design: str, surrogate: "Surrogate", runs: DesignRuns) -> dict[str, Any]:
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

    return {
        "inputs": inputs,
        "term_count": len(surrogate.multi_indices),
        "degree": surrogate.degree,
        "fits": {name: _fit(entry) for name, entry in surrogate.report["outputs"].items()},
        "mean": _by_output(surrogate, np.asarray(surrogate.mean)),
        "std": _by_output(surrogate, np.sqrt(np.asarray(surrogate.variance))),
        "sobol_first": by_output(estimates["first"][0]),
        "sobol_total": by_output(estimates["total"][0]),
        "sobol_first_interval": by_output(np.moveaxis(estimates["first"][1:], 0, -1)),
        "sobol_total_interval": by_output(np.moveaxis(estimates["total"][1:], 0, -1)),
    }


def _fit(entry: dict[str, Any]) -> dict[str, Any]:
    """How one output was fitted, the error expected at a new run and the scatter between equal runs, SI.

    noise_share: of the variance of the runs; None where the scatter is not known or the runs do not vary.
    """
    keys = ("method", "term_count", "condition_number", "rmse_estimate", "rrmse_estimate", "noise_std", "noise_from")
    table = {key: entry.get(key) for key in keys}
    noise, share = table["noise_std"], table["rrmse_estimate"]
    if noise is None or not share:
        return {**table, "noise_share": None}
    return {**table, "noise_share": min((noise * share / table["rmse_estimate"]) ** 2, 1.0)}


def _by_output(surrogate: "Surrogate", values: np.ndarray) -> dict[str, float]:
    return dict(zip(surrogate.output_names, values.tolist(), strict=True))
