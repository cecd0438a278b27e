"""Landers that the emulator takes from touchdown to touchdown, and landings where it has no answer."""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.campaign import Record, RunStatus
from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import about_z, uniform_attitude
from lithobrake.pipeline.design.arrivals import FLATTEST_DEG, MEAN_INCIDENCE, friction_of, ground_inputs, met_ground
from lithobrake.pipeline.design.lander_attitude import attitude_inputs_of
from lithobrake.pipeline.design.soils import felt
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys import touchdown_emulator
from lithobrake.pipeline.journeys.journey import ENDS, MOST_TOUCHDOWNS, JourneyModel, on_ground
from lithobrake.pipeline.runs.landings import touchdowns
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    ORIENTATION,
    PLACE,
    SPIN,
    SPIN_OUT,
    TIME_LEFT,
    VELOCITY_OUT,
)

# Of these landings alone: what the study says of its runs is of those of its journeys.
LEDGER = "emulated.sqlite"
AFTER = {
    TouchdownOutcome.CAPTURED.value: JourneyEnd.AT_REST.value,
    TouchdownOutcome.TIME_LIMIT.value: JourneyEnd.UNDER_WAY.value,
    TouchdownOutcome.LEFT_SIDEWAYS.value: JourneyEnd.FAILED.value,
}


@dataclass(frozen=True)
class NextImpacts:
    """Impacts of some landers, all arrays [count], vectors [count, 3] in the frames of the touchdowns.

    lander: its place among all of them; speed [m/s]; incidence [deg]; spin against the ground [rad/s]; acceleration of
    what rests there [m/s2]; time [s]: since the first touchdown began.
    """

    lander: np.ndarray
    speed: np.ndarray
    incidence: np.ndarray
    spin: np.ndarray
    acceleration: np.ndarray
    time: np.ndarray


@dataclass
class LandingsBetween:
    """Landings of a study among touchdowns of its emulator, at most `most` of them; made: so far.

    title: of the landers, which begin as `begin` says.
    """

    job: Job
    title: str
    begin: touchdown_emulator.Arrivals
    most: int
    made: int = 0

    @cached_property
    def model(self) -> JourneyModel:
        return JourneyModel(self.job.design)

    def answers(self, impacts: NextImpacts, number: int) -> touchdown_emulator.Answers:
        """Land at touchdowns of a number, the first ones as long as landings are left; of others nothing is known."""
        total = len(impacts.lander)
        found, count = touchdown_emulator.Answers.unknown(total), min(total, self.most - self.made)
        if count > 0:
            self.made += count
            rows = [self._row(impacts, place, number) for place in range(count)]
            runs = touchdowns(self.job, rows, "landings where the emulator has no answer", 0, LEDGER)
            for place, record in enumerate(runs.records):
                _take_in(found, place, record)
        return found

    def _row(self, impacts: NextImpacts, place: int, number: int) -> touchdown_emulator.Row:
        """Inputs of a landing: the lander's own soil and bed, at a fresh place, in a random direction and attitude."""
        lander = int(impacts.lander[place])
        row, acceleration = self.begin.rows[lander], impacts.acceleration[place].tolist()
        # The first touchdown is that of the design, whose attitude and place are the lander's own.
        if number == 0:
            return row | ground_inputs(acceleration, row[IMPACT_AZIMUTH], friction_of(row))
        seed = hashed_seed(self.model.seed, "landings between", self.title, lander, number)
        x, y, turn, *attitude = np.random.default_rng(seed).random(6).tolist()
        azimuth = 360.0 * turn
        spin = about_z(math.radians(azimuth)).apply(impacts.spin[place])
        of_lander = {name: value for name, value in row.items() if name != MEAN_INCIDENCE}
        return of_lander | {
            "touchdown": float(number),
            TIME_LEFT: self.model.duration - float(impacts.time[place]),
            IMPACT_SPEED: float(impacts.speed[place]),
            IMPACT_INCIDENCE: float(impacts.incidence[place]),
            IMPACT_AZIMUTH: azimuth,
            **dict(zip(SPIN, spin.tolist(), strict=True)),
            **dict(zip(ORIENTATION, uniform_attitude(*attitude).tolist(), strict=True)),
            **dict(zip(PLACE, self.model.place(x, y, row), strict=True)),
            **ground_inputs(acceleration, azimuth, friction_of(row)),
        }


def _take_in(found: touchdown_emulator.Answers, place: int, record: Record) -> None:
    outputs = record.outputs
    if record.status == RunStatus.FAILED:
        found.outcome[place] = RunStatus.FAILED.value
        return
    found.outcome[place] = str(record.outcome)
    found.duration[place] = outputs.get(touchdown_emulator.DURATION, 0.0)
    found.way[place] = outputs.get(touchdown_emulator.ALONG, 0.0), outputs.get(touchdown_emulator.ASIDE, 0.0), 0.0
    if record.outcome == TouchdownOutcome.CLEAR:
        found.velocity[place] = [outputs[name] for name in VELOCITY_OUT]
        found.spin[place] = [outputs.get(name, 0.0) for name in SPIN_OUT]


