"""An expansion that is called by the names of its inputs."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from lithobrake.chaos import Surrogate


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
