"""The time of a world and the length of its steps: given, or chosen once it is known what may collide how fast."""

import math
from collections.abc import Callable
from dataclasses import dataclass


def checked_step(time_step: float, allowed: str = "a finite value above 0") -> float:
    """Return a time step [s]. Raises ValueError for one that is not finite and positive; `allowed` says what is."""
    if not 0.0 < time_step < math.inf:
        raise ValueError(f"World time_step is {time_step!r} s; allowed is {allowed}: change it")
    return float(time_step)


def checked_count(steps: float) -> int:
    """Return a number of steps. Raises ValueError for one that is not whole, or below 0."""
    if steps != int(steps) or steps < 0:
        raise ValueError(f"World.run steps is {steps!r}; allowed is a whole number of at least 0: change it")
    return int(steps)


@dataclass
class Clock:
    """Simulated time and the step that advances it: one that was given stays, a chosen one until something is added."""

    time: float  # s
    given_time_step: float | None  # s; None: to be chosen
    time_step: float | None  # s, in use; None: not chosen yet

    def give(self, time_step: float) -> None:
        """Take steps of this length [s] from now on. Raises ValueError for one that is not finite and positive."""
        self.time_step = self.given_time_step = checked_step(time_step)

    def choose_anew(self) -> None:
        """Let go of a step that was chosen for what there was before."""
        self.time_step = self.given_time_step

    def steps_in(self, duration: float | None, chosen: Callable[[], float]) -> int:
        """Return the number of steps in a duration [s]; one not yet `chosen` [s] is made to fit into it.

        Raises ValueError for a duration that is not finite, or below 0.
        """
        if duration is None or not 0.0 <= duration < math.inf:
            raise ValueError(
                f"World.run duration is {duration!r} s; allowed is a finite value of at least 0: change it"
            )
        if duration == 0.0:
            return 0
        if self.time_step is None:
            self.time_step = duration / math.ceil(duration / chosen())
        return round(duration / self.time_step)