@dataclass
class EmulatedLanders:
    """Landers under way; arrays [count], one entry a lander, vectors fixed to the body.

    time: since the first touchdown began [s]; position [m]; speed [m/s], incidence [deg], axes (in rows) and spin
    against the ground [rad/s] in that frame: of the next impact. end: a word of JourneyEnd, UNKNOWN_END, or "" while
    under way. landings: made for it; beyond: the input of an impact that the emulator did not know, the last one; ""
    where there was none.
    """

    job: Job
    emulator: touchdown_emulator.TouchdownEmulator
    title: str
    begin: touchdown_emulator.Arrivals
    position: np.ndarray
    axes: np.ndarray
    spin: np.ndarray
    speed: np.ndarray
    incidence: np.ndarray
    time: np.ndarray
    end: np.ndarray
    landings: np.ndarray
    beyond: np.ndarray
    soil: dict[str, np.ndarray] = field(default_factory=dict)

    @classmethod
    def of(
        cls, job: Job, emulator: touchdown_emulator.TouchdownEmulator, title: str, begin: touchdown_emulator.Arrivals
    ) -> "EmulatedLanders":
        count = len(begin.rows)
        names = [name for name in emulator.plain_inputs if name not in emulator.ranges]
        return cls(
            job=job,
            emulator=emulator,
            title=title,
            begin=begin,
            position=np.array(begin.origin),
            axes=np.array(begin.axes),
            spin=begin.spin,
            speed=begin.column(IMPACT_SPEED),
            incidence=begin.column(IMPACT_INCIDENCE),
            time=np.zeros(count),
            # As wide as the longest of its words: NumPy cuts longer ones without notice.
            end=np.full(count, "", dtype="<U10"),
            landings=np.zeros(count, dtype=np.int64),
            # The same of the names of OF_TOUCHDOWN.
            beyond=np.full(count, "", dtype="<U24"),
            soil={name: begin.column(name) for name in names},
        )

    def follow(self, most_landings: int) -> None:
        between = LandingsBetween(self.job, self.title, self.begin, most_landings)
        for number in range(MOST_TOUCHDOWNS):
            going = np.flatnonzero(self.end == "")
            self.job.progress(len(self.end) - len(going), len(self.end), self.title)
            if not len(going):
                return
            acceleration = self._acceleration(going)
            answers = self._answers(going, acceleration, number)
            asked = ~answers.is_known
            impacts = self._impacts(going[asked], acceleration[asked])
            landed = between.answers(impacts, number)
            answers.fill(asked, landed)
            self.landings[impacts.lander] += landed.is_known
            self._go_on(going, answers, number)
        self.end[self.end == ""] = JourneyEnd.UNDER_WAY

    def _impacts(self, which: np.ndarray, acceleration: np.ndarray) -> NextImpacts:
        states = (self.speed[which], self.incidence[which], self.spin[which])
        return NextImpacts(which, *states, acceleration, self.time[which])

    def _acceleration(self, going: np.ndarray) -> np.ndarray:
        """Of what rests where landers touch down [m/s2], [count, 3], in the frames of their touchdowns."""
        site, clock = self.begin.site, self.begin.clock[going] + self.time[going]
        body = self.job.site.body
        local = felt(body, self.position[going], clock, site["mass"][going], site["spin_period"][going])
        return np.einsum("nij,nj->ni", self.axes[going], local)

    def _answers(self, going: np.ndarray, acceleration: np.ndarray, number: int) -> touchdown_emulator.Answers:
        rows = (self.begin.rows[one] for one in going.tolist())
        # The emulator reads the size of the acceleration and the slope, for which any azimuth will do.
        ground = [ground_inputs(one, 0.0, friction_of(row)) for one, row in zip(acceleration, rows, strict=True)]
        inputs = {name: values[going] for name, values in self.soil.items()} | {
            IMPACT_SPEED: self.speed[going],
            IMPACT_INCIDENCE: self.incidence[going],
            touchdown_emulator.GRAVITY: np.array([one[touchdown_emulator.GRAVITY] for one in ground]),
            touchdown_emulator.SLOPE: np.array([one[touchdown_emulator.SLOPE] for one in ground]),
            **self._attitude(going, number),
        }
        beyond = self.emulator.beyond(inputs)
        self.beyond[going] = np.where(beyond == "", self.beyond[going], beyond)
        seed = hashed_seed(self.job.study.seed, self.title, number)
        return self.emulator.answers(inputs, self.spin[going], self.begin.refit[going], seed)

    def _attitude(self, going: np.ndarray, number: int) -> dict[str, np.ndarray]:
        """Terms of the attitudes of some landers: as delivered at the first touchdown, any attitude at later ones.

        A lander that has bounced tumbles for minutes before it comes down again.
        """
        terms = self.emulator.terms
        if terms is None:
            return {}
        if number == 0:
            delivered = {name: self.begin.column(name)[going] for name in (*ORIENTATION, IMPACT_AZIMUTH)}
            return attitude_inputs_of(terms, delivered)
        # Drawn for all landers, so that the numbers of one do not depend on which others are still under way.
        random = np.random.default_rng(hashed_seed(self.job.study.seed, self.title, "attitudes", number))
        return self.emulator.attitude_of(Rotation.random(len(self.end), rng=random)[going])

    def _go_on(self, going: np.ndarray, answers: touchdown_emulator.Answers, number: int) -> None:
        duration = self.duration
        self.time[going] += answers.duration
        self.position[going] += np.einsum("nji,nj->ni", self.axes[going], answers.way)
        self.end[going] = [AFTER.get(word, word) for word in answers.outcome]
        left = answers.outcome == TouchdownOutcome.CLEAR
        self.end[going[left]] = np.where(self.time[going[left]] < duration, "", JourneyEnd.UNDER_WAY.value)
        flying = self.end[going] == ""
        # Only those that a touchdown has moved: the search for the ground takes one lander at a time.
        for lander in going[flying & answers.way.any(axis=1)].tolist():
            self.position[lander] = on_ground(self.job.site.body.shape, self.position[lander])
        if flying.any():
            self._fly(going[flying], answers.velocity[flying], answers.spin[flying], number)

    def _fly(self, going: np.ndarray, velocity: np.ndarray, spin: np.ndarray, number: int) -> None:
        """Fly landers that leave with velocities [m/s] and spins [rad/s] in the frames of their touchdowns."""
        from lithobrake.smallbody import fly

        site, job = self.begin.site, self.job
        velocity, spin = (np.einsum("nji,nj->ni", self.axes[going], one) for one in (velocity, spin))
        period = site["spin_period"][going]
        flown = fly(
            *(job.site.body, self.position[going], velocity, self.duration - self.time[going]),
            gravity=job.study.flight.gravity,
            start_time=self.begin.clock[going] + self.time[going],
            mass=site["mass"][going],
            spin_period=period,
            threads=getattr(job.executor, "worker_count", None),
        )
        self.position[going], self.time[going] = flown.position, self.time[going] + flown.time
        ended = {status.value: end.value for status, end in ENDS.items()}
        self.end[going] = [ended.get(str(word), "") for word in flown.status]
        hit = flown.status == FlightStatus.IMPACT
        down = going[hit]
        self.speed[down] = flown.impact_speed[hit]
        up = job.site.body.shape.normals[flown.facet[hit]]
        self._meet_ground(down, flown.velocity[hit], up, flown.incidence[hit], number)
        self.spin[down] = self._arriving_spin(down, spin[hit], flown.start.time[hit], flown.time[hit], period[hit])

    def _meet_ground(
        self, down: np.ndarray, velocity: np.ndarray, up: np.ndarray, incidence: np.ndarray, number: int
    ) -> None:
        """Lay the frames of the next impacts: velocities [m/s] and normals of the facets, [count, 3]."""

        def uniforms() -> np.ndarray:
            # For all landers, as the attitudes.
            seed = hashed_seed(self.job.study.seed, self.title, "roughness", number)
            return np.random.default_rng(seed).random((len(self.end), 2))[down]

        self.axes[down], met = met_ground(self.job.study, velocity, up, incidence, uniforms)
        self.incidence[down] = np.minimum(np.degrees(met), FLATTEST_DEG)

    def _arriving_spin(
        self, down: np.ndarray, spin: np.ndarray, start: np.ndarray, time: np.ndarray, period: np.ndarray
    ) -> np.ndarray:
        """Spins against the ground [rad/s] in the frames of the next impacts, as those of balls.

        What depends on how a lander tumbles is in the scatter of the emulator, which does not read the spin.
        """
        from lithobrake.smallbody.rotation import ground_spin, kept_among_stars

        ground = self.job.site.body.rotation
        fixed = kept_among_stars(ground, spin + ground_spin(ground, start, period), start, time, period)
        found: np.ndarray = np.einsum("nij,nj->ni", self.axes[down], fixed - ground_spin(ground, start + time, period))
        return found

    @property
    def duration(self) -> float:
        """Longest journey [s]."""
        assert self.job.study.journey is not None
        return self.job.study.journey.duration
