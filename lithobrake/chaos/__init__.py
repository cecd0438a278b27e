"""Polynomial chaos for any model: inputs with distributions, designs, fits, moments, sensitivity indices."""

from lithobrake.chaos.basis import condition_number
from lithobrake.chaos.bounded import Beta, LogUniform, Uniform
from lithobrake.chaos.computed import Empirical, TruncatedNormal
from lithobrake.chaos.design import latin_hypercube, sobol_sequence, tensor_count, tensor_grid
from lithobrake.chaos.fitting import fit
from lithobrake.chaos.germ import Distribution
from lithobrake.chaos.kinds import distribution
from lithobrake.chaos.optimal import fekete
from lithobrake.chaos.scores import absolute_percentage_error
from lithobrake.chaos.sparse_grid import smolyak, smolyak_count
from lithobrake.chaos.storage import load
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.terms import multi_index_set, term_count
from lithobrake.chaos.unbounded import Exponential, Gamma, LogNormal, Normal

__all__ = [
    "Beta",
    "Distribution",
    "Empirical",
    "Exponential",
    "Gamma",
    "LogNormal",
    "LogUniform",
    "Normal",
    "Surrogate",
    "TruncatedNormal",
    "Uniform",
    "absolute_percentage_error",
    "condition_number",
    "distribution",
    "fekete",
    "fit",
    "latin_hypercube",
    "load",
    "multi_index_set",
    "smolyak",
    "smolyak_count",
    "sobol_sequence",
    "tensor_count",
    "tensor_grid",
    "term_count",
]
