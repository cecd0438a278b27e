"""How touchdowns of some landers end, by the emulator or by landings."""

from dataclasses import dataclass, fields

import numpy as np

from lithobrake.vocabulary.quantities import UNKNOWN_END


@dataclass(frozen=True)
class Answers:
    """How touchdowns end, [count] and [count, 3], in the frames of the touchdowns.

    outcome: a word of TouchdownOutcome, "failed", or UNKNOWN_END. velocity [m/s] and spin against the ground [rad/s] of
    those that left; way: from the impact to where a touchdown ended [m]; duration [s].
    """

    outcome: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray
    way: np.ndarray
    duration: np.ndarray

    @classmethod
    def unknown(cls, count: int) -> "Answers":
        """Of so many touchdowns of which nothing is known."""
        velocity, spin, way = (np.zeros((count, 3)) for _ in range(3))
        return cls(np.full(count, UNKNOWN_END, dtype="<U16"), velocity, spin, way, np.zeros(count))

    @property
    def is_known(self) -> np.ndarray:
        """Which touchdowns have an answer, [count]."""
        known: np.ndarray = self.outcome != UNKNOWN_END
        return known

    def fill(self, which: np.ndarray, others: "Answers") -> None:
        """Put answers in the places of some of these."""
        for one in fields(self):
            getattr(self, one.name)[which] = getattr(others, one.name)
