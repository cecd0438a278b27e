"""Moving bodies to look at outside the report: a file for ParaView, a window, a film, a contact sheet."""

from lithobrake.view.contact_sheet import contact_sheet
from lithobrake.view.files import refuse_other_kinds, write_motion
from lithobrake.view.film import film
from lithobrake.view.vtkhdf import write_vtkhdf
from lithobrake.view.window import show

__all__ = ["contact_sheet", "film", "refuse_other_kinds", "show", "write_motion", "write_vtkhdf"]
