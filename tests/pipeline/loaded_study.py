"""What a study needs, imported once by the server whose forks are studies.

The faces of packages import nothing before they are asked for something, so files behind them are named.
"""

import matplotlib.figure  # noqa: F401
import scipy.stats  # noqa: F401

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
