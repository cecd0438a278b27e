"""The stages that make runs; whatever comes after only reads them."""

from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.campaign import Runs, missing
from lithobrake.pipeline.emulate.energy_bound import energy_warning, height_of_beds
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.designs import design_inputs
from lithobrake.pipeline.runs.drawn_design import SIDE_DESIGNS, inputs_of, sequence_rows, side_rows
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.touchdown_runs import touchdown_keys, touchdowns
from lithobrake.pipeline.site import gravity_warning


def make_drawn_runs(job: Job) -> None:
    """Make the runs of the sequence."""
    _say_gravity(job)
    _make_rows(job, "sequence", [sequence_rows(job.study)])


def make_side_runs(job: Job) -> None:
    """Make the runs beside the sequence: on a second soil, and at places a little beside."""
    for design in SIDE_DESIGNS if job.study.design.side_runs else ():
        _make_rows(job, design, [side_rows(job.study, design)])


def _make_rows(job: Job, design: str, rows: Sequence[Sequence[Mapping[str, float]]]) -> None:
    """Make runs with all their inputs, a list for each time that they are made, and write their table."""
    count, title = len(rows), f"{design.replace('_', ' ')} runs"
    titles = [f"{title}, {number} of {count} times" if count > 1 else title for number in range(1, count + 1)]
    keys = [key for replicate, one in enumerate(rows) for key in touchdown_keys(job.study, one, replicate)]
    job.folder.note_runs(design, keys)
    made = [touchdowns(job, rows[replicate], words, replicate) for replicate, words in enumerate(titles)]
    runs = Runs([record for one in made for record in one.records], sum(one.reused_count for one in made))
    inputs = tuple(design_inputs(job.study))
    every = [row for one in rows for row in one]
    _account(job, design, runs, inputs_of(every, inputs), inputs)
    gained = energy_warning(job.study, runs.records, height_of_beds(job.study, job.folder))
    if gained:
        job.say(f"{title}: {gained}")
    DesignRuns.of(runs).save(job.folder, design)


def _say_gravity(job: Job) -> None:
    """Say that touchdowns and flights feel another acceleration, which may be a reason not to make the landings."""
    warning = gravity_warning(job.study)
    if warning:
        job.say(warning)


def _account(job: Job, design: str, runs: Runs, x: np.ndarray, inputs: Sequence[str]) -> None:
    """Say what of a design was known before, and what is missing. Raises ValueError when too much is."""
    name, distinct = design.replace("_", " "), len({record.key for record in runs.records})
    if runs.reused_count:
        job.say(f"{name}: {runs.reused_count} of {distinct} runs were known and are reused")
    lost = missing(x, runs.reasons, inputs, job.study.campaign.failed_share)
    if lost:
        job.say(f"{name}: {lost}")
