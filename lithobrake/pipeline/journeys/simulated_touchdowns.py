"""Touchdowns by simulated landings, or by a program of the user's, and landings where another model has no answer."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.campaign import Record, RunStatus
from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import attitude_of, spin_of, uniform_attitude
from lithobrake.pipeline.design import arrivals
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.first_arrivals import Arrivals, Row
from lithobrake.pipeline.journeys.landers import touchdown_uniforms
from lithobrake.pipeline.runs.landings import touchdowns
from lithobrake.smallbody.touchdown import Answers, ImpactStates, Touchdown
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    ELSEWHERE,
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    ORIENTATION_OUT,
    PLACE,
    SOIL,
    TIME_LEFT,
    TO_REST,
    VELOCITY_OUT,
)

ALONG, ASIDE, DURATION, CONTACTS, RISE = TO_REST
# Of these landings alone: what the study says of its runs is of those of its journeys.
LEDGER = "emulated.sqlite"


@dataclass(frozen=True)
class LandingRows:
    """Inputs of the simulated landings of landers: each has its own soil and bed, and an impact point of its own."""

    design: DrawnDesign
    begin: Arrivals

    def of(self, impacts: ImpactStates) -> list[Row]:
        """The inputs of the landings, in the order of the impacts."""
        return [self._row(impacts, place) for place in range(len(impacts))]

    def _row(self, impacts: ImpactStates, place: int) -> Row:
        lander, number = int(impacts.lander[place]), int(impacts.number[place])
        row, journey = self.begin.rows[lander], int(self.begin.number[lander])
        if number == 0:
            return row | self._ground(impacts, place, row, row[IMPACT_AZIMUTH])
        x, y, turn, *_ = touchdown_uniforms(self.design.study.seed, journey, number)
        ground = int(impacts.ground[place])
        row = row | self._patch(lander, journey, impacts.position[place], ground)
        azimuth, row = 360.0 * turn, row | self._soil(journey, impacts.position[place], ground)
        attitude, axes = impacts.attitude[place], impacts.axes[place]
        if attitude is None:
            attitude = self._any_attitude(journey, number)
        arrival = {
            "touchdown": float(number),
            TIME_LEFT: float(impacts.left[place]),
            IMPACT_SPEED: float(impacts.speed[place]),
            IMPACT_INCIDENCE: min(float(impacts.incidence_deg[place]), arrivals.FLATTEST_DEG),
            IMPACT_AZIMUTH: azimuth,
            **arrivals.attitude_inputs(axes, azimuth, attitude, impacts.spin[place]),
            **dict(zip(PLACE, self._place(x, y, row), strict=True)),
            **self._ground(impacts, place, row, azimuth),
        }
        if arrivals.MEAN_INCIDENCE in row:
            arrival[arrivals.MEAN_INCIDENCE] = float(impacts.mean_incidence_deg[place])
        return row | arrival

    def _ground(self, impacts: ImpactStates, place: int, row: Row, azimuth: float) -> Row:
        if not self.design.study.has_local_ground:
            return {}
        met = arrivals.ground_inputs(impacts.acceleration[place].tolist(), azimuth, arrivals.friction_of(row))
        return met | arrivals.rotation_inputs(impacts.rotation[place].tolist(), azimuth)

    def _any_attitude(self, journey: int, number: int) -> Rotation:
        """A lander that has bounced tumbles for minutes before it comes down again."""
        seed = hashed_seed(self.design.study.seed, "attitudes of touchdowns", journey, number)
        quaternion = uniform_attitude(*np.random.default_rng(seed).random(3).tolist())
        return Rotation.from_quat(quaternion, scalar_first=True)

    def _place(self, x: float, y: float, row: Row) -> tuple[float, float]:
        """Where on its bed a lander comes down [m], of two uniform numbers; always at one place without a region."""
        region = self.design.grounds.region(int(row["bed"]))
        if region is None:
            return row[PLACE[0]], row[PLACE[1]]
        (west, east), (south, north) = region
        return west + x * (east - west), south + y * (north - south)

    def _patch(self, lander: int, journey: int, place: np.ndarray, ground: int) -> Row:
        """The bed that a lander meets at a place [m], [3], and what it reads of its ground; nothing of one ground."""
        if self.design.study.ground is None:
            return {}
        first, bodies = self.begin.origin[lander], (int(self.begin.ground[lander]), ground)
        bed = self.design.grounds.bed_at(journey, int(self.begin.rows[lander]["bed"]), first, place, bodies)
        own = {name: float(values[0]) for name, values in self.design.own_soils(np.array([journey])).items()}
        return own | self.design.grounds.of(bed, own)

    @cached_property
    def _soils(self) -> Soils:
        return Soils(self.design.site)

    def _soil(self, journey: int, place: np.ndarray, ground: int) -> Row:
        """The numbers of the grains that a lander meets at a place [m], [3], by dotted key; none where no region has a
        soil of its own, and all ground is what the lander met first. Regions are of the body of the site alone.
        """
        if not self.design.study.soil:
            return {}
        own = self.design.own_soils(np.array([journey]))
        met = own if ground else self._soils.met(np.array([journey]), own, place[None])
        return {key: float(values[0]) for key, values in met.items()}

    def soil_column(self, place: np.ndarray, ground: int) -> dict[str, str]:
        """The region of a touchdown at a place [m], [3], as its table has it; nothing where there are no regions."""
        if not self.design.study.soil:
            return {}
        return dict(zip(SOIL, [ELSEWHERE] if ground else self._soils.at(place[None]), strict=True))


def answers_of(records: Sequence[Record]) -> Answers:
    """How landings ended."""
    found = Answers.unknown(len(records))
    for place, record in enumerate(records):
        outputs = record.outputs
        if record.status == RunStatus.FAILED:
            found.outcome[place], found.reason[place] = RunStatus.FAILED.value, record.reason or ""
            continue
        along, aside = outputs.get(ALONG, 0.0), outputs.get(ASIDE, 0.0)
        found.outcome[place] = str(record.outcome)
        found.way[place], found.length[place] = (along, aside, 0.0), math.hypot(along, aside)
        # A program of the user's own may give the duration of the contact alone.
        found.duration[place] = outputs.get(DURATION, outputs.get("contact_duration", 0.0))
        found.rise[place] = outputs.get(RISE, 0.0)
        found.contacts[place] = max(1, round(outputs.get(CONTACTS, 1.0)))
        is_clear = record.outcome == TouchdownOutcome.CLEAR
        # A touchdown that ends as the lander is captured has no attitude; a program that has none leaves it unturned.
        found.attitude[place] = attitude_of(outputs) if is_clear or ORIENTATION_OUT[0] in outputs else None
        if is_clear:
            found.velocity[place], found.spin[place] = [outputs[name] for name in VELOCITY_OUT], spin_of(outputs)
    return found


class Unanswered:
    """No model's touchdowns: all of them are left to landings."""

    def answers(self, impacts: ImpactStates) -> Answers:
        """Nothing is known of any."""
        return Answers.unknown(len(impacts))


@dataclass
class WithLandings:
    """Another model's touchdowns, and simulated landings where it has no answer, at most `most` of them.

    landings: made for each lander so far, [lander_count].
    """

    job: Job
    begin: Arrivals
    touchdown: Touchdown
    most: int
    landings: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        self.landings = np.zeros(len(self.begin.rows), dtype=np.int64)

    def answers(self, impacts: ImpactStates) -> Answers:
        """Land at the first impacts without an answer, as long as landings are left; of others nothing is known."""
        found = self.touchdown.answers(impacts)
        asked = np.flatnonzero(~found.is_known)[: self.most - int(self.landings.sum())]
        if len(asked):
            rows = LandingRows(self.job.design, self.begin).of(impacts.at(asked))
            runs = touchdowns(self.job, rows, "landings where the emulator has no answer", 0, LEDGER)
            found.fill(asked, answers_of(runs.records))
            self.landings[impacts.lander[asked]] += 1
        return found
