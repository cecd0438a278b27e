"""The flights of the first samples' journeys on the soil, each as the state with which it begins and its times."""

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from lithobrake.smallbody import Arcs

FILE = "arcs.csv"


def arc_rows(arcs: "Arcs", samples: np.ndarray) -> list[list[Any]]:
    """A row of arcs.csv for each arc, in the columns of outputs.ARC.

    samples: of all landers of the journeys, ascending, [lander_count].
    """
    # Arcs come lander by lander, so each one's number counts from where its lander first stands.
    number = np.arange(len(arcs.lander)) - np.searchsorted(arcs.lander, arcs.lander)
    columns = (
        *(samples[arcs.lander], number, arcs.begin, arcs.end, arcs.clock),
        *(*arcs.position.T, *arcs.velocity.T, arcs.mass, arcs.spin_period),
    )
    return [list(row) for row in zip(*(column.tolist() for column in columns), strict=True)]
