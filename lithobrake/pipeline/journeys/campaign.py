"""The stage that follows every lander of a study to the end of its journey, and the tables of journeys."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.campaign import Ledger, Record, Runs, Tally, run_chains
from lithobrake.pipeline.design.descents import descents_in_words
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import side_down
from lithobrake.pipeline.first_touchdown.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.first_arrivals import Arrivals, Row
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.pipeline.journeys.simulated_touchdowns import LandingRows, answers_of
from lithobrake.pipeline.runs.energy_bound import energy_warning, height_of_beds
from lithobrake.pipeline.runs.landings import account, campaign_setting, model_of
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.smallbody.landers import ENDS
from lithobrake.smallbody.touchdown import FAILED
from lithobrake.vocabulary.file_names import ARCS_FILE, JOURNEYS_FILE, RUNS_FILE, TOUCHDOWNS_FILE
from lithobrake.vocabulary.number_words import out_of, percent
from lithobrake.vocabulary.outcomes import RESTS, FlightStatus, JourneyEnd
from lithobrake.vocabulary.quantities import ARC, IMPACT_INCIDENCE, IMPACT_SPEED, JOURNEY, JOURNEY_TOUCHDOWN, SOIL

if TYPE_CHECKING:
    from lithobrake.smallbody import Flights

JOURNEY_FILES: tuple[str, ...] = (JOURNEYS_FILE, TOUCHDOWNS_FILE, ARCS_FILE)
# Standard errors on either side of a share that is told while journeys are under way: an interval of 90 %.
INTERVAL_ERRORS = 1.645


@dataclass(frozen=True)
class Journeys:
    """Landers by simulated landings, with the rows of their tables.

    rows: inputs of the present touchdown of each; touchdowns, flights: rows of their tables, by column, of each.
    """

    landers: StudyLanders
    rows: list[Row]
    touchdowns: list[list[dict[str, Any]]] = field(default_factory=list)
    flights: list[list[dict[str, Any]]] = field(default_factory=list)

    @classmethod
    def of(cls, landers: StudyLanders) -> "Journeys":
        count = len(landers)
        return cls(landers, list(landers.begin.rows), [[] for _ in range(count)], [[] for _ in range(count)])

    @classmethod
    def begun(cls, design: DrawnDesign) -> "Journeys":
        """The journeys of a study at their first touchdowns; those that never touch down have ended aloft."""
        most, descents = design.study.journey.touchdowns, design.descents
        if descents is None:
            return cls.of(StudyLanders.of(design, Arrivals.of_rows(design.site, design.rows, 0), most))
        landers = StudyLanders.of(design, Arrivals.of_descents(descents, design.rows, design.beds), most)
        down = descents.touches_down
        landers.is_down[:] = down
        landers.end[~down] = [str(ENDS[FlightStatus(word)]) for word in descents.flights.status[~down].tolist()]
        # Times count from the first touchdown; of a lander that has none, from its release.
        landers.time[~down] = descents.flights.time[~down]
        journeys = cls.of(landers)
        begin = np.where(down, -descents.flights.time, 0.0)
        for lander, flights in enumerate(journeys.flights):
            flights.append(flight_row(lander, descents.flights, lander, float(begin[lander])))
        return journeys

    @property
    def design(self) -> DrawnDesign:
        return self.landers.design

    def __len__(self) -> int:
        return len(self.landers)

    def number(self, lander: int) -> int:
        """The number of the journey of a lander."""
        return int(self.landers.begin.number[lander])

    def go_on(self, lander: int, record: Record) -> Row | None:
        """Take in how the present touchdown ended; give the inputs of the next one, or None where there is none."""
        which, answers = np.array([lander]), answers_of([record])
        end = float(self.landers.time[lander] + answers.duration[0])
        self.touchdowns[lander].append(self._touchdown(lander, record, end))
        flights = self.landers.go_on(which, answers)
        if flights is not None:
            self.flights[lander].append(flight_row(self.number(lander), flights, 0, end))
        if self.landers.end[lander]:
            return None
        (self.rows[lander],) = self._landing_rows.of(self.landers.impacts(which))
        return self.rows[lander]

    @cached_property
    def _landing_rows(self) -> LandingRows:
        return LandingRows(self.design, self.landers.begin)

    def _touchdown(self, lander: int, record: Record, end: float) -> dict[str, Any]:
        landers, place = self.landers, self.landers.position[lander].copy()
        latitude, longitude = (float(one) for one in landers.body.shape.latitude_longitude(place))
        return {
            "journey": self.number(lander),
            "touchdown": int(landers.touchdowns[lander]),
            "key": record.key,
            "outcome": record.outcome or FAILED,
            "body": self.design.site.ground_names[landers.ground[lander]],
            "begin_s": float(landers.time[lander]),
            "end_s": end,
            "latitude_deg": latitude,
            "longitude_deg": longitude,
            **{f"position_{axis}": float(value) for axis, value in zip("xyz", place, strict=True)},
            **{f"velocity_{axis}": float(value) for axis, value in zip("xyz", self._incoming(lander), strict=True)},
            **self._landing_rows.soil_column(place, int(landers.ground[lander])),
        }

    def _incoming(self, lander: int) -> np.ndarray:
        """Velocity of the present impact against the ground [m/s], fixed to the body."""
        row, axes = self.rows[lander], self.landers.axes[lander]
        incidence = math.radians(row[IMPACT_INCIDENCE])
        along, down = row[IMPACT_SPEED] * math.sin(incidence), row[IMPACT_SPEED] * math.cos(incidence)
        incoming: np.ndarray = along * axes[0] - down * axes[2]
        return incoming

    def row(self, lander: int) -> list[Any]:
        """Where a journey ended; what is not on the ground has no place there, what does not rest no side.

        The distance is that from the aim point, of which there is none on the partner.
        """
        landers, end, body = self.landers, str(self.landers.end[lander]), ""
        place: list[Any] = ["", "", "", "", "", ""]
        if end in (*RESTS, JourneyEnd.UNDER_WAY) and landers.is_down[lander]:
            position, ground = landers.position[lander], int(landers.ground[lander])
            latitude, longitude = (float(one) for one in landers.body.shape.latitude_longitude(position))
            away = "" if ground else float(self.design.site.ways_from_aim(position))
            body, place = self.design.site.ground_names[ground], [latitude, longitude, *position.tolist(), away]
        counts = [int(landers.contacts[lander]), int(landers.touchdowns[lander]), float(landers.path_length[lander])]
        bed, time = int(self.rows[lander]["bed"]), float(landers.time[lander])
        lies = self._lies(lander) if end in RESTS and body else [""] * 6
        return [self.number(lander), bed, end, body, time, *place, *counts, *lies, landers.reason[lander]]

    def _lies(self, lander: int) -> list[Any]:
        """Side, tilt and attitude of a lander at rest; none of a ball, or where the touchdown has no attitude."""
        attitude = self.landers.attitude[lander]
        if self.design.study.lander.is_ball or attitude is None:
            return [""] * 6
        side, tilt = side_down(attitude, self.landers.acceleration(np.array([lander]))[0])
        return [side, math.degrees(tilt), *attitude.as_quat(scalar_first=True).tolist()]

    def write(self, folder: StudyFolder) -> None:
        """Write journeys.csv, touchdowns.csv and arcs.csv."""
        write_table(folder, JOURNEYS_FILE, tuple(JOURNEY), [self.row(one) for one in range(len(self))], JOURNEY)
        touchdowns = [list(row.values()) for rows in self.touchdowns for row in rows]
        columns = JOURNEY_TOUCHDOWN | (SOIL if self.design.study.soil else {})
        write_table(folder, TOUCHDOWNS_FILE, tuple(columns), touchdowns, columns)
        flights = [
            [{**row, "arc": number}[name] for name in ARC] for rows in self.flights for number, row in enumerate(rows)
        ]
        write_table(folder, ARCS_FILE, tuple(ARC), flights, ARC)


def flight_row(journey: int, flights: "Flights", place: int, begin: float) -> dict[str, Any]:
    """A row of the table of flights but for its number, by column; begin: since the first touchdown [s]."""
    start = flights.start
    return {
        "sample": journey,
        "begin_s": begin,
        "end_s": begin + float(flights.time[place]),
        "clock_s": float(start.time[place]),
        **{f"position_{axis}": float(value) for axis, value in zip("xyz", start.position[place], strict=True)},
        **{f"velocity_{axis}": float(value) for axis, value in zip("xyz", start.velocity[place], strict=True)},
        "site_mass": float(start.mass[place]),
        "site_spin_period": float(start.spin_period[place]),
    }


def make_journeys(job: Job) -> None:
    for words in job.site.remarks:
        job.say(words)
    if job.design.descents is not None:
        job.say(descents_in_words(job.design.descents))
    journeys, rows = Journeys.begun(job.design), job.design.rows
    # Before they are made, so that other processes can distinguish these runs from others of the ledger.
    job.folder.note_runs("drawn", job.design.keys)
    chains, reused = follow_in_chains(job, journeys, rows)
    records = [record for chain in chains for record in chain]
    _say_touchdowns(job, records, reused)
    if gained := energy_warning(job.design, records, height_of_beds(job.study, job.folder)):
        job.say(f"touchdowns: {gained}")
    first = Runs([chain[0] for chain in chains], 0)
    account(job, "drawn", first, tuple(job.design.inputs))
    # First touchdowns are what the drawn runs of other studies are, so all that reads those serves journeys as well.
    DesignRuns.of(first).save(job.folder, "drawn")
    DesignRuns.of(Runs(records, 0)).save(job.folder, "touchdowns")
    journeys.write(job.folder)


def follow_in_chains(
    job: Job, journeys: Journeys, rows: Sequence[Mapping[str, float]]
) -> tuple[list[list[Record]], int]:
    """Make all touchdowns of journeys that begin with these, and say how many of them the ledger had.

    Each lander goes on as soon as its own touchdown has ended. rows: first touchdowns, in the order of the journeys
    that have one.
    """
    # A lander that never touches down has no chain; the others keep their order.
    landing, reused = journeys.landers.going.tolist(), 0

    def then(number: int, records: Sequence[Record]) -> Mapping[str, float] | None:
        return journeys.go_on(landing[number], records[-1])

    def show(state: Tally) -> None:
        nonlocal reused
        reused = state.reused
        ends = [end for end in journeys.landers.end.tolist() if end]
        said = progress_words(ends, len(journeys), state.ended)
        # Other processes read this from the lock: the tables are written when all journeys have ended.
        job.note(journeys=said)
        job.progress(len(ends), len(journeys), "journeys", f"{said}\n{state.sentence()}")

    with Ledger(job.folder / RUNS_FILE) as ledger:
        chains = run_chains(
            model_of(job.study, job.folder.path.absolute(), job.model),
            rows,
            then,
            ledger=ledger,
            progress=show,
            **campaign_setting(job),
        )
    return chains, reused


def progress_words(ends: Sequence[str], journey_count: int, touchdown_count: int) -> str:
    """How far journeys are, by the ends so far, as "31 of 96 journeys, 140 touchdowns, at rest so far 71 +- 8 %"."""
    said = f"{out_of(len(ends), journey_count, 'journeys')}, {touchdown_count} touchdowns"
    if not ends:
        return said
    at_rest, more = ends.count(JourneyEnd.AT_REST), INTERVAL_ERRORS**2
    # With half as many added on either side the error of a share next to 0 or 1 is none of 0. Source: [Agresti-1998].
    share = (at_rest + 0.5 * more) / (len(ends) + more)
    error = INTERVAL_ERRORS * math.sqrt(share * (1.0 - share) / (len(ends) + more))
    return f"{said}, at rest so far {percent(at_rest / len(ends)).removesuffix(' %')} +- {percent(error)}"


def _say_touchdowns(job: Job, records: Sequence[Record], reused: int) -> None:
    """Say how many touchdowns the journeys have, and how many of them were known."""
    count, total = len({record.inputs["journey"] for record in records}), len(records)
    known = f"; {reused} of them were known and are reused" if reused else ""
    job.say(f"{count} journeys have {total} touchdowns, {total / count:.1f} each{known}")
