"""The flights of which journeys are made, one after the other: where each begins, and when it ends."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.flight_results import Flights


@dataclass(frozen=True)
class Arcs:
    """Flights of some landers between impacts; every array has one entry or row an arc.

    `fly` from these states for what is left of the journey's time gives the flight of the journey to the last bit.

    lander       row in the journeys
    begin        since the start of the journey [s], and end
    clock        at the beginning [s]: start_time of `fly`
    position     there [m], velocity [m/s], body-fixed, [count, 3]
    mass         of the body [kg]; spin_period [s]
    """

    lander: NDArray[np.int64]
    begin: NDArray[np.float64]
    end: NDArray[np.float64]
    clock: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    mass: NDArray[np.float64]
    spin_period: NDArray[np.float64]

    @classmethod
    def of(cls, flights: Flights, lander: NDArray[np.int64], begin: NDArray[np.float64], landers: int) -> "Arcs":
        """Those of the first `landers` among flights of these landers, which began at these times [s], [count]."""
        few, start = lander < landers, flights.start
        return cls(
            lander=lander[few],
            begin=begin[few],
            end=(begin + flights.time)[few],
            clock=start.time[few],
            position=start.position[few],
            velocity=start.velocity[few],
            mass=start.mass[few],
            spin_period=start.spin_period[few],
        )

    @classmethod
    def joined(cls, parts: "Sequence[Arcs]") -> "Arcs":
        """Arcs of one round after the other, lander by lander; at least one part."""
        order = np.argsort(np.concatenate([part.lander for part in parts]), kind="stable")
        names = (field.name for field in fields(cls))
        return cls(*(np.concatenate([getattr(part, name) for part in parts])[order] for name in names))
