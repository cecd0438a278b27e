"""What a limit state may name of a whole journey: its end, and numbers of a lander at rest with their ranges."""

import math
from typing import NamedTuple

from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import SIDES, SKY_WORDS

# Hours of 24 in which a lander sees a body, by the name in a limit state.
HOURS = "_hours"
SKY_HOURS = {f"{body}{HOURS}": body for body in SKY_WORDS}


class JourneyNumber(NamedTuple):
    """A number of a lander at rest: ends of its range, which a whole number may have, unit, and whether it is whole."""

    lower: float
    upper: float
    unit: str
    is_whole: bool = False

    @property
    def words(self) -> str:
        """Its range in words."""
        if math.isinf(self.upper):
            return f"{'at least' if self.is_whole else 'above'} {self.lower:g}{self._unit}"
        return f"from {self.lower:g} to {self.upper:g}{self._unit}"

    @property
    def _unit(self) -> str:
        return f" {self.unit}" if self.unit else ""


# By their columns in journeys.csv; the hours are 24 times day_fraction of sky.csv.
JOURNEY_NUMBERS = {
    "distance": JourneyNumber(0.0, math.inf, "m"),
    "latitude_deg": JourneyNumber(-90.0, 90.0, "deg"),
    "longitude_deg": JourneyNumber(-180.0, 180.0, "deg"),
    "time_s": JourneyNumber(0.0, math.inf, "s"),
    "tilt_deg": JourneyNumber(0.0, 90.0, "deg"),
    "path_length": JourneyNumber(0.0, math.inf, "m"),
    "contacts": JourneyNumber(1.0, math.inf, "", is_whole=True),
    "touchdowns": JourneyNumber(1.0, math.inf, "", is_whole=True),
    **dict.fromkeys(SKY_HOURS, JourneyNumber(0.0, 24.0, "h")),
}
# Those that a place on the ground decides.
PLACE = frozenset({"distance", "latitude_deg", "longitude_deg"})
# One that failed has no known end.
JOURNEY_WORDS = tuple(end.value for end in JourneyEnd if end != JourneyEnd.FAILED)
FACE = "face"


def face_word(side: str) -> str:
    """The word for a side that is down."""
    return f"{FACE} {side}"


FACES = {face_word(side): side for side in SIDES}
