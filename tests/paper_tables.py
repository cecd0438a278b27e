"""Tables of studies: the template as one of two steps, ground that is small, and tables with other keys."""

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
    """The tables of the template with the method "paper" and small grids."""
    design = {"method": "paper", "screening_level": 2, "screening_degree": 2, "refined_level": 3, "refined_degree": 3}
    return tomllib.loads(template()) | {"design": design | {"test_count": 10}}


def with_keys(tables: dict[str, Any], changes: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """Tables of a study with other keys in some of them."""
    return tables | {name: tables.get(name, {}) | keys for name, keys in changes.items()}
