"""Parts of summary.json that both methods have: the study as it was understood, beds, outputs, samples, provenance."""

import os
import platform
import sys
from datetime import UTC, datetime
from importlib.metadata import version
from typing import Any

import numpy as np

from lithobrake.campaign import read_records
from lithobrake.pipeline.answer.missing_landings import described
from lithobrake.pipeline.answer.site_summary import body_product
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.fly.flights import QUANTILES
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.vocabulary.quantities import TOUCHDOWN


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
    from lithobrake.study.touchdown_model import grain, lander, stored_bed
    from lithobrake.touchdown import smallest_bed

    bed, values = stored_bed(job.folder / name), job.design.medians
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
