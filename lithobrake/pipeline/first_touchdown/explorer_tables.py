"""The refits of an emulator of touchdowns as tables in a file, for the explorer of the page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.pipeline.design.lander_attitude import PREFIX, attitude_rows, attitude_terms
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import across_of, bound_numbers, height_of_beds
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.table import FORMAT_VERSION, NAMES, ExplorerAttitude, ExplorerTables
from lithobrake.study import Study
from lithobrake.study.lander_section import directions_of_sides, side_words
from lithobrake.vocabulary.file_names import EXPLORER_FILE

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator

AZIMUTH = "azimuth_out"


def write_explorer(job: Job, models: "Sequence[Emulator]") -> None:
    height, across = height_of_beds(job.study, job.folder), across_of(job.study, job.folder)
    bound = bound_numbers(job.design, height, across)
    names = [name for name in models[0].runs.inputs if name.startswith(PREFIX)]
    rows = attitude_rows(job.design, DesignRuns.load(job.folder, "drawn").inputs, names)
    attitude = explorer_attitude(job.study, names, rows)
    save_explorer(job.folder / EXPLORER_FILE, replace(tables_of_refits(models, bound), attitude=attitude))


def explorer_attitude(
    study: Study, names: Sequence[str], rows: list[list[float]] | None = None
) -> ExplorerAttitude | None:
    """What draws the attitudes of touchdowns; None where an emulator reads no terms of them.

    names: of the terms among its inputs. rows: terms of attitudes that are as likely as each other, None where any
    attitude is.
    """
    terms = attitude_terms(study)
    if terms is None or not names:
        return None
    # Of an attitude that is not free no side can be chosen.
    downs = directions_of_sides(study.lander) if rows is None else {}
    sides = {side_words(study.lander, side): directions for side, directions in downs.items()}
    return ExplorerAttitude(tuple(names), terms.axes.tolist(), terms.has_sides, terms.is_cube, sides, rows)


def tables_of_refits(models: "Sequence[Emulator]", bound: Mapping[str, float]) -> ExplorerTables:
    """Tables of `lithobrake.emulator.law_tables` of refits of one emulator, and azimuth [row_count], the direction
    [rad] that each row was left in.
    """
    from lithobrake.analysis.confidence import t_quantile
    from lithobrake.analysis.unseen_event import unseen_limit
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
        unseen_limit=unseen_limit(runs.group),
        bound=dict(bound),
    )


def save_explorer(path: Path, explorer: ExplorerTables) -> None:
    import h5py

    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        for name, table in explorer.tables.items():
            file.create_dataset(name, data=table)
        file.attrs["format_version"] = FORMAT_VERSION
        for name in (*NAMES, "output_outcome", "group_count", "interval_reach", "unseen_limit"):
            file.attrs[name] = getattr(explorer, name)
        file.attrs["attitude"] = json.dumps(None if explorer.attitude is None else asdict(explorer.attitude))
        for name, value in explorer.bound.items():
            file.attrs[f"bound.{name}"] = value
