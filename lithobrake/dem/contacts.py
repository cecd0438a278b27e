"""The contacts of a world, as a person reads them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem.arrays import Pairs

CONTACT = np.dtype(
    [
        ("body_a", np.int64), ("body_b", np.int64), ("point", np.float64, 3), ("normal", np.float64, 3),
        ("overlap", np.float64), ("normal_force", np.float64), ("tangential_force", np.float64, 3),
    ]
)  # fmt: skip


def contacts_of(pairs: Pairs) -> NDArray[Any]:
    """Return the pairs that touch as a structured array, see `World.contacts`."""
    touching = np.flatnonzero(pairs.overlap > 0.0)
    result = np.zeros(len(touching), dtype=CONTACT)
    result["body_a"], result["body_b"] = pairs.first[touching], pairs.second[touching]
    for name in ("point", "normal", "overlap", "normal_force", "tangential_force"):
        result[name] = getattr(pairs, name)[touching]
    return result
