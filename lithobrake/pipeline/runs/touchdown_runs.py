"""Touchdowns of a study as a campaign: which model makes them, from which values, and what was drawn by chance."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.campaign import Ledger, Limits, ModelServer, RunOptions, Runs, Tally, run_key, run_seed
from lithobrake.campaign import run as run_campaign
from lithobrake.campaign.model_server import PREFIX
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.beds import bed_files, touchdown_reads
from lithobrake.pipeline.runs.solver import (
    FunctionModel,
    Model,
    ServerModel,
    SolverModel,
    solver_command,
    solver_setting,
)
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain
from lithobrake.study.touchdown_model import TouchdownModel, draw, engine_hash, medians
from lithobrake.vocabulary.quantities import OUTPUTS


def drawn_rows(study: Study, names: Sequence[str], x: np.ndarray, replicate: int) -> list[dict[str, float]]:
    """All inputs of the runs at the rows of x, shape [run_count, len(names)], with what each draws by chance.

    replicate: another number gives the same rows other draws.

    What a run draws is drawn here and counts among its inputs, so that a run depends on nothing else: another bed, or
    a wider region, leaves every run as it was whose draws remain.
    """
    return [_drawn(study, names, row, replicate) for row in x.tolist()]


def touchdown_keys(study: Study, rows: Sequence[Mapping[str, float]], replicate: int) -> list[str]:
    """The keys of these runs in the ledger."""
    context = touchdown_reads(study)
    return [run_key(row, study.seed, replicate, context) for row in rows]


def touchdowns(job: Job, rows: Sequence[Mapping[str, float]], title: str, replicate: int) -> Runs:
    """Make the touchdowns with these inputs; those that the ledger has are read from it."""
    study = job.study

    def show(state: Tally) -> None:
        job.progress(state.ended, state.total, title, "\n".join([state.sentence(), *state.spread_lines(OUTPUTS)]))

    with Ledger(job.folder / "runs.sqlite") as ledger:
        return run_campaign(
            model_of(study, job.folder.path.absolute(), job.model),
            np.array([list(row.values()) for row in rows]),
            names=list(rows[0]),
            context=touchdown_reads(study),
            ledger=ledger,
            executor=job.executor,
            limits=Limits(study.campaign.wall_limit or math.inf, study.campaign.memory_limit or math.inf),
            options=RunOptions(
                seed=study.seed,
                replicate=replicate,
                retry_count=study.campaign.retry_count,
                log_folder=job.folder.path.absolute() / "logs" if job.keeps_logs else None,
            ),
            progress=show,
        )


def drawn_reads(study: Study) -> dict[str, Any]:
    """What the draws of a run depend on, beside its seed."""
    return {
        "bed_count": study.bed_count,
        "azimuth": "random" if study.impact.azimuth_deg == "random" else "fixed",
        **study.impact.model_dump(include={"region", "orientation", "pointing_error_deg"}),
    }


def _drawn(study: Study, names: Sequence[str], row: Sequence[float], replicate: int) -> dict[str, float]:
    values = medians(study) | dict(zip(names, row, strict=True))
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
