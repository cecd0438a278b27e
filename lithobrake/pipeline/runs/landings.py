"""Touchdowns of a study as a campaign, and landings of it to look at."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake import campaign
from lithobrake.campaign import run as run_campaign
from lithobrake.campaign.model_server import PREFIX
from lithobrake.campaign.single_run import Model
from lithobrake.pipeline.design import dependencies
from lithobrake.pipeline.design.drawn_design import DrawnDesign, inputs_of
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.design.side_designs import SIDE_DESIGNS
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.beds import compile_kernels
from lithobrake.pipeline.runs.energy_bound import energy_warning, height_of_beds
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import FunctionModel, ServerModel, SolverModel
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain
from lithobrake.touchdown import touchdown_model
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.study_keys import by_study_keys
from lithobrake.touchdown.touchdown_model import landing
from lithobrake.vocabulary.file_names import LANDING_FILE, RUNS_FILE, TELLING_LANDING_FILE
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import OUTPUTS, Row

SNAPSHOT_FRAMES = 120
FIRST, TELLING = LANDING_FILE, TELLING_LANDING_FILE


def drawn_rows(design: DrawnDesign, x: np.ndarray, replicate: int) -> list[Row]:
    """All inputs of the runs at these uncertain inputs, [run_count, input_count], with what each draws by chance.

    replicate: another number gives the same rows other draws.

    What a run draws is drawn here and counts among its inputs, so that a run depends on nothing else: another bed, or
    a wider region, leaves every run as it was whose draws remain.
    """
    return [_drawn(design, row, replicate) for row in x.tolist()]


def touchdowns(
    job: Job, rows: Sequence[Mapping[str, float]], title: str, replicate: int, ledger_file: str = RUNS_FILE
) -> campaign.Runs:  # fmt: skip
    """Make the touchdowns with these inputs; those that the ledger has are read from it."""
    study = job.study

    def show(state: campaign.Tally) -> None:
        job.progress(state.ended, state.total, title, "\n".join([state.sentence(), *state.spread_lines(OUTPUTS)]))

    with campaign.Ledger(job.folder / ledger_file) as ledger:
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
        "context": dependencies.touchdown_dependencies(job.study),
        "executor": job.executor,
        "limits": campaign.Limits(asked.wall_limit or math.inf, asked.memory_limit or math.inf),
        "options": campaign.RunOptions(
            seed=job.study.seed,
            replicate=replicate,
            retry_count=asked.retry_count,
            log_folder=job.folder.path.absolute() / "logs" if job.keeps_logs else None,
        ),
    }


def _drawn(design: DrawnDesign, row: Sequence[float], replicate: int) -> Row:
    study, values = design.study, design.medians | dict(zip(design.inputs, row, strict=True))
    drawn = draw(study, values, campaign.run_seed(values, study.seed, replicate), design.region)
    return {name: float(value) for name, value in drawn.items()}


def model_of(
    study: Study, folder: Path, function: Model | None
) -> touchdown_model.TouchdownModel | SolverModel | ServerModel | FunctionModel:
    """What makes the touchdowns of a study with this folder, an absolute path: workers may have another one."""
    if function is not None:
        return FunctionModel(function)
    if study.solver.command and study.solver.command.startswith(PREFIX):
        return ServerModel(
            campaign.ModelServer.of(study.solver.command),
            tuple(uncertain(study.touchdown_values())),
            dependencies.solver_setting(study),
        )
    if study.solver.command:
        return SolverModel(dependencies.solver_command(study, folder), dependencies.solver_setting(study))
    return touchdown_model.TouchdownModel(
        study, tuple(folder / name for name in dependencies.bed_files(study)), touchdown_model.engine_hash()
    )


def known_runs(study: Study, folder: StudyFolder) -> dict[str, campaign.Record]:
    """Runs of the folder's ledger, by key, that are not made again; none where there is no ledger.

    Raises ValueError for a file that is no ledger.
    """
    path = folder / RUNS_FILE
    records = campaign.read_records(path) if path.is_file() else []
    tries = study.campaign.retry_count
    return {
        entry.key: entry
        for entry in records
        if entry.status == "done" or (entry.status == "failed" and entry.attempts > tries)
    }


def make_side_runs(job: Job) -> None:
    for design in SIDE_DESIGNS if job.study.design.side_runs else ():
        make_rows(job, design, [job.design.rows_of(design)])


def make_rows(job: Job, design: str, rows: Sequence[Sequence[Mapping[str, float]]]) -> None:
    """Make runs with all their inputs, a list for each time that they are made, and write their table."""
    count, title = len(rows), f"{design.replace('_', ' ')} runs"
    titles = [f"{title}, {number} of {count} times" if count > 1 else title for number in range(1, count + 1)]
    keys = [key for replicate, one in enumerate(rows) for key in dependencies.touchdown_keys(job.study, one, replicate)]
    # Before they are made, so that other processes can distinguish these runs from others of the ledger.
    job.folder.note_runs(design, keys)
    made = [touchdowns(job, rows[replicate], words, replicate) for replicate, words in enumerate(titles)]
    runs = campaign.Runs([record for one in made for record in one.records], sum(one.reused_count for one in made))
    inputs = tuple(job.design.inputs)
    account(job, design, runs, inputs)
    gained = energy_warning(job.design, runs.records, height_of_beds(job.study, job.folder))
    if gained:
        job.say(f"{title}: {gained}")
    DesignRuns.of(runs).save(job.folder, design)


def say_gravity(job: Job) -> None:
    """Say that touchdowns and flights feel another acceleration, which may be a reason not to make the landings."""
    if job.site.gravity_warning:
        job.say(job.site.gravity_warning)


def account(job: Job, design: str, runs: campaign.Runs, inputs: Sequence[str]) -> None:
    """Say what of a design was known before, and what is missing. Raises ValueError when too much is."""
    name, distinct = design.replace("_", " "), len({record.key for record in runs.records})
    if runs.reused_count:
        job.say(f"{name}: {runs.reused_count} of {distinct} runs were known and are reused")
    x = inputs_of([record.inputs for record in runs.records], inputs)
    lost = campaign.missing(x, runs.reasons, inputs, job.study.campaign.failed_share)
    if lost:
        job.say(f"{name}: {lost}")


def landing_files(study: Study) -> list[str]:
    return [FIRST] if study.has_soil else []


def telling_files(study: Study) -> list[str]:
    return [TELLING] if study.has_soil and study.design.run_count else []


def landing_dependencies(study: Study) -> dict[str, Any]:
    return {"touchdown": dependencies.touchdown_dependencies(study), "values": landing_values(DrawnDesign(study))}


def landing_values(design: DrawnDesign) -> Row:
    """All inputs of the landing to look at: the first drawn run, or that at the medians of all inputs."""
    if not design.study.design.run_count:
        # Without a lander that is drawn the landing is that of the medians.
        return draw(design.study, design.medians, design.study.seed, design.region)
    return design.shown_row


def land_once(job: Job) -> None:
    # Beds that come from the library have compiled nothing.
    compile_kernels(job.progress, joined=job.study.lander.is_hinged)
    _land(job, landing_values(job.design), FIRST)


def land_tellingly(job: Job) -> None:
    """Make the telling run again, for its pictures.

    Says where it comes out otherwise than as a run: another machine may have made that.
    """
    runs = DesignRuns.load(job.folder, "drawn")
    row = telling_run(runs)
    ended = _land(job, job.design.rows[row], TELLING, run=runs.keys[row])
    if ended != runs.outcomes[row]:
        job.say(f"the landing shown, run {runs.keys[row][:8]}, ended as {ended} here: {runs.outcomes[row]} as a run")


def telling_run(runs: DesignRuns) -> int:
    """The row of the run with the median speed [m/s] of those that leave, of two the slower; of none, the first.

    First that has ended: a run that failed has nothing to show.
    """
    left = np.flatnonzero(runs.has_outputs)
    if len(left):
        # Stable, so that of runs of one speed the same is taken on every machine.
        by_speed = left[np.argsort(runs.output("speed_out")[left], kind="stable")]
        return int(by_speed[(len(left) - 1) // 2])
    return next(row for row, outcome in enumerate(runs.outcomes) if outcome in list(TouchdownOutcome))


def _land(job: Job, values: Row, file: str, **notes: str) -> str:
    from lithobrake.touchdown import land

    bed = touchdown_model.stored_bed(job.folder / dependencies.bed_files(job.study)[round(values["bed"])])
    with by_study_keys():
        body, arrival = lander(job.study, values), landing(job.study, values)
        outcome = land(bed, body, arrival, SNAPSHOT_FRAMES, lambda fraction, what: job.progress(fraction, 1.0, what))
    outcome.save_frames(job.folder / file, bed, body, arrival, **notes)
    return str(outcome.status)
