"""A bounce law in a loop of your own: landers bounce to rest.

lithobrake run quick --out runs/quick
lithobrake export runs/quick --to bounce-law
python examples/bounce_law_loop.py runs/quick/export 200

The simulation stands for one of yours: it steps a state until an event, the touchdown, asks the law how it ends, and
goes on from there. Its body is a sphere that turns, of the size, mass and period of Dimorphos, without a partner. Only
NumPy and the reader beside the law are needed.
"""

import math
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

RADIUS, GRAVITY_PARAMETER, PERIOD = 75.5, 0.287, 42_912.0  # m, m3/s2, s
RATE = 2.0 * math.pi / PERIOD  # rad/s
# A lander that is farther away than this has escaped [m].
FAR = 20.0 * RADIUS
STEP, LONGEST, SEED = 20.0, 48 * 3600.0, 1  # s, s
ALTITUDE, DELIVERY = 30.0, 0.05  # m, m/s


def rates(state: np.ndarray) -> np.ndarray:
    """Rates of position [m] and velocity [m/s] in the frame that turns with the body, [6]."""
    x, y, z, *velocity = state.tolist()
    pull = -GRAVITY_PARAMETER / math.hypot(x, y, z) ** 3
    # Gravity, centrifugal acceleration and Coriolis.
    along_x = (pull + RATE**2) * x + 2.0 * RATE * velocity[1]
    along_y = (pull + RATE**2) * y - 2.0 * RATE * velocity[0]
    return np.array([*velocity, along_x, along_y, pull * z])


def stepped(state: np.ndarray, step: float) -> np.ndarray:
    """The state after a step of the classical Runge-Kutta method."""
    first = rates(state)
    second = rates(state + 0.5 * step * first)
    third = rates(state + 0.5 * step * second)
    return state + step / 6.0 * (first + 2.0 * second + 2.0 * third + rates(state + step * third))


def altitude(state: np.ndarray) -> float:
    """Height above the ground [m]."""
    return float(np.linalg.norm(state[:3])) - RADIUS


def next_touchdown(state: np.ndarray, left: float) -> tuple[np.ndarray, float]:
    """The state at the next touchdown, far away, or when the time is up, and the time until then [s]."""
    time = 0.0
    while time < left and altitude(state) < FAR:
        after = stepped(state, STEP)
        if altitude(after) < 0.0 and state[:3] @ after[3:] < 0.0:
            low, high = 0.0, STEP
            for _ in range(40):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if altitude(stepped(state, middle)) > 0.0 else (low, middle)
            return stepped(state, low), time + low
        state, time = after, time + STEP
    return state, time


def frame_of(velocity: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Axes of a touchdown in rows: x along the horizontal velocity, z along the outward normal, y = z cross x."""
    level = velocity - (velocity @ normal) * normal
    if np.linalg.norm(level) < 1e-12:
        level = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    x = level / np.linalg.norm(level)
    return np.array([x, np.cross(normal, x), normal])


def conditions_of(law: Any, soil: dict[str, float], velocity: np.ndarray, felt: np.ndarray) -> dict[str, float]:
    """What the law reads of a touchdown; velocity [m/s] and acceleration of what rests there [m/s2] in its frame."""
    speed, strength = float(np.linalg.norm(velocity)), float(np.linalg.norm(felt))
    # A study has no touchdown slower than its slowest, which also stands for those of its own journeys.
    slowest = law.ranges["impact.speed"][0]
    return soil | {
        "impact.speed": max(speed, slowest),
        "impact.incidence_deg": math.degrees(math.acos(min(1.0, -velocity[2] / speed))),
        "surface.gravity": strength,
        "surface.slope_deg": math.degrees(math.acos(min(1.0, -felt[2] / strength))),
    }


def journey(law: Any, refusal: type[Exception], number: int) -> tuple[str, float, int]:
    """How a lander ends, when [s], and its touchdowns. Soil, lander and fit of the law are drawn once."""
    soil, fit = law.soil(SEED, number), 1 + number % (law.fit_count - 1)
    random = np.random.default_rng([SEED, number])
    incidence, heading = math.radians(random.uniform(0.0, 40.0)), random.uniform(0.0, 2.0 * math.pi)
    level = DELIVERY * math.sin(incidence)
    velocity = [-DELIVERY * math.cos(incidence), level * math.cos(heading), level * math.sin(heading)]
    state, time, count = np.array([RADIUS + ALTITUDE, 0.0, 0.0, *velocity]), 0.0, 0
    while time < LONGEST:
        state, passed = next_touchdown(state, LONGEST - time)
        time += passed
        if time >= LONGEST or altitude(state) >= FAR:
            return ("escaped" if altitude(state) >= FAR else "under way"), time, count
        axes = frame_of(state[3:], state[:3] / np.linalg.norm(state[:3]))
        felt = rates(np.concatenate([state[:3], np.zeros(3)]))[3:]
        try:
            conditions = conditions_of(law, soil, axes @ state[3:], axes @ felt)
            # Each touchdown of each journey has a number of its own. After minutes of flight any attitude is as likely.
            rebound = law.draw(conditions, SEED, 1000 * number + count, fit=fit)
        except refusal:
            return "outside the range of the law", time, count
        count, time = count + 1, time + np.nan_to_num(rebound.duration)
        if rebound.outcome != "clear":
            return rebound.outcome, time, count
        # The way leads along the ground; the next flight begins on it.
        place = state[:3] + rebound.way[:2] @ axes[:2]
        state = np.concatenate([place * RADIUS / np.linalg.norm(place), rebound.velocity @ axes])
    return "under way", time, count


def main(folder: str, lander_count: int) -> Counter[str]:
    """Follow landers, and print how they end."""
    sys.path.insert(0, folder)
    from bounce_law import BounceLaw, OutsideRangeError  # the reader that was exported beside the law

    law = BounceLaw(Path(folder) / "bounce_law.txt")
    found = [journey(law, OutsideRangeError, number) for number in range(lander_count)]
    ends = Counter(end for end, _, _ in found)
    for end, count in ends.most_common():
        hours, touchdowns = (np.median([one[part] for one in found if one[0] == end]) for part in (1, 2))
        share = 100.0 * count / lander_count
        print(f"{share:5.1f} % {end}: in the median after {hours / 3600.0:.1f} h; touchdowns: {touchdowns:.0f}")
    return ends


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 50)
