"""What a study needs, imported once by the server whose forks are studies; and Numba knows the types of its kernels.

The faces of packages import nothing before they are asked for something, so files behind them are named.
"""

import matplotlib.figure  # noqa: F401
import scipy.stats  # noqa: F401
from numba.core.registry import cpu_target

import lithobrake.chaos.surrogate
import lithobrake.cli
import lithobrake.dem.example_world
import lithobrake.pipeline.planning.planner
import lithobrake.pipeline.stages
import lithobrake.pipeline.study_run
import lithobrake.report.pages.study_page
import lithobrake.report.reports
import lithobrake.smallbody.flight
import lithobrake.touchdown.bed_library
import lithobrake.touchdown.simulation  # noqa: F401

cpu_target.typing_context.refresh()
cpu_target.target_context.refresh()
