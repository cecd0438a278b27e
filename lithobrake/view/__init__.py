"""Moving bodies to look at outside the report: a file for ParaView, a window, a film, a contact sheet."""

from lithobrake.view.drawn_motion import show, write_vtkhdf
from lithobrake.view.motion_files import (
    contact_sheet,
    film,
    journey_film,
    refuse_other_kinds,
    write_journey,
    write_motion,
)

__all__ = [
    "contact_sheet", "film", "journey_film", "refuse_other_kinds", "show", "write_journey", "write_motion",
    "write_vtkhdf",
]  # fmt: skip
