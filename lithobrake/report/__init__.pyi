from .figures.model_figures import write_corner as write_corner
from .further_reports import write_comparison as write_comparison
from .further_reports import write_sites as write_sites
from .plotted_study import PlottedStudy as PlottedStudy
from .study_plots import StudyPlots as StudyPlots
from .study_report import write_report as write_report
