"""The compiled side of a world: its arrays, and the stepping that renews lists as they are used up."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from lithobrake.dem.bodies.arrays import DAMPING, Bodies, Cores, Floats, Laws, Pairs, Period, Planes, Reactions, Step
from lithobrake.dem.bodies.motion import write_matrices
from lithobrake.dem.bodies.period import refuse_short_period
from lithobrake.dem.bodies.rigid_body import Plane, RigidBody
from lithobrake.dem.narrow_phase.feature_id import INLINE_FEATURES
from lithobrake.dem.narrow_phase.feature_list import BOUND_SLACK
from lithobrake.dem.narrow_phase.scratch import Scratch, System, scratch_for
from lithobrake.dem.stepping.assembly import bodies_of, cores_of, laws_of, materials_of, parts_of, planes_of, shapes_of
from lithobrake.dem.stepping.neighbours import carry_over, neighbouring_pairs, with_more_overflow
from lithobrake.dem.stepping.threads import Team, new_reactions, partitions_of
from lithobrake.dem.stepping.time_loop import DONE, FEATURES_OVERFLOW, LIST_USED_UP, advance

# Skin of the neighbour list over the smallest bounding radius: costs or saves time, changes no result.
SKIN = 0.25
NO_REACTIONS = new_reactions(0)
# What changes of bodies and does not follow from the rest; what a checkpoint keeps of them.
MOVING = (
    "position", "velocity", "quaternion", "angular_momentum", "force", "torque", "half_spin", "travel", "travel_listed",
    "dragged",
)  # fmt: skip


def pool_of(thread_count: int) -> ThreadPoolExecutor | None:
    """Return the threads beside the one that calls, if there are any."""
    return ThreadPoolExecutor(thread_count - 1) if thread_count > 1 else None


class Engine:
    """Arrays of a world in which nothing is added any more.

    motion holds position, velocity, quaternion and angular_momentum and is advanced in place; pairs carry the history
    of contacts; lost [3] (see Pairs) and watch_record count on across engines.
    """

    def __init__(
        self,
        bodies: list[RigidBody],
        planes: list[Plane],
        options: dict[str, str],
        motion: dict[str, Floats],
        pairs: Pairs,
        lost: Floats,
        watch_record: Floats,
        thread_count: int,
        period: Period,
    ) -> None:
        parts = parts_of(bodies)
        shapes, materials = shapes_of(parts), materials_of(parts, planes)
        self.cores: Cores = cores_of(shapes)
        self.laws: Laws = laws_of(materials, options)
        self.planes: Planes = planes_of(planes, materials, len(bodies))
        self.bodies: Bodies = bodies_of(bodies, parts, shapes, materials, motion, period)
        self.pairs: Pairs
        self.scratch: Scratch
        self.team: Team | None
        self.lost, self.watch_record = lost, watch_record
        self.skin = SKIN * float(self.bodies.bounding_radius.min())
        refuse_short_period(period, self.bodies.bounding_radius, self.skin)
        self.thread_count, self.pool = thread_count, pool_of(thread_count)
        # Neighbours are not listed yet, and no list of features says when it was made.
        self.gather(pairs)
        self.pairs.wake[:] = 0.0

    def advance(self, steps: int, step: Step, watched: int) -> tuple[int, int]:
        """Take steps; return how many were taken, and why it ended (DONE, or what is wrong).

        A step of no duration computes the forces at hand.
        """
        left, drifted = steps, False
        while left > 0:
            taken, reason, drifted = self._advance(left, drifted, step, watched)
            left -= taken
            if reason == LIST_USED_UP:
                self.list_neighbours()
            elif reason == FEATURES_OVERFLOW:
                self.gather(with_more_overflow(self.pairs))
            elif reason != DONE:
                return steps - left, reason
        return steps, DONE

    def _advance(self, steps: int, drifted: bool, step: Step, watched: int) -> tuple[int, int, bool]:
        """Take steps until the lists have to be renewed, on one thread or on several."""
        if self.team is None:
            return advance(
                self.system(NO_REACTIONS), step, self.whole, steps, drifted, self._travel_limit, watched,
                self.watch_record,
            )  # fmt: skip
        return self.team.advance(
            self.system(self.team.reactions), step, steps, drifted, self._travel_limit, watched, self.watch_record
        )

    def system(self, reactions: Reactions) -> System:
        """Return all that contact forces are computed from, with room for what pairs do."""
        return System(self.bodies, self.cores, self.planes, self.pairs, self.laws, self.scratch, reactions)

    def losses(self) -> Floats:
        """Return what damping, friction and rolling have taken so far [J], shape [3]."""
        lost = self.lost + self.pairs.lost.sum(axis=0)
        lost[DAMPING] += self.bodies.dragged.sum()
        return lost

    def book(self) -> None:
        """Enter the losses of pairs and bodies into the sums, before these arrays are left."""
        self.lost[:] = self.losses()
        self.pairs.lost[:], self.bodies.dragged[:] = 0.0, 0.0

    def restore(self, moving: dict[str, Floats], pairs: Pairs, skin: float) -> None:
        """Go on from where another engine for the same bodies stood: its MOVING arrays, pairs, and skin [m]."""
        for name, values in moving.items():
            getattr(self.bodies, name)[:] = values
        write_matrices(self.bodies)
        self.skin = skin
        self.gather(pairs)

    def use_threads(self, thread_count: int) -> None:
        """Go on with so many threads."""
        self.thread_count, self.pool = thread_count, pool_of(thread_count)
        self.gather(self.pairs)

    def gather(self, pairs: Pairs) -> None:
        """Take on pairs: make scratch for them, and divide them among the threads."""
        self.pairs, self.scratch = pairs, self.scratch_of(pairs)
        self.whole, *_ = partitions_of(pairs, len(self.bodies.mass), 1)
        self.team = None
        if self.pool is not None:
            scratches = [self.scratch_of(pairs) for _ in range(self.thread_count)]
            self.team = Team(self.pool, scratches, len(self.bodies.mass), pairs)

    def scratch_of(self, pairs: Pairs) -> Scratch:
        """Return scratch with room for every contact of these pairs."""
        shape = self.bodies.shape
        vertices, edges = (
            np.sort(np.diff(start)[shape])[-2:] for start in (self.cores.vertex_start, self.cores.edge_start)
        )
        # All corners and all pairs of edges of the two largest bodies, should they cross, and a list's worth beside.
        points = 1 + int(vertices.sum() + 2 * edges.prod()) + INLINE_FEATURES + pairs.overflow.shape[1]
        return scratch_for(int(vertices.max() + edges.max()), points)

    @property
    def _travel_limit(self) -> float:
        """How far a surface may come nearer to others before neighbours are listed anew [m]."""
        return 0.5 * (1.0 - BOUND_SLACK) * self.skin

    def list_neighbours(self) -> None:
        """List neighbours anew; contacts keep their history."""
        self.book()
        pairs = neighbouring_pairs(self.bodies, self.cores, self.planes, self.scratch, self.skin)
        self.gather(carry_over(self.pairs, pairs))
        self.bodies.travel_listed[:] = self.bodies.travel
