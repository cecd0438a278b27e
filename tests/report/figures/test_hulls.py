"""Painting of convex bodies: geometry of the camera, what is painted and in which order."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from lithobrake.dem import ConvexHull
from lithobrake.geometry.attitude import rotation_matrices
from lithobrake.report.figures.hulls import SUN, Camera, Hull, direction, frame_axes, paint, subdivide

CUBE = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
STRAIGHT = np.array([[1.0, 0.0, 0.0, 0.0]])


def cube(colour: str = "#808080") -> Hull:
    hull = ConvexHull(CUBE)
    return Hull(hull.vertices, hull.triangles, colour)


def test_camera_from_the_front_sees_x_to_the_right_and_z_up() -> None:
    camera = Camera((0.0, 0.0, 0.0), -90.0, 0.0, 10.0)
    flat, nearness = camera.project(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]))
    np.testing.assert_allclose(flat, [[1, 0], [0, 1], [0, 0]], atol=1e-12)
    np.testing.assert_allclose(nearness, [0, 0, 1], atol=1e-12)


def test_camera_shows_near_things_larger() -> None:
    camera = Camera((0.0, 0.0, 0.0), -90.0, 0.0, 10.0)
    flat, _ = camera.project(np.array([[1.0, -5.0, 0.0], [1.0, 5.0, 0.0]]))
    assert flat[0, 0] == pytest.approx(2.0)
    assert flat[1, 0] == pytest.approx(2.0 / 3.0)


def test_rotation_turns_x_to_y_for_a_quarter_turn_about_z() -> None:
    quarter = np.array([[np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]])
    np.testing.assert_allclose(rotation_matrices(quarter)[0] @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-12)


def test_subdivision_keeps_the_area_and_shortens_the_edges() -> None:
    triangle = np.array([[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]]])
    pieces = subdivide(triangle, 1.0)
    areas = 0.5 * np.linalg.norm(np.cross(pieces[:, 1] - pieces[:, 0], pieces[:, 2] - pieces[:, 0]), axis=1)
    assert areas.sum() == pytest.approx(6.0)
    assert np.linalg.norm(pieces - np.roll(pieces, 1, axis=1), axis=2).max() <= 1.0


def test_only_faces_that_look_at_the_viewer_are_painted() -> None:
    axes = Figure().add_subplot()
    paint(axes, [cube()], np.zeros((1, 3)), STRAIGHT, Camera((0.0, 0.0, 0.0), -60.0, 30.0, 10.0))
    assert len(axes.collections[0].get_paths()) == 6


def test_the_nearer_body_hides_the_farther() -> None:
    """The middle shows the near one of two cubes on the line of sight, whatever their order in the list."""
    for order in (1, -1):
        bodies = [cube("#ff0000"), cube("#0000ff")][::order]
        position = np.array([[0.0, -2.0, 0.0], [0.0, 2.0, 0.0]])[::order]
        figure = Figure(figsize=(1, 1), dpi=50)
        axes = figure.add_axes((0, 0, 1, 1))
        paint(axes, bodies, position, np.repeat(STRAIGHT, 2, axis=0), Camera((0.0, 0.0, 0.0), -90.0, 0.0, 20.0))
        frame_axes(axes, (-0.2, 0.2), (-0.2, 0.2))
        red, _, blue = middle_pixel(figure)
        assert red > 3 * blue


def test_a_body_under_the_sun_shades_the_one_below() -> None:
    """The top of a cube is darker with another cube between it and the sun."""
    camera = Camera((0.0, 0.0, 0.0), -90.0, 80.0, 20.0)
    lit = brightness_of_top(camera, with_shade=False)
    assert brightness_of_top(camera, with_shade=True) < 0.9 * lit


def brightness_of_top(camera: Camera, *, with_shade: bool) -> float:
    bodies, position = [cube()], [[0.0, 0.0, 0.0]]
    if with_shade:
        bodies.append(cube())
        position.append((np.array([0.0, 0.0, 0.5]) + 2.5 * direction(SUN, camera.azimuth_deg)).tolist())
    axes = Figure().add_subplot()
    paint(axes, bodies, np.array(position), np.repeat(STRAIGHT, len(bodies), axis=0), camera)
    collection = axes.collections[0]
    centres = np.array([path.vertices[:3].mean(axis=0) for path in collection.get_paths()])
    nearest = np.argsort(np.linalg.norm(centres - camera.project(np.array([[0.0, 0.0, 0.5]]))[0], axis=1))[:2]
    return float(np.mean([sum(to_rgb(collection.get_facecolor()[k])) for k in nearest]))


def middle_pixel(figure: Figure) -> tuple[float, float, float]:
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    picture = np.asarray(canvas.buffer_rgba(), dtype=float)
    red, green, blue, _ = picture[picture.shape[0] // 2, picture.shape[1] // 2]
    return red, green, blue
