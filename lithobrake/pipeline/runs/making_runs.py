"""The stages that make runs; whatever comes after only reads them."""

from collections.abc import Mapping, Sequence

from lithobrake.campaign import Runs, missing
from lithobrake.pipeline.design.dependencies import touchdown_keys
from lithobrake.pipeline.design.drawn_design import SIDE_DESIGNS, inputs_of
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import energy_warning, height_of_beds
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.touchdown_runs import touchdowns


def make_drawn_runs(job: Job) -> None:
    """Make the drawn runs."""
    say_gravity(job)
    make_rows(job, "drawn", [job.design.rows])


def make_side_runs(job: Job) -> None:
    """Make the runs beside the drawn ones: on a second soil, and at places a little beside."""
    for design in SIDE_DESIGNS if job.study.design.side_runs else ():
        make_rows(job, design, [job.design.rows_of(design)])


def make_rows(job: Job, design: str, rows: Sequence[Sequence[Mapping[str, float]]]) -> None:
    """Make runs with all their inputs, a list for each time that they are made, and write their table."""
    count, title = len(rows), f"{design.replace('_', ' ')} runs"
    titles = [f"{title}, {number} of {count} times" if count > 1 else title for number in range(1, count + 1)]
    keys = [key for replicate, one in enumerate(rows) for key in touchdown_keys(job.study, one, replicate)]
    job.folder.note_runs(design, keys)
    made = [touchdowns(job, rows[replicate], words, replicate) for replicate, words in enumerate(titles)]
    runs = Runs([record for one in made for record in one.records], sum(one.reused_count for one in made))
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


def account(job: Job, design: str, runs: Runs, inputs: Sequence[str]) -> None:
    """Say what of a design was known before, and what is missing. Raises ValueError when too much is."""
    name, distinct = design.replace("_", " "), len({record.key for record in runs.records})
    if runs.reused_count:
        job.say(f"{name}: {runs.reused_count} of {distinct} runs were known and are reused")
    x = inputs_of([record.inputs for record in runs.records], inputs)
    lost = missing(x, runs.reasons, inputs, job.study.campaign.failed_share)
    if lost:
        job.say(f"{name}: {lost}")
