"""How exact flights are: against another integrator, and against our own at tight tolerance.

All start from latitude and longitude 0 of the built-in Didymos at 0.01 to 0.4 m/s within 60 deg of the vertical and
last up to 12 h. The other integrator is SciPy's DOP853, about Didymos alone, with its own test for the ground and for
escape; its gravity is that of polyhedral-gravity where that is installed, else our sum over the facets.
Results go into flight_accuracy.json beside this file.
Usage: python validation/flight_accuracy.py [--oracle 200] [--own 2000]
"""

import platform
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from scipy.integrate import solve_ivp

from lithobrake.smallbody import Body, didymos, fly

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from flight_speed import cone
from harness import Row, command_line, origin, write_document

RESULTS = Path(__file__).with_suffix(".json")
DURATION = 12 * 3600.0
TIGHT = 1e-11


def gravity(body: Body) -> tuple[str, Callable[[np.ndarray], np.ndarray]]:
    """Name and acceleration [m/s2] at one point [m], from the library of others if it is there."""
    if not find_spec("polyhedral_gravity"):
        return "lithobrake", body.acceleration
    import polyhedral_gravity as library

    polyhedron = library.Polyhedron(
        polyhedral_source=(body.shape.vertices, body.shape.faces),
        density=body.density,
        normal_orientation=library.NormalOrientation.OUTWARDS,
        integrity_check=library.PolyhedronIntegrity.DISABLE,
    )
    evaluable = library.GravityEvaluable(polyhedron)
    return "polyhedral-gravity", lambda point: np.asarray(evaluable(point, parallel=False)[1])


def oracle(body: Body, position: np.ndarray, velocity: np.ndarray) -> tuple[str, float, np.ndarray]:
    """Status, time [s] and place [m] at the end of one flight by DOP853."""
    push, spin = gravity(body)[1], body.spin_rate
    # The body is star-shaped: a point is outside where its coordinates in the cone of its facet add up to more than 1.
    cones = np.linalg.inv(np.swapaxes(body.shape.corners, 1, 2))

    def slope(_time: float, state: np.ndarray) -> list[float]:
        x, y, _, u, v, _ = state
        pull = push(state[:3])
        return [*state[3:], pull[0] + spin * (spin * x + 2.0 * v), pull[1] + spin * (spin * y - 2.0 * u), pull[2]]

    def ground(time: float, state: np.ndarray) -> float:
        shares = cones @ state[:3]
        return float(shares[shares.min(axis=1).argmax()].sum() - 1.0) if time > 1.0 else 1.0

    def away(_time: float, state: np.ndarray) -> float:
        x, y, z, u, v, w = state
        energy = 0.5 * ((u - spin * y) ** 2 + (v + spin * x) ** 2 + w * w)
        distance = float(np.sqrt(x * x + y * y + z * z))
        bound = energy < body.gravitational_parameter / distance
        return -1.0 if bound else distance - 10.0 * body.shape.radius

    ground.terminal, ground.direction = True, -1  # type: ignore[attr-defined]
    away.terminal, away.direction = True, 1  # type: ignore[attr-defined]
    limits: dict[str, Any] = {"rtol": 1e-11, "atol": 1e-9, "max_step": 60.0, "first_step": 0.5}
    start = np.concatenate([position, velocity])
    end = solve_ivp(slope, (0.0, DURATION), start, method="DOP853", events=[ground, away], **limits)
    status = "flying" if end.status == 0 else ("impact" if len(end.t_events[0]) else "escaped")
    return status, float(end.t[-1]), end.y[:3, -1]


def compared(name: str, truth: tuple[np.ndarray, ...], tested: tuple[np.ndarray, ...]) -> Row:
    """How often the ends agree, and how far apart impacts are in place and time; both: status, time, position."""
    same = truth[0] == tested[0]
    hit = same & (truth[0] == "impact")
    apart, late = np.linalg.norm(truth[2] - tested[2], axis=1)[hit], np.abs(truth[1] - tested[1])[hit]
    row = {"case": name, "flights": len(same), "status_equal": float(same.mean()), "impacts": int(hit.sum())}
    row |= {f"apart_m_{level}": float(np.quantile(apart, q)) for level, q in (("median", 0.5), ("p95", 0.95))}
    row |= {"apart_m_largest": float(apart.max()), "late_s_p95": float(np.quantile(late, 0.95))}
    print(row)
    return row


def ends(body: Body, start: tuple[np.ndarray, np.ndarray], **choices: Any) -> tuple[np.ndarray, ...]:
    """Status, time and place at the ends of our flights."""
    flights = fly(body, *start, DURATION, **choices)
    if body.partner is None:
        drift = np.abs(flights.jacobi_drift)
        print(f"{choices}: Jacobi constant drifts by {np.median(drift):.1e} in the median, {drift.max():.1e} at most")
    return flights.status, flights.time, flights.position


def main() -> None:
    options = command_line(__doc__, oracle=200, own=2000).parse_args()
    alone, rows = didymos(partner=False), []
    start = cone(alone, options.oracle, seed=3)
    flown = [oracle(alone, *pair) for pair in zip(*start, strict=True)]
    truth = tuple(np.array(column) for column in zip(*flown, strict=True))
    against = f"DOP853 with the gravity of {gravity(alone)[0]}"
    for kind in ("exact", "table"):
        rows.append(compared(f"{kind}, alone, against {against}", truth, ends(alone, start, gravity=kind)))
    for body, which in ((alone, "alone"), (didymos(), "with Dimorphos")):
        start = cone(body, options.own, seed=4)
        truth = ends(body, start, tolerance=TIGHT)
        for kind in ("exact", "table"):
            name = f"{kind}, {which}, against exact at a tolerance of {TIGHT:g}"
            rows.append(compared(name, truth, ends(body, start, gravity=kind)))
    result = {
        **origin(" ".join(["validation/flight_accuracy.py", *sys.argv[1:]])),
        "python": platform.python_version(),
        "scipy": scipy.__version__,
        "rows": rows,
    }
    write_document(RESULTS, result)


if __name__ == "__main__":
    main()
