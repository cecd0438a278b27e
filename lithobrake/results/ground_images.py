"""Ground that repeats, as it is shown: wherever the lander goes, a whole tile of grains lies around it."""

from dataclasses import replace

import numpy as np

from lithobrake.results.moving_bodies import MovingBodies


def with_images(landing: MovingBodies) -> MovingBodies:
    """Return a landing with those images of its grains that lie in the tile around the lander in any frame.

    Whether an image does is told by where its grain was in the first frame. It moves as its grain does, and the lander
    is the last body again. A landing between walls is returned as it is, and so is a bed, of which one tile is shown.
    """
    facts = landing.attributes
    if (facts.get("format"), facts.get("sides")) != ("lithobrake landing", "periodic"):
        return landing
    width, start = np.array(facts["width"]), landing.position[0, :-1, :2]
    path = landing.position[:, -1, :2]
    first = np.ceil((path.min(axis=0) - start.max(axis=0)) / width - 0.5).astype(int)
    last = np.floor((path.max(axis=0) - start.min(axis=0)) / width + 0.5).astype(int)
    numbers, shifts = [], []
    for tile in np.ndindex(*(last - first + 1)):
        shift = (first + tile) * width
        way = np.abs(start + shift - path[:, None])
        (near,) = np.nonzero((way <= 0.5 * width).all(axis=2).any(axis=0))
        numbers.append(near)
        shifts.append(np.tile([*shift, 0.0], (len(near), 1)))
    lander = landing.position.shape[1] - 1
    bodies, shift = np.concatenate([*numbers, [lander]]), np.concatenate([*shifts, np.zeros((1, 3))])
    return replace(
        landing,
        vertices=tuple(landing.vertices[body] for body in bodies),
        faces=tuple(landing.faces[body] for body in bodies),
        position=landing.position[:, bodies] + shift,
        orientation=landing.orientation[:, bodies],
        force=None if landing.force is None else landing.force[:, bodies],
    )
