"""What a study passes on to other programs: flights, the shape, numbers per facet, the map, in their formats."""

from lithobrake.export.flown import ExportOptions
from lithobrake.export.formats import KINDS, export_study
from lithobrake.export.maps import write_site_cells
from lithobrake.export.push import Push, write_push

__all__ = ["KINDS", "ExportOptions", "Push", "export_study", "write_push", "write_site_cells"]
