"""Runs on a Dask cluster, behind the interface of concurrent.futures."""

import re
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from typing import TYPE_CHECKING, Any

from lithobrake.campaign.executors import WorkerDiedError

if TYPE_CHECKING:
    import distributed

# How long to look for the scheduler, and how often the size of the cluster is asked for [s].
_CONNECT_TIMEOUT, _CLUSTER_POLL_INTERVAL = 10.0, 5.0
# Calls are handed out for so many workers at least: a cluster that is still empty will grow.
_SMALLEST_CAPACITY = 16


class DaskExecutor(Executor):
    """The workers of a Dask cluster. A call whose worker is lost goes to another one."""

    def __init__(self, scheduler: str) -> None:
        """Connect to a scheduler (`tcp://host:port`, or `tls://host:port` with the certificates of Dask's settings).

        Raises ValueError when Dask is not installed, no scheduler answers, or the certificates do not do.
        """
        if not re.fullmatch(r"(tcp|tls)://[^\s/]+:\d+", scheduler):
            raise ValueError(
                f"the address of the Dask scheduler is {scheduler!r}; allowed: tcp://HOST:PORT or tls://HOST:PORT, as "
                "`dask scheduler` prints it"
            )
        try:
            from distributed import Client
        except ImportError as error:
            raise ValueError("the executor dask needs Dask; install it with: pip install lithobrake[dask]") from error
        try:
            security = _security(scheduler)
            # A default client would send every other Dask computation of the user's script to this scheduler, too.
            self._client = Client(scheduler, timeout=_CONNECT_TIMEOUT, security=security, set_as_default=False)
        except OSError as error:
            raise ValueError(
                f"no Dask scheduler answers at {scheduler} ({error}); start one with: dask scheduler"
            ) from error
        self._scheduler = scheduler
        self._submitted: dict[distributed.Future[Any], Future[Any]] = {}
        self._thread_count, self._asked = 0, -_CLUSTER_POLL_INTERVAL

    @property
    def capacity(self) -> int:
        """Number of calls that the cluster makes at once, as of a few seconds ago."""
        if time.monotonic() > self._asked + _CLUSTER_POLL_INTERVAL:
            self._asked, self._thread_count = time.monotonic(), sum(self._client.nthreads().values())
        return max(self._thread_count, _SMALLEST_CAPACITY)

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        """Send a call to the scheduler; it counts as running from then on."""
        # Impure: a call that is made a second time must not get the answer to the first.
        there, here = self._client.submit(function, *args, **kwargs, pure=False), Future[Any]()
        # Dask does not report when a worker begins with a call.
        here.set_running_or_notify_cancel()
        self._submitted[there] = here
        there.add_done_callback(self._forward_result)
        return here

    def _forward_result(self, there: "distributed.Future[Any]") -> None:
        """Hand the answer of the cluster to whoever waits for it; Dask calls this in a thread of its own."""
        here = self._submitted.pop(there)
        try:
            if there.status == "cancelled":
                raise BrokenExecutor(f"the Dask scheduler at {self._scheduler} has dropped a call")
            # An answer that was lost with its worker (status "lost") is made again: this waits for it.
            here.set_result(there.result())
        # Whoever waits for the answer has to hear that it does not come, whatever went wrong on the way.
        except BaseException as error:
            here.set_exception(_reason(error))

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster; with cancel_futures, withdraw calls that have not begun."""
        if cancel_futures and self._client.status == "running":
            self._client.cancel(list(self._submitted))
        self._client.close()


def _security(scheduler: str) -> "distributed.Security":
    """What Dask's settings say of certificates. Raises ValueError when they do not go with the scheduler's address."""
    from distributed import Security

    security = Security()
    try:
        settings = security.get_connection_args("client")
    except OSError as error:
        raise ValueError(
            f"the certificates in Dask's settings cannot be used ({error}); mend distributed.comm.tls"
        ) from error
    encrypted = scheduler.startswith("tls://")
    if encrypted and settings["ssl_context"] is None:
        raise ValueError(
            f"{scheduler} asks for certificates, and Dask's settings name none; set distributed.comm.tls.ca-file, "
            "client.cert and client.key (docs/cluster.md)"
        )
    if settings["require_encryption"] and not encrypted:
        raise ValueError(
            f"Dask's settings require encryption, and {scheduler} has none; give an address tls://HOST:PORT"
        )
    return security


def _reason(error: BaseException) -> BaseException:
    from distributed import KilledWorker

    if isinstance(error, KilledWorker):
        return WorkerDiedError("its worker was lost, and so were those that it was given to afterwards")
    return error
