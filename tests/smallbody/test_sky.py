"""What a place sees of the sky: closed forms on a ball, a wall that hides, an orbiter, an eclipse, and the mask."""

import math

import numpy as np
import pytest

from lithobrake.smallbody import Screen, Shape, circle_places, day_directions, seen_from
from lithobrake.smallbody.built_in_bodies import top_shape
from lithobrake.smallbody.sky import DIRECTIONS, PLACES

BALL = top_shape((200.0, 200.0, 200.0), ridge_height=0.0, name="ball")


def seen_over_a_day(shape: Shape, place: np.ndarray, up: np.ndarray, latitude: float, **others: float) -> np.ndarray:
    return seen_from(shape, place, up, day_directions([latitude]), **others)


@pytest.mark.parametrize(("latitude", "sun"), [(0.0, 0.0), (40.0, 15.0), (-40.0, 15.0), (80.0, -20.0), (75.0, 20.0)])
def test_day_on_a_ball_is_as_long_as_in_closed_form(latitude: float, sun: float) -> None:
    """The Sun is up while cos(hour angle) > -tan(latitude) tan(its latitude)."""
    angle = np.radians(latitude)
    up = np.array([[np.cos(angle), 0.0, np.sin(angle)]])
    seen = seen_over_a_day(BALL, 100.5 * up, up, sun)
    rise = -np.tan(angle) * np.tan(np.radians(sun))
    assert seen.mean() == pytest.approx(np.arccos(np.clip(rise, -1.0, 1.0)) / np.pi, abs=1.0 / DIRECTIONS)


def test_mask_takes_its_height_off_either_end_of_the_day() -> None:
    up = np.array([[1.0, 0.0, 0.0]])
    seen = seen_over_a_day(BALL, 100.5 * up, up, 0.0, mask_deg=30.0)
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


TREAD = np.array([[1.4, 0.4, 0.0]]), np.array([[0.0, 1.0, 0.0]])


def test_a_wall_hides_what_stands_lower_than_its_top() -> None:
    """Seen from the step's tread, 1 m off a wall 2 m high, a body low in that direction is hidden below 63 degrees."""
    directions, seen = day_directions([0.0])[0], seen_over_a_day(step(), *TREAD, 0.0)[0]
    height = np.degrees(np.arcsin(directions[:, 1]))
    toward_wall = directions[:, 0] < 0.0
    assert (seen == ((height > 0.0) & (~toward_wall | (height > np.degrees(np.arctan2(2.0, 1.0)))))).all()


def test_a_wall_hides_nothing_that_is_before_it() -> None:
    way = np.array([[[-1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]]) / math.sqrt(2.0)
    # The wall is 1 m off, and so 1.41 m along this direction.
    assert seen_from(step(), *TREAD, way, distance=[[1.4, 1.43]]).tolist() == [[True, False]]


def test_directions_go_around_at_their_latitude() -> None:
    directions = day_directions([30.0])[0]
    assert np.allclose(directions[:, 2], 0.5)
    assert np.allclose(directions.mean(axis=0)[:2], 0.0)
    assert np.allclose(np.linalg.norm(directions, axis=1), 1.0)


@pytest.mark.parametrize(("inclination", "latitude"), [(0.0, 0.0), (180.0, 0.0), (90.0, 90.0)])
@pytest.mark.parametrize("mask", [0.0, 20.0])
def test_an_orbiter_is_seen_for_its_arc_above_the_mask(inclination: float, latitude: float, mask: float) -> None:
    """From below its orbit it is in sight over twice the angle arccos((R / r) cos(mask)) - mask about the centre."""
    height, radius = 100.0, 300.0
    angle, mask_angle = np.radians(latitude), np.radians(mask)
    up = np.array([[np.cos(angle), 0.0, np.sin(angle)]])
    ball = top_shape((2.0, 2.0, 2.0), ridge_height=0.0, name="dot")
    way = circle_places(radius, inclination)[None] - height * up[:, None]
    distance = np.linalg.norm(way, axis=-1)
    seen = seen_from(ball, height * up, up, way / distance[..., None], mask, distance=distance)
    arc = math.acos(height / radius * math.cos(mask_angle)) - mask_angle
    assert seen.mean() == pytest.approx(arc / math.pi, abs=2.0 / PLACES + 2e-3)


def test_places_of_an_orbiter_fill_its_band_evenly() -> None:
    """As much above one pole as above the other, at any longitude; sines of latitude as those of a circle."""
    places = circle_places(5.0, 60.0)
    assert np.linalg.norm(places, axis=1) == pytest.approx(np.full(PLACES, 5.0))
    assert np.abs(places.mean(axis=0)).max() < 0.01
    assert (places[:, 2] ** 2).mean() == pytest.approx(0.5 * (5.0 * math.sin(math.radians(60.0))) ** 2)
    assert (places[:, 0] ** 2).mean() == pytest.approx((places[:, 1] ** 2).mean(), rel=0.01)


DISTANCE = 1000.0


def eclipsed(screen: Screen, sun: float) -> float:
    """The fraction of a day over which the Sun, over a latitude, is behind a screen, for a place on a dot that it is
    over at noon."""
    dot = top_shape((0.02, 0.02, 0.02), ridge_height=0.0, name="dot")
    up = np.array([[1.0, 0.0, 0.0]])
    directions = day_directions([sun])
    free = seen_from(dot, 0.01 * up, up, directions).mean()
    return float(free - seen_from(dot, 0.01 * up, up, directions, screen=screen).mean())


@pytest.mark.parametrize("radius", [150.0, 400.0])
def test_an_eclipse_lasts_as_long_as_the_disc_is_wide(radius: float) -> None:
    """2 arcsin(R / d) of the turn, where the partner stands over the equator, as does the Sun."""
    screen = Screen(np.tile([DISTANCE, 0.0, 0.0], (DIRECTIONS, 1)), radius, radius)
    lasts = 2.0 * math.asin(radius / DISTANCE) / (2.0 * math.pi)
    assert eclipsed(screen, 0.0) == pytest.approx(lasts, abs=1.0 / DIRECTIONS)
    assert eclipsed(screen, math.degrees(math.asin(radius / DISTANCE)) + 1.0) == 0.0


def test_a_flat_partner_hides_a_sun_that_is_not_too_high() -> None:
    """Up to the angle of its polar semi-axis, and below it for as long as an ellipse is wide there."""
    screen = Screen(np.tile([DISTANCE, 0.0, 0.0], (DIRECTIONS, 1)), 400.0, 200.0)
    assert eclipsed(screen, 0.0) == pytest.approx(math.asin(0.4) / math.pi, abs=1.0 / DIRECTIONS)
    highest = math.degrees(math.atan(200.0 / math.sqrt(DISTANCE**2 - 400.0**2)))
    assert eclipsed(screen, highest - 0.5) > 0.0
    assert eclipsed(screen, highest + 0.5) == 0.0


def test_a_partner_on_the_other_side_or_behind_the_orbiter_hides_nothing() -> None:
    assert eclipsed(Screen(np.tile([-DISTANCE, 0.0, 0.0], (DIRECTIONS, 1)), 400.0, 400.0), 0.0) == 0.0
    up, far = np.array([[1.0, 0.0, 0.0]]), Screen(np.tile([DISTANCE, 0.0, 0.0], (2, 1)), 100.0, 100.0)
    along = np.tile([1.0, 0.0, 0.0], (1, 2, 1))
    assert seen_from(BALL, 100.5 * up, up, along, distance=[[500.0, 1500.0]], screen=far).tolist() == [[True, False]]
