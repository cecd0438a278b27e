"""Landers that rest where they come down, on a ball: a law in closed form."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from ...smallbody.meshes import sphere_mesh
from ..journeys.bouncing_lander import _attitude, _contact, _rebound, journey_tables

# Radius of the body, standard deviation of the errors, and the distance that is required [m].
RADIUS, SIGMA, NEAR = 400.0, 15.0, 30.0
GRAVITY, CONSTANT = 5e-5, 6.6743e-11
# Hops of this speed are 0.1 m high and end 0.3 m away at most.
HOP = 0.003


def admissible_errors(required: float, sigma: float = SIGMA) -> float:
    """The factor of the errors at which 1 - exp(-R2 / 2 s2) is the required probability, exactly (Rayleigh)."""
    return NEAR / math.sqrt(-2.0 * math.log(1.0 - required)) / sigma


def rest(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """Half of the landers hop once, by centimetres; the others rest where they come down."""
    random = np.random.default_rng(seed)
    outputs = _contact(0.0) | _attitude(random)
    if inputs["touchdown"] > 0 or random.random() < 0.5:
        return {"outcome": "captured", "outputs": outputs}
    up = HOP * inputs["grain.friction"] * random.uniform(0.5, 1.0)
    return {"outcome": "clear", "outputs": outputs | _rebound(0.5 * up, up, 0.1 * random.uniform(0.5, 1.0))}


def resting_tables(folder: Path, **changes: dict[str, Any]) -> dict[str, Any]:
    """The tables of a study of these landers, aimed at the middle of a facet; its shape is written to the folder."""
    vertices, faces = sphere_mesh(4)
    middle = vertices[faces[5]].mean(axis=0)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (RADIUS * vertices).tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    (folder / "ball.obj").write_text("\n".join(lines), encoding="utf-8")
    error = {"distribution": "normal", "mean": 0.0, "std": SIGMA}
    own: dict[str, dict[str, Any]] = {
        "site": {
            "body": str(folder / "ball.obj"), "mass": GRAVITY * RADIUS**2 / CONSTANT, "spin_period": 1e6,
        },
        "delivery": {
            "latitude_deg": math.degrees(math.asin(middle[2] / np.linalg.norm(middle))),
            "longitude_deg": math.degrees(math.atan2(middle[1], middle[0])),
            "north_error": error, "east_error": error,
        },
        "limit_states": {"near": f"distance < {NEAR}", "fast": "speed_out > 0.1", "upright": "face == +z"},
        "journey": {"emulated_count": 100},
    }  # fmt: skip
    return {k: v for k, v in journey_tables(**{**own, **changes}).items() if k != "sky"}
