"""Images that show a lost lander: light, view and pixels on a ball, and the order of the windows."""

import numpy as np
import pytest

from lithobrake.smallbody import Imager, Shape, image_windows, recognised

from .meshes import sphere_mesh

FIELD, PIXEL = np.radians(5.5), np.radians(5.5) / 1020


def ellipsoid(semi_axes: tuple[float, float, float], frequency: int) -> Shape:
    vertices, faces = sphere_mesh(frequency)
    return Shape(vertices * np.array(semi_axes), faces)


def on_ball(angles: list[float], radius: float = 100.0) -> tuple[np.ndarray, np.ndarray]:
    """Places along the equator at longitudes [deg], and their normals."""
    along = np.radians(angles)
    up = np.column_stack([np.cos(along), np.sin(along), np.zeros(len(along))])
    return radius * up, up


@pytest.fixture(scope="module")
def ball() -> Shape:
    return ellipsoid((99.0, 99.0, 99.0), 8)


def test_a_lander_is_recognised_where_it_is_lit_near_and_seen(ball: Shape) -> None:
    """Imager and Sun over longitude 0: the emission angle is the longitude but for the parallax of 100 m in 10 km."""
    places, up = on_ball([0.0, 60.0, 70.0, 80.0, 95.0, 180.0])
    above = [[10_000.0, 0.0, 0.0]]
    camera = Imager(FIELD, PIXEL, pixels=1.0, emission=np.radians(75.0), sun=np.radians(5.0))
    found, toward = recognised(ball, places, up, above, [[3.0, 0.0, 0.0]], 1.0, camera)
    assert found[:, 0].tolist() == [True, True, True, False, False, False]
    assert toward[0, 0] == pytest.approx([-1.0, 0.0, 0.0])
    # Of 1 m at 9.9 km a pixel covers 0.93 m; twice as many are not to be had.
    assert not recognised(ball, places, up, above, [[1.0, 0.0, 0.0]], 1.0, Imager(FIELD, PIXEL, pixels=2.0))[0].any()
    # With the Sun over longitude 90 it stands 5 degrees high at longitude 5.
    lit = recognised(ball, *on_ball([4.0, 6.0, 60.0]), above, [[0.0, 1.0, 0.0]], 1.0, camera)[0]
    assert lit[:, 0].tolist() == [False, True, True]


def test_ground_hides_a_lander() -> None:
    """Behind a wall of a larger body: a second peak between place and camera."""
    ground = ellipsoid((200.0, 50.0, 50.0), 12)
    place, up = np.array([[0.0, 50.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])
    camera = Imager(FIELD, PIXEL, pixels=0.1, emission=np.radians(89.0))
    low, high = [[1000.0, 40.0, 0.0]], [[1000.0, 400.0, 0.0]]
    assert not recognised(ground, place, up, low, [[0.0, 1.0, 0.0]], 1.0, camera)[0].any()
    assert recognised(ground, place, up, high, [[0.0, 1.0, 0.0]], 1.0, camera)[0].all()


def looking_down(offsets: list[float]) -> np.ndarray:
    """Unit vectors to places at small angles [deg] beside nadir, for one image, [count, 1, 3]."""
    angle = np.radians(offsets)
    return np.column_stack([np.sin(angle), np.zeros(len(angle)), -np.cos(angle)])[:, None]


def test_a_window_is_pointed_where_most_weight_fits_into_the_field() -> None:
    """Of places at 0, 1, 2 and 9 degrees a field of 2.2 shows the first three, amid them; then the last is left."""
    toward = looking_down([0.0, 1.0, 2.0, 9.0])
    shown = np.ones((4, 1), dtype=bool)
    (window,) = image_windows(shown, toward, np.ones(4), np.radians(2.2), 5)
    assert window.shown.tolist() == [True, True, True, False]
    assert window.boresight == pytest.approx(looking_down([1.0])[0, 0], abs=1e-9)
    assert window.gain == 3.0
    (heavy,) = image_windows(shown, toward, [1.0, 1.0, 1.0, 4.0], np.radians(2.2), 5)
    assert heavy.shown.tolist() == [False, False, False, True]


def test_images_are_taken_once_in_the_order_of_their_gain() -> None:
    """Image 1 shows three places, image 0 two of them and another one, image 2 nothing new."""
    shown = np.array([[1, 1, 0], [1, 1, 1], [0, 1, 1], [1, 0, 0]], dtype=bool)
    toward = np.broadcast_to(looking_down([0.0, 0.1, 0.2, 0.3]), (4, 3, 3))
    windows = image_windows(shown, toward, np.ones(4), FIELD, 5)
    assert [(one.image, one.gain) for one in windows] == [(0, 3.0), (1, 1.0)]
    assert [one.image for one in image_windows(shown, toward, [1.0, 1.0, 3.0, 1.0], FIELD, 1)] == [1]
    assert image_windows(np.zeros_like(shown), toward, np.ones(4), FIELD, 5) == []


def test_windows_show_at_least_half_of_the_best_choice() -> None:
    """Image 0 may point left or right, image 1 sees the left alone: taken for the left first, half is lost."""
    toward = np.repeat(looking_down([0.0] * 10 + [30.0] * 10), 2, axis=1)
    shown = np.column_stack([np.ones(20, dtype=bool), np.arange(20) < 10])
    weight = np.where(np.arange(20) < 10, 1.001, 1.0)
    windows = image_windows(shown, toward, weight, np.radians(5.0), 2)
    assert [one.gain for one in windows] == pytest.approx([10.01])
    assert sum(one.gain for one in windows) >= 0.5 * 20.01


def test_windows_of_one_direction_show_at_least_half_of_the_best_pair() -> None:
    generator = np.random.default_rng(4)
    for _ in range(20):
        shown = generator.random((12, 6)) < 0.3
        toward = np.broadcast_to(looking_down([0.0] * 12), (12, 6, 3))
        chosen = sum(one.gain for one in image_windows(shown, toward, np.ones(12), FIELD, 2))
        best = max((shown[:, i] | shown[:, j]).sum() for i in range(6) for j in range(6))
        assert 0.5 * best <= chosen <= best


@pytest.mark.parametrize("weight", [[1.0, -1.0], [1.0, np.nan]])
def test_weights_below_zero_are_refused(weight: list[float]) -> None:
    with pytest.raises(ValueError, match=r"weight has .*, but must be at least 0 everywhere"):
        image_windows(np.ones((2, 1), dtype=bool), looking_down([0.0, 1.0]), weight, FIELD, 1)


@pytest.mark.parametrize(("values", "said"), [
    ({"field": 0.0}, "field is 0.0"), ({"pixel": 0.2}, "pixel is 0.2"), ({"pixels": -1.0}, "pixels is -1.0"),
    ({"emission": 2.0}, "emission is 2.0"), ({"sun": -0.1}, "sun is -0.1"),
], ids=str)  # fmt: skip
def test_a_camera_that_is_none_is_refused(values: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Imager(**{"field": FIELD, "pixel": PIXEL} | values)
