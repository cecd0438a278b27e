"""What the page's explorer evaluates: the emulator's refits as tables, and what energy allows a lander."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.pipeline.energy_bound import bound_numbers, height_of_beds
from lithobrake.pipeline.fitted_emulator import AZIMUTH, refits
from lithobrake.pipeline.job import Job
from lithobrake.results.explorer_tables import FORMAT_VERSION

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator

FILE = "explorer.h5"


def write_explorer(job: Job) -> None:
    """Write explorer.h5, of the refits that samples are drawn of."""
    save_explorer(job.folder / FILE, refits(job), bound_numbers(job.study, height_of_beds(job.study, job.folder)))


def save_explorer(path: Path, models: "Sequence[Emulator]", bound: Mapping[str, float]) -> None:
    """Write the tables of `lithobrake.emulator.law_tables` of refits of one emulator.

    Beside them azimuth [row_count], the direction [rad] that each row was left in, and as attributes the names of
    inputs, outputs and outcomes, the outcome with outputs, how many groups refits draw, the quantile of Student's t
    that intervals of so many reach to, and the numbers of the energy bound.
    """
    import h5py

    from lithobrake.analysis.confidence import t_quantile
    from lithobrake.emulator import law_tables

    runs = models[0].runs
    groups = len(np.unique(runs.group))
    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        for name, table in law_tables(models).items():
            file.create_dataset(name, data=table)
        file.create_dataset("azimuth", data=runs.y[:, runs.output_names.index(AZIMUTH)])
        file.attrs["format_version"] = FORMAT_VERSION
        file.attrs["input_names"] = list(runs.inputs)
        file.attrs["output_names"] = [runs.output_names[column] for column in runs.modelled]
        file.attrs["outcome_names"] = list(runs.outcome_names)
        file.attrs["output_outcome"] = runs.outcome_names[runs.output_outcome]
        file.attrs["group_count"], file.attrs["interval_reach"] = groups, t_quantile(groups - 1)
        for name, value in bound.items():
            file.attrs[f"bound.{name}"] = value
