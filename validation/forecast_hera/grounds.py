"""Hard ground of a restitution that nobody knows: what every published odds of a landing stand on."""

import hashlib
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
import hard_ground
from hard_ground import HardGround

TANGENTIAL = 0.9  # of the speed along the ground, as in validation/ballistic_descent
# The restitution of each lander; study files do not let it be 0.
RESTITUTION = {"distribution": "uniform", "lower": 1e-6, "upper": 1.0}
CODE = hashlib.sha256(b"".join(Path(one).read_bytes() for one in (__file__, hard_ground.__file__))).hexdigest()


@dataclass(frozen=True)
class DrawnRestitution:
    """Bounces off hard ground with the restitution that the lander drew.

    code: hash of what does it; a study knows a model by its attributes, so other code makes its landers again.
    """

    code: str = CODE

    def __call__(self, values: dict[str, float], seed: int) -> dict[str, Any]:
        """Bounce once."""
        return HardGround(values["lander.restitution"], TANGENTIAL)(values, seed)
