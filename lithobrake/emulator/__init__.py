"""Conditional distributions of any stochastic model, from its runs: fit, draw, score, save. Stands on chaos alone."""

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lithobrake.emulator.fitting import fit as fit
    from lithobrake.emulator.mean_law import MeanLaw as MeanLaw
    from lithobrake.emulator.model import Draws as Draws
    from lithobrake.emulator.model import Emulator as Emulator
    from lithobrake.emulator.model import load as load
    from lithobrake.emulator.plain_tables import law_tables as law_tables
    from lithobrake.emulator.stochastic_expansion import StochasticExpansion as StochasticExpansion
    from lithobrake.emulator.stochastic_expansion import load_stochastic_expansion as load_stochastic_expansion
    from lithobrake.emulator.stochastic_fitting import fit_stochastic_expansion as fit_stochastic_expansion
    from lithobrake.emulator.validation import Scores as Scores

_PLACES = {
    "Draws": "model", "Emulator": "model", "MeanLaw": "mean_law", "Scores": "validation",
    "StochasticExpansion": "stochastic_expansion", "fit": "fitting", "fit_stochastic_expansion": "stochastic_fitting",
    "law_tables": "plain_tables", "load": "model", "load_stochastic_expansion": "stochastic_expansion",
}  # fmt: skip


def __getattr__(name: str) -> Any:
    """Import a public name when it is asked for."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}", name=name, obj=sys.modules[__name__])
    return getattr(import_module(f"{__name__}.{_PLACES[name]}"), name)


def __dir__() -> list[str]:
    """List the public names."""
    return list(_PLACES)
