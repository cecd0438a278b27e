"""The emulator of all touchdowns of a study's journeys."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import AttitudeTerms
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import PREFIX, attitude_terms, named_terms
from lithobrake.pipeline.first_touchdown.emulator import (
    RIDERS,
    DrawnLandings,
    fitted,
    inputs_met,
    outputs_of_runs,
    with_attitude,
)
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import EnergyBound, energy_bound, height_of_beds
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.results.named_emulator import trained_range
from lithobrake.smallbody.touchdown import Answers
from lithobrake.study import Study
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.file_names import TOUCHDOWN_EMULATOR_FILE
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    GROUND,
    IMPACT_SPEED,
    JOURNEY_DESIGN,
    OF_TOUCHDOWN,
    SPIN,
    TO_REST,
)

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

    from lithobrake.chaos import Distribution
    from lithobrake.emulator import Emulator

# Another file than that of single landings, whose inputs are those of the study alone.
GRAVITY, SLOPE, _ = GROUND
ALONG, ASIDE, DURATION, _, RISE = TO_REST
# Tables of which the emulator has these keys alone: what else they hold is drawn at every touchdown.
ARRIVAL_TABLES = ("impact.", "surface.")


@dataclass(frozen=True)
class TouchdownEmulator:
    """The emulator of a study's touchdowns.

    refits: of the emulator to beds drawn with replacement. terms: of the lander's attitude that it reads, None for a
    ball. bed: of each touchdown that it was fitted to. ranges: of the
    inputs of OF_TOUCHDOWN, beyond which it has no answer. rest: duration [s] and way along and aside [m] of the
    touchdowns in which a lander came to rest, [count, 3]. across [m]: the longest way of a touchdown. bed_height [m]:
    of the highest bed.
    """

    design: DrawnDesign
    refits: "list[Emulator]"
    terms: AttitudeTerms | None
    bed: np.ndarray
    ranges: Mapping[str, tuple[float, float]]
    rest: np.ndarray
    across: float
    bed_height: float

    @classmethod
    def read(cls, design: DrawnDesign, folder: StudyFolder) -> "TouchdownEmulator":
        """The one that was fitted. Raises ValueError for a file that is damaged."""
        from lithobrake import emulator

        study, model = design.study, emulator.load(folder / TOUCHDOWN_EMULATOR_FILE)
        runs = DesignRuns.load(folder, JOURNEY_DESIGN)
        rests = np.array(runs.outcomes) == TouchdownOutcome.CAPTURED
        rest = np.column_stack([np.nan_to_num(runs.output(name)) for name in (DURATION, ALONG, ASIDE)])[rests]
        bed = runs.inputs["bed"][np.isin(runs.outcomes, model.outcome_names)].astype(int)
        refits = model.refits(REFIT_COUNT, hashed_seed(study.seed, "refits"))
        height = height_of_beds(study, folder)
        terms = attitude_terms(study)
        return cls(design, refits, terms, bed, trained_ranges(study, runs), rest, _across(runs), height)

    @property
    def inputs(self) -> tuple[str, ...]:
        """What it reads of a touchdown, by dotted key."""
        return tuple(self.refits[0].runs.inputs)

    @property
    def plain_inputs(self) -> tuple[str, ...]:
        return tuple(name for name in self.inputs if not name.startswith(PREFIX))

    def attitude_of(self, attitude: "Rotation") -> dict[str, np.ndarray]:
        """The terms of attitudes in the frames of their touchdowns [count] as inputs; none for a ball."""
        into_frame = attitude.as_matrix()
        return {} if self.terms is None else named_terms(self.terms, into_frame[:, 2], into_frame[:, 0])

    def unseen(self, bed: int) -> np.ndarray:
        """Places of the refits that have not seen a bed."""
        there = self.bed == bed
        return np.flatnonzero([not model.weights[there].any() for model in self.refits])

    def beyond(self, inputs: Mapping[str, np.ndarray]) -> np.ndarray:
        """Which input of each touchdown lies beyond the ranges, the first of them, [count]; "" where none does."""
        found = np.full(len(next(iter(inputs.values()))), "", dtype="<U24")
        for name, (lower, upper) in self.ranges.items():
            # Whoever asks with the inputs alone asks for what all touchdowns have in common.
            if name not in inputs:
                continue
            # To rest no speed is too low: such a touchdown is as the slowest of them.
            is_any = name == IMPACT_SPEED and self.design.study.journey.touchdowns is None
            outside = (inputs[name] > upper) | ((inputs[name] < lower) & (not is_any))
            found[outside & (found == "")] = name
        return found

    def answers(self, inputs: Mapping[str, np.ndarray], spin: np.ndarray, refit: np.ndarray, seed: int) -> Answers:
        """Draw how touchdowns end, each by its refit [count]; nothing is known of those beyond the ranges.

        inputs: by dotted key in the file's units, [count] each. spin: of the arrival [rad/s], [count, 3].
        """
        found = Answers.unknown(len(refit))
        inside = self.beyond(inputs) == ""
        # Slower than any touchdown is as the slowest of them, which has more energy to leave with.
        if IMPACT_SPEED in self.inputs:
            inputs = {**inputs, IMPACT_SPEED: np.maximum(inputs[IMPACT_SPEED], self.ranges[IMPACT_SPEED][0])}
        values = {name: inputs[name] for name in self.inputs} | dict(zip(SPIN, spin.T, strict=True))
        bound = energy_bound(self.design, self.bed_height, values, len(refit), self.across)
        x = np.column_stack([inputs[name] for name in self.inputs])
        random = np.random.default_rng(seed)
        # All refits take a seed, whether landers of theirs touch down or not.
        for number, own in enumerate(random.integers(2**31, size=len(self.refits)).tolist()):
            of_refit = np.flatnonzero(inside & (refit == number))
            if len(of_refit):
                self._draw(found, of_refit, self.refits[number], x[of_refit], bound.at(of_refit), own)
        return found

    def _draw(
        self, found: Answers, which: np.ndarray, model: "Emulator", x: np.ndarray, bound: EnergyBound, seed: int
    ) -> None:
        drawn = DrawnLandings.of(model, x, bound, seed)
        names = np.array(model.outcome_names)
        found.outcome[which] = names[drawn.outcome]
        left = names[drawn.outcome] == TouchdownOutcome.CLEAR
        found.velocity[which[left]], found.spin[which[left]] = drawn.velocity[left], drawn.spin[left]
        if DURATION in drawn.outputs:
            found.duration[which[left]] = drawn.outputs[DURATION][left]
        if RISE in drawn.outputs:
            found.rise[which[left]] = drawn.outputs[RISE][left]
        rests = which[found.outcome[which] == TouchdownOutcome.CAPTURED]
        # Nothing is fitted to touchdowns that end at rest: how long and far they go is that of one of them.
        if not len(rests):
            return
        taken = self.rest[np.random.default_rng(seed).integers(len(self.rest), size=len(rests))]
        found.duration[rests], found.way[rests, :2] = taken[:, 0], taken[:, 1:]
        found.length[rests] = np.linalg.norm(found.way[rests], axis=1)


def fit_touchdowns(job: Job) -> str | None:
    """Fit the emulator to all touchdowns and write it; give the reason, in a sentence, where there is none."""
    runs = with_attitude(job.study, DesignRuns.load(job.folder, JOURNEY_DESIGN))
    why = _why_none(job.study, runs)
    if why is not None:
        job.folder.write_json(TOUCHDOWN_EMULATOR_FILE, {"why": why})
        return why
    values = {name: runs.inputs[name] for name in job.design.medians if name in runs.inputs}
    bound = energy_bound(job.design, height_of_beds(job.study, job.folder), values, runs.run_count, _across(runs))
    outputs = outputs_of_runs(runs, (*RIDERS, DURATION, RISE))
    met = [outcome for outcome in TouchdownOutcome if outcome in runs.outcomes]
    fitted(job, _inputs(job, runs), runs, outputs, bound, met).save(job.folder / TOUCHDOWN_EMULATOR_FILE)
    return None


def trained_ranges(study: Study, runs: DesignRuns) -> dict[str, tuple[float, float]]:
    """The ranges of OF_TOUCHDOWN, in the file's units, in which the emulator of touchdowns has an answer."""
    found = {}
    for name, (lower, upper) in runs.ranges(OF_TOUCHDOWN).items():
        ends = trained_range(name, lower, upper)
        # First touchdowns at one place have one ground: nothing is known of others, where landers are followed anyway.
        if study.journey.touchdowns is not None and name in GROUND and upper - lower < ends[1] - upper:
            continue
        found[name] = ends
    return found


