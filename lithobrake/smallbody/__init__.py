"""Small bodies: shape, gravity, rotation and flight."""

from lithobrake.smallbody.body import Body, Partner
from lithobrake.smallbody.bounce import Bounce, HardSurface, Impacts, Rebounds, RestitutionTable
from lithobrake.smallbody.built_in_bodies import built_in_body, didymos, dimorphos
from lithobrake.smallbody.flight import fly
from lithobrake.smallbody.flight_results import Flights
from lithobrake.smallbody.rotation import AttitudeHistory
from lithobrake.smallbody.rotation_history import (
    PartnerPlace,
    SpinState,
    read_partner,
    read_places,
    read_spin,
    rotation_history,
)
from lithobrake.smallbody.rough_ground import incidence_on, met_normals
from lithobrake.smallbody.shape import Shape
from lithobrake.smallbody.sky import HeliocentricOrbit, Screen, circle_places, day_directions, latitudes_over, seen_from
from lithobrake.smallbody.tumbling import tumble
from lithobrake.vocabulary.outcomes import FlightStatus

__all__ = [
    "AttitudeHistory", "Body", "Bounce", "FlightStatus", "Flights", "HardSurface", "HeliocentricOrbit", "Impacts",
    "Partner", "PartnerPlace", "Rebounds", "RestitutionTable", "Screen", "Shape", "SpinState", "built_in_body",
    "circle_places", "day_directions", "didymos", "dimorphos", "fly", "incidence_on", "latitudes_over", "met_normals",
    "read_partner", "read_places", "read_spin", "rotation_history", "seen_from", "tumble",
]  # fmt: skip
