"""Ground of studies that tests follow without soil, or only read: a small bed, and a rock of uncertain friction."""

from typing import Any

SMALL_GROUND: dict[str, Any] = {
    "bed": {"grain_count": 96, "width": [0.56, 0.56], "diameter": {"distribution": "constant", "value": 0.09}},
    "grain": {
        "density": 2500.0, "young_modulus": 1e6, "poisson_ratio": 0.25, "restitution": 0.5,
        "friction": {"distribution": "uniform", "lower": 0.8, "upper": 0.9},
    },
}  # fmt: skip
