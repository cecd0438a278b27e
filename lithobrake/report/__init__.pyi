from .figures.model_figures import write_corner as write_corner
from .plotted_study import PlottedStudy as PlottedStudy
from .reports import write_comparison as write_comparison
from .reports import write_report as write_report
from .reports import write_sites as write_sites
from .study_plots import StudyPlots as StudyPlots
