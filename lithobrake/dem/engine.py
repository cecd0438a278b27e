"""The compiled side of a world: its arrays, and the stepping that renews lists as they are used up."""

import numpy as np

from lithobrake.dem.advance import DONE, LIST_USED_UP, NAMES_OVERFLOW, advance
from lithobrake.dem.arrays import Bodies, Cores, Floats, Laws, Pairs, Planes
from lithobrake.dem.body import Body, Plane, bodies_of, cores_of, laws_of, planes_of
from lithobrake.dem.distance import Search, search_for
from lithobrake.dem.force import Step
from lithobrake.dem.material import Material
from lithobrake.dem.neighbours import neighbours, pairs_of, renewed, roomier
from lithobrake.dem.shape import Shape

# Skin of the neighbour list over the smallest bounding radius: costs or saves time, changes no result.
SKIN = 0.2


def no_pairs() -> Pairs:
    """Return the pairs of a world in which nothing has met."""
    return pairs_of(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64))


class Engine:
    """Arrays of a world in which nothing is added any more.

    state holds position, velocity, quaternion and angular_momentum and is advanced in place; pairs carry the history of
    contacts; totals and probed count on across engines.
    """

    def __init__(
        self,
        bodies: list[Body],
        planes: list[Plane],
        options: dict[str, str],
        state: dict[str, Floats],
        pairs: Pairs,
        totals: Floats,
        probed: Floats,
    ) -> None:
        self.shapes: list[Shape] = list({id(body.shape): body.shape for body in bodies}.values())
        made_of = [body.material for body in bodies] + [plane.material for plane in planes]
        self.materials: list[Material] = list(dict.fromkeys(made_of))
        self.cores: Cores = cores_of(self.shapes)
        self.laws: Laws = laws_of(self.materials, options["shear_modulus_rule"], options["pair_rule"])
        self.planes: Planes = planes_of(planes, self.materials, len(bodies))
        self.bodies: Bodies = bodies_of(bodies, self.shapes, self.materials, state)
        self.pairs, self.totals, self.probed = pairs, totals, probed
        self.skin = SKIN * float(self.bodies.bounding_radius.min())
        self.search: Search = self._scratch()
        self._list_neighbours()
        self.pairs.wake[:] = 0.0

    def advance(self, steps: int, step: Step, watched: int) -> tuple[int, int]:
        """Take steps; return how many were taken, and why it ended (DONE, or what is wrong).

        A step of no duration computes the forces at hand.
        """
        left, drifted = steps, False
        while left > 0:
            taken, reason, drifted = advance(
                left, drifted, self.bodies, self.cores, self.planes, self.pairs, self.laws, step, 0.5 * self.skin,
                self.search, self.totals, watched, self.probed,
            )  # fmt: skip
            left -= taken
            if reason == LIST_USED_UP:
                self._list_neighbours()
            elif reason == NAMES_OVERFLOW:
                self.pairs = roomier(self.pairs, 2 * self.pairs.term.shape[1])
                self.search = self._scratch()
            elif reason != DONE:
                return steps - left, reason
        return steps, DONE

    def _scratch(self) -> Search:
        shape = self.bodies.shape
        vertices, edges = (
            np.sort(np.diff(start)[shape])[-2:] for start in (self.cores.vertex_start, self.cores.edge_start)
        )
        # All corners and all pairs of edges of the two largest bodies, should they cross, and a list's worth beside.
        points = 1 + int(vertices.sum() + 2 * edges.prod()) + self.pairs.term.shape[1]
        return search_for(int(vertices.max() + edges.max()), points)

    def _list_neighbours(self) -> None:
        first, second = neighbours(self.bodies, self.planes, self.skin)
        self.pairs = renewed(self.pairs, first, second)
        self.bodies.position_listed[:] = self.bodies.position
