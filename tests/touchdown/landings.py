"""A landing of a small box on a bed of rock, which the tests of landings change."""

from typing import Any

from lithobrake.dem import Box, Material
from lithobrake.touchdown import ContactModel, Lander, Landing

ROCK = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)
LANDER = Lander(shape=Box((0.08, 0.06, 0.05)), mass=0.6, material=ROCK)


def landing(**changes: Any) -> Landing:
    values: dict[str, Any] = {
        "grain": ROCK, "speed": 0.3, "incidence": 0.2, "azimuth": 0.3, "place": (0.0, 0.0),
        "orientation": (0.9, 0.3, 0.2, 0.1), "spin": (0.0, 0.0, 0.0), "gravity": (0.0, 0.0, -5e-4), "time_limit": 20.0,
        "contact": ContactModel(steps_per_contact=25.0),
    }  # fmt: skip
    return Landing(**{**values, **changes})
