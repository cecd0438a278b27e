"""Features of a pair as whole numbers: what the list of a pair holds.

A pair has room for a few; the few pairs that need more have a row of their own beside it.
"""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Pairs

# Kinds of features: a corner of the first on the second, of the second on the first (i, and one more than the number of
# the face below it, or 0), two edges (i and j), two spheres.
CORNER_OF_FIRST, CORNER_OF_SECOND, EDGES, SPHERES = 0, 1, 2, 3
KIND_BITS, INDEX_BITS = 40, 20
# Features that every pair has room for; few need more.
INLINE_FEATURES = 6
# In `feature_count`: the cores penetrate each other, and all their features are looked at.
ALL_FEATURES = -1


@kernel
def encode_feature(kind: int, i: int, j: int) -> int:
    """Return the number of a feature."""
    return (kind << KIND_BITS) + (i << INDEX_BITS) + j


@kernel
def feature_kind(feature: int) -> int:
    """Return the kind of a feature."""
    return feature >> KIND_BITS


@kernel
def feature_indices(feature: int) -> tuple[int, int]:
    """Return i and j of a feature."""
    lowest = (1 << INDEX_BITS) - 1
    return (feature >> INDEX_BITS) & lowest, feature & lowest


@kernel
def add_feature(pair: int, pairs: Pairs, kind: int, i: int, j: int) -> None:
    """Add a feature to the list of a pair; the count goes on where the list is full. Writes to pairs."""
    count, feature = pairs.feature_count[pair], encode_feature(kind, i, j)
    if count < feature_capacity(pair, pairs):
        if count < INLINE_FEATURES:
            pairs.feature[pair, count] = feature
        else:
            pairs.overflow[pairs.overflow_row[pair], count - INLINE_FEATURES] = feature
    pairs.feature_count[pair] = count + 1


@kernel
def feature_capacity(pair: int, pairs: Pairs) -> int:
    """Return how many features the list of a pair can hold."""
    return INLINE_FEATURES + pairs.overflow.shape[1] if pairs.overflow_row[pair] >= 0 else INLINE_FEATURES


@kernel
def listed_feature(pair: int, pairs: Pairs, k: int) -> int:
    """Return feature k of the list of a pair."""
    return (
        pairs.feature[pair, k] if k < INLINE_FEATURES else pairs.overflow[pairs.overflow_row[pair], k - INLINE_FEATURES]
    )
