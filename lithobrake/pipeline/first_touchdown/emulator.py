"""The emulator of drawn runs, and its draws."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.analysis import sample_inputs
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign, inputs_of
from lithobrake.pipeline.design.lander_attitude import PREFIX, attitude_laws, drawn_attitudes, told_attitudes
from lithobrake.pipeline.first_touchdown.explorer_tables import write_explorer
from lithobrake.pipeline.first_touchdown.samples import VELOCITY, Samples, outgoing_velocity, rolling_spin
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import (
    EnergyBound,
    across_of,
    bound_of_runs,
    energy_bound,
    height_of_beds,
    runs_beyond,
)
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.file_names import EMULATOR_FILE
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import OUTPUTS, SPIN_OUT

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution
    from lithobrake.emulator import Emulator

SPEED, ELEVATION, AZIMUTH, SPIN = "speed_out", "elevation_out", "azimuth_out", "spin_out"
STEEPEST = 0.5 * math.pi
# What is drawn with its run: directions, and numbers beside the motion.
RIDERS = (AZIMUTH, *SPIN_OUT, "contact_duration", "penetration", "peak_acceleration", "energy_lost")
# A lander that leaves straight up, or does not turn, is put this far inside the bounds of what is drawn.
MARGIN = 1e-6


def fit_emulator(job: Job) -> None:
    """Fit the emulator of the first touchdown and write it, or the reason why there is none.

    Raises ValueError where there is none and the study asks for its samples.
    """
    from lithobrake.emulator.training_runs import FEWEST

    runs = with_attitude(job.study, DesignRuns.load(job.folder, "drawn"))
    left = int(runs.has_outputs.sum())
    if left < FEWEST:
        why = f"{left} of {runs.run_count} landers left the surface, but an emulator needs {FEWEST}"
        if job.study.sample_count and job.study.expansion is None:
            remedy = job.study.as_written("raise design.run_count")
            raise ValueError(f"{why}; {remedy}, or set monte_carlo.sample_count to 0")
        job.folder.write_json(EMULATOR_FILE, {"why": f"{why}."})
        return
    bound, outputs = bound_of_runs(job.design, job.folder, runs), outputs_of_runs(runs, RIDERS)
    inputs = inputs_met(job.design, runs) | attitude_laws(job.design, runs.inputs)
    fitted(job, inputs, runs, outputs, bound, tuple(TouchdownOutcome)).save(job.folder / EMULATOR_FILE)


def with_attitude(study: Study, runs: DesignRuns) -> DesignRuns:
    """The runs with the terms of their attitudes among their inputs, where they tell them."""
    return replace(runs, inputs={**runs.inputs, **told_attitudes(study, runs.inputs)})


def inputs_met(design: DrawnDesign, runs: DesignRuns) -> "dict[str, Distribution]":
    """The inputs of touchdowns with their laws: those of the study; of what landers meet on their way, its range."""
    found = design.grounds.laws | design.inputs
    for name in design.met_on_the_way:
        reaches = design.reaches_met(name) or [(float(runs.inputs[name].min()), float(runs.inputs[name].max()))]
        ends = [end for reach in reaches for end in reach]
        if min(ends) < max(ends):
            found[name] = _over(design.inputs.get(name), min(ends), max(ends))
    return found


def _over(law: "Distribution | None", lower: float, upper: float) -> "Distribution":
    """A law over a range, on the scale of another one."""
    from lithobrake.chaos import LogUniform, Uniform

    return (LogUniform if isinstance(law, LogUniform) else Uniform)(lower, upper)


def why_no_emulator(content: Mapping[str, Any]) -> str | None:
    """The reason that a file of an emulator holds in its place; None where there is an emulator."""
    why = content.get("why")
    return None if why is None else str(why)


def fitted(
    job: Job,
    inputs: "Mapping[str, Distribution]",
    runs: DesignRuns,
    outputs: dict[str, np.ndarray],
    bound: EnergyBound,
    outcomes: Sequence[str],
) -> "Emulator":
    """The emulator of runs that ended in one of some outcomes; runs of a bed are left out together.

    outputs: by name [run_count], as `outputs_of_runs` gives them. bound: what energy allows each run; it does not count
    where some run left with more.
    """
    from lithobrake import emulator

    ended = np.isin(runs.outcomes, outcomes)
    bed = runs.inputs["bed"].astype(int)[ended]
    upper = np.full((runs.run_count, len(outputs)), np.inf)
    upper[:, list(outputs).index(ELEVATION)] = STEEPEST
    # Between 0 and the bound the emulator works in the logit, so that no draw exceeds the energy of the impact.
    if _is_kept(job, runs, bound):
        upper[:, list(outputs).index(SPEED)], upper[:, list(outputs).index(SPIN)] = bound.speed, bound.spin()
    modelled = (SPEED, ELEVATION, SPIN)
    return emulator.fit(
        inputs,
        runs.columns(list(inputs))[ended],
        np.column_stack(list(outputs.values()))[ended],
        # One bed cannot be left out of itself, so its runs are then left out singly.
        groups=bed if len(np.unique(bed[runs.has_outputs[ended]])) > 1 else None,
        outcome=np.array(runs.outcomes)[ended],
        outcomes=outcomes,
        lower=[0.0 if name in modelled else -np.inf for name in outputs],
        upper=upper[ended],
        riders=[name for name in outputs if name not in modelled],
        output_names=list(outputs),
    )


def over_attitudes(model: "Emulator") -> "Emulator":
    """The emulator of the same runs whose scatter has the attitude in it, for whoever does not know that.

    Raises ValueError where it has no other input.
    """
    from lithobrake import emulator

    runs = model.runs
    laws = {name: law for name, law in runs.inputs.items() if not name.startswith(PREFIX)}
    if len(laws) == len(runs.inputs):
        return model
    if not laws:
        raise ValueError("the emulator reads nothing but the attitude; give a number of the soil a distribution")
    y, upper = np.full((2, len(runs.x), runs.y.shape[1]), np.nan)
    y[runs.has_outputs], upper[:] = runs.y, np.inf
    upper[runs.has_outputs] = runs.upper
    return emulator.fit(
        laws,
        runs.x[:, [name in laws for name in runs.inputs]],
        y,
        groups=runs.group,
        outcome=np.array(runs.outcome_names)[runs.outcome],
        outcomes=runs.outcome_names,
        lower=runs.lower[0],
        upper=upper,
        riders=runs.riders,
        output_names=runs.output_names,
    )


def _is_kept(job: Job, runs: DesignRuns, bound: EnergyBound) -> bool:
    """Whether every run left within what energy allows; said aloud where some did not."""
    beyond = runs_beyond(runs, bound)
    if beyond:
        job.say(
            f"{beyond} of {runs.run_count} runs left with more speed and spin than the impact energy allows, so the "
            "emulator bounds neither; find the source of energy in the program that simulates the touchdowns, or give "
            "lander.inertia"
        )
    return not beyond


def outputs_of_runs(runs: DesignRuns, riders: Sequence[str]) -> dict[str, np.ndarray]:
    """What the emulator draws, by name [run_count]: NaN in the runs that did not leave, and in no other."""
    left = runs.has_outputs
    found = {name: runs.output(name) for name in (SPEED, ELEVATION, SPIN, *riders)}
    _, across, _ = VELOCITY
    found[AZIMUTH] = np.arctan2(runs.output(across), runs.output(VELOCITY[0]))
    found[ELEVATION] = np.clip(found[ELEVATION], MARGIN * STEEPEST, (1.0 - MARGIN) * STEEPEST)
    found[SPIN] = np.maximum(found[SPIN], MARGIN * max(float(np.max(found[SPIN][left], initial=0.0)), MARGIN))
    # A program of the user's own may leave out what no flight needs.
    return {name: np.where(left, y, np.nan) for name, y in found.items() if np.isfinite(y[left]).all()}


def refits(job: Job) -> "list[Emulator]":
    """The emulator fitted anew to beds drawn with replacement, the same ones at every call."""
    from lithobrake import emulator

    return emulator.load(job.folder / EMULATOR_FILE).refits(REFIT_COUNT, hashed_seed(job.study.seed, "refits"))


@dataclass(frozen=True)
class DrawnLandings:
    """Landings drawn from an emulator.

    outcome [count], places among the touchdown outcomes; outputs by name [count], SI, NaN where the lander did not
    leave; velocity and spin [count, 3].
    """

    outcome: np.ndarray
    outputs: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, model: "Emulator", x: np.ndarray, bound: EnergyBound, seed: int) -> "DrawnLandings":
        """Draw one at each x [count, input_count]; bound: what energy allows each."""
        upper = np.tile(model.runs.upper[0], (len(x), 1))
        speed, spin = (model.output_names.index(name) for name in (SPEED, SPIN))
        bounded = bool(np.isfinite(model.runs.upper[0, speed]))
        if bounded:
            upper[:, speed], upper[:, spin] = bound.speed, bound.spin()
        drawn = model.draw(x, 1, seed, lower=model.runs.lower[0], upper=upper)
        y = drawn.y[:, 0]
        if bounded:
            # Each is within its own bound; what the speed has taken is not there for the spin.
            y[:, spin] = np.minimum(y[:, spin], bound.spin(y[:, speed]))
        return cls(drawn.outcome[:, 0], dict(zip(model.output_names, y.T, strict=True)))

    @cached_property
    def velocity(self) -> np.ndarray:
        """Velocity [m/s] in the frame of the touchdown, of the drawn speed, elevation and azimuth, [count, 3]."""
        return outgoing_velocity(*(self.outputs[name] for name in (SPEED, ELEVATION, AZIMUTH)))

    @cached_property
    def spin(self) -> np.ndarray:
        """Angular velocity [rad/s], of the drawn size about the axis of the run that was drawn, [count, 3].

        Where runs do not tell the axis it is that of rolling along the velocity.
        """
        if SPIN_OUT[0] not in self.outputs:
            return rolling_spin(self.velocity, self.outputs[SPIN])
        axis = np.column_stack([self.outputs[name] for name in SPIN_OUT])
        length = np.linalg.norm(axis, axis=1, keepdims=True)
        spin: np.ndarray = axis / np.where(length > 0.0, length, 1.0) * self.outputs[SPIN][:, None]
        return spin

    def table(self) -> dict[str, np.ndarray]:
        """All outputs by name [count], those that are fitted to in a study of the other method first."""
        of_vectors = dict(zip((*VELOCITY, *SPIN_OUT), np.hstack([self.velocity, self.spin]).T, strict=True))
        found = {**self.outputs, **of_vectors}
        return {name: found[name] for name in dict.fromkeys((*OUTPUTS, *found))}


def draw_emulator_samples(job: Job) -> None:
    """Sample all inputs and draw a landing for each; sample i comes from refit i modulo REFIT_COUNT.

    So every share of the samples has its scatter over refits in itself, and no flight is made for an interval alone.
    """
    models = refits(job)
    drawn_samples(job, models, _sampled(job, models[0].runs.inputs), "draws").save(job.folder)
    write_explorer(job, models)


def _sampled(job: Job, laws: "Mapping[str, Distribution]") -> np.ndarray:
    """Points [sample_count, input_count] over the laws of the study, and over its attitudes."""
    study, design = job.study, job.design
    runs = DesignRuns.load(job.folder, "drawn")
    if design.met_on_the_way:
        # Of landers behind those of the study: what these meet follows from where they come down.
        first = len(design.beds)
        rows = design.on_known_beds(first + study.sample_count).rows[len(design.rows) :]
        values = dict(zip(rows[0], inputs_of(rows, list(rows[0])).T, strict=True))
        values |= told_attitudes(study, values)
    else:
        x = sample_inputs(design.inputs, study.sample_count, hashed_seed(study.seed, "samples"))
        values = dict(zip(design.inputs, x.T, strict=True))
        seed = hashed_seed(study.seed, "attitudes of samples")
        values |= drawn_attitudes(design, runs.inputs, values, len(x), seed)
    return points_within(laws, values)


def points_within(laws: "Mapping[str, Distribution]", values: Mapping[str, np.ndarray]) -> np.ndarray:
    """Points [count, input_count] of values by name; what no run had is as the nearest that one had."""
    return np.column_stack([np.clip(values[name], *law.support) for name, law in laws.items()])


def drawn_samples(job: Job, models: "Sequence[Emulator]", x: np.ndarray, purpose: str) -> Samples:
    """Draw a landing at each x [sample_count, input_count]; sample i by the model of i modulo their number.

    purpose: of the random numbers.
    """
    study, inputs = job.study, list(models[0].runs.inputs)
    height, across = height_of_beds(study, job.folder), across_of(study, job.folder)
    bound = energy_bound(job.design, height, dict(zip(inputs, x.T, strict=True)), len(x), across)
    names: list[str] = []
    outputs, outcome = np.empty((len(x), 0)), np.empty(len(x), dtype=np.uint8)
    for number, model in enumerate(models):
        job.progress(number, len(models), "samples")
        # Interleaved, so that the first samples, which are flown, are of all refits.
        part = slice(number, None, len(models))
        drawn = DrawnLandings.of(model, x[part], bound.at(part), hashed_seed(study.seed, purpose, number))
        table = drawn.table()
        if not names:
            names, outputs = list(table), np.empty((len(x), len(table)))
        outputs[part], outcome[part] = np.column_stack(list(table.values())), drawn.outcome
    return Samples(inputs, names, x, outputs, outcome)
