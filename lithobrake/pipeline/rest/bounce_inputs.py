"""What of an impact a model of the bounce takes for its inputs."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.study import Study
from lithobrake.study.quantity import uncertain
from lithobrake.vocabulary.quantities import SPIN

if TYPE_CHECKING:
    from lithobrake.smallbody import Impacts


# Without these two among the uncertain inputs the expansion says nothing about an impact that differs from the first.
NEEDED = ("impact.speed", "impact.incidence_deg")


def why_no_soil(study: Study) -> str | None:
    """Why the soil cannot be asked about the impacts after the first; None where it can."""
    absent = [name for name in NEEDED if name not in uncertain(study.touchdown_values())]
    if not absent:
        return None
    return (
        f"{' and '.join(absent)} {'is' if len(absent) == 1 else 'are'} no uncertain input, so the runs do not "
        "cover later impacts; give it a distribution that covers them"
    )


def inputs_at(
    impacts: "Impacts", inputs: Mapping[str, np.ndarray], ranges: Mapping[str, tuple[float, float]]
) -> tuple[np.ndarray, np.ndarray]:
    """All inputs at the impacts, [count, input_count], and which of these are outside the ranges, [count].

    inputs: of each lander. Those outside have the inputs of the first impact in place of theirs.
    """
    felt = {"impact.speed": impacts.speed, "impact.incidence_deg": np.degrees(impacts.incidence)}
    felt |= dict(zip(SPIN, impacts.spin.T, strict=True)) | {"surface.gravity": -impacts.effective_acceleration}
    x = np.column_stack([values[impacts.lander] for values in inputs.values()])
    outside = np.zeros(len(x), dtype=bool)
    for index, name in enumerate(inputs):
        if name in felt:
            lower, upper = ranges[name]
            known = (felt[name] >= lower) & (felt[name] <= upper)
            x[known, index] = felt[name][known]
            outside |= ~known
    return x, outside
