"""How far a grain reaches from its centroid at most on ground that repeats: nothing there may meet itself.

One of some thousands of grains reaches farther; it is drawn again, and takes no wider ground.
"""

from itertools import pairwise

# In diameters, by the points of the cloud whose envelope the grain is.
LONGEST_GRAIN = {4: 16.0, 5: 5.0, 6: 3.2, 8: 1.9, 10: 1.55, 12: 1.45, 14: 1.25, 20: 1.05, 30: 0.9, 100: 0.7}


def longest_reach(point_count: int) -> float:
    """How far a grain of so many points, 4 to 100, may reach from its centroid, in its diameters."""
    (low, longer), (high, shorter) = next(ends for ends in pairwise(LONGEST_GRAIN.items()) if point_count <= ends[1][0])
    return longer + (shorter - longer) * (point_count - low) / (high - low)
