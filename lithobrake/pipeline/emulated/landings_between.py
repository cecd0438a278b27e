"""Simulated landings for impacts that the emulator of a study's touchdowns does not know."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.campaign import Record, RunStatus
from lithobrake.files.hashing import hashed_seed
from lithobrake.geometry.attitude import uniform_attitude
from lithobrake.pipeline.design.local_ground import friction_of, ground_inputs
from lithobrake.pipeline.emulated.answers import Answers
from lithobrake.pipeline.emulated.arrivals import SPIN, Row
from lithobrake.pipeline.emulated.touchdown_emulator import ALONG, ASIDE, DURATION, INCIDENCE, SPEED
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.contact_frame import about_z
from lithobrake.pipeline.journeys.journey_model import JourneyModel
from lithobrake.pipeline.runs.touchdown_runs import touchdowns
from lithobrake.study.touchdown_model import ORIENTATION, PLACE, TIME_LEFT
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import SPIN_OUT, VELOCITY_OUT

if TYPE_CHECKING:
    from lithobrake.pipeline.emulated.landers import Landers


@dataclass
class LandingsBetween:
    """Landings of a study among touchdowns of its emulator, at most `most` of them; made: so far."""

    job: Job
    most: int
    made: int = 0
    model: JourneyModel = field(init=False)

    def __post_init__(self) -> None:
        self.model = JourneyModel(self.job.design, self.job.site)

    def answers(self, landers: "Landers", which: np.ndarray, acceleration: np.ndarray, number: int) -> Answers:
        """Land some of the landers under these accelerations [m/s2], [count, 3], at their touchdown of a number.

        The first ones, as long as landings are left; of the others nothing is known.
        """
        found, count = Answers.unknown(len(which)), min(len(which), self.most - self.made)
        if count > 0:
            rows = [self._row(landers, *one, number) for one in zip(which[:count].tolist(), acceleration, strict=False)]
            self.made += count
            for place, record in enumerate(touchdowns(self.job, rows, "landings where the emulator has no answer", 0).records):
                _take_in(found, place, record)
        return found

    def _row(self, landers: "Landers", lander: int, acceleration: np.ndarray, number: int) -> Row:
        """Inputs of a landing: the lander's own soil and bed, at a fresh place, in a random direction and attitude."""
        row = landers.begin.rows[lander]
        if number == 0:
            return row
        journey = int(landers.begin.number[lander])
        seed = hashed_seed(self.model.seed, "landings between", landers.title, lander, journey, number)
        x, y, turn, *attitude = np.random.default_rng(seed).random(6).tolist()
        azimuth = 360.0 * turn
        spin = about_z(np.radians(azimuth)).apply(landers.spin[lander])
        return row | {
            "touchdown": float(number),
            TIME_LEFT: landers.duration - float(landers.time[lander]),
            SPEED: float(landers.speed[lander]),
            INCIDENCE: float(landers.incidence[lander]),
            "impact.azimuth_deg": azimuth,
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
