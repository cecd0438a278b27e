"""Every public name of the part, from the file that it stands in."""

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import basis_matrix, condition_number
from lithobrake.chaos.bootstrap import coefficient_changes, score_intervals, sobol_estimates, sobol_intervals
from lithobrake.chaos.bounded_distributions import Beta, LogUniform, Uniform
from lithobrake.chaos.counts import smolyak_count, term_count
from lithobrake.chaos.design import latin_hypercube, sobol_sequence, tensor_count, tensor_grid
from lithobrake.chaos.distribution_registry import distribution
from lithobrake.chaos.fitting import fit
from lithobrake.chaos.gaussian_copula import DependentSurrogate, GaussianCopula, fit_dependent, load_dependent
from lithobrake.chaos.germ_tables import input_tables
from lithobrake.chaos.multi_index import multi_index_set
from lithobrake.chaos.noise import replicates
from lithobrake.chaos.numerical_distributions import Empirical, TruncatedNormal
from lithobrake.chaos.optimal_design import christoffel, christoffel_weights, d_optimal, fekete
from lithobrake.chaos.postprocessing import (
    density,
    gradient,
    main_effect,
    marginal,
    output_correlation,
    quantiles,
    sampled_outputs,
    shape_moments,
)
from lithobrake.chaos.scores import absolute_percentage_error
from lithobrake.chaos.smolyak_grid import smolyak
from lithobrake.chaos.stochastic import StochasticSurrogate, fit_stochastic, joint_scatter, load_stochastic
from lithobrake.chaos.surrogate import Surrogate, load
from lithobrake.chaos.unbounded_distributions import Exponential, Gamma, LogNormal, Normal

__all__ = [
    "Beta",
    "DependentSurrogate",
    "Distribution",
    "Empirical",
    "Exponential",
    "Gamma",
    "GaussianCopula",
    "LogNormal",
    "LogUniform",
    "Normal",
    "StochasticSurrogate",
    "Surrogate",
    "TruncatedNormal",
    "Uniform",
    "absolute_percentage_error",
    "basis_matrix",
    "christoffel",
    "christoffel_weights",
    "coefficient_changes",
    "condition_number",
    "d_optimal",
    "density",
    "distribution",
    "fekete",
    "fit",
    "fit_dependent",
    "fit_stochastic",
    "gradient",
    "input_tables",
    "joint_scatter",
    "latin_hypercube",
    "load",
    "load_dependent",
    "load_stochastic",
    "main_effect",
    "marginal",
    "multi_index_set",
    "output_correlation",
    "quantiles",
    "replicates",
    "sampled_outputs",
    "score_intervals",
    "shape_moments",
    "smolyak",
    "smolyak_count",
    "sobol_estimates",
    "sobol_intervals",
    "sobol_sequence",
    "tensor_count",
    "tensor_grid",
    "term_count",
]
