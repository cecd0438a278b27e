"""The flights of the samples of an expansion."""

from collections.abc import Iterable
from typing import Any

from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.fly.flights import COLUMNS, flight_rows, fly_samples, fly_starts, starts, write_table
from lithobrake.pipeline.job import Job


def fly_expansion_samples(job: Job) -> None:
    """Fly the samples of an expansion; where these have the scatter from run to run, without it too.

    flights_without_scatter.csv has the flights of the expansion alone; without scatter it is empty.
    """
    fly_samples(job)
    samples = Samples.load(job.folder)
    alone: Iterable[list[Any]] = ()
    if samples.without_scatter is not None:
        start = starts(job.site, samples.expansion_alone())
        alone = flight_rows(start, fly_starts(job, start, "flights without scatter"))
    write_table(job.folder, "flights_without_scatter.csv", COLUMNS, alone)
