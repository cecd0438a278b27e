"""Arrays in which kernels keep what they work out on the way: one set for each thread, overwritten by every pair."""

from typing import NamedTuple

import numpy as np

from lithobrake.dem.bodies.arrays import Bodies, Cores, Laws, Pairs, Planes, Reactions
from lithobrake.vocabulary.array_types import Floats, Integers


class Simplex(NamedTuple):
    """Corners of the difference of two cores, among which the closest point to the origin is sought (gjk.py)."""

    on_first: Floats  # [4, 3]
    on_second: Floats  # [4, 3]
    difference: Floats  # [4, 3]
    vertex: Integers  # [4, 2], of either core
    weight: Floats  # [4], of the corners in the closest point
    steps: Integers  # [1], that the last search took


class TurnedFeatures(NamedTuple):
    """Corners or edges of the second core, turned into the first's frame once for all they are compared with."""

    feature: Floats  # [edge_count_max + vertex_count_max, 12], a corner; an edge with its normals, or with its box
    edge: Integers  # [edge_count_max + vertex_count_max], which edges these are


class Patch(NamedTuple):
    point: Floats  # [point_max, 3]
    normal: Floats  # [point_max, 3], from first to second
    couple: Floats  # [point_max, 3], of deep edges, see deep_edges.py
    depth: Floats  # [point_max], overlap at the point
    family: Integers  # [point_max], see patch_energy.py
    weight: Floats  # [point_max], derivative of the patch's overlap by that of the point


class Scratch(NamedTuple):
    simplex: Simplex
    turned: TurnedFeatures
    relative: Floats  # [1, 3, 3], rotation from the second body's frame to the first's
    patch: Patch


class System(NamedTuple):
    bodies: Bodies
    cores: Cores
    planes: Planes
    pairs: Pairs
    laws: Laws
    scratch: Scratch
    reactions: Reactions


def scratch_for(feature_max: int, point_max: int) -> Scratch:
    simplex = Simplex(
        np.zeros((4, 3)), np.zeros((4, 3)), np.zeros((4, 3)), np.zeros((4, 2), dtype=np.int64), np.zeros(4),
        np.zeros(1, dtype=np.int64),
    )  # fmt: skip
    turned = TurnedFeatures(np.zeros((feature_max, 12)), np.zeros(feature_max, dtype=np.int64))
    patch = Patch(
        np.zeros((point_max, 3)), np.zeros((point_max, 3)), np.zeros((point_max, 3)), np.zeros(point_max),
        np.zeros(point_max, dtype=np.int64), np.zeros(point_max),
    )  # fmt: skip
    return Scratch(simplex, turned, np.zeros((1, 3, 3)), patch)
