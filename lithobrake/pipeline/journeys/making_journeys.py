"""The stage that follows every lander of a study to the end of its journey."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.campaign import Ledger, Record, Runs, Tally, run_chains
from lithobrake.pipeline.design.descent_words import descents_in_words
from lithobrake.pipeline.design.rough_ground import first_axes
from lithobrake.pipeline.fly.flight_paths import Ways, write_flight_paths
from lithobrake.pipeline.fly.flights import write_shape
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.delivered_journeys import begun_aloft
from lithobrake.pipeline.journeys.journey import Journey
from lithobrake.pipeline.journeys.journey_model import JourneyModel
from lithobrake.pipeline.journeys.journey_tables import write_journeys
from lithobrake.pipeline.runs.making_runs import account
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.touchdown_runs import campaign_setting, model_of
from lithobrake.vocabulary.outcomes import JourneyEnd

# Standard errors on either side of a share that is told while journeys are under way: an interval of 90 %.
INTERVAL_ERRORS = 1.645


def make_journeys(job: Job) -> None:
    """Follow every lander and write its touchdowns, flights and end."""
    for words in (job.site.warning, job.site.rotation_words):
        if words:
            job.say(words)
    if job.design.descents is not None:
        job.say(descents_in_words(job.design.descents))
    journeys = begun(job)
    rows = job.design.rows
    job.folder.note_runs("drawn", job.design.keys)
    chains = follow(job, journeys, rows)
    records = [record for chain in chains for record in chain]
    _say_what_was_known(job, records)
    first = Runs([chain[0] for chain in chains], 0)
    account(job, "drawn", first, tuple(job.design.inputs))
    DesignRuns.of(first).save(job.folder, "drawn")
    DesignRuns.of(Runs(records, 0)).save(job.folder, "touchdowns")
    write_journeys(job.folder, journeys)
    write_shape(job.site.body, job.folder)
    write_flight_paths(job, job.site.body, Ways.of_journeys(job.folder))


def begun(job: Job) -> list[Journey]:
    """The journeys of a study before their first touchdowns; of those that never touch down, at their end."""
    model, descents = JourneyModel(job.design, job.site), job.design.descents
    return begin(model, job.design.rows, 0) if descents is None else begun_aloft(model, descents)


def begin(model: JourneyModel, rows: Sequence[dict[str, float]], first: int) -> list[Journey]:
    """Journeys, numbered from `first` on, whose first touchdowns have these inputs."""
    site = model.site
    columns = {key: values[first:] for key, values in site.sampled(first + len(rows)).items()}
    origin, mean_axes = site.frames(columns)
    axes = first_axes(site.study, mean_axes, rows)
    numbers = zip(
        *(one.tolist() for one in (site.clock(columns), columns["mass"], columns["spin_period"])), strict=True
    )
    starts = zip(rows, origin, axes, numbers, strict=True)
    return [Journey(model, first + number, *start, *own) for number, (*start, own) in enumerate(starts)]


def follow(job: Job, journeys: Sequence[Journey], rows: Sequence[Mapping[str, float]]) -> list[list[Record]]:
    """Make all touchdowns of journeys that begin with these; those that the ledger has are read from it.

    rows: first touchdowns, in the order of the journeys that have one.
    """
    landing = [journey for journey in journeys if journey.end is None]

    def then(number: int, records: Sequence[Record]) -> Mapping[str, float] | None:
        return landing[number].go_on(records[-1])

    def show(state: Tally) -> None:
        ended, said = sum(one.end is not None for one in journeys), progress_words(journeys, state.ended)
        job.note(journeys=said)
        job.progress(ended, len(journeys), "journeys", f"{said}\n{state.sentence()}")

    with Ledger(job.folder / "runs.sqlite") as ledger:
        return run_chains(
            model_of(job.study, job.folder.path.absolute(), job.model),
            rows,
            then,
            ledger=ledger,
            progress=show,
            **campaign_setting(job),
        )


def progress_words(journeys: Sequence[Journey], touchdown_count: int) -> str:
    """How far journeys are, as "31 of 96 journeys, 140 touchdowns, at rest so far 71 +- 8 %"."""
    ends = [one.end for one in journeys if one.end is not None]
    said = f"{len(ends)} of {len(journeys)} journeys, {touchdown_count} touchdowns"
    if not ends:
        return said
    at_rest, more = ends.count(JourneyEnd.AT_REST), INTERVAL_ERRORS**2
    # With half as many added on either side the error of a share next to 0 or 1 is none of 0. Source: [Agresti-1998].
    share = (at_rest + 0.5 * more) / (len(ends) + more)
    error = INTERVAL_ERRORS * math.sqrt(share * (1.0 - share) / (len(ends) + more))
    return f"{said}, at rest so far {100 * at_rest / len(ends):.0f} +- {100 * error:.0f} %"


def _say_what_was_known(job: Job, records: Sequence[Record]) -> None:
    """Say how many touchdowns the journeys have."""
    per_journey = Counter(int(record.inputs["journey"]) for record in records)
    mean = float(np.mean(list(per_journey.values())))
    job.say(f"{len(per_journey)} journeys have {len(records)} touchdowns, {mean:.1f} each")
