"""The engine's kernels, compiled before anything else: the first bed would seem to stand still, and workers would wait.

What is compiled follows from what is called, so a world of two grains is stepped as any other is. What another core can
compile meanwhile is left to a process of its own, and what flights call to a worker, while others pour beds; the folder
on the disk is where it is found.
"""

import logging
from collections.abc import Callable, Iterator
from concurrent.futures import wait
from contextlib import contextmanager

import numpy as np

from lithobrake.campaign import LocalExecutor, available_cores
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.site import Site
from lithobrake.study import Study

WHAT = "compiling kernels"


def compile_kernels(tell: Callable[..., None], busy: int = 0) -> None:
    """Compile what beds and landings call, unless it lies on disk; workers that start afterwards find it there.

    tell: called as the progress of a job, with how many kernels are done, of how many. busy: cores that compile
    something else. On one that idles a second process compiles a part of the engine: sooner done, at more CPU time,
    as what both parts call is prepared twice.
    """
    from lithobrake.compilation.compiled import disk_cache, lies_on_disk, watched
    from lithobrake.dem.example_world import step_locally, step_together
    from lithobrake.dem.stepping.time_loop import advance

    tell(0, 1, WHAT)
    with watched("dem", lambda done, total: tell(done, total, WHAT, f"{done} of {total} kernels")):
        if lies_on_disk(advance) or available_cores() < 2 + busy or not disk_cache("dem").keeps:
            step_locally()
        else:
            with _meanwhile(step_together):
                step_locally()
        step_together()
    tell(1, 1, WHAT)


def compile_flights(job: Job) -> int:
    """Have one of several workers of this machine compile what flights and journeys call, unless it lies on disk.

    Returns how many workers are at it. Nobody waits for it; where it fails the flights will compile, and say why.
    """
    from lithobrake.compilation.compiled import disk_cache, lies_on_disk
    from lithobrake.smallbody.integration import integrate_flights

    if not isinstance(job.executor, LocalExecutor) or job.executor.worker_count == 1:
        return 0
    if lies_on_disk(integrate_flights) or not disk_cache("smallbody").keeps:
        return 0
    job.executor.submit(_quietly, fly_briefly, job.study)
    return 1


def fly_briefly(study: Study) -> None:
    """Fly one lander from the site of a study for a second, and have another slide there; makes the gravity table."""
    from lithobrake.smallbody import HardSurface, Launch, hop

    site = Site(study)
    origin, axes = site.frames(site.columns(2))
    launch = Launch(origin, np.outer([1.0, 0.0], axes[0, 2]), captured=[False, True])
    # No bounce: what happens at an impact is nothing that is compiled.
    hop(site.body, launch, HardSurface(0.0), 1.0, friction=1.0, gravity=study.flight.gravity, bounce_limit=0)


@contextmanager
def _meanwhile(function: Callable[[], None]) -> Iterator[None]:
    """Have another process call a function, and wait until it has; where that fails, nothing has been compiled."""
    executor = LocalExecutor(1)
    try:
        called = executor.submit(_quietly, function)
        yield
        wait([called])
    finally:
        executor.shutdown(cancel_futures=True)


def _quietly(function: Callable[..., None], *arguments: object) -> None:
    """Call a function and say nothing of what is compiled: the process that waits for it says so."""
    logging.disable(logging.WARNING)
    try:
        function(*arguments)
    finally:
        logging.disable(logging.NOTSET)
