"""Samples of a model of the bounce, their file, and the velocity with which a lander leaves."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import hashed_seed, reading
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.study import Study
from lithobrake.study.quantity import median
from lithobrake.study.units import input_units
from lithobrake.vocabulary.file_names import SAMPLES_FILE
from lithobrake.vocabulary.outcomes import SampleOutcome
from lithobrake.vocabulary.quantities import RUN, TOUCHDOWN, VELOCITY_OUT, quantity

VELOCITY = VELOCITY_OUT
FORMAT_VERSION = 2
SAMPLE_OUTCOMES = tuple(SampleOutcome)
CLEAR, CAPTURED = SAMPLE_OUTCOMES.index(SampleOutcome.CLEAR), SAMPLE_OUTCOMES.index(SampleOutcome.CAPTURED)
OUTSIDE = SAMPLE_OUTCOMES.index(SampleOutcome.OUTSIDE)
# Those after which nobody knows where the lander is.
MISSING = (SampleOutcome.LEFT_SIDEWAYS, SampleOutcome.TIME_LIMIT, SampleOutcome.OUTSIDE)


def outgoing(outputs: np.ndarray, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Outputs whose velocity has the drawn speed, elevation and azimuth, and which of them can be.

    outputs: [count, output_count], SI, columns as the names say; result of the same shape, and [count]. The azimuth is
    that of the drawn horizontal components. Components that were drawn one by one shrink towards their means, so their
    speed is less than the speed that was drawn. A speed of 0 or less, or an elevation outside 0 to 90 degrees, is no
    way to leave: such a draw says nothing of the lander.
    """
    column = {name: outputs[:, list(names).index(name)] for name in ("speed_out", "elevation_out", *VELOCITY)}
    speed, elevation = column["speed_out"], column["elevation_out"]
    azimuth = np.arctan2(column["velocity_out_y"], column["velocity_out_x"])
    result = outputs.copy()
    result[:, [list(names).index(name) for name in VELOCITY]] = outgoing_velocity(speed, elevation, azimuth)
    return result, (speed > 0.0) & (elevation > 0.0) & (elevation <= 0.5 * math.pi)


