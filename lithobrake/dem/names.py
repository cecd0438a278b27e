"""Names of features of a pair: what the list of a pair holds.

A pair has room for a few names; the few pairs that need more have a row of their own beside it.
"""

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Pairs

# Kinds of features: a corner of the first on the second, of the second on the first (i, and one more than the number of
# the face below it, or 0), two edges (i and j), two spheres.
CORNER_OF_FIRST, CORNER_OF_SECOND, EDGES, SPHERES = 0, 1, 2, 3
KIND_BITS, PLACE_BITS = 40, 20
# Names that every pair has room for; few need more.
NEAR = 6
# In `term_count`: the cores cross, and all their features are looked at.
DEEP = -1


@kernel
def feature_name(kind: int, i: int, j: int) -> int:
    """Return the name of a feature."""
    return (kind << KIND_BITS) + (i << PLACE_BITS) + j


@kernel
def kind_of(name: int) -> int:
    """Return the kind of a feature."""
    return name >> KIND_BITS


@kernel
def places_of(name: int) -> tuple[int, int]:
    """Return i and j of a feature."""
    lowest = (1 << PLACE_BITS) - 1
    return (name >> PLACE_BITS) & lowest, name & lowest


@kernel
def note_term(pairs: Pairs, pair: int, kind: int, i: int, j: int) -> None:
    """Add a name to the list of a pair; the count goes on where the list is full."""
    count, name = pairs.term_count[pair], feature_name(kind, i, j)
    if count < room(pairs, pair):
        if count < NEAR:
            pairs.term[pair, count] = name
        else:
            pairs.rest[pairs.rest_row[pair], count - NEAR] = name
    pairs.term_count[pair] = count + 1


@kernel
def room(pairs: Pairs, pair: int) -> int:
    """Return how many names the list of a pair can hold."""
    return NEAR + pairs.rest.shape[1] if pairs.rest_row[pair] >= 0 else NEAR


@kernel
def name_of(pairs: Pairs, pair: int, k: int) -> int:
    """Return name k of the list of a pair."""
    return pairs.term[pair, k] if k < NEAR else pairs.rest[pairs.rest_row[pair], k - NEAR]
