"""A bounce law as the contact with the soil in MuJoCo: a box hops.

lithobrake run quick --out runs/quick
lithobrake export runs/quick --to bounce-law
pip install mujoco
python examples/bounce_law_mujoco.py runs/quick/export

Geometries have no contacts. When a corner of the box is below the ground on its way down, the law gives velocity, spin
and attitude with which it leaves, or that it is captured. For another lander change the edges: a law holds for the
lander of its study, whose edges stand in its head.
"""

import math
import sys
from itertools import product
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

EDGES, MASS, GRAVITY, SEED = (0.1, 0.1, 0.227), 2.0, 4.5e-5, 1  # m, kg, m/s2
STEP, LONGEST = 0.5, 48 * 3600.0  # s, s
CORNERS = 0.5 * np.array(EDGES) * np.array(list(product((-1, 1), repeat=3)))
HALF = " ".join(str(0.5 * edge) for edge in EDGES)
MODEL = f"""<mujoco>
  <option timestep="{STEP}" gravity="0 0 {-GRAVITY}" integrator="RK4"/>
  <worldbody>
    <geom type="plane" size="100 100 1" contype="0" conaffinity="0"/>
    <body name="lander"><freejoint/><geom type="box" size="{HALF}" mass="{MASS}" contype="0" conaffinity="0"/></body>
  </worldbody>
</mujoco>"""


def turned(attitude: np.ndarray) -> np.ndarray:
    """The matrix that turns the lander's axes into those of the world, of a quaternion w, x, y, z."""
    found = np.zeros(9)
    mujoco.mju_quat2Mat(found, attitude)
    return found.reshape(3, 3)


def frame_of(velocity: np.ndarray) -> np.ndarray:
    """Axes of a touchdown on level ground in rows: x along the horizontal velocity, z upward, y = z cross x."""
    length = math.hypot(velocity[0], velocity[1])
    x = np.array([velocity[0], velocity[1], 0.0]) / length if length > 1e-12 else np.array([1.0, 0.0, 0.0])
    return np.array([x, np.cross([0.0, 0.0, 1.0], x), [0.0, 0.0, 1.0]])


def quaternion(matrix: np.ndarray) -> np.ndarray:
    """The quaternion w, x, y, z of a rotation matrix."""
    found = np.zeros(4)
    mujoco.mju_mat2Quat(found, np.ascontiguousarray(matrix).ravel())
    return found


def touch_down(law: Any, data: Any, soil: dict[str, float], draw: int) -> str:
    """Put the lander where a drawn touchdown leaves it, and say how that ended."""
    velocity, into_world = data.qvel[:3].copy(), turned(data.qpos[3:7])
    axes, speed = frame_of(velocity), float(np.linalg.norm(velocity))
    conditions = soil | {
        # A study has no touchdown slower than its slowest, which also stands for those of its own journeys.
        "impact.speed": max(speed, law.ranges["impact.speed"][0]),
        "impact.incidence_deg": math.degrees(math.acos(min(1.0, -velocity[2] / speed))),
        "surface.gravity": GRAVITY,
        "surface.slope_deg": 0.0,
    }
    # MuJoCo has the angular velocity of a free joint along the axes of the body, the law along those of the frame.
    spin = axes @ (into_world @ data.qvel[3:6])
    rebound = law.draw(conditions, SEED, draw, attitude=quaternion(axes @ into_world), spin=spin)
    data.time += np.nan_to_num(rebound.duration)
    if not np.isnan(rebound.attitude).any():
        into_world = axes.T @ turned(rebound.attitude)
        data.qpos[3:7] = quaternion(into_world)
    data.qpos[:3] += np.nan_to_num(rebound.way) @ axes
    data.qvel[:3] = np.nan_to_num(rebound.velocity) @ axes
    data.qvel[3:6] = into_world.T @ (np.nan_to_num(rebound.spin) @ axes)
    return str(rebound.outcome)


def main(folder: str) -> tuple[str, int]:
    """Follow one lander, and print its touchdowns."""
    sys.path.insert(0, folder)
    from bounce_law import BounceLaw  # the reader that was exported beside the law

    law = BounceLaw(Path(folder) / "bounce_law.txt")
    model = mujoco.MjModel.from_xml_string(MODEL)
    data, soil, count, outcome = mujoco.MjData(model), law.soil(SEED, 0), 0, "in flight"
    data.qpos[:3], data.qvel[:] = (0.0, 0.0, 1.0), (0.02, 0.0, -0.05, 0.01, 0.02, 0.0)
    while data.time < LONGEST and outcome in ("in flight", "clear"):
        mujoco.mj_step(model, data)
        lowest = data.qpos[2] + (CORNERS @ turned(data.qpos[3:7]).T)[:, 2].min()
        if lowest < 0.0 and data.qvel[2] < 0.0:
            before = float(np.linalg.norm(data.qvel[:3]))
            outcome, count = touch_down(law, data, soil, count), count + 1
            after = float(np.linalg.norm(data.qvel[:3]))
            print(
                f"{data.time / 60.0:7.1f} min  x {data.qpos[0]:6.2f} m  {before:.3f} m/s to {after:.3f} m/s  {outcome}"
            )
    return outcome, count


if __name__ == "__main__":
    main(sys.argv[1])
