"""Small bodies: shape, gravity, rotation and flight."""

from lithobrake.smallbody.body import Body
from lithobrake.smallbody.didymos import didymos, dimorphos
from lithobrake.smallbody.flight import Flights, fly
from lithobrake.smallbody.shape import Shape

__all__ = ["Body", "Flights", "Shape", "didymos", "dimorphos", "fly"]
