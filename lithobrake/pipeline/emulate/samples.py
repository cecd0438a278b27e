"""Samples of a model of the bounce: what leaves the surface, how fast and where to, what does not, and their file."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.files.hashing import hashed_seed
from lithobrake.files.reading import reading
from lithobrake.pipeline.emulate.outgoing import outgoing
from lithobrake.pipeline.folder.study_folder import AGAIN, StudyFolder
from lithobrake.study import Study
from lithobrake.study.quantity import median
from lithobrake.study.units import input_units
from lithobrake.vocabulary.outcomes import SampleOutcome
from lithobrake.vocabulary.quantities import RUN, TOUCHDOWN, quantity

FORMAT_VERSION = 2
SAMPLE_OUTCOMES = tuple(SampleOutcome)
CLEAR, CAPTURED = SAMPLE_OUTCOMES.index(SampleOutcome.CLEAR), SAMPLE_OUTCOMES.index(SampleOutcome.CAPTURED)
OUTSIDE = SAMPLE_OUTCOMES.index(SampleOutcome.OUTSIDE)
# Those after which nobody knows where the lander is.
MISSING = (SampleOutcome.LEFT_SIDEWAYS, SampleOutcome.TIME_LIMIT, SampleOutcome.OUTSIDE)


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
        with atomic_path(folder / "samples.h5") as draft, h5py.File(draft, "w") as file:
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

        with reading(folder / "samples.h5", AGAIN), h5py.File(folder / "samples.h5") as file:
            arrays = {name: data[()] for name, data in file.items()}
            return cls(list(file.attrs["input_names"]), list(file.attrs["output_names"]), **arrays)


def sampling_seed(study: Study, purpose: str) -> int:
    """Seed of the random numbers of one purpose."""
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
