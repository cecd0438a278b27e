"""A bounce law in tudatpy: the pattern of arcs that end at the ground.

This file was written from the documentation of tudatpy 0.9 and has not been run: tudatpy is installed by conda alone.
The loop is that of bounce_law_basilisk.py, which runs.

python examples/bounce_law_tudat.py runs/quick/export
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from bounce_law_loop import GRAVITY_PARAMETER, RADIUS, RATE, conditions_of, frame_of
from tudatpy import numerical_simulation
from tudatpy.math import root_finders
from tudatpy.numerical_simulation import environment_setup, propagation_setup

STEP, LONGEST, SEED = 20.0, 48 * 3600.0, 1  # s, s
SPIN = np.array([0.0, 0.0, RATE])


def environment() -> Any:
    """A sphere with a gravity of its own at the origin, and the lander."""
    settings = environment_setup.BodyListSettings("SSB", "ECLIPJ2000")
    settings.add_empty_settings("Body")
    body = settings.get("Body")
    body.gravity_field_settings = environment_setup.gravity_field.central(GRAVITY_PARAMETER)
    body.shape_settings = environment_setup.shape.spherical(RADIUS)
    body.ephemeris_settings = environment_setup.ephemeris.constant(np.zeros(6), "SSB", "ECLIPJ2000")
    body.rotation_model_settings = environment_setup.rotation_model.simple(
        "ECLIPJ2000", "Body_Fixed", np.eye(3), 0.0, RATE
    )
    bodies = environment_setup.create_system_of_bodies(settings)
    bodies.create_empty_body("Lander")
    return bodies


def next_touchdown(bodies: Any, state: np.ndarray, time: float) -> tuple[np.ndarray, float]:
    """State and time at the ground, or when the time is up."""
    gravity = {"Lander": {"Body": [propagation_setup.acceleration.point_mass_gravity()]}}
    accelerations = propagation_setup.create_acceleration_models(bodies, gravity, ["Lander"], ["Body"])
    altitude = propagation_setup.dependent_variable.altitude("Lander", "Body")
    finder = root_finders.bisection(1e-6, 50)
    ends = [
        propagation_setup.propagator.dependent_variable_termination(altitude, 0.0, True, True, finder),
        propagation_setup.propagator.time_termination(LONGEST),
    ]
    arc = propagation_setup.propagator.translational(
        ["Body"], accelerations, ["Lander"], state, time,
        propagation_setup.integrator.runge_kutta_fixed_step(STEP, propagation_setup.integrator.CoefficientSets.rk_4),
        propagation_setup.propagator.hybrid_termination(ends, fulfill_single_condition=True),
    )  # fmt: skip
    history = numerical_simulation.create_dynamics_simulator(bodies, arc).propagation_results.state_history
    last = max(history)
    return np.array(history[last]), float(last)


def touch_down(law: Any, soil: dict[str, float], state: np.ndarray, draw: int) -> tuple[str, np.ndarray, float]:
    """How a touchdown ends, the state after it, and how long it takes [s]."""
    position, ground = state[:3], np.cross(SPIN, state[:3])
    axes = frame_of(state[3:] - ground, position / np.linalg.norm(position))
    felt = -GRAVITY_PARAMETER / np.linalg.norm(position) ** 3 * position - np.cross(SPIN, ground)
    # Without an attitude the law takes any, which holds after minutes of flight.
    rebound = law.draw(conditions_of(law, soil, axes @ (state[3:] - ground), axes @ felt), SEED, draw)
    place = position + np.nan_to_num(rebound.way[:2]) @ axes[:2]
    # Just above the ground, where the next arc does not end at once.
    place *= (RADIUS + 1e-3) / np.linalg.norm(place)
    velocity = np.nan_to_num(rebound.velocity) @ axes + np.cross(SPIN, place)
    return rebound.outcome, np.concatenate([place, velocity]), float(np.nan_to_num(rebound.duration))


def main(folder: str) -> None:
    """Follow one lander, and print its touchdowns."""
    sys.path.insert(0, folder)
    from bounce_law import BounceLaw  # the reader that was exported beside the law

    law, bodies = BounceLaw(Path(folder) / "bounce_law.txt"), environment()
    soil, time, count, outcome = law.soil(SEED, 0), 0.0, 0, "in flight"
    place = np.array([RADIUS + 20.0, 0.0, 0.0])
    state = np.concatenate([place, np.cross(SPIN, place) + np.array([-0.05, 0.01, 0.0])])
    while outcome in ("in flight", "clear"):
        state, time = next_touchdown(bodies, state, time)
        if time >= LONGEST:
            break
        outcome, state, duration = touch_down(law, soil, state, count)
        count, time = count + 1, time + duration
        print(f"{time / 60.0:7.1f} min: {outcome}")


if __name__ == "__main__":
    main(sys.argv[1])
