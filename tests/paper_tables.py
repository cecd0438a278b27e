"""Tables of studies: the template as the paper's analysis, ground that is small, and tables with other keys."""

import tomllib
from typing import Any

from lithobrake.study.template import template

# Of studies that tests follow without soil, or only read: a small bed, and a rock of uncertain friction.
SMALL_GROUND: dict[str, Any] = {
    "bed": {"grain_count": 96, "width": [0.56, 0.56], "diameter": {"distribution": "constant", "value": 0.09}},
    "grain": {
        "density": 2500.0, "young_modulus": 1e6, "poisson_ratio": 0.25, "restitution": 0.5,
        "friction": {"distribution": "uniform", "lower": 0.8, "upper": 0.9},
    },
}  # fmt: skip


def paper_tables() -> dict[str, Any]:
    """The template on one bed, at one place and in one attitude, with expansions on small grids and no drawn lander."""
    levels = {"screening_level": 2, "screening_degree": 2, "refined_level": 3, "refined_degree": 3, "test_count": 10}
    return with_keys(
        tomllib.loads(template()),
        {
            "bed": {"sides": "walls", "bed_count": 1},
            "impact": {"azimuth_deg": 0.0, "place": {"x": 0.0, "y": 0.0}, "orientation": [1.0, 0.0, 0.0, 0.0]},
            "contact": {"held_speed": 0.0},
            "journey": {"duration": 86_400.0},
            "design": {"run_count": 0},
            "expansion": levels,
            "hard_ground": {"count": 100},
        },
    )


def with_keys(tables: dict[str, Any], changes: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """Tables of a study with other keys in some of them."""
    return tables | {name: tables.get(name, {}) | keys for name, keys in changes.items()}
