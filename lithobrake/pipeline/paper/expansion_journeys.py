"""The journeys of the samples of an expansion, from bounce to bounce."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.emulate.outgoing import rolling_spin
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper.expansion_bounce import soil_bounce
from lithobrake.pipeline.rest.journeys import first_velocity, follow

if TYPE_CHECKING:
    from lithobrake.smallbody import Bounce


def follow_expansion_samples(job: Job) -> None:
    """Follow the first samples of the expansion from bounce to bounce."""
    follow(job, "screening", _soil)


def _soil(job: Job, samples: Samples) -> "tuple[np.ndarray, Bounce]":
    """Spin after the first impact, of the size that the expansion gives about the axis of rolling, and the bounce."""
    spin = rolling_spin(first_velocity(samples), np.maximum(samples.output("spin_out"), 0.0))
    inputs = {name: samples.inputs[samples.known, index] for index, name in enumerate(samples.input_names)}
    return spin, soil_bounce(job, inputs)
