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
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.json_values import to_json
from lithobrake.results.run_results import OutputRange
from lithobrake.results.site_results import BedNumbers
from lithobrake.results.study_files import SUMMARY_FORMAT
from lithobrake.results.summary import DrawnResults, PaperResults, Provenance, RunTimes
from lithobrake.study import Study
from lithobrake.vocabulary.quantities import TOUCHDOWN


def summary_dependencies(study: Study) -> dict[str, Any]:
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


def bed_results(job: Job, name: str) -> BedNumbers:
    """A bed of the study, and how large the first impact asks it to be."""
    from lithobrake.study.touchdown_model import grain, lander, stored_bed
    from lithobrake.touchdown import smallest_bed

    bed, values = stored_bed(job.folder / name), job.design.medians
    width, depth = smallest_bed(
        lander(job.study, values), grain(values), float(bed.grain_diameter), values["impact.speed"]
    )  # fmt: skip
    return BedNumbers(
        solid_fraction=float(bed.solid_fraction),
        coordination_number=float(bed.coordination_number),
        surface_height_m=float(bed.surface_height),
        mean_diameter_m=float(bed.grain_diameter),
        smallest_width_m=width,
        smallest_depth_m=depth,
        large_enough=bool(min(bed.width) >= width and bed.surface_height >= depth),
    )


def outputs_of_runs(runs: DesignRuns) -> dict[str, OutputRange]:
    """What else the touchdowns gave, over distinct runs: median, smallest and largest."""
    table = {}
    for name in ("contact_duration", "penetration", "peak_acceleration", "energy_lost"):
        known = np.isfinite(runs.output(name))
        values = runs.output(name)[~np.isnan(runs.output(name))]
        if len(values):
            table[name] = OutputRange(
                float(np.median(values)), float(values.min()), float(values.max()), TOUCHDOWN[name].units,
                described(known, runs.outcomes),
            )  # fmt: skip
    return table


def write_summary_file(job: Job, results: DrawnResults | PaperResults, asked: int, runs: DesignRuns) -> None:
    """Write summary.json. Times, host, folders and versions stand in provenance only; asked, runs: as provenance."""
    tables = {
        "study": study_tables(job.study, job.tables),
        "results": results,
        "provenance": provenance(job, asked, runs),
    }
    job.folder.write_json("summary.json", {"format_version": SUMMARY_FORMAT, **to_json(tables)})


def provenance(job: Job, asked: int, runs: DesignRuns) -> Provenance:
    """Where it all comes from; asked: runs of all designs, of which `runs` are the distinct ones."""
    ledger, keys = job.folder / "runs.sqlite", set(runs.keys)
    records = [one for one in (read_records(ledger) if ledger.is_file() else []) if one.key in keys]
    packages = ("lithobrake", "numpy", "scipy", "numba", "scikit-learn", "h5py")
    wall = [one.wall_s or 0.0 for one in records]
    return Provenance(
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        folder=str(job.folder.path),
        host=platform.node(),
        system=platform.platform(),
        cores=os.cpu_count(),
        python=sys.version.split()[0],
        packages={name: version(name) for name in packages},
        wall_s=job.folder.wall_times(),
        runs=RunTimes(
            asked, runs.run_count, sum(wall), sum(one.cpu_s or 0.0 for one in records), max(wall, default=0.0)
        ),
    )
