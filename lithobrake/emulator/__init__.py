"""Conditional distributions of any stochastic model, from its runs: fit, draw, score, save. Stands on chaos alone."""

from typing import TYPE_CHECKING

from lithobrake.vocabulary.lazy_names import lazy_names

if TYPE_CHECKING:
    from lithobrake.emulator.fitting import fit as fit
    from lithobrake.emulator.mean_law import MeanLaw as MeanLaw
    from lithobrake.emulator.model import Draws as Draws
    from lithobrake.emulator.model import Emulator as Emulator
    from lithobrake.emulator.model import law_tables as law_tables
    from lithobrake.emulator.model import load as load
    from lithobrake.emulator.stochastic_expansion import StochasticExpansion as StochasticExpansion
    from lithobrake.emulator.stochastic_expansion import fit_stochastic_expansion as fit_stochastic_expansion
    from lithobrake.emulator.stochastic_expansion import load_stochastic_expansion as load_stochastic_expansion
    from lithobrake.emulator.validation import Scores as Scores
else:
    __getattr__, __dir__ = lazy_names(__name__)
