"""Simulated landings for impacts that the emulator of a study's touchdowns does not know."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lithobrake.campaign import Record, RunStatus
from lithobrake.files.hashing import hashed_seed
from lithobrake.geometry.attitude import uniform_attitude
from lithobrake.geometry.contact_frame import about_z
from lithobrake.pipeline.design.local_ground import AZIMUTH, friction_of, ground_inputs
from lithobrake.pipeline.design.rough_ground import MEAN_INCIDENCE
from lithobrake.pipeline.emulated.answers import Answers
from lithobrake.pipeline.emulated.arrivals import Arrivals, Row
from lithobrake.pipeline.emulated.touchdown_emulator import ALONG, ASIDE, DURATION, INCIDENCE, SPEED
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.journey_model import JourneyModel
from lithobrake.pipeline.runs.touchdown_runs import touchdowns
from lithobrake.study.touchdown_model import PLACE, TIME_LEFT
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import ORIENTATION, SPIN, SPIN_OUT, VELOCITY_OUT

# Of these landings alone: what the study says of its runs is of those of its journeys.
LEDGER = "emulated.sqlite"


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
    begin: Arrivals
    most: int
    made: int = 0

    @cached_property
    def model(self) -> JourneyModel:
        """Site and design of the study."""
        return JourneyModel(self.job.design, self.job.site)

    def answers(self, impacts: NextImpacts, number: int) -> Answers:
        """Land at touchdowns of a number, the first ones as long as landings are left; of others nothing is known."""
        total = len(impacts.lander)
        found, count = Answers.unknown(total), min(total, self.most - self.made)
        if count > 0:
            self.made += count
            rows = [self._row(impacts, place, number) for place in range(count)]
            runs = touchdowns(self.job, rows, "landings where the emulator has no answer", 0, LEDGER)
            for place, record in enumerate(runs.records):
                _take_in(found, place, record)
        return found

    def _row(self, impacts: NextImpacts, place: int, number: int) -> Row:
        """Inputs of a landing: the lander's own soil and bed, at a fresh place, in a random direction and attitude."""
        lander = int(impacts.lander[place])
        row, acceleration = self.begin.rows[lander], impacts.acceleration[place].tolist()
        if number == 0:
            return row | ground_inputs(acceleration, row[AZIMUTH], friction_of(row))
        seed = hashed_seed(self.model.seed, "landings between", self.title, lander, number)
        x, y, turn, *attitude = np.random.default_rng(seed).random(6).tolist()
        azimuth = 360.0 * turn
        spin = about_z(math.radians(azimuth)).apply(impacts.spin[place])
        of_lander = {name: value for name, value in row.items() if name != MEAN_INCIDENCE}
        return of_lander | {
            "touchdown": float(number),
            TIME_LEFT: self.model.duration - float(impacts.time[place]),
            SPEED: float(impacts.speed[place]),
            INCIDENCE: float(impacts.incidence[place]),
            AZIMUTH: azimuth,
            **dict(zip(SPIN, spin.tolist(), strict=True)),
            **dict(zip(ORIENTATION, uniform_attitude(*attitude).tolist(), strict=True)),
            **dict(zip(PLACE, self.model.place(x, y, row), strict=True)),
            **ground_inputs(acceleration, azimuth, friction_of(row)),
        }


def _take_in(found: Answers, place: int, record: Record) -> None:
    """Note how a landing ended."""
    outputs = record.outputs
    if record.status == RunStatus.FAILED:
        found.outcome[place] = RunStatus.FAILED.value
        return
    found.outcome[place] = str(record.outcome)
    found.duration[place] = outputs.get(DURATION, 0.0)
    found.way[place] = outputs.get(ALONG, 0.0), outputs.get(ASIDE, 0.0), 0.0
    if record.outcome == TouchdownOutcome.CLEAR:
        found.velocity[place] = [outputs[name] for name in VELOCITY_OUT]
        found.spin[place] = [outputs.get(name, 0.0) for name in SPIN_OUT]
