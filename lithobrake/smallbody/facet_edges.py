"""Ways along the ground of a shape, from facet to facet over their edges, as paper is folded.

The ground bends between facets as if their angle were spread from middle to middle.
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.shape import Shape
from lithobrake.vocabulary.arrays import Array

Whole = NDArray[np.int64]
CROSSINGS = 8  # edges that one way may go over


def unit(vectors: Array) -> Array:
    """Vectors [count, 3] over their lengths; zero where they are."""
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)


def over_edges(
    shape: Shape, facet: Whole, position: Array, way: Array, velocity: Array, press: Array, braking: Array
) -> tuple[Array, Array, Whole, NDArray[np.bool_]]:
    """Fold ways [m] and velocities that leave their facets over the edges: position, velocity, facet, and who leaves.

    Round an outward edge the lander's own motion takes some of its weight off, which saves friction, or all of it, and
    it flies on; in an inward edge it adds to it (the rope round a post, with either sign). press: what presses it on
    the ground over its mass [m/s2], and braking, what friction takes of the speed over that, [count].
    """
    start, way, velocity, facet = position.copy(), way.copy(), velocity.copy(), facet.copy()
    lifted = np.zeros(len(position), dtype=bool)
    on = np.arange(len(position))
    for _ in range(CROSSINGS):
        edge, part = first_edge(shape, facet[on], start[on], way[on])
        on, edge, part = on[edge >= 0], edge[edge >= 0], part[edge >= 0]
        if not len(on):
            break
        start[on] += part[:, None] * way[on]
        fold = Fold.of(shape, facet[on], edge)
        across, speed = -np.einsum("ni,ni->n", velocity[on], fold.inward), np.linalg.norm(velocity[on], axis=1)
        off = (across > 0.0) & (across**2 * fold.angle > press[on] * fold.spread)
        lifted[on[off]], way[on[off]] = True, 0.0
        on, fold, across, speed = on[~off], fold.of_some(~off), across[~off], speed[~off]
        share = np.divide(across, speed, out=np.zeros_like(speed), where=speed > 0.0)
        kept = np.exp(braking[on] * fold.angle * np.abs(share))
        way[on] = fold((1.0 - part[~off])[:, None] * way[on])
        velocity[on] = kept[:, None] * fold(velocity[on])
        facet[on] = fold.beyond
    # A way that turns about a corner for longer ends there.
    way[on] = 0.0
    return start + way, velocity, facet, lifted


def first_edge(shape: Shape, facet: Whole, start: Array, way: Array) -> tuple[Whole, Array]:
    """Number of the edge through which each way leaves its facet, -1: none, and the part of the way before it."""
    corner, inward = shape.corners[facet], shape.inward[facet]
    before = np.maximum(np.einsum("nei,nei->ne", inward, start[:, None] - corner), 0.0)
    change = np.einsum("nei,ni->ne", inward, way)
    out = before + change < -1e-12 * shape.radius
    part = np.divide(before, -change, out=np.full_like(before, np.inf), where=out)
    edge = part.argmin(axis=1)
    return np.where(out.any(axis=1), edge, -1), part[np.arange(len(part)), edge]


@dataclass(frozen=True)
class Fold:
    """Edges that are gone over: vectors along one facet become the same along the next, as paper is folded.

    along, inward, onward   unit vectors along the edge, and across it along either facet, [count, 3]
    angle      by which the ground bends, below 0 where it rises [rad], and spread: the way over which it does so [m]
    beyond     the facet beyond
    """

    along: Array
    inward: Array
    onward: Array
    angle: Array
    spread: Array
    beyond: Whole

    @classmethod
    def of(cls, shape: Shape, facet: Whole, edge: Whole) -> "Fold":
        """Those of edges of facets, by their number."""
        row, beyond = np.arange(len(facet)), shape.neighbours[facet, edge]
        corner, up, next_up = shape.corners[facet], shape.normals[facet], shape.normals[beyond]
        side = corner[row, (edge + 1) % 3] - corner[row, edge]
        along = unit(side)
        inward, onward = np.cross(up, along), np.cross(along, next_up)
        angle = np.arctan2(-np.einsum("ni,ni->n", onward, up), np.einsum("ni,ni->n", up, next_up))
        # A facet's middle lies a third of its height off its edge.
        far = [
            np.einsum("nci,ni->nc", shape.corners[one] - corner[row, edge][:, None], to).max(axis=1)
            for one, to in ((facet, inward), (beyond, onward))
        ]
        return cls(along, inward, onward, angle, (far[0] + far[1]) / 3.0, beyond)

    def of_some(self, some: NDArray[np.bool_]) -> "Fold":
        """Some of them."""
        return Fold(**{field.name: getattr(self, field.name)[some] for field in fields(self)})

    def __call__(self, vectors: Array) -> Array:
        """Turn vectors [count, 3] from one facet onto the next."""
        level = np.einsum("ni,ni->n", vectors, self.along)[:, None] * self.along
        folded: Array = level - np.einsum("ni,ni->n", vectors, self.inward)[:, None] * self.onward
        return folded
