"""The ways of the first flights of journeys, for a picture of them."""

from collections.abc import Sequence

import numpy as np

from lithobrake.pipeline.fly.flight_paths import PATHS, write_flight_paths
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.journey import Journey

# Flights that end at once have no way.
LEAST_TIME = 1e-3


def write_ways(job: Job, journeys: Sequence[Journey]) -> None:
    """Write flight_paths.h5 with the first flights, journey by journey, of as many as a picture shows."""
    from lithobrake.smallbody import fly

    flights = [one for journey in journeys for one in journey.flights if one["end_s"] - one["begin_s"] > LEAST_TIME]
    first = flights[:PATHS]

    def column(name: str) -> np.ndarray:
        return np.array([one[name] for one in first], dtype=float)

    position, velocity = (
        np.column_stack([column(f"{name}_{axis}") for axis in "xyz"]).reshape(-1, 3)
        for name in ("position", "velocity")
    )
    # As long as each flight took, and a little more, so that it ends as it did.
    flown = fly(
        job.site.body, position, velocity, np.maximum(column("end_s") - column("begin_s") + 1.0, 1.0),
        gravity=job.study.flight.gravity, start_time=column("clock_s"), mass=column("site_mass"),
        spin_period=column("site_spin_period"), threads=1,
    )  # fmt: skip
    write_flight_paths(job, job.site.body, flown, column("sample").astype(np.int64))