def outgoing_velocity(speed: np.ndarray, elevation: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    """Velocities [m/s] in the frame of the touchdown, [count, 3], from speed [m/s], elevation and azimuth [rad]."""
    level = speed * np.cos(elevation)
    return np.column_stack([level * np.cos(azimuth), level * np.sin(azimuth), speed * np.sin(elevation)])


def rolling_spin(velocity: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Angular velocity [rad/s] of a size, shape [count], about the axis of rolling along velocities [count, 3]."""
    across = np.column_stack([-velocity[:, 1], velocity[:, 0], np.zeros(len(velocity))])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    # Straight up there is no direction to roll in; any level axis will do.
    axis = np.where(length > 0.0, across / np.where(length > 0.0, length, 1.0), np.array([0.0, 1.0, 0.0]))
    spin: np.ndarray = axis * size[:, None]
    return spin


@dataclass(frozen=True)
class Samples:
    """Samples of the Monte Carlo.

    inputs [sample_count, input_count], in the file's units; outputs [sample_count, output_count], SI, in the local
    frame; outcome [sample_count]: place in SAMPLE_OUTCOMES, drawn by its probability, or "outside" where the outputs
    cannot be; without_scatter: the outputs of the expansion alone, where scatter was added, else None.
    """

    input_names: list[str]
    output_names: list[str]
    inputs: np.ndarray
    outputs: np.ndarray
    outcome: np.ndarray
    without_scatter: np.ndarray | None = None

    @classmethod
    def of(
        cls,
        input_names: Iterable[str],
        output_names: Iterable[str],
        inputs: np.ndarray,
        outputs: np.ndarray,
        drawn: np.ndarray,
        without_scatter: np.ndarray | None = None,
    ) -> "Samples":
        """Samples whose outcomes were drawn as those of runs; clear ones that cannot leave so become "outside"."""
        names = list(output_names)
        consistent, possible = outgoing(outputs, names)
        # One byte each, as there may be 1e8.
        outcome = np.where((drawn == CLEAR) & ~possible, OUTSIDE, drawn).astype(np.uint8)
        alone = None if without_scatter is None else outgoing(without_scatter, names)[0]
        return cls(list(input_names), names, inputs, consistent, outcome, alone)

    @property
    def leaves(self) -> np.ndarray:
        """Which samples leave the surface, shape [sample_count]."""
        left: np.ndarray = self.outcome == CLEAR
        return left

    @property
    def known(self) -> np.ndarray:
        """Of which samples it is known where they go: they leave the surface or are captured; shape [sample_count]."""
        followed: np.ndarray = self.leaves | (self.outcome == CAPTURED)
        return followed

    def output(self, name: str) -> np.ndarray:
        """One output, shape [sample_count]."""
        return self.outputs[:, self.output_names.index(name)]

    def expansion_alone(self) -> "Samples":
        """The samples without the scatter from run to run; themselves where none was added."""
        if self.without_scatter is None:
            return self
        # What the scatter has made impossible may be possible without it, so these are judged again.
        drawn = np.where(self.outcome == OUTSIDE, CLEAR, self.outcome)
        return Samples.of(self.input_names, self.output_names, self.inputs, self.without_scatter, drawn)

    def first(self, count: int) -> "Samples":
        """The first samples, which are as random as all, with the scatter where there is any."""
        part = {name: getattr(self, name)[:count] for name in ("inputs", "outputs", "outcome")}
        return replace(self, without_scatter=None, **part)

    def save(self, folder: StudyFolder) -> None:
        """Write samples.h5; each data set says of its columns what they are."""
        import h5py

        study_units = input_units()
        with atomic_path(folder / SAMPLES_FILE) as draft, h5py.File(draft, "w") as file:
            for name in ("inputs", "outputs", "outcome"):
                file.create_dataset(name, data=getattr(self, name))
            if self.without_scatter is not None:
                file.create_dataset("without_scatter", data=self.without_scatter)
            file["outcome"].attrs.update(RUN["outcome"].attributes)
            for name in (name for name in file if name != "outcome"):
                names = self.input_names if name == "inputs" else self.output_names
                columns = [quantity(column, TOUCHDOWN, study_units) for column in names]
                # One word for each column.
                for attribute in ("units", "long_name", "frame"):
                    file[name].attrs[attribute] = [getattr(column, attribute) for column in columns]
            file.attrs["format_version"] = FORMAT_VERSION
            file.attrs["input_names"], file.attrs["output_names"] = self.input_names, self.output_names
            file.attrs["outcomes"] = [outcome.value for outcome in SAMPLE_OUTCOMES]

    @classmethod
    def load(cls, folder: StudyFolder) -> "Samples":
        """Read samples.h5. Raises ValueError for a damaged file."""
        import h5py

        with reading(folder / SAMPLES_FILE, AGAIN), h5py.File(folder / SAMPLES_FILE) as file:
            arrays = {name: data[()] for name, data in file.items()}
            return cls(list(file.attrs["input_names"]), list(file.attrs["output_names"]), **arrays)


def sampling_seed(study: Study, purpose: str) -> int:
    return hashed_seed(study.seed, purpose)


def touchdown_values(study: Study, inputs: Iterable[str], x: np.ndarray, name: str) -> np.ndarray:
    """One touchdown value in the file's units, shape [sample_count]: its column of x, or what the study fixes it to.

    x: [sample_count, input_count], of the inputs in their order.
    """
    columns = list(inputs)
    if name in columns:
        drawn: np.ndarray = x[:, columns.index(name)]
        return drawn
    return np.full(len(x), median(study.touchdown_values()[name]))
