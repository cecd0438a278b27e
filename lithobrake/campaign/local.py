"""Runs on the cores of this machine: a process pool that mends itself, behind the interface of concurrent.futures."""

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any

# One run fills one core; a numerical library that starts threads of its own would only slow the others down.
_THREAD_COUNTS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
_ONE_THREAD = dict.fromkeys(_THREAD_COUNTS, "1")


class LocalExecutor(Executor):
    """A pool of processes, each with one thread.

    Processes are spawned, never forked: a fork of a process that has threads may hang. When a worker dies, its pool is
    given up and the next submit starts a new one.
    """

    def __init__(self, worker_count: int | None = None) -> None:
        """Prepare a pool of `worker_count` processes (None: one for each core); they start with the first submit."""
        self.worker_count = worker_count or available_cores()
        self._pool: ProcessPoolExecutor | None = None

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        """Queue a call; it is pickled."""
        # The children read the variables while their interpreter starts, which may be at any submit.
        with _environment(_ONE_THREAD):
            if self._pool is not None:
                try:
                    return self._pool.submit(function, *args, **kwargs)
                except BrokenProcessPool:
                    self.shutdown(wait=False, cancel_futures=True)
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(self.worker_count, mp_context=context, initializer=_ignore_interrupt)
            return self._pool.submit(function, *args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Stop the pool; with cancel_futures, runs under way are ended too."""
        pool, self._pool = self._pool, None
        if pool is None:
            return
        # Python 3.14 has kill_workers; until then the processes of a pool are found only in its inner table.
        children = list((getattr(pool, "_processes", None) or {}).values()) if cancel_futures else []
        pool.shutdown(wait=wait and not cancel_futures, cancel_futures=cancel_futures)
        for child in children:
            child.terminate()


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _ignore_interrupt() -> None:
    """Leave Ctrl-C to the coordinator, which keeps what is finished and then ends the workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextlib.contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
