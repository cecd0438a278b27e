"""What came out of a study: read from its folder, nothing written; one touchdown can be made again for its frames."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from lithobrake.results.study_results import StudyResults, open_study

if TYPE_CHECKING:
    from lithobrake.results.explorer_tables import ExplorerTables
    from lithobrake.results.moving_bodies import MovingBodies
    from lithobrake.results.named_emulator import NamedEmulator
    from lithobrake.results.table import Column, Table

_HOME = {
    "Column": "table", "ExplorerTables": "explorer_tables", "MovingBodies": "moving_bodies",
    "NamedEmulator": "named_emulator", "Table": "table",
}  # fmt: skip
__all__ = ["Column", "ExplorerTables", "MovingBodies", "NamedEmulator", "StudyResults", "Table", "open_study"]


def __getattr__(name: str) -> Any:
    # A table brings NumPy, which whoever asks for a sentence does not wait for.
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
