"""What a study passes on to other programs: flights, the shape, numbers per facet, the map, in their formats."""

from lithobrake.export.attitudes import write_attitudes
from lithobrake.export.czml import write_czml
from lithobrake.export.ephemerides import write_ephemerides, write_spk
from lithobrake.export.formats import KINDS, ExportOptions, export_study
from lithobrake.export.maps import write_geojson, write_geotiff, write_rest_geojson, write_site_cells
from lithobrake.export.push import Push, write_push
from lithobrake.export.shape_tables import write_facet_csv, write_facet_fits, write_plates

__all__ = [
    "KINDS", "ExportOptions", "Push", "export_study", "write_attitudes", "write_czml", "write_ephemerides",
    "write_facet_csv", "write_facet_fits", "write_geojson", "write_geotiff", "write_plates", "write_push",
    "write_rest_geojson", "write_site_cells", "write_spk",
]  # fmt: skip
