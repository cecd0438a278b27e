"""What a fitted expansion says: samples, captured landers, percentages with their intervals."""

from lithobrake.analysis.capture import CaptureModel
from lithobrake.analysis.ellipse import Ellipses, landing_ellipses
from lithobrake.analysis.proportion import wilson_interval
from lithobrake.analysis.sampling import sample_inputs

__all__ = ["CaptureModel", "Ellipses", "landing_ellipses", "sample_inputs", "wilson_interval"]
