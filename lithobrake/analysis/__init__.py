"""What runs and a fitted expansion say: estimates with their intervals, samples, outcomes."""

from lithobrake.analysis.best_choice import BestChoice, best_choice, quantile_within
from lithobrake.analysis.confidence import LEVEL, IntervalEstimate, wilson_interval
from lithobrake.analysis.control_variate import regression_terms
from lithobrake.analysis.direction import DirectionEstimate, direction_estimate
from lithobrake.analysis.ellipse import Ellipses, dispersion_ellipses
from lithobrake.analysis.equal_area_cells import EqualAreaCells
from lithobrake.analysis.failure_inputs import FailureInput, failure_inputs
from lithobrake.analysis.failure_probability import (
    FailureProbability,
    drawn_counts,
    drawn_failures,
    failure_probability,
)
from lithobrake.analysis.half_width import (
    best_runs_a_bed,
    cost_over_best,
    expected_half_width,
    runs_for_half_width,
)
from lithobrake.analysis.half_width_range import HalfWidthRange, half_width_range
from lithobrake.analysis.highest_density import DensityRegion, HighestDensity, highest_density
from lithobrake.analysis.inference import LearntInput, Posterior, infer
from lithobrake.analysis.observed_bounces import Identifiability, identifiability, predictive_p_value
from lithobrake.analysis.outcome_model import OutcomeModel, unseen_limit, upper_limit
from lithobrake.analysis.output_estimates import (
    QuantileEstimate,
    mean_estimate,
    quantile_estimate,
    quantile_estimates,
)
from lithobrake.analysis.paired_difference import PairedDifference, quantile_difference, share_difference
from lithobrake.analysis.refit_interval import refit_interval
from lithobrake.analysis.sequential_stopping import half_width_of, next_run_count, scatter_of
from lithobrake.analysis.share_estimate import ShareEstimate, share_estimate
from lithobrake.analysis.shared_beds import Observation, bed_shares, beds_statement
from lithobrake.analysis.side_runs import chaos_variance, soil_total_effect
from lithobrake.analysis.subset_simulation import SubsetResult, subset_simulation
from lithobrake.analysis.variance_shares import VarianceShares, variance_shares
from lithobrake.chaos.design import sample_inputs

__all__ = [
    "LEVEL", "BestChoice", "DensityRegion", "DirectionEstimate", "Ellipses", "EqualAreaCells", "FailureInput",
    "FailureProbability", "HalfWidthRange", "HighestDensity", "Identifiability", "IntervalEstimate", "LearntInput",
    "Observation", "OutcomeModel", "PairedDifference", "Posterior", "QuantileEstimate", "ShareEstimate", "SubsetResult",
    "VarianceShares", "bed_shares", "beds_statement", "best_choice", "best_runs_a_bed", "chaos_variance",
    "cost_over_best", "direction_estimate", "dispersion_ellipses", "drawn_counts", "drawn_failures",
    "expected_half_width", "failure_inputs", "failure_probability", "half_width_of", "half_width_range",
    "highest_density", "identifiability", "infer", "mean_estimate", "next_run_count", "predictive_p_value",
    "quantile_difference", "quantile_estimate", "quantile_estimates", "quantile_within", "refit_interval",
    "regression_terms", "runs_for_half_width", "sample_inputs", "scatter_of", "share_difference", "share_estimate",
    "soil_total_effect", "subset_simulation", "unseen_limit", "upper_limit", "variance_shares", "wilson_interval",
]  # fmt: skip
