"""Calls with limits on any executor: each in a process beside the worker's, which lives on when the call is ended."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from functools import cache
from typing import Any

from lithobrake.campaign.limits import Limits
from lithobrake.campaign.local_executor import LocalExecutor, available_cores


def submit_limited(executor: Executor, limits: Limits, function: Callable[..., Any], *args: Any) -> "Future[Any]":
    """Send a call that is ended when it goes over its limits; its future then has a WorkerDiedError."""
    if limits == Limits():
        return executor.submit(function, *args)
    if isinstance(executor, LocalExecutor):
        return executor.submit_limited(limits, function, *args)
    return executor.submit(limited, limits, function, *args)


def limited(limits: Limits, function: Callable[..., Any], *args: Any) -> Any:
    """Make a call in a process of its own, from the worker that this is called in."""
    return _own_executor().submit_limited(limits, function, *args).result()


@cache
def _own_executor() -> LocalExecutor:
    return LocalExecutor(available_cores())
