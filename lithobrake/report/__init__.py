"""The report of a study: reads the files of its folder, draws the figures, writes one page. Computes nothing new."""

from typing import TYPE_CHECKING

from lithobrake.vocabulary.lazy_names import lazy_names

if TYPE_CHECKING:
    from lithobrake.report.figures.model_figures import write_corner as write_corner
    from lithobrake.report.further_reports import write_comparison as write_comparison
    from lithobrake.report.further_reports import write_sites as write_sites
    from lithobrake.report.plotted_study import PlottedStudy as PlottedStudy
    from lithobrake.report.study_plots import StudyPlots as StudyPlots
    from lithobrake.report.study_report import write_report as write_report
else:
    __getattr__, __dir__ = lazy_names(__name__)
