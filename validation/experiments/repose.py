"""The slope at which a heap of beads stays when one end of its box is opened."""

import math
import time
from dataclasses import replace

import numpy as np
from result_rows import Row
from sphere_bed import LOOKS, Beads, come_to_rest

from lithobrake.dem import Sphere, World

LONG, HIGH, ACROSS = 15.0, 9.0, 5.0  # beads that the box holds along, upwards and between its smooth walls


def angle_of_repose(beads: Beads, seed: int) -> Row:
    """Fill a narrow box, open one end above its lowest two layers, and measure the slope of what stays on them.

    The lowest two layers stay behind the gate: a floor as rough as the heap. What leaves is caught below.
    """
    start, generator = time.process_time(), np.random.default_rng(seed)
    size, material, gravity = beads.mean_diameter, beads.material, beads.gravity
    count = round(0.58 * LONG * HIGH * ACROSS / (math.pi / 6.0))
    smooth = replace(material, friction=0.0)
    world = World((0.0, 0.0, -gravity), None)
    pitch = 1.03 * max(beads.diameters)
    row = (int(LONG * size / pitch), int(ACROSS * size / pitch))
    for k in range(count):
        cell = np.array([k % row[0], k // row[0] % row[1], k // (row[0] * row[1])]) + 0.5
        place = cell * [LONG * size / row[0], ACROSS * size / row[1], pitch]
        world.add_body(
            Sphere(0.5 * generator.choice(beads.diameters)),
            material,
            place + 0.015 * pitch * generator.uniform(-1.0, 1.0, 3),
        )
    world.add_plane((0, 0, 0), (0, 0, 1), material)
    world.add_plane((0, 0, 0), (1, 0, 0), material)
    world.add_plane((0, 0, 0), (0, 1, 0), smooth)
    world.add_plane((0, ACROSS * size, 0), (0, -1, 0), smooth)
    world.add_plane((0, 0, -8.0 * size), (0, 0, 1), material)
    gate = world.add_plane((LONG * size, 0, 0), (-1, 0, 0), material)
    world.drag = math.sqrt(gravity / size) / 3.0
    come_to_rest(world, beads, LOOKS)
    filled = float(world.position[:, 2].max())
    world.move_plane(gate, bodies=[int(k) for k in np.flatnonzero(world.position[:, 2] < 2.0 * size)])
    tick = 2.0 * math.sqrt(size / gravity)
    for _ in range(60):
        world.run(duration=tick)
        staying = np.flatnonzero((world.position[:, 0] < LONG * size) & (world.position[:, 2] > 0.0))
        world.move_plane(0, bodies=[int(k) for k in staying])
        if np.abs(world.velocity[staying]).max() < 0.02 * math.sqrt(gravity * size):
            break
    left = world.position[staying]
    return {
        "seed": seed, "friction": material.friction, "beads": count, "stayed": len(staying),
        "height_left": float(left[:, 2].max()) / filled, "angle_deg": surface_slope(left, size, LONG * size),
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def surface_slope(position: np.ndarray, size: float, length: float) -> float:
    """Angle [deg] of a line through the highest bead of each slice, two beads from the wall and the edge."""
    edges = np.arange(2.0 * size, length - 2.5 * size, size)
    tops = [position[(position[:, 0] >= low) & (position[:, 0] < low + size), 2].max() for low in edges]
    return math.degrees(math.atan(-np.polyfit(edges, tops, 1)[0]))
