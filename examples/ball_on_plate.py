"""A ball bounces off a hard plate: the smallest solver that a study can use in place of its own soil.

As a program it reads `inputs.json` from its working folder and writes `outputs.json` there. Any Python can run it;
nothing has to be installed. `ball_on_plate_campaign.py` uses the function `bounce` directly.
"""

import json
import math
from pathlib import Path


def bounce(
    speed: float, incidence: float, restitution: float, friction: float, radius: float, spin: float, tilt: float
) -> dict[str, float]:
    """Velocity [m/s] and spin [rad/s] of a homogeneous ball after one impact in the x-z plane.

    speed [m/s] and incidence [rad, from the normal] of the arrival; spin about y [rad/s]; tilt: slope of the plate
    [rad], uphill along x, against the mean surface, which the outputs refer to. During the impact the contact slides
    until friction has brought it to rest, if it does: then two sevenths of the slip are gone.

    Source: Stronge (2000), Impact Mechanics, section 3.2 (rough sphere, Coulomb friction, Newton's restitution).
    """
    # Along the plate and away from it.
    along, away = speed * math.sin(incidence - tilt), -speed * math.cos(incidence - tilt)
    slip = along - radius * spin
    change = -math.copysign(min(friction * (1 + restitution) * -away, 2 / 7 * abs(slip)), slip)
    along, away = along + change, -restitution * away
    # The push at the lowest point of the ball turns it: moment m change radius on an inertia of 2/5 m radius^2.
    spin -= 5 / 2 * change / radius
    cosine, sine = math.cos(tilt), math.sin(tilt)
    return {
        "velocity_out_x": cosine * along - sine * away,
        "velocity_out_y": 0.0,
        "velocity_out_z": cosine * away + sine * along,
        "spin_out": abs(spin),
    }


def main() -> None:
    """Answer the question of one run."""
    inputs = json.loads(Path("inputs.json").read_text(encoding="utf-8"))["inputs"]
    outputs = bounce(
        speed=inputs["impact.speed"],
        incidence=math.radians(inputs["impact.incidence_deg"]),
        restitution=inputs["lander.restitution"],
        friction=inputs["lander.friction"],
        radius=inputs["lander.diameter"] / 2,
        spin=inputs["impact.spin_y"],
        tilt=math.radians(inputs["solver.inputs.plate_tilt_deg"]),
    )
    # Speed and elevation follow from the components. A lander that stays would be {"outcome": "captured"}.
    Path("outputs.json").write_text(json.dumps({"outcome": "clear", "outputs": outputs}), encoding="utf-8")


if __name__ == "__main__":
    main()
