"""The engine's kernels, compiled before anything else: the first bed would seem to stand still, and workers would wait.

What is compiled follows from what is called, so a world of two grains is stepped as any other is. What another core can
compile meanwhile is left to a process of its own; the folder on the disk is where it is found.
"""

import logging
from collections.abc import Callable, Iterator
from concurrent.futures import wait
from contextlib import contextmanager
from typing import Protocol

from lithobrake.campaign import LocalExecutor, available_cores

WHAT = "compiling kernels"


class ShowsProgress(Protocol):
    """Shows how far a piece of work is, as a job does."""

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show it."""


def compile_kernels(job: ShowsProgress) -> None:
    """Compile what beds and landings call, unless it lies on disk; workers that start afterwards find it there."""
    from lithobrake.compilation.compiled import disk_cache, lies_on_disk, watched
    from lithobrake.dem.example_world import step_locally, step_together
    from lithobrake.dem.stepping.time_loop import advance

    job.progress(0, 1, WHAT)
    with watched("dem", lambda done, total: job.progress(done, total, WHAT, f"{done} of {total} kernels")):
        if lies_on_disk(advance) or available_cores() == 1 or not disk_cache("dem").keeps:
            step_locally()
        else:
            with _meanwhile(step_together):
                step_locally()
        step_together()
    job.progress(1, 1, WHAT)


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


def _quietly(function: Callable[[], None]) -> None:
    """Call a function and say nothing of what is compiled: the process that waits for it says so."""
    logging.disable(logging.WARNING)
    function()
