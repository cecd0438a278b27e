"""The emulator or an expansion of a study, called by the names of its inputs."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.results.table import Table
from lithobrake.vocabulary.given_numbers import numbers, whole_number
from lithobrake.vocabulary.number_words import QUANTILES
from lithobrake.vocabulary.plain_text import html_table, in_lines
from lithobrake.vocabulary.quantities import (
    GROUND,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    OUTPUTS,
    RUN,
    SPIN_OUT,
    TOUCHDOWN,
    Quantity,
    quantity,
)

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator
    from lithobrake.results.table import ExplorerAttitude

    Value = float | np.ndarray
    from lithobrake.chaos import Surrogate

SPEED, ELEVATION, AZIMUTH, SPIN = "speed_out", "elevation_out", "azimuth_out", "spin_out"
VELOCITY = ("velocity_out_x", "velocity_out_y", "velocity_out_z")
# How far beyond the trained range an impact may lie: by a factor of speed and gravity, by degrees of its angles.
FACTOR, DEGREES = 1.1, 5.0
LARGEST = {IMPACT_INCIDENCE: 90.0, GROUND[1]: 90.0}


def trained_range(name: str, lower: float, upper: float) -> tuple[float, float]:
    """The range in which an emulator has an answer, of an input of OF_TOUCHDOWN that its runs had between two ends."""
    if name in LARGEST:
        return max(lower - DEGREES, 0.0), min(upper + DEGREES, LARGEST[name])
    # Gravity below 0 points outward.
    margin = (FACTOR - 1.0) * max(abs(lower), abs(upper))
    return (lower if name == IMPACT_SPEED else lower - margin), upper + margin


class NamedEmulator:
    """The emulator of a study; `model` is the object of lithobrake.emulator behind it, which has its scores."""

    def __init__(
        self,
        model: "Emulator",
        units: Mapping[str, str],
        bound: Callable[[], Mapping[str, float]] = dict,
        attitude: "ExplorerAttitude | None" = None,
    ) -> None:
        """Take over an emulator; units: of inputs by dotted key; bound, attitude: of `ExplorerTables` of its study."""
        self.model, self._units, self._bound, self._attitude = model, dict(units), bound, attitude

    @property
    def inputs(self) -> dict[str, str]:
        """Names of the inputs in their order, each with its unit in the study file ("" for a pure number)."""
        return {name: self._quantity(name).units for name in self.model.runs.inputs}

    def sample(self, inputs: "Mapping[str, Value]", count: int, seed: int = 0) -> Table:
        """Sample `count` landings at inputs by dotted key, in the study file's units: numbers, or arrays of one length.

        The terms of the lander's attitude ("attitude."), where it has any, may all be left out: each sample then has an
        attitude as the study draws them.
        Result: a table with a row for each sample, those of one point one after the other: the inputs, the outcome, and
        outputs [SI], NaN where the lander does not leave the surface.
        Raises ValueError for names that are not those of the emulator, and for values outside their distributions.
        """
        whole_number("count", count, 1)
        x = self._points(inputs)
        if self._drawn_terms(inputs):
            x, count = self._with_attitudes(np.repeat(x, count, axis=0), seed), 1
        upper = self._upper(x)
        drawn = self.model.draw(x, count, seed, lower=self.model.runs.lower[0], upper=upper)
        rows, uppers = np.repeat(x, count, axis=0), np.repeat(upper, count, axis=0)
        columns: dict[str, np.ndarray] = dict(zip(self.model.runs.inputs, rows.T, strict=True))
        columns["outcome"] = np.array(self.model.outcome_names)[drawn.outcome.ravel()]
        columns |= self._outputs(drawn.y.reshape(len(rows), -1), uppers)
        return Table.of("sample", {name: (self._quantity(name), values) for name, values in columns.items()})

    def __call__(self, inputs: "Mapping[str, Value]", count: int, seed: int = 0) -> Table:
        """Sample landings; see `sample`."""
        return self.sample(inputs, count, seed)

    def __repr__(self) -> str:
        """Say what it takes and gives, and what the inputs are worth."""
        return in_lines(
            f"NamedEmulator of {', '.join(self._modelled)} at {self._shown(self.inputs)}. "
            f"{self.model.statement_on('beds')} Sample it with .sample({{name: value, ...}}, count)."
        )

    def _repr_html_(self) -> str:
        """The inputs with their distributions, and what the emulator makes of them, for a notebook."""
        rows = [
            (name, unit or "-", *(float(law.ppf(share)) for share in QUANTILES))
            for (name, unit), law in zip(self.inputs.items(), self.model.runs.inputs.values(), strict=True)
        ]
        heads = ("input", "unit", "5 % quantile", "median", "95 % quantile")
        return html_table("Inputs of the emulator", heads, rows) + self.model._repr_html_()

    @property
    def tables(self) -> dict[str, np.ndarray]:
        """The emulator as plain tables, for programs in other languages (`lithobrake.emulator.law_tables`)."""
        from lithobrake.emulator import law_tables

        return law_tables([self.model])

    @property
    def _modelled(self) -> list[str]:
        return [self.model.output_names[column] for column in self.model.runs.modelled]

    def _quantity(self, name: str) -> Quantity:
        return quantity(name, RUN | TOUCHDOWN, self._units)

    def _shown(self, inputs: Mapping[str, str]) -> str:
        return ", ".join(f"{name} [{unit}]" if unit else name for name, unit in inputs.items())

    def _points(self, inputs: "Mapping[str, Value]") -> np.ndarray:
        """Inputs as points [point_count, input_count], NaN for terms of the attitude that are left out.

        Raises ValueError for other names, and for no one length.
        """
        from lithobrake.vocabulary.plain_text import closest

        if not isinstance(inputs, Mapping):
            raise ValueError(
                f"inputs are of the type {type(inputs).__name__}, but must be a dict by name; {self._all()}"
            )
        known = self.inputs
        for name in inputs:
            if name not in known:
                raise ValueError(f"{name!r} is no input of the emulator{closest(name, known)}; {self._all()}")
        drawn = self._drawn_terms(inputs)
        if absent := {name: unit for name, unit in known.items() if name not in {*inputs, *drawn}}:
            raise ValueError(f"inputs lack {self._shown(absent)}; {self._all()}")
        columns = [np.array(math.nan) if name in drawn else numbers(name, inputs[name]) for name in known]
        lengths = {column.shape for column in columns} - {()}
        if len(lengths) > 1 or any(len(shape) > 1 for shape in lengths):
            raise ValueError(f"inputs have the shapes {sorted(lengths)}, but must be numbers, or arrays of one length")
        if (0,) in lengths:
            raise ValueError(f"inputs have no point: an array is empty; {self._all()}")
        return np.column_stack(np.broadcast_arrays(*(np.atleast_1d(column) for column in columns)))

    def _drawn_terms(self, inputs: "Mapping[str, Value]") -> tuple[str, ...]:
        """The terms of the attitude, where none of them is given."""
        terms = () if self._attitude is None else self._attitude.input_names
        return () if any(name in inputs for name in terms) else terms

    def _with_attitudes(self, x: np.ndarray, seed: int) -> np.ndarray:
        """Points [point_count, input_count], each with the terms of an attitude that the study may have."""
        from scipy.spatial.transform import Rotation

        from lithobrake.geometry.attitude import AttitudeTerms

        whole_number("seed", seed, 0)
        law = self._attitude
        assert law is not None
        random, names = np.random.default_rng([seed, 1]), tuple(str(number) for number in range(len(law.axes)))
        if law.drawn is None:
            terms = AttitudeTerms(np.array(law.axes), names, law.has_sides, law.is_cube)
            into_frame = Rotation.random(len(x), random_state=random).as_matrix()
            found = terms.at(into_frame[:, 2], into_frame[:, 0])
        else:
            found = np.array(law.drawn)[random.integers(len(law.drawn), size=len(x))]
        places = [list(self.model.runs.inputs).index(name) for name in law.input_names]
        # Rounding may put a term beyond its end.
        lower, upper = np.array([self.model.runs.inputs[name].support for name in law.input_names]).T
        filled = x.copy()
        filled[:, places] = np.clip(found, lower, upper)
        return filled

    def _all(self) -> str:
        return f"give all of: {self._shown(self.inputs)}"

    def _upper(self, x: np.ndarray) -> np.ndarray:
        """Upper bounds [point_count, output_count]: what energy allows, where the runs are bounded by it."""
        runs = self.model.runs
        upper = np.tile(runs.upper[0], (len(x), 1))
        columns = [self.model.output_names.index(name) for name in (SPEED, SPIN) if name in self.model.output_names]
        if columns and np.isfinite(upper[:, columns]).all():
            upper[:, columns] = allowed_motion(
                self._bound(), dict(zip(self.model.runs.inputs, x.T, strict=True)), len(x)
            )
        return upper

    def _outputs(self, y: np.ndarray, upper: np.ndarray) -> dict[str, np.ndarray]:
        """Outputs by name [row_count] of samples [row_count, output_count] below bounds; velocity and spin follow."""
        found = dict(zip(self.model.output_names, y.T, strict=True))
        if not {SPEED, ELEVATION, AZIMUTH, SPIN} <= set(found):
            return found
        speed, spin = (upper[:, self.model.output_names.index(name)] for name in (SPEED, SPIN))
        if np.isfinite(speed).all():
            # What the speed has taken of the energy is not there for the spin.
            found[SPIN] = np.minimum(found[SPIN], np.sqrt(np.maximum(speed**2 - found[SPEED] ** 2, 0.0)) * spin / speed)
        level = found[SPEED] * np.cos(found[ELEVATION])
        parts = level * np.cos(found[AZIMUTH]), level * np.sin(found[AZIMUTH]), found[SPEED] * np.sin(found[ELEVATION])
        found |= dict(zip(VELOCITY, parts, strict=True))
        if SPIN_OUT[0] in found:
            # The axis is that of the run that was drawn, the rate the emulator's.
            axis = np.column_stack([found[name] for name in SPIN_OUT])
            length = np.linalg.norm(axis, axis=1)
            axis *= (found[SPIN] / np.where(length > 0.0, length, math.inf))[:, None]
            found |= dict(zip(SPIN_OUT, axis.T, strict=True))
        return {name: found[name] for name in dict.fromkeys((*OUTPUTS, *found))}


def allowed_motion(bound: Mapping[str, float], values: Mapping[str, np.ndarray], count: int) -> np.ndarray:
    """Largest speed [m/s] and spin [rad/s] that energy allows landers that leave, [count, 2].

    bound: as of `ExplorerTables`; values: of inputs by dotted key, [count] each, in the place of its medians. As in the
    explorer of the report: energy of the impact, and what gravity adds over the bed and along its slope.
    """
    known = {name: np.full(count, value) for name, value in bound.items()} | dict(values)

    def ratio(name: str) -> np.ndarray:
        return known[name] / bound[name] if bound.get(name) else np.ones(count)

    power = ratio("lander.mass") ** bound["mass_power"] * ratio("lander.diameter") ** bound["diameter_power"]
    spin = sum(known[f"impact.spin_{axis}"] ** 2 for axis in "xyz")
    slope, gravity = np.sin(np.radians(known["surface.slope_deg"])), np.abs(known["surface.gravity"])
    limit = bound["time_limit"]
    downhill = known[IMPACT_SPEED] * limit + 0.5 * gravity * slope * limit**2
    fall = bound["height"] + (bound["across"] + downhill) * slope
    square = known[IMPACT_SPEED] ** 2 + bound["largest"] * power * spin + 2.0 * gravity * fall
    return np.column_stack([np.sqrt(square), np.sqrt(square / (bound["smallest"] * power))])


class NamedSurrogate:
    """The expansion of a study; `expansion` is the object of lithobrake.chaos behind it."""

    def __init__(self, expansion: "Surrogate") -> None:
        """Take over an expansion."""
        self.expansion = expansion

    @classmethod
    def read(cls, path: Path) -> "NamedSurrogate":
        """Read an expansion that a study has saved. Raises ValueError for another file."""
        from lithobrake.chaos import load

        return cls(load(path))

    def __call__(self, inputs: dict[str, ArrayLike]) -> dict[str, np.ndarray]:
        """Outputs [SI] by name at inputs by dotted key, in the file's units; numbers or arrays of one shape.

        Raises ValueError for inputs that are not those of the expansion, or outside the ranges that it has learnt.
        """
        names = list(self.expansion.input_names)
        if set(inputs) != set(names):
            raise ValueError(f"the inputs are {', '.join(inputs) or 'none'}; give exactly {', '.join(names)}")
        columns = np.broadcast_arrays(*(np.asarray(inputs[name], dtype=float) for name in names))
        shape = columns[0].shape
        y = np.asarray(self.expansion(np.column_stack([column.ravel() for column in columns])))
        return {name: y[:, index].reshape(shape) for index, name in enumerate(self.expansion.output_names)}
