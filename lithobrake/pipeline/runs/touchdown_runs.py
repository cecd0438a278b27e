"""Touchdowns of a study as a campaign: which model makes them, from which values, and what was drawn by chance."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.campaign import Ledger, Limits, ModelServer, Record, RunOptions, Runs, Tally, read_records, run_seed
from lithobrake.campaign import run as run_campaign
from lithobrake.campaign.model_server import PREFIX
from lithobrake.pipeline.design.dependencies import bed_files, solver_command, solver_setting, touchdown_dependencies
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.solver import FunctionModel, Model, ServerModel, SolverModel
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain
from lithobrake.study.touchdown_model import TouchdownModel, draw, engine_hash
from lithobrake.vocabulary.quantities import OUTPUTS


def drawn_rows(design: DrawnDesign, x: np.ndarray, replicate: int) -> list[dict[str, float]]:
    """All inputs of the runs at these uncertain inputs, [run_count, input_count], with what each draws by chance.

    replicate: another number gives the same rows other draws.

    What a run draws is drawn here and counts among its inputs, so that a run depends on nothing else: another bed, or
    a wider region, leaves every run as it was whose draws remain.
    """
    return [_drawn(design, row, replicate) for row in x.tolist()]


def touchdowns(
    job: Job, rows: Sequence[Mapping[str, float]], title: str, replicate: int, ledger_file: str = "runs.sqlite"
) -> Runs:  # fmt: skip
    """Make the touchdowns with these inputs; those that the ledger has are read from it."""
    study = job.study

    def show(state: Tally) -> None:
        job.progress(state.ended, state.total, title, "\n".join([state.sentence(), *state.spread_lines(OUTPUTS)]))

    with Ledger(job.folder / ledger_file) as ledger:
        return run_campaign(
            model_of(study, job.folder.path.absolute(), job.model),
            np.array([list(row.values()) for row in rows]),
            names=list(rows[0]),
            ledger=ledger,
            progress=show,
            **campaign_setting(job, replicate),
        )


def campaign_setting(job: Job, replicate: int = 0) -> dict[str, Any]:
    """What every campaign of landings of a study is given, as arguments of `campaign.run` and `run_chains`."""
    asked = job.study.campaign
    return {
        "context": touchdown_dependencies(job.study),
        "executor": job.executor,
        "limits": Limits(asked.wall_limit or math.inf, asked.memory_limit or math.inf),
        "options": RunOptions(
            seed=job.study.seed,
            replicate=replicate,
            retry_count=asked.retry_count,
            log_folder=job.folder.path.absolute() / "logs" if job.keeps_logs else None,
        ),
    }


def _drawn(design: DrawnDesign, row: Sequence[float], replicate: int) -> dict[str, float]:
    study, values = design.study, design.medians | dict(zip(design.inputs, row, strict=True))
    drawn = draw(study, values, run_seed(values, study.seed, replicate))
    return {name: float(value) for name, value in drawn.items()}


def model_of(
    study: Study, folder: Path, function: Model | None
) -> TouchdownModel | SolverModel | ServerModel | FunctionModel:
    """What makes the touchdowns of a study with this folder, an absolute path: workers may have another one."""
    if function is not None:
        return FunctionModel(function)
    if study.solver.command and study.solver.command.startswith(PREFIX):
        return ServerModel(
            ModelServer.of(study.solver.command), tuple(uncertain(study.touchdown_values())), solver_setting(study)
        )
    if study.solver.command:
        return SolverModel(solver_command(study, folder), solver_setting(study))
    return TouchdownModel(study, tuple(folder / name for name in bed_files(study)), engine_hash())


def known_runs(study: Study, folder: StudyFolder) -> dict[str, Record]:
    """Runs of the folder's ledger, by key, that are not made again; none where there is no ledger.

    Raises ValueError for a file that is no ledger.
    """
    path = folder / "runs.sqlite"
    records = read_records(path) if path.is_file() else []
    tries = study.campaign.retry_count
    return {
        entry.key: entry
        for entry in records
        if entry.status == "done" or (entry.status == "failed" and entry.attempts > tries)
    }
