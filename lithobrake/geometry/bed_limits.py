"""How large boulders and grains of a bed may be, and when two lengths or moments of inertia count as the same."""

import math
from itertools import pairwise

# How far a boulder reaches from its centroid, in diameters of the sphere of equal volume. An ellipsoid with the axes of
# blocks on Ryugu, 2 : sqrt(2) : 1, reaches 0.71. Source: [Michikami-2022].
BOULDER_REACH = 0.75
# Discs dropped at random cover 0.547 of the ground until no more fits [Feder-1980]; boulders are wider than these.
LARGEST_COVERAGE = 0.3
# In diameters, by the points of the cloud whose envelope the grain is.
LONGEST_GRAIN = {4: 16.0, 5: 5.0, 6: 3.2, 8: 1.9, 10: 1.55, 12: 1.45, 14: 1.25, 20: 1.05, 30: 0.9, 100: 0.7}
# Two lengths or moments that are the same differ by less than this part.
ALIKE = 1e-6


def longest_reach(point_count: int) -> float:
    """How far a grain of so many points, 4 to 100, may reach from its centroid, in its diameters."""
    (low, longer), (high, shorter) = next(ends for ends in pairwise(LONGEST_GRAIN.items()) if point_count <= ends[1][0])
    return longer + (shorter - longer) * (point_count - low) / (high - low)


def alike(first: float, second: float) -> bool:
    """Whether two lengths, or two moments, are the same but for rounding."""
    return math.isclose(first, second, rel_tol=ALIKE)
