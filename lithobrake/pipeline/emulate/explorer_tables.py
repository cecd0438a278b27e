"""What the page's explorer evaluates: the emulator's refits as tables, and what energy allows a lander."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.pipeline.emulate.fitted_emulator import AZIMUTH, refits
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import bound_numbers, height_of_beds
from lithobrake.results.explorer_tables import FORMAT_VERSION, NAMES, ExplorerTables

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator

FILE = "explorer.h5"


def write_explorer(job: Job) -> None:
    """Write explorer.h5, of the refits that samples are drawn of."""
    bound = bound_numbers(job.design, height_of_beds(job.study, job.folder))
    save_explorer(job.folder / FILE, tables_of_refits(refits(job), bound))


def tables_of_refits(models: "Sequence[Emulator]", bound: Mapping[str, float]) -> ExplorerTables:
    """Tables of `lithobrake.emulator.law_tables` of refits of one emulator, and azimuth [row_count], the direction
    [rad] that each row was left in.
    """
    from lithobrake.analysis.confidence import t_quantile
    from lithobrake.emulator import law_tables

    runs = models[0].runs
    groups = len(np.unique(runs.group))
    return ExplorerTables(
        {**law_tables(models), "azimuth": runs.y[:, runs.output_names.index(AZIMUTH)]},
        input_names=tuple(runs.inputs),
        output_names=tuple(runs.output_names[column] for column in runs.modelled),
        outcome_names=tuple(runs.outcome_names),
        output_outcome=runs.outcome_names[runs.output_outcome],
        group_count=groups,
        interval_reach=t_quantile(groups - 1),
        bound=dict(bound),
    )


def save_explorer(path: Path, explorer: ExplorerTables) -> None:
    """Write tables for `ExplorerTables.read`: a data set each, and all else as attributes."""
    import h5py

    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        for name, table in explorer.tables.items():
            file.create_dataset(name, data=table)
        file.attrs["format_version"] = FORMAT_VERSION
        for name in (*NAMES, "output_outcome", "group_count", "interval_reach"):
            file.attrs[name] = getattr(explorer, name)
        file.attrs["attitude"] = json.dumps(None if explorer.attitude is None else asdict(explorer.attitude))
        for name, value in explorer.bound.items():
            file.attrs[f"bound.{name}"] = value
