"""The deliveries of a requirement: their landers by the emulator, and at the corners by simulated landings."""

import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from lithobrake.analysis import share_estimate
from lithobrake.analysis.admissible_region import admissible_edge, verdict, with_grounds
from lithobrake.analysis.paired_differences import difference_bounds
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.answer.journey_limit_states import rest_values
from lithobrake.pipeline.answer.run_answers import is_on_one_ground, why_no_interval
from lithobrake.pipeline.design.bed_order import beds_of_runs
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.delivered_landers import DeliveredLanders
from lithobrake.pipeline.journeys.delivery_options import option_landers
from lithobrake.pipeline.journeys.emulated_journeys import follow_emulated
from lithobrake.pipeline.journeys.landers import StudyLanders, followed
from lithobrake.pipeline.journeys.simulated_touchdowns import Unanswered, WithLandings
from lithobrake.pipeline.journeys.touchdown_emulator import TouchdownEmulator
from lithobrake.pipeline.site_grid import beyond_words
from lithobrake.results.requirement_results import RequiredDelivery, RequirementEdge, SimulatedCorner
from lithobrake.results.site_results import MOST_UNKNOWN
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.quantities import REST_NUMBERS
from lithobrake.vocabulary.requirement import Verdict

TITLE = "landers of the deliveries"


@dataclass(frozen=True)
class Asked:
    """A requirement: at least so large a probability of a limit state, by an interval of this level.

    grid: ascending values by dotted key of [delivery].
    """

    state: LimitState
    required: float
    level: float
    grid: Mapping[str, Sequence[float]]

    @property
    def options(self) -> list[dict[str, float]]:
        """All deliveries, the last parameter fastest."""
        return [dict(zip(self.grid, values, strict=True)) for values in product(*self.grid.values())]


@dataclass(frozen=True)
class GridLanders:
    """Landers of several deliveries, [delivery_count, lander_count].

    met: 1, 0, or NaN where the outcome is unknown; down: which reached the ground; beyond: the input of an impact that
    the emulator did not know, or "".
    """

    met: np.ndarray
    bed: np.ndarray
    refit: np.ndarray
    down: np.ndarray
    beyond: np.ndarray

    @classmethod
    def of(
        cls,
        job: Job,
        delivered: DeliveredLanders,
        landers: StudyLanders,
        beyond: np.ndarray,
        state: LimitState,
        count: int,
    ) -> "GridLanders":
        """Landers that have been followed to their ends; count: deliveries."""
        columns = (
            *(landers.time, landers.ways_from_aims, landers.latitude, landers.longitude),
            *(landers.touchdowns.astype(float), landers.path_length),
        )
        numbers = {name: delivered.of_all(one) for name, one in zip(REST_NUMBERS, columns, strict=True)}
        met = limit_state_met(state, rest_values(delivered.ends(landers).astype(str), numbers))
        down = np.zeros(len(delivered.end), dtype=bool)
        down[delivered.place] = True
        study, number = job.study, delivered.number
        bed = np.array(beds_of_runs(study, int(number.max()) + 1))[number] % study.bed_count
        bed[delivered.place] = delivered.begin.column("bed").astype(int)
        found = (np.broadcast_to(met, bed.shape), bed, delivered.refit, down, delivered.of_all(beyond))
        return cls(*(one.reshape(count, -1) for one in found))

    def probability(self, row: int, fitted: Refits, level: float, *, one_ground: bool) -> Estimate:
        """That of the limit state at one delivery, with an interval for whatever became of landers of unknown outcome.

        one_ground: that of one ground, as far as grounds differ for the emulator.
        """
        met, refit = self.met[row], self.refit[row]
        everyone, known = np.ones(len(met), dtype=bool), np.isfinite(met)
        ends = []
        for fill in (0.0, 1.0):
            filled = np.where(known, met, fill)
            found = fitted.share(filled == 1.0, everyone, refit, level)
            ends.append(with_grounds(found, filled, self.bed[row], level) if one_ground else found)
        value = float(met[known].mean()) if known.any() else math.nan
        return Estimate(value, ends[0].lower, ends[1].upper, level)


def follow_deliveries(job: Job, asked: Asked, lander_count: int) -> GridLanders:
    """Follow so many landers of each delivery by the emulator, without a landing; all have the same landers."""
    delivered = option_landers(job.design, asked.options, lander_count)
    emulator = TouchdownEmulator.read(job.design, job.folder)
    found = follow_emulated(job, emulator, delivered.begin, TITLE, 0)
    return GridLanders.of(job, delivered, found.landers, found.beyond, asked.state, len(asked.options))


