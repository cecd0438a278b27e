"""What an explorer evaluates in the place of the emulator: tables of its refits, and names, as a study keeps them."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.reading import reading
from lithobrake.vocabulary.plain_text import short_repr

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FORMAT_VERSION = 2
NAMES = ("input_names", "output_names", "outcome_names")


@dataclass(frozen=True)
class ExplorerAttitude:
    """What draws the attitudes of a touchdown, as `lithobrake.geometry.attitude` has them.

    input_names: of the terms; axes [axis_count][3] of the lander; sides: in words, with the directions of the lander
    that are toward the ground.
    """

    input_names: tuple[str, ...]
    axes: list[list[float]]
    has_sides: bool
    is_cube: bool
    sides: dict[str, list[list[float]]]


@dataclass(frozen=True, eq=False)
class ExplorerTables:
    """tables by name, as `lithobrake.emulator.law_tables` says, and azimuth [row_count] of each row [rad].

    Those of an expansion have velocities among their outputs and no azimuth, scatter that grows [output_count] with the
    impact's speed from the runs' scatter_speed [m/s], and chances of outcomes that follow its first terms.
    group_count: groups of runs that refits draw; interval_reach: standard errors that an interval over them reaches to.
    bound: numbers of the energy bound, and by dotted key the medians of what it depends on. attitude: None where the
    law reads none.
    """

    tables: "dict[str, NDArray[np.float64]]"
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    outcome_names: tuple[str, ...]
    output_outcome: str
    group_count: int
    interval_reach: float
    bound: dict[str, float]
    attitude: ExplorerAttitude | None = None
    __repr__ = short_repr

    @property
    def attitude_inputs(self) -> tuple[str, ...]:
        """Inputs that are terms of the attitude; none where the law reads no attitude."""
        return () if self.attitude is None else self.attitude.input_names

    @classmethod
    def read(cls, path: Path, remedy: str) -> "ExplorerTables":
        """Read explorer.h5. Raises DamagedFileError, with the remedy, for another file."""
        import h5py

        with reading(path, remedy), h5py.File(path, "r") as file:
            if file.attrs["format_version"] != FORMAT_VERSION:
                raise ValueError(
                    f"it has format {file.attrs['format_version']}, and this version reads {FORMAT_VERSION}"
                )
            names = {key: tuple(map(str, file.attrs[key])) for key in NAMES}
            bound = {
                key.removeprefix("bound."): float(file.attrs[key]) for key in file.attrs if key.startswith("bound.")
            }
            attitude = json.loads(str(file.attrs["attitude"]))
            if attitude is not None:
                attitude = ExplorerAttitude(**attitude | {"input_names": tuple(attitude["input_names"])})
            tables = {name: data[()] for name, data in file.items()}
            return cls(
                tables,
                **names,
                output_outcome=str(file.attrs["output_outcome"]),
                group_count=int(file.attrs["group_count"]),
                interval_reach=float(file.attrs["interval_reach"]),
                bound=bound,
                attitude=attitude,
            )
