"""When two edges or moments of inertia count as the same."""

import math

# They differ by less than this part.
ALIKE = 1e-6


def alike(first: float, second: float) -> bool:
    """Whether two lengths, or two moments, are the same but for rounding."""
    return math.isclose(first, second, rel_tol=ALIKE)
