"""A bounce law in an event loop of Basilisk: a lander bounces to rest.

lithobrake run quick --out runs/quick
lithobrake export runs/quick --to bounce-law
pip install bsk
python examples/bounce_law_basilisk.py runs/quick/export

Basilisk's spacecraft flies around a sphere of the size, mass and period of Dimorphos. The simulation stops every few
seconds; where the lander has come down, the law gives the state with which it goes on. A finer stop finds the ground
more closely.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from Basilisk.simulation import gravityEffector, spacecraft
from Basilisk.utilities import RigidBodyKinematics, SimulationBaseClass, macros
from bounce_law_loop import GRAVITY_PARAMETER, RADIUS, RATE, conditions_of, frame_of

STEP, LONGEST, SEED = 2.0, 48 * 3600.0, 1  # s, s
INERTIA = np.diag([0.0102, 0.0102, 0.0033])  # kg m2
SPIN = np.array([0.0, 0.0, RATE])


def simulation() -> tuple[Any, Any, Any]:
    """The simulation, its lander, which comes down from 20 m, and the body, which must outlive this function."""
    found = SimulationBaseClass.SimBaseClass()
    found.CreateNewProcess("landing").addTask(found.CreateNewTask("flight", macros.sec2nano(STEP)))
    lander, body = spacecraft.Spacecraft(), gravityEffector.GravBodyData()
    body.planetName, body.mu, body.radEquator, body.isCentralBody = "body", GRAVITY_PARAMETER, RADIUS, True
    lander.gravField.gravBodies = spacecraft.GravBodyVector([body])
    lander.hub.mHub, lander.hub.IHubPntBc_B = 2.0, INERTIA.tolist()
    place = np.array([RADIUS + 20.0, 0.0, 0.0])
    lander.hub.r_CN_NInit, lander.hub.v_CN_NInit = place, np.cross(SPIN, place) + np.array([-0.05, 0.01, 0.0])
    lander.hub.omega_BN_BInit = [[0.01], [0.02], [0.0]]
    found.AddModelToTask("flight", lander)
    found.InitializeSimulation()
    return found, lander, body


def set_state(
    lander: Any, position: np.ndarray, velocity: np.ndarray, into_space: np.ndarray, spin: np.ndarray
) -> None:
    """Give the hub a state: along axes that do not turn, but the angular velocity along those of the lander."""
    mrp = RigidBodyKinematics.C2MRP(into_space.T)
    hub = lander.hub
    pairs = ((hub.nameOfHubPosition, position), (hub.nameOfHubVelocity, velocity), (hub.nameOfHubSigma, mrp),
             (hub.nameOfHubOmega, spin))  # fmt: skip
    for name, value in pairs:
        lander.dynManager.getStateObject(name).setState([[float(one)] for one in value])


def touch_down(law: Any, lander: Any, state: Any, soil: dict[str, float], draw: int) -> tuple[str, float]:
    """Draw a touchdown and put the lander where it ends; how it ended, and how long it took [s]."""
    position, velocity, spin = (np.array(one) for one in (state.r_BN_N, state.v_BN_N, state.omega_BN_B))
    into_space = RigidBodyKinematics.MRP2C(state.sigma_BN).T
    ground = np.cross(SPIN, position)
    axes = frame_of(velocity - ground, position / np.linalg.norm(position))
    felt = -GRAVITY_PARAMETER / np.linalg.norm(position) ** 3 * position - np.cross(SPIN, ground)
    rebound = law.draw(
        conditions_of(law, soil, axes @ (velocity - ground), axes @ felt), SEED, draw,
        attitude=RigidBodyKinematics.C2EP(RigidBodyKinematics.MRP2C(state.sigma_BN) @ axes.T).tolist(),
        spin=(axes @ (into_space @ spin - SPIN)).tolist(),
    )  # fmt: skip
    if rebound.outcome == "clear":
        place = position + rebound.way[:2] @ axes[:2]
        place *= RADIUS / np.linalg.norm(place)
        attitude = axes.T @ RigidBodyKinematics.EP2C(rebound.attitude).T
        whole = rebound.spin @ axes + SPIN
        set_state(lander, place, rebound.velocity @ axes + np.cross(SPIN, place), attitude, attitude.T @ whole)
    return rebound.outcome, float(np.nan_to_num(rebound.duration))


def main(folder: str) -> tuple[str, int]:
    """Follow one lander, and print its touchdowns."""
    sys.path.insert(0, folder)
    from bounce_law import BounceLaw  # the reader that was exported beside the law

    law = BounceLaw(Path(folder) / "bounce_law.txt")
    flight, lander, _ = simulation()
    soil, time, lost, count, outcome = law.soil(SEED, 0), 0.0, 0.0, 0, "in flight"
    while time < LONGEST and outcome in ("in flight", "clear"):
        time += STEP
        flight.ConfigureStopTime(macros.sec2nano(time))
        flight.ExecuteSimulation()
        state = lander.scStateOutMsg.read()
        place = np.array(state.r_BN_N)
        if np.linalg.norm(place) < RADIUS and place @ (np.array(state.v_BN_N) - np.cross(SPIN, place)) < 0.0:
            outcome, duration = touch_down(law, lander, state, soil, count)
            # The clock of Basilisk, and with it the body, stands still in a touchdown.
            count, lost = count + 1, lost + duration
            speed = float(np.linalg.norm(np.array(state.v_BN_N) - np.cross(SPIN, place)))
            print(f"{(time + lost) / 60.0:7.1f} min: impact at {speed:.3f} m/s, {outcome}")
    return outcome, count


if __name__ == "__main__":
    main(sys.argv[1])
