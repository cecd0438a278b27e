"""The stage that follows every lander of a study to the end of its journey, and the tables of journeys."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lithobrake.campaign import Ledger, Record, Runs, Tally, run_chains
from lithobrake.pipeline.design.arrivals import first_axes
from lithobrake.pipeline.design.descents import Descents, descents_in_words
from lithobrake.pipeline.flights import Ways, write_flight_paths, write_shape, write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.journey import ENDS, Journey, JourneyModel, flight_row
from lithobrake.pipeline.runs.landings import account, campaign_setting, model_of
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.vocabulary.file_names import ARCS_FILE, JOURNEYS_FILE, RUNS_FILE, TOUCHDOWNS_FILE
from lithobrake.vocabulary.number_words import out_of, percent
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd
from lithobrake.vocabulary.quantities import ARC, JOURNEY, JOURNEY_TOUCHDOWN, SOIL

JOURNEY_FILES: tuple[str, ...] = (JOURNEYS_FILE, TOUCHDOWNS_FILE, ARCS_FILE)
# Standard errors on either side of a share that is told while journeys are under way: an interval of 90 %.
INTERVAL_ERRORS = 1.645


def begun_aloft(model: JourneyModel, descents: Descents) -> list[Journey]:
    """The journeys before their first touchdowns; those that never touch down have ended with their flight."""
    rows, flights, start = iter(model.design.rows), descents.flights, descents.flights.start
    journeys = []
    for number, (status, bed) in enumerate(zip(flights.status.tolist(), model.design.beds, strict=True)):
        end = ENDS.get(FlightStatus(status))
        journey = Journey(
            *(model, number, {"bed": float(bed)} if end else next(rows)),
            *(flights.position[number], descents.axes[number], float(descents.clock[number])),
            *(float(start.mass[number]), float(start.spin_period[number])),
        )
        journey.end, journey.descent = end, _descent(descents, number, end is None)
        # Times count from the first touchdown; of a lander that has none, from its release.
        journey.time = 0.0 if end is None else float(flights.time[number])
        journeys.append(journey)
    return journeys


def _descent(descents: Descents, number: int, touches_down: bool) -> dict[str, Any]:
    flights, start = descents.flights, descents.flights.start
    time = float(flights.time[number])
    begin = -time if touches_down else 0.0
    return flight_row(
        number, begin, begin + time, float(start.time[number]), start.position[number], start.velocity[number],
        float(start.mass[number]), float(start.spin_period[number]),
    )  # fmt: skip


def write_journeys(folder: StudyFolder, journeys: Sequence[Journey]) -> None:
    write_table(folder, JOURNEYS_FILE, tuple(JOURNEY), [journey_row(journey) for journey in journeys], JOURNEY)
    touchdowns = [list(row.values()) for journey in journeys for row in journey.touchdowns]
    columns = JOURNEY_TOUCHDOWN | (SOIL if any(journey.model.design.study.soil for journey in journeys) else {})
    write_table(folder, TOUCHDOWNS_FILE, tuple(columns), touchdowns, columns)
    flights = [[row[name] for name in ARC] for journey in journeys for row in _flights(journey)]
    write_table(folder, ARCS_FILE, tuple(ARC), flights, ARC)


def _flights(journey: Journey) -> list[dict[str, Any]]:
    rows = [*([] if journey.descent is None else [journey.descent]), *journey.flights]
    return [{**row, "arc": number} for number, row in enumerate(rows)]


def journey_row(journey: Journey) -> list[Any]:
    """Where a journey ended; what is not on the ground of the body has no place there, what does not rest no side."""
    place: list[Any] = ["", "", "", "", "", ""]
    if journey.end in (JourneyEnd.AT_REST, JourneyEnd.UNDER_WAY) and journey.is_on_ground:
        latitude, longitude = (float(one) for one in journey.model.body.shape.latitude_longitude(journey.origin))
        place = [latitude, longitude, *journey.origin.tolist(), float(journey.model.site.ways_from_aim(journey.origin))]
    side, tilt = ("", "") if journey.lies is None else (journey.lies[0], math.degrees(journey.lies[1]))
    attitude = [""] * 4 if journey.attitude is None else journey.attitude.as_quat(scalar_first=True).tolist()
    counts = [journey.contacts, len(journey.touchdowns), journey.path_length]
    bed = int(journey.row["bed"])
    return [journey.number, bed, str(journey.end), journey.time, *place, *counts, side, tilt, *attitude, journey.reason]


def make_journeys(job: Job) -> None:
    for words in (job.site.warning, job.site.rotation_words):
        if words:
            job.say(words)
    if job.design.descents is not None:
        job.say(descents_in_words(job.design.descents))
    journeys = begun(job)
    rows = job.design.rows
    # Before they are made, so that other processes can distinguish these runs from others of the ledger.
    job.folder.note_runs("drawn", job.design.keys)
    chains = follow(job, journeys, rows)
    records = [record for chain in chains for record in chain]
    _say_what_was_known(job, records)
    first = Runs([chain[0] for chain in chains], 0)
    account(job, "drawn", first, tuple(job.design.inputs))
    # First touchdowns are what the drawn runs of other studies are, so all that reads those serves journeys as well.
    DesignRuns.of(first).save(job.folder, "drawn")
    DesignRuns.of(Runs(records, 0)).save(job.folder, "touchdowns")
    write_journeys(job.folder, journeys)
    write_shape(job.site.body, job.folder)
    write_flight_paths(job, job.site.body, Ways.of_journeys(job.folder))


def begun(job: Job) -> list[Journey]:
    model, descents = JourneyModel(job.design), job.design.descents
    return begin(model, job.design.rows, 0) if descents is None else begun_aloft(model, descents)


def begin(model: JourneyModel, rows: Sequence[dict[str, float]], first: int) -> list[Journey]:
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
    # A lander that never touches down has no chain; the others keep their order.
    landing = [journey for journey in journeys if journey.end is None]

    def then(number: int, records: Sequence[Record]) -> Mapping[str, float] | None:
        return landing[number].go_on(records[-1])

    def show(state: Tally) -> None:
        ended, said = sum(one.end is not None for one in journeys), progress_words(journeys, state.ended)
        # Other processes read this from the lock: the tables are written when all journeys have ended.
        job.note(journeys=said)
        job.progress(ended, len(journeys), "journeys", f"{said}\n{state.sentence()}")

    with Ledger(job.folder / RUNS_FILE) as ledger:
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
    said = f"{out_of(len(ends), len(journeys), 'journeys')}, {touchdown_count} touchdowns"
    if not ends:
        return said
    at_rest, more = ends.count(JourneyEnd.AT_REST), INTERVAL_ERRORS**2
    # With half as many added on either side the error of a share next to 0 or 1 is none of 0. Source: [Agresti-1998].
    share = (at_rest + 0.5 * more) / (len(ends) + more)
    error = INTERVAL_ERRORS * math.sqrt(share * (1.0 - share) / (len(ends) + more))
    return f"{said}, at rest so far {percent(at_rest / len(ends)).removesuffix(' %')} +- {percent(error)}"


def _say_what_was_known(job: Job, records: Sequence[Record]) -> None:
    """Say how many touchdowns the journeys have."""
    per_journey = Counter(int(record.inputs["journey"]) for record in records)
    mean = float(np.mean(list(per_journey.values())))
    job.say(f"{len(per_journey)} journeys have {len(records)} touchdowns, {mean:.1f} each")
