"""What an explorer evaluates in the place of the emulator: tables of its refits, and names, as a study keeps them."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.reading import reading

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FORMAT_VERSION = 2
NAMES = ("input_names", "output_names", "outcome_names")


@dataclass(frozen=True, eq=False)
class ExplorerTables:
    """tables by name, as `lithobrake.emulator.law_tables` says, and azimuth [row_count] of each row [rad].

    Those of an expansion have velocities among their outputs and no azimuth, scatter that grows [output_count] with the
    impact's speed from the runs' scatter_speed [m/s], and chances of outcomes that follow its first terms.
    group_count: groups of runs that refits draw; interval_reach: standard errors that an interval over them reaches to.
    bound: numbers of the energy bound, and by dotted key the medians of what it depends on.
    """

    tables: "dict[str, NDArray[np.float64]]"
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    outcome_names: tuple[str, ...]
    output_outcome: str
    group_count: int
    interval_reach: float
    bound: dict[str, float]

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
            tables = {name: data[()] for name, data in file.items()}
            return cls(
                tables,
                **names,
                output_outcome=str(file.attrs["output_outcome"]),
                group_count=int(file.attrs["group_count"]),
                interval_reach=float(file.attrs["interval_reach"]),
                bound=bound,
            )
