"""When a lander rests: it has stayed where it is for longer than one takes to topple that stands on an edge."""

import math

import numpy as np

from lithobrake.dem import BodyMotion
from lithobrake.touchdown.lander import Lander

# A lander that stands on an edge topples with the time constant sqrt(size / gravity), in which its tilt grows by a
# factor of e: what moves by less than REST_WAY meanwhile was within 0.6 % of its size of balance, or rests.
TOPPLING_TIMES = 1.0
REST_WAY = 0.015  # of the smallest edge, by any point of the lander


class RestWatch:
    """Watches a lander until no point of it has moved by more than REST_WAY for long enough."""

    def __init__(self, lander: Lander, inward_gravity: float) -> None:
        """Begin; inward_gravity: of the site [m/s2]. Where it does not point inward nothing rests."""
        self.reach, self.way = lander.reach, REST_WAY * lander.smallest_edge
        self.patience = rest_time(lander, inward_gravity)
        self.since = math.inf
        self.anchor: BodyMotion | None = None

    def is_over(self, time: float, motion: BodyMotion) -> bool:
        """Look at the lander at a time [s], and return whether it rests."""
        if self.anchor is None or self._moved(self.anchor, motion) > self.way:
            self.since, self.anchor = time, motion
        return time - self.since > self.patience

    def _moved(self, before: BodyMotion, now: BodyMotion) -> float:
        """Return a bound on how far a point of the lander has moved [m]."""
        between = abs(float(np.dot(before.orientation, now.orientation)))
        turn = 2.0 * math.acos(min(between, 1.0))
        return float(np.linalg.norm(now.position - before.position)) + turn * self.reach


def rest_time(lander: Lander, inward_gravity: float) -> float:
    """Return how long [s] a lander has to stay where it is until it rests; infinite where gravity points outward."""
    if inward_gravity <= 0.0:
        return math.inf
    return TOPPLING_TIMES * math.sqrt(lander.smallest_edge / inward_gravity)
