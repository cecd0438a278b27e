"""Images of the ground around a lander that goes over several tiles."""

from dataclasses import replace

import numpy as np

from lithobrake.results import MovingBodies
from lithobrake.results.motions import with_images

WIDTH = (1.0, 2.0)
# Two grains: near the middle of the tile, and beside its edge.
GRAINS = np.array([(0.1, 0.0, 0.1), (-0.35, 0.9, 0.1)])
PATH = np.array([(0.0, 0.0, 0.5), (1.1, 0.3, 0.4), (2.2, 0.3, 0.5)])


def landing(**attributes: str) -> MovingBodies:
    """Two grains, of which the first rises from frame to frame, and a lander that flies over two tiles along x."""
    position = np.repeat(np.concatenate([GRAINS, np.zeros((1, 3))])[None], 3, axis=0)
    position[:, 2], position[:, 0, 2] = PATH, [0.1, 0.2, 0.3]
    vertices = tuple(np.full((4, 3), float(body)) for body in range(3))
    facts = {"format": "lithobrake landing", "width": list(WIDTH), "sides": "periodic"} | attributes
    faces = (np.zeros((4, 3), int),) * 3
    force = np.arange(9.0).reshape(3, 3)
    return MovingBodies(vertices, faces, np.arange(3.0), position, np.ones((3, 3, 4)), facts, {}, force)


def test_each_image_that_comes_into_the_tile_around_the_lander_is_shown_once() -> None:
    shown = with_images(landing())
    places = {tuple(place) for place in np.round(shown.position[0, :-1, :2], 9).tolist()}
    # Within half a tile of the lander at x = 0, 1.1 and 2.2, and at y = 0 and 0.3.
    assert places == {(0.1, 0.0), (1.1, 0.0), (2.1, 0.0), (-0.35, 0.9), (0.65, 0.9), (2.65, 0.9)}
    assert shown.position.shape == (3, 7, 3)


def test_images_move_as_their_grain_and_the_lander_is_last() -> None:
    made, shown = landing(), with_images(landing())
    of_first = np.flatnonzero([vertices[0, 0] == 0.0 for vertices in shown.vertices])
    assert len(of_first) == 3
    for body in of_first:
        assert np.array_equal(shown.position[:, body, 2], [0.1, 0.2, 0.3])
        assert np.array_equal(shown.force[:, body], made.force[:, 0])
    assert np.array_equal(shown.position[:, -1], PATH)
    assert shown.vertices[-1][0, 0] == 2.0


def test_a_lander_that_stays_in_the_middle_is_shown_on_its_tile() -> None:
    made = landing()
    made.position[:, -1, :2] = 0.0
    shown = with_images(made)
    assert np.array_equal(np.sort(shown.position[0, :, 0]), np.sort(made.position[0, :, 0]))


def test_walls_and_beds_have_no_images() -> None:
    for made in (landing(sides="walls"), landing(format="lithobrake bed"), replace(landing(), attributes={})):
        assert with_images(made) is made
