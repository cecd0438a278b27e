"""Polynomial chaos for any model: inputs with distributions, designs, fits, moments, sensitivity indices."""

from typing import TYPE_CHECKING

from lithobrake.vocabulary.lazy_names import lazy_names

if TYPE_CHECKING:
    from lithobrake.chaos.basis import basis_matrix as basis_matrix
    from lithobrake.chaos.basis import condition_number as condition_number
    from lithobrake.chaos.basis import input_tables as input_tables
    from lithobrake.chaos.basis import multi_index_set as multi_index_set
    from lithobrake.chaos.bootstrap import coefficient_changes as coefficient_changes
    from lithobrake.chaos.bootstrap import score_intervals as score_intervals
    from lithobrake.chaos.bootstrap import sobol_estimates as sobol_estimates
    from lithobrake.chaos.bootstrap import sobol_intervals as sobol_intervals
    from lithobrake.chaos.counts import smolyak_count as smolyak_count
    from lithobrake.chaos.counts import term_count as term_count
    from lithobrake.chaos.design import GaussianCopula as GaussianCopula
    from lithobrake.chaos.design import christoffel as christoffel
    from lithobrake.chaos.design import christoffel_weights as christoffel_weights
    from lithobrake.chaos.design import d_optimal as d_optimal
    from lithobrake.chaos.design import fekete as fekete
    from lithobrake.chaos.design import latin_hypercube as latin_hypercube
    from lithobrake.chaos.design import sobol_sequence as sobol_sequence
    from lithobrake.chaos.design import tensor_count as tensor_count
    from lithobrake.chaos.design import tensor_grid as tensor_grid
    from lithobrake.chaos.distributions import Beta as Beta
    from lithobrake.chaos.distributions import Distribution as Distribution
    from lithobrake.chaos.distributions import Exponential as Exponential
    from lithobrake.chaos.distributions import Gamma as Gamma
    from lithobrake.chaos.distributions import LogNormal as LogNormal
    from lithobrake.chaos.distributions import LogUniform as LogUniform
    from lithobrake.chaos.distributions import Normal as Normal
    from lithobrake.chaos.distributions import Uniform as Uniform
    from lithobrake.chaos.fitting import fit as fit
    from lithobrake.chaos.numerical_distributions import Empirical as Empirical
    from lithobrake.chaos.numerical_distributions import TruncatedNormal as TruncatedNormal
    from lithobrake.chaos.numerical_distributions import distribution as distribution
    from lithobrake.chaos.postprocessing import density as density
    from lithobrake.chaos.postprocessing import gradient as gradient
    from lithobrake.chaos.postprocessing import main_effect as main_effect
    from lithobrake.chaos.postprocessing import marginal as marginal
    from lithobrake.chaos.postprocessing import output_correlation as output_correlation
    from lithobrake.chaos.postprocessing import quantiles as quantiles
    from lithobrake.chaos.postprocessing import sampled_outputs as sampled_outputs
    from lithobrake.chaos.postprocessing import shape_moments as shape_moments
    from lithobrake.chaos.scores import absolute_percentage_error as absolute_percentage_error
    from lithobrake.chaos.scores import replicates as replicates
    from lithobrake.chaos.smolyak_grid import smolyak as smolyak
    from lithobrake.chaos.stochastic import StochasticSurrogate as StochasticSurrogate
    from lithobrake.chaos.stochastic import fit_stochastic as fit_stochastic
    from lithobrake.chaos.stochastic import joint_scatter as joint_scatter
    from lithobrake.chaos.stochastic import load_stochastic as load_stochastic
    from lithobrake.chaos.surrogate import Surrogate as Surrogate
    from lithobrake.chaos.surrogate import load as load
else:
    __getattr__, __dir__ = lazy_names(__name__)
