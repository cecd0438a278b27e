"""What runs and a fitted expansion say: estimates with their intervals, samples, outcomes."""

from lithobrake.analysis.bayesian_inference import LearntInput, Posterior, infer
from lithobrake.analysis.best_choice import BestChoice, best_choice, quantile_within
from lithobrake.analysis.confidence import LEVEL, wilson_interval
from lithobrake.analysis.control_variate import chaos_variance, regression_terms, soil_total_effect
from lithobrake.analysis.equal_area import EqualAreaCells
from lithobrake.analysis.failure_probability import (
    FailureInput,
    FailureProbability,
    drawn_counts,
    drawn_failures,
    failure_inputs,
    failure_probability,
)
from lithobrake.analysis.half_width import (
    HalfWidthRange,
    best_runs_a_bed,
    cost_over_best,
    expected_half_width,
    half_width_of,
    half_width_range,
    next_run_count,
    runs_for_half_width,
    scatter_of,
)
from lithobrake.analysis.identifiability import Identifiability, identifiability, predictive_p_value
from lithobrake.analysis.outcome_model import OutcomeModel, refit_interval
from lithobrake.analysis.output_estimates import (
    DirectionEstimate,
    direction_estimate,
    mean_estimate,
    quantile_estimate,
    quantile_estimates,
)
from lithobrake.analysis.paired_difference import (
    PairedDifference,
    quantile_difference,
    ratio_difference,
    share_difference,
)
from lithobrake.analysis.posterior import Observation, bed_shares, beds_statement
from lithobrake.analysis.regions import DensityRegion, Ellipses, HighestDensity, dispersion_ellipses, highest_density
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.analysis.subset_simulation import SubsetResult, subset_simulation
from lithobrake.analysis.unseen_event import unseen_limit, upper_limit
from lithobrake.analysis.variance_shares import VarianceShares, variance_shares
from lithobrake.chaos.design import sample_inputs
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.landing_fraction import LandingFraction

__all__ = [
    "LEVEL", "BestChoice", "DensityRegion", "DirectionEstimate", "Ellipses", "EqualAreaCells", "Estimate",
    "FailureInput", "FailureProbability", "HalfWidthRange", "HighestDensity", "Identifiability", "LandingFraction",
    "LearntInput", "Observation", "OutcomeModel", "PairedDifference", "Posterior", "SubsetResult", "VarianceShares",
    "bed_shares", "beds_statement", "best_choice", "best_runs_a_bed", "chaos_variance", "cost_over_best",
    "direction_estimate", "dispersion_ellipses", "drawn_counts", "drawn_failures", "expected_half_width",
    "failure_inputs", "failure_probability", "half_width_of", "half_width_range", "highest_density", "identifiability",
    "infer", "mean_estimate", "next_run_count", "predictive_p_value", "quantile_difference", "quantile_estimate",
    "quantile_estimates", "quantile_within", "ratio_difference", "refit_interval", "regression_terms",
    "runs_for_half_width",
    "sample_inputs", "scatter_of", "share_difference", "share_estimate", "soil_total_effect", "subset_simulation",
    "unseen_limit", "upper_limit", "variance_shares", "wilson_interval",
]  # fmt: skip
