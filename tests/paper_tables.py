"""The template as a study of the two steps: a screening over all inputs, then more runs over those that matter."""

import tomllib
from typing import Any

from lithobrake.study.template import template


def paper_tables() -> dict[str, Any]:
    """The tables of the template with the method "paper" and small grids."""
    design = {"method": "paper", "screening_level": 2, "screening_degree": 2, "refined_level": 3, "refined_degree": 3}
    return tomllib.loads(template()) | {"design": design | {"test_count": 10}}
