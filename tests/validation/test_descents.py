"""Descents found by flight back in time are flown forward by the package, and end where they were to end."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from lithobrake.smallbody import fly

DESCENTS = runpy.run_path(str(Path(__file__).parents[2] / "validation" / "ballistic_descent" / "descents.py"))


@pytest.mark.parametrize("longitude", [0.0, 70.0, 200.0])
def test_a_descent_flown_forward_comes_down_vertically_at_its_site(longitude: float) -> None:
    """Against facets and exact gravity; a wrong sense of the Coriolis acceleration misses by tens of degrees."""
    body, east, speed = DESCENTS["balls"](), np.radians(longitude), 0.09
    up = np.array([[np.cos(east), np.sin(east), 0.0]])
    state = DESCENTS["back_in_time"](body, up, np.array([speed]), (200.0,))[200.0].states[0]
    flight = fly(body, state[:3], state[3:], 86_400.0)
    assert flight.status[0] == "impact"
    assert np.linalg.norm(state[:3]) == pytest.approx(200.0, abs=2.0)
    assert abs((flight.longitude[0] - longitude + 180.0) % 360.0 - 180.0) < 1.0
    assert flight.impact_speed[0] == pytest.approx(speed, rel=0.01)
    assert np.degrees(flight.incidence[0]) < 5.0
