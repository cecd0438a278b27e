"""What a place sees over a day: the closed form on a ball, a wall that hides, and the mask."""

import numpy as np
import pytest

from lithobrake.smallbody import Shape, day_directions, seen_over_a_day
from lithobrake.smallbody.built_in_bodies import top_shape
from lithobrake.smallbody.sky import DIRECTIONS

BALL = top_shape((200.0, 200.0, 200.0), ridge_height=0.0, name="ball")


@pytest.mark.parametrize(("latitude", "sun"), [(0.0, 0.0), (40.0, 15.0), (-40.0, 15.0), (80.0, -20.0), (75.0, 20.0)])
def test_day_on_a_ball_is_as_long_as_in_closed_form(latitude: float, sun: float) -> None:
    """The Sun is up while cos(hour angle) > -tan(latitude) tan(its latitude)."""
    angle = np.radians(latitude)
    up = np.array([[np.cos(angle), 0.0, np.sin(angle)]])
    seen = seen_over_a_day(BALL, 100.5 * up, up, [sun])
    rise = -np.tan(angle) * np.tan(np.radians(sun))
    assert seen.mean() == pytest.approx(np.arccos(np.clip(rise, -1.0, 1.0)) / np.pi, abs=1.0 / DIRECTIONS)


def test_mask_takes_its_height_off_either_end_of_the_day() -> None:
    up = np.array([[1.0, 0.0, 0.0]])
    seen = seen_over_a_day(BALL, 100.5 * up, up, [0.0], mask_deg=30.0)
    assert seen.mean() == pytest.approx(120.0 / 360.0, abs=1.0 / DIRECTIONS)


def step() -> Shape:
    """A body like a step: a slab of 2 x 4 x 4 m, and on one half of its top a block 2 m high."""
    outline = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]], dtype=float) - [1.6, 1.6]
    count = len(outline)
    corners = np.vstack([np.column_stack([outline, np.full(count, z)]) for z in (-2.0, 2.0)])
    caps = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]
    faces = [[a, c, b] for a, b, c in caps] + [[a + count, b + count, c + count] for a, b, c in caps]
    for k in range(count):
        n = (k + 1) % count
        faces += [[k, n, n + count], [k, n + count, k + count]]
    return Shape(corners, faces, name="step")


def test_a_wall_hides_what_stands_lower_than_its_top() -> None:
    """Seen from the step's tread, 1 m off a wall 2 m high, a body low in that direction is hidden below 63 degrees."""
    shape = step()
    place, up = np.array([[1.4, 0.4, 0.0]]), np.array([[0.0, 1.0, 0.0]])
    directions, seen = day_directions([0.0])[0], seen_over_a_day(shape, place, up, [0.0])[0]
    height = np.degrees(np.arcsin(directions[:, 1]))
    toward_wall = directions[:, 0] < 0.0
    assert (seen == ((height > 0.0) & (~toward_wall | (height > np.degrees(np.arctan2(2.0, 1.0)))))).all()


def test_directions_go_around_at_their_latitude() -> None:
    directions = day_directions([30.0])[0]
    assert np.allclose(directions[:, 2], 0.5)
    assert np.allclose(directions.mean(axis=0)[:2], 0.0)
    assert np.allclose(np.linalg.norm(directions, axis=1), 1.0)