def required_deliveries(job: Job, asked: Asked, landers: GridLanders, fitted: Refits) -> tuple[RequiredDelivery, ...]:
    """Every delivery with its probability and its verdict."""
    found, one_ground = [], is_on_one_ground(job.study)
    for row, option in enumerate(asked.options):
        probability = landers.probability(row, fitted, asked.level, one_ground=one_ground)
        unknown = float(np.isnan(landers.met[row]).mean())
        is_outside = unknown > MOST_UNKNOWN
        found.append(
            RequiredDelivery(
                tuple(option.values()),
                probability,
                unknown,
                beyond_words(landers.beyond[row]),
                Verdict.OUTSIDE if is_outside else verdict(probability, asked.required),
            )
        )
    return tuple(found)


def requirement_edges(asked: Asked, deliveries: Sequence[RequiredDelivery]) -> tuple[RequirementEdge, ...]:
    """The edge along each parameter at all values of the others."""
    grid = [tuple(values) for values in asked.grid.values()]
    shape, found = tuple(map(len, grid)), []
    numbers = np.arange(len(deliveries)).reshape(shape)
    for along, values in enumerate(grid):
        for line in np.moveaxis(numbers, along, -1).reshape(-1, len(values)):
            own = [deliveries[one] for one in line]
            told = [None if one.verdict is Verdict.OUTSIDE else one.probability for one in own]
            others = tuple(None if k == along else one for k, one in enumerate(own[0].values))
            found.append(RequirementEdge(along, others, admissible_edge(values, told, asked.required)))
    return tuple(found)


def region_corners(asked: Asked, deliveries: Sequence[RequiredDelivery]) -> tuple[int, ...]:
    """Numbers of the deliveries that meet the requirement and lie farthest out toward each corner of the grid."""
    met = [number for number, one in enumerate(deliveries) if one.verdict is Verdict.MET]
    if not met:
        return ()
    # In steps of the grid, as parameters have units of their own.
    shape = [len(values) for values in asked.grid.values()]
    steps = np.stack(np.unravel_index(met, shape), axis=1) / np.maximum(np.array(shape) - 1, 1)
    toward = (steps @ np.array(signs) for signs in product((-1.0, 1.0), repeat=len(shape)))
    return tuple(sorted({met[int(np.argmax(far))] for far in toward}))


def simulate_corners(
    job: Job, asked: Asked, emulated: GridLanders, fitted: Refits, corners: Sequence[int], count: int
) -> tuple[SimulatedCorner, ...]:
    """Simulate so many journeys at each corner; their first landers are those that the emulator has followed.

    emulated: the landers of all deliveries by the emulator.
    """
    options = [asked.options[one] for one in corners]
    delivered = option_landers(job.design, options, count)
    touchdown = WithLandings(job, delivered.begin, Unanswered(), sys.maxsize)
    landers = followed(job, delivered.begin, touchdown, "simulated journeys at the corners")
    nothing = np.full(len(delivered.begin.rows), "", dtype="<U1")
    found = GridLanders.of(job, delivered, landers, nothing, asked.state, len(corners))
    simulated = []
    for row, corner in enumerate(corners):
        landings = _share_of_landings(job, found, row)
        # Landings give the mean over beds: what one ground would give is another number.
        emulator = emulated.probability(corner, fitted, landings.level, one_ground=False)
        bounds = difference_bounds(landings, emulator)
        agrees = None if bounds is None else bounds[0] <= 0.0 <= bounds[1]
        simulated.append(SimulatedCorner(tuple(options[row].values()), count, landings, emulator, agrees))
    return tuple(simulated)


def _share_of_landings(job: Job, found: GridLanders, row: int) -> Estimate:
    """The probability by the simulated journeys at a corner, as a mean over beds. Raises ValueError for no outcome."""
    met = found.met[row]
    if not np.isfinite(met).any():
        raise ValueError(
            f"none of {len(met)} simulated journeys at a corner has a known outcome; allowed: landings that end; raise "
            "landing.time_limit, or correct the program that makes them"
        )
    return share_estimate(met, found.bed[row], why=why_no_interval(job.study)).share
