"""summary.json: every number of the report, the study as it was understood, and where it all comes from."""

import os
import platform
import sys
from collections import Counter
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.campaign import read_records
from lithobrake.pipeline.answer.dispersion_statistics import dispersion_results
from lithobrake.pipeline.answer.missing_landings import described
from lithobrake.pipeline.answer.run_estimates import SPLIT
from lithobrake.pipeline.answer.site_summary import body_product, site_results
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

QUANTILES = (0.05, 0.5, 0.95)


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
        "site": site_results(job.study),
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


def summary_reads(study: Study) -> dict[str, Any]:
    """What the summary depends on beside the files of the stages before it."""
    return study_tables(study) | {"product": body_product(study)}


def study_tables(study: Study, tables: Any = None) -> dict[str, Any]:
    """The study with the defaults of its method, as the tables of its file; paths of meshes as they were written."""
    dump: dict[str, Any] = _plain(study.model_dump(exclude={"design": study.design.keys_of_the_other_method}))
    for section, key in (("lander", "file"), ("site", "body"), ("site", "kernels"), ("solver", "command")):
        dump[section][key] = (tables or {}).get(section, {}).get(key, dump[section][key])
    return dump


def _plain(value: Any) -> Any:
    """A dumped study as JSON values; a distribution in the form that a study file has."""
    if isinstance(value, dict) and set(value) == {"distribution", "parameters"}:
        return {"distribution": value["distribution"], **value["parameters"]}
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    return [_plain(entry) for entry in value] if isinstance(value, list | tuple) else value


def bed_results(job: Job, name: str) -> dict[str, Any]:
    from lithobrake.study.touchdown_model import grain, lander, medians, stored_bed
    from lithobrake.touchdown import smallest_bed

    bed, values = stored_bed(job.folder / name), medians(job.study)
    width, depth = smallest_bed(
        lander(job.study, values), grain(values), float(bed.grain_diameter), values["impact.speed"]
    )  # fmt: skip
    return {
        "solid_fraction": float(bed.solid_fraction),
        "coordination_number": float(bed.coordination_number),
        "surface_height_m": float(bed.surface_height),
        "mean_diameter_m": float(bed.grain_diameter),
        "smallest_width_m": width,
        "smallest_depth_m": depth,
        "large_enough": bool(min(bed.width) >= width and bed.surface_height >= depth),
    }


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


def outputs_of_runs(runs: DesignRuns) -> dict[str, Any]:
    """What else the touchdowns gave, over distinct runs: median, smallest and largest."""
    table: dict[str, Any] = {}
    for name in ("contact_duration", "penetration", "peak_acceleration", "energy_lost"):
        values = runs.output(name)[~np.isnan(runs.output(name))]
        if len(values):
            table[name] = {
                "median": float(np.median(values)), "smallest": float(values.min()), "largest": float(values.max()),
                "unit": TOUCHDOWN[name].units, "of": described(np.isfinite(runs.output(name)), runs.outcomes),
            }  # fmt: skip
    return table


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


def monte_carlo_results(samples: Samples) -> dict[str, Any]:
    """Spread of each output over the samples that leave the surface."""
    leaving = samples.leaves
    table: dict[str, Any] = {"sample_count": len(leaving), "leaving_count": int(leaving.sum()), "outputs": {}}
    for index, name in enumerate(samples.output_names if leaving.any() else ()):
        values = samples.outputs[leaving, index]
        quantiles = {f"quantile_{level:g}": float(np.quantile(values, level)) for level in QUANTILES}
        table["outputs"][name] = {"mean": float(values.mean()), "std": float(values.std()), **quantiles}
    return table


def provenance(job: Job, asked: int, runs: DesignRuns) -> dict[str, Any]:
    """Where it all comes from; asked: runs of all designs, of which `runs` are the distinct ones."""
    ledger, keys = job.folder / "runs.sqlite", set(runs.keys)
    records = [one for one in (read_records(ledger) if ledger.is_file() else []) if one.key in keys]
    packages = ("lithobrake", "numpy", "scipy", "numba", "scikit-learn", "h5py")
    return {
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "folder": str(job.folder.path),
        "host": platform.node(),
        "system": platform.platform(),
        "cores": os.cpu_count(),
        "python": sys.version.split()[0],
        "packages": {name: version(name) for name in packages},
        "wall_s": job.folder.wall_times(),
        "runs": {
            "asked": asked,
            "distinct": runs.run_count,
            "wall_s": sum(one.wall_s or 0.0 for one in records),
            "cpu_s": sum(one.cpu_s or 0.0 for one in records),
            "longest_wall_s": max((one.wall_s or 0.0 for one in records), default=0.0),
        },
    }
