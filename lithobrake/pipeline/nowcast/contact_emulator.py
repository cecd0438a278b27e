"""First contacts of a study's landers, many more than it simulated: all numbers that a lander could have observed."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace

import numpy as np

from lithobrake.analysis.subset_simulation import ALSO_OF_CAPTURED
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.emulator import (
    AZIMUTH,
    ELEVATION,
    SPEED,
    SPIN,
    STEEPEST,
    DrawnLandings,
    outgoing_velocity,
)
from lithobrake.pipeline.inferred_study import SPEED_CHANGE
from lithobrake.pipeline.journeys.emulated_touchdowns import EmulatedTouchdowns
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.pipeline.journeys.touchdown_emulator import DURATION, RISE, TouchdownEmulator
from lithobrake.pipeline.runs.energy_bound import energy_bound
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.results.site_results import MOST_UNKNOWN
from lithobrake.smallbody.touchdown import Answers, ImpactStates
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.given_numbers import without_rounding
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import IMPACT_INCIDENCE, IMPACT_SPEED
from lithobrake.vocabulary.quantities import SPIN as SPIN_IN

TITLE = "first contacts"
# Numbers of a contact that a lander can measure, beside its motion after it.
OF_CONTACT = ALSO_OF_CAPTURED


def contact_bounds(output_names: Collection[str]) -> dict[str, tuple[float, float]]:
    """Outputs that may be observed, by name, with the smallest and largest value that each may have [SI]."""
    found = {name: (0.0, np.inf) for name in (SPEED, SPIN, *OF_CONTACT) if name in output_names}
    return found | {ELEVATION: (0.0, STEEPEST), SPEED_CHANGE: (0.0, np.inf)}


@dataclass(frozen=True)
class AskedTouchdowns(TouchdownEmulator):
    """The emulator that notes what it is asked; asked: inputs and spins [count, 3] of each question."""

    asked: list[tuple[Mapping[str, np.ndarray], np.ndarray]] = field(default_factory=list)

    def answers(self, inputs: Mapping[str, np.ndarray], spin: np.ndarray, refit: np.ndarray, seed: int) -> Answers:
        """As the emulator."""
        self.asked.append((inputs, spin))
        return super().answers(inputs, spin, refit, seed)


def contact_emulator(design: DrawnDesign, folder: StudyFolder, observed: Collection[str]) -> TouchdownEmulator:
    """The emulator of a study's touchdowns, in which what was observed of a contact follows the inputs as well.

    In the file such numbers are drawn with the motion of a run unchanged. Those that never vary stay so.
    """
    found = TouchdownEmulator.read(design, folder)
    runs = found.refits[0].runs
    riders, varied = [runs.output_names[column] for column in runs.riders], without_rounding(runs.y)
    modelled = [
        name
        for name in riders
        if name in observed and name in OF_CONTACT and np.ptp(varied[:, runs.output_names.index(name)]) > 0.0
    ]
    if not modelled:
        return found
    from lithobrake import emulator

    def of_all(table: np.ndarray, empty: np.ndarray | float) -> np.ndarray:
        whole = np.tile(empty, (len(runs.x), 1)) * np.ones(table.shape[1])
        whole[runs.has_outputs] = table
        return whole

    lower = of_all(runs.lower, runs.lower[0])
    lower[
        :,
        [runs.output_names.index(name) for name in modelled if (runs.y[:, runs.output_names.index(name)] > 0.0).all()],
    ] = 0.0
    model = emulator.fit(
        runs.inputs,
        runs.x,
        of_all(runs.y, np.nan),
        groups=runs.group if len(np.unique(runs.group)) > 1 else None,
        outcome=np.array(runs.outcome_names)[runs.outcome],
        outcomes=runs.outcome_names,
        lower=lower,
        upper=of_all(runs.upper, runs.upper[0]),
        riders=[name for name in riders if name not in modelled],
        output_names=runs.output_names,
    )
    return replace(found, refits=model.refits(REFIT_COUNT, hashed_seed(design.study.seed, "refits")))


@dataclass(frozen=True)
class FirstContacts:
    """First contacts drawn from an emulator, several of each lander; nothing is known of those beyond its ranges.

    begin: the landers; lander [count]: of each contact its place among them; refit [count]; outcome [count]; outputs,
    by name [count], NaN of landers that did not leave; x: inputs of the landers' contacts, by dotted key
    [lander_count]; beyond [lander_count]: which input lies beyond the ranges, "" for none.
    """

    emulator: TouchdownEmulator
    begin: Arrivals
    lander: Integers
    refit: Integers
    outcome: np.ndarray
    outputs: dict[str, Array]
    axis: Array
    x: Mapping[str, Array]
    beyond: np.ndarray

    @classmethod
    def drawn(cls, emulator: TouchdownEmulator, begin: Arrivals, copies: int) -> "FirstContacts":
        """So many contacts of each lander, by one refit after the other."""
        design, count = emulator.design, len(begin.rows)
        asked = AskedTouchdowns(*(getattr(emulator, one.name) for one in fields(emulator)))
        impacts = StudyLanders.of(design, begin).impacts(np.arange(count))
        EmulatedTouchdowns(asked, begin, TITLE).answers(impacts)
        inputs, spin = asked.asked[0]
        beyond = emulator.beyond(inputs)
        lander = np.repeat(np.flatnonzero(beyond == ""), copies)
        refit = np.arange(len(lander)) % len(emulator.refits)
        at = {name: inputs[name] for name in emulator.inputs}
        if IMPACT_SPEED in at:
            at[IMPACT_SPEED] = np.maximum(at[IMPACT_SPEED], emulator.ranges[IMPACT_SPEED][0])
        values = at | dict(zip(SPIN_IN, spin.T, strict=True))
        bound = energy_bound(design, emulator.bed_height, values, count, emulator.across)
        x, seed = np.column_stack(list(at.values())), hashed_seed(design.study.seed, TITLE)
        names = emulator.refits[0].output_names
        outputs = {name: np.full(len(lander), np.nan) for name in names}
        outcome, axis = np.full(len(lander), "", dtype="<U24"), np.zeros((len(lander), 3))
        for number, model in enumerate(emulator.refits):
            which = np.flatnonzero(refit == number)
            drawn = DrawnLandings.of(model, x[lander[which]], bound.at(lander[which]), seed + number)
            outcome[which] = np.array(model.outcome_names)[drawn.outcome]
            for name in names:
                outputs[name][which] = drawn.outputs[name]
            axis[which] = drawn.spin
        outputs[SPEED_CHANGE] = _change(outputs, at, lander)
        return cls(emulator, begin, lander, refit, outcome, outputs, _unit(axis), at, beyond)

    def beyond_input(self) -> str | None:
        """The input beyond whose range most of the landers are that are left out; None where none is."""
        names, counts = np.unique(self.beyond[self.beyond != ""], return_counts=True)
        return str(names[counts.argmax()]) if len(names) else None

    def refuse_beyond(self, where: str) -> None:
        """Raise ValueError, with the file, where so many landers are left out that the others do not stand for all."""
        share, name = float((self.beyond != "").mean()), self.beyond_input()
        if name is not None and share > MOST_UNKNOWN:
            low, high = self.emulator.ranges[name]
            raise ValueError(
                f"{where}: of {percent(share)} of the landers {name} lies outside what the study simulated; allowed: "
                f"{low:.4g} to {high:.4g} for all but {percent(MOST_UNKNOWN)}; look at what is known of the arrival, "
                "or widen the inputs of the study"
            )

    def ended_as(self, outcome: str | None) -> np.ndarray:
        """Which ended as an observed run did; None: left the surface."""
        ended: np.ndarray = self.outcome == (outcome or TouchdownOutcome.CLEAR)
        return ended

    def answers(self, which: Integers, observed: Mapping[str, float], errors: Mapping[str, float]) -> Answers:
        """How some of them end, with what was observed of the motion after the contact in the place of the draw."""
        random = np.random.default_rng(hashed_seed(self.emulator.design.study.seed, TITLE, "errors"))
        found, left = Answers.unknown(len(which)), self.outcome[which] == TouchdownOutcome.CLEAR
        found.outcome[:] = self.outcome[which]
        motion = {name: self.outputs[name][which].copy() for name in (SPEED, ELEVATION, SPIN)}
        # In the order of the motion: that of a set changes from process to process, and with it each draw.
        for name in (name for name in motion if name in observed):
            motion[name] = observed[name] + errors.get(name, 0.0) * random.standard_normal(len(which))
            motion[name] = np.clip(motion[name], 1e-9, STEEPEST if name == ELEVATION else np.inf)
        velocity = outgoing_velocity(motion[SPEED], motion[ELEVATION], self.outputs[AZIMUTH][which])
        found.velocity[left] = velocity[left]
        found.spin[left] = (self.axis[which] * motion[SPIN][:, None])[left]
        for name, values in ((DURATION, found.duration), (RISE, found.rise)):
            if name in self.outputs:
                values[left] = self.outputs[name][which][left]
        rests = np.flatnonzero(found.outcome == TouchdownOutcome.CAPTURED)
        if len(rests):
            rest = self.emulator.rest
            taken = rest[random.integers(len(rest), size=len(rests))]
            found.duration[rests], found.way[rests, :2] = taken[:, 0], taken[:, 1:]
            found.length[rests] = np.linalg.norm(found.way[rests], axis=1)
        return found


def _change(outputs: Mapping[str, Array], at: Mapping[str, Array], lander: Integers) -> Array:
    """Size of the change of velocity in each contact [m/s]."""
    speed, incidence = at[IMPACT_SPEED][lander], np.radians(at[IMPACT_INCIDENCE][lander])
    before = np.column_stack([speed * np.sin(incidence), np.zeros(len(lander)), -speed * np.cos(incidence)])
    after = outgoing_velocity(outputs[SPEED], outputs[ELEVATION], outputs[AZIMUTH])
    change: Array = np.linalg.norm(after - before, axis=1)
    return change


def _unit(axis: Array) -> Array:
    length = np.linalg.norm(axis, axis=1, keepdims=True)
    unit: Array = np.nan_to_num(axis) / np.where(length > 0.0, length, 1.0)
    return np.nan_to_num(unit)


@dataclass(frozen=True)
class AfterContact:
    """Touchdowns of landers whose first one is known; later ones are answered by an emulator."""

    first: Answers
    later: EmulatedTouchdowns

    def answers(self, impacts: ImpactStates) -> Answers:
        """Those of the first touchdowns as they are known: all landers have them at once."""
        return self.first if int(impacts.number[0]) == 0 else self.later.answers(impacts)