def _inputs(job: Job, runs: DesignRuns) -> "dict[str, Distribution]":
    """Soil and lander as the study draws them or runs have met them, and what else differs, over its range."""
    from lithobrake.chaos import LogUniform, Uniform

    kept = {name: law for name, law in inputs_met(job.design, runs).items() if not name.startswith(ARRIVAL_TABLES)}
    # What is the same in all touchdowns says nothing of others; beyond it the emulator has no answer.
    varies = [name for name, (lower, upper) in runs.ranges(OF_TOUCHDOWN).items() if lower < upper]
    ranges = {name: ends for name, ends in trained_ranges(job.study, runs).items() if name in varies}
    found = kept | {name: (LogUniform if name == IMPACT_SPEED else Uniform)(*ends) for name, ends in ranges.items()}
    terms = attitude_terms(job.study)
    of_attitude = {} if terms is None else terms.ranges
    return found | {f"{PREFIX}{name}": Uniform(*ends) for name, ends in of_attitude.items()}


def _why_none(study: Study, runs: DesignRuns) -> str | None:
    """Why there is nothing to fit an emulator to; None where there is enough."""
    from lithobrake.emulator.training_runs import FEWEST

    left, outcomes = runs.has_outputs, np.array(runs.outcomes)
    begin = "The study has no emulator of its touchdowns: "
    if left.sum() < FEWEST:
        return f"{begin}{int(left.sum())} of {runs.run_count} left the ground, and it needs {FEWEST}."
    if study.journey.touchdowns is None and not (outcomes == TouchdownOutcome.CAPTURED).any():
        return f"{begin}no lander came to rest."
    return None


def _across(runs: DesignRuns) -> float:
    """Longest way along the ground in a touchdown [m]; 0 where the runs do not say."""
    return float(np.nanmax(np.nan_to_num(np.hypot(runs.output(ALONG), runs.output(ASIDE)))))


def why_no_emulator(content: Mapping[str, Any]) -> str | None:
    """The reason that a file of an emulator holds in its place; None where there is an emulator."""
    why = content.get("why")
    return None if why is None else str(why)
