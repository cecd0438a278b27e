"""What a fitted expansion says: samples, outcomes, percentages with their intervals."""

from lithobrake.analysis.ellipse import Ellipses, dispersion_ellipses
from lithobrake.analysis.outcome_model import OutcomeModel, upper_limit
from lithobrake.analysis.proportion import wilson_interval
from lithobrake.analysis.sampling import sample_inputs

__all__ = ["Ellipses", "OutcomeModel", "dispersion_ellipses", "sample_inputs", "upper_limit", "wilson_interval"]
