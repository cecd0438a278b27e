"""A model that is served: one vector of numbers in, one out."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class ServedModel:
    """A model by its name, the names of its inputs and outputs in their order, and the function.

    evaluate: called with the inputs and what the client configures; it gives the outputs, all finite, and raises
    ValueError for inputs or a configuration that it refuses.
    """

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    evaluate: Callable[[list[float], Mapping[str, Any]], list[float]]

    def __post_init__(self) -> None:
        if not self.inputs or not self.outputs:
            raise ValueError(f"model {self.name} has {len(self.inputs)} inputs and {len(self.outputs)} outputs")
