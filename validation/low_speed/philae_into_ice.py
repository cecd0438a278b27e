"""How strong is ice into which Philae's top side presses a dent of 0.25 m? A box on cohesive grains of 75 % porosity.

    python validation/low_speed/philae_into_ice.py --work FOLDER --out FOLDER [--names NAME ...]

The speed is that of a body that stops within the dent and the time of the source under a constant force. Rows that
stand in philae_into_ice.csv are not run again. Source: [ORourke-2020]; box, tilt, density and grains are ours.
"""

import math
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, ConvexHull, Material, World
from lithobrake.geometry.attitude import quaternion

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
from plate_into_loose_grains import Soil, put
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Floats, add_beads

HERE = Path(__file__).parent
NAME = "philae_into_ice.csv"
MASS, EDGES = 98.0, (0.8, 0.8, 0.8)  # kg, m
DENT, DURATION = 0.25, 3.0  # m, s: the source
SPEED = 2.0 * DENT / DURATION  # m/s
TILT_DEG = 10.0  # of the side that strikes first
LOOK, LONGEST = 0.05, 12.0  # s
STEPS = 20.0  # of its own that each contact takes


@dataclass(frozen=True)
class Ice:
    """What a run follows from. cohesion: the pull of a contact over the square of the mean diameter [Pa]."""

    cohesion: float = 0.0
    filled: float = 0.25
    grain: float = 0.1  # m, mean diameter
    density: float = 2000.0  # kg/m3, of a grain: 500 of the ice
    tilt_deg: float = TILT_DEG
    seed: int = 1

    @property
    def soil(self) -> Soil:
        """Grains of our own choice: put anywhere, between 0.8 and 1.2 of their mean diameter."""
        return Soil(
            filled=self.filled, grain=self.grain, width=2.0, depth=0.8, friction=0.6, rolling_friction=0.1,
            cohesion=self.cohesion, density=self.density, young_modulus=1e5, speed=SPEED, seed=self.seed,
        )  # fmt: skip


ICE = Ice()
NAMES = {
    **{f"{pull:g} Pa": replace(ICE, cohesion=pull) for pull in (0.0, 10.0, 100.0, 300.0, 1000.0)},
    "0 Pa, again": replace(ICE, seed=2),
    "100 Pa, again": replace(ICE, cohesion=100.0, seed=2),
    "100 Pa, filled 0.18": replace(ICE, cohesion=100.0, filled=0.18),
    "100 Pa, filled 0.32": replace(ICE, cohesion=100.0, filled=0.32),
    "10 Pa, filled 0.32": replace(ICE, cohesion=10.0, filled=0.32),
    "0 Pa, filled 0.32": replace(ICE, filled=0.32),
    "100 Pa, flat": replace(ICE, cohesion=100.0, tilt_deg=0.0),
    "100 Pa, light": replace(ICE, cohesion=100.0, density=400.0),
}


def pressed(ice: Ice) -> tuple[Row, Floats]:
    """Let the box come down; return the row and the path: time [s], depth of the lowest corner [m], speed [m/s]."""
    start, soil = time.process_time(), ice.soil
    place, radius = put(soil)
    stuff: Material = soil.material
    world = World(period=(soil.width, soil.width))
    add_beads(world, radius, stuff, place)
    world.add_plane((0, 0, -soil.depth), (0, 0, 1), stuff)
    box = ConvexHull(Box(EDGES).vertices)
    turn = Rotation.from_euler("x", math.radians(ice.tilt_deg))
    reach = -float(turn.apply(box.vertices)[:, 2].min())
    body = world.add_body(
        box, replace(stuff, cohesion_force=0.0), (0.0, 0.0, reach + 1e-6), (0.0, 0.0, -SPEED), quaternion(turn),
        mass=MASS, inertia=MASS / 6.0 * EDGES[0] ** 2 * np.eye(3),
    )  # fmt: skip
    path = [(0.0, 0.0, SPEED)]
    while world.time < LONGEST and path[-1][2] > 0.0:
        world.run_locally(LOOK, STEPS)
        now = Rotation.from_quat(world.orientation[body], scalar_first=True)
        lowest = float(world.position[body, 2] + now.apply(box.vertices)[:, 2].min())
        path.append((world.time, -lowest, -float(world.velocity[body, 2])))
    way = np.array(path)
    row = {"grains": len(radius), **read_off(way), "cpu_s": time.process_time() - start}
    return row, way


def read_off(way: Floats) -> Row:
    """Return the deepest place [m], when it is reached [s], and when the box is 0.25 m deep, NaN where it never is."""
    deepest = int(np.argmax(way[:, 1]))
    there = way[: deepest + 1]
    time_of_dent = math.nan
    if there[-1, 1] >= DENT:
        time_of_dent = float(np.interp(DENT, there[:, 1], there[:, 0]))
    return {
        "deepest": float(there[-1, 1]), "time_of_deepest": float(there[-1, 0]), "time_of_dent": time_of_dent,
        "speed_at_dent": float(np.interp(DENT, there[:, 1], there[:, 2])) if there[-1, 1] >= DENT else 0.0,
        "stopped": int(way[-1, 2] <= 0.0),
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__, HERE, names=tuple(NAMES))
    ran = {row["name"] for row in read_rows(given.out / NAME)}
    for name in given.names:
        if name not in ran:
            ice = NAMES[name]
            row, way = pressed(ice)
            np.savetxt(given.work / f"philae_{name.replace(' ', '_')}.txt", way)
            shown = {key: getattr(ice, key) for key in Ice.__dataclass_fields__}
            note(given.out / NAME, {"name": name, **shown, **row})


if __name__ == "__main__":
    main()
