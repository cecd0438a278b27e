"""What a fitted expansion says: samples, captured landers, percentages with their intervals."""

from lithobrake.analysis.capture import CaptureModel
from lithobrake.analysis.proportion import wilson_interval
from lithobrake.analysis.sampling import sample_inputs

__all__ = ["CaptureModel", "sample_inputs", "wilson_interval"]
