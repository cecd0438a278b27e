"""Runs on the cores of this machine, behind the interface of concurrent.futures, and their limits."""

import contextlib
import math
import os
import pickle
import platform
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from functools import cache
from multiprocessing.connection import Pipe, wait
from typing import TYPE_CHECKING, Any

from lithobrake.campaign.processes import memory_of_workers
from lithobrake.campaign.single_run import Limits
from lithobrake.campaign.worker import BEGUN, Call, Worker, pickled

if TYPE_CHECKING:
    pass

# How often running calls are looked at when they have limits [s].
_POLL_INTERVAL = 0.2
# A process that has had no call for so long [s] ends, and gives its memory back: starting one takes two seconds.
IDLE_TIME = 20.0
# So many processes in a row that die before they begin with a call are no accident.
_STILLBORN_LIMIT = 3


class WorkerDiedError(RuntimeError):
    """The process of a call died, or was ended because the call went over its limits; the reason says which.

    wall_s: how long it had been at the call [s]; host: where; None where nobody saw it.
    """

    def __init__(self, reason: str, wall_s: float | None = None, host: str | None = None) -> None:
        # All three go into args, from which pickle makes the exception again in another process.
        super().__init__(reason, wall_s, host)
        self.wall_s, self.host = wall_s, host

    def __str__(self) -> str:
        return str(self.args[0])


class LocalExecutor(Executor):
    """A pool of processes, each with one thread; one that dies is replaced, and one without calls ends after a while.

    Processes are interpreters of their own, never forks: a fork of a process that has threads may hang. They import the
    script that is run here only where a call names something that it defines. They end with this one, however it ends.
    """

    def __init__(self, worker_count: int | None = None) -> None:
        """Prepare `worker_count` processes (None: one for each core); they start when there is work for them.

        Raises ValueError for less than one.
        """
        if worker_count is not None and (worker_count != int(worker_count) or worker_count < 1):
            raise ValueError(f"worker_count is {worker_count!r}; allowed: a whole number of at least 1, or None")
        self.worker_count = available_cores() if worker_count is None else int(worker_count)
        self._waiting: deque[Call] = deque()
        self._workers: list[Worker] = []
        # The thread waits on pipes; a new call or the end is announced through one more.
        self._wake_receiver, self._wake_sender = Pipe(duplex=False)
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._closing = False
        # Whether calls under way are ended, too.
        self._ends_calls = False
        self._stillborn_count = 0

    @property
    def capacity(self) -> int:
        """Number of calls that run concurrently."""
        return self.worker_count

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        """Queue a call; it is pickled here and now."""
        return self.submit_limited(Limits(), function, *args, **kwargs)

    def submit_limited(
        self, limits: Limits, function: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> "Future[Any]":
        """Queue a call whose process is ended when it goes over its limits; the future then has a WorkerDiedError.

        Raises ValueError for a call that cannot be sent to a process.
        """
        # Pickled in the thread of the caller, so that a call that cannot be sent is refused where it was made.
        call, future = pickled("a call", (function, args, kwargs)), Future[Any]()
        with self._lock:
            if self._closing:
                raise RuntimeError("this LocalExecutor is shut down; make another one")
            self._waiting.append(Call(future, call, limits))
            if self._thread is None:
                self._thread = threading.Thread(target=self._serve, name="local executor", daemon=True)
                self._thread.start()
        self._wake_sender.send_bytes(b"call")
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Take no more calls; with cancel_futures, those that wait are cancelled and those under way are ended."""
        with self._lock:
            self._closing, self._ends_calls = True, self._ends_calls or cancel_futures
            given_up = [call.future for call in self._waiting] if cancel_futures else []
            if cancel_futures:
                self._waiting.clear()
        for future in given_up:
            future.cancel()
        if cancel_futures:
            for worker in list(self._workers):
                worker.kill()
        if self._thread is not None:
            # Where the thread has ended already, nobody listens.
            with contextlib.suppress(OSError):
                self._wake_sender.send_bytes(b"end")
            if wait:
                self._thread.join()

    def _serve(self) -> None:
        """Hand out calls and collect answers until the executor is shut down and nothing is left to do."""
        try:
            while self._hand_out():
                busy = [worker for worker in self._workers if worker.call]
                has_limits = any(worker.call.limits != Limits() for worker in busy if worker.call)
                pipes = [self._wake_receiver, *(worker.connection for worker in busy)]
                next_end = self._end_idle()
                # Without limits there is nothing to look at between two messages but how long others are idle.
                ready = wait(pipes, timeout=_POLL_INTERVAL if has_limits else next_end)
                if self._wake_receiver in ready:
                    self._wake_receiver.recv_bytes()
                for worker in busy:
                    if worker.connection in ready:
                        self._receive(worker)
                if has_limits:
                    self._end_those_over_their_limits()
        # Say, no process can be started: whoever waits for a future has to hear of it.
        except BaseException as error:
            self._give_up(error)
        for worker in self._workers:
            worker.end()

    def _hand_out(self) -> bool:
        """Give waiting calls to idle processes, starting processes as needed; False when all is done and closed."""
        while True:
            with self._lock:
                idle = next((worker for worker in self._workers if worker.call is None), None)
                if not self._waiting or (idle is None and len(self._workers) >= self.worker_count):
                    busy = any(worker.call for worker in self._workers)
                    return bool(self._waiting) or busy or not self._closing
                call = self._waiting.popleft()
            if not (call.future.running() or call.future.set_running_or_notify_cancel()):
                continue
            if idle is None:
                idle = Worker()
                self._workers.append(idle)
            if not idle.take(call):
                # It died while it had nothing to do; the call has not begun, so another process takes it.
                self._remove(idle)
                with self._lock:
                    self._waiting.appendleft(call)
            elif self._ends_calls:
                # It was started while the others were ended.
                idle.kill()

    def _end_idle(self) -> float | None:
        """End processes that have been idle for too long; how long until the next of them [s], None: none is idle."""
        idle = [worker for worker in self._workers if worker.call is None]
        now = time.monotonic()
        for worker in idle:
            if worker.idle_since + IDLE_TIME <= now:
                self._workers.remove(worker)
                worker.end()
        left = [worker.idle_since + IDLE_TIME - now for worker in idle if worker in self._workers]
        return min(left, default=None)

    def _receive(self, worker: Worker) -> None:
        try:
            said = worker.connection.recv_bytes()
        except (EOFError, OSError):
            # A process that dies before it has begun with a call costs its run no try: the run had no part in it.
            if worker.begun is None:
                self._pass_on_the_call_of(worker)
            else:
                self._lose(worker, "its process died ({ended})")
            return
        if said == BEGUN:
            worker.begun, self._stillborn_count = time.monotonic(), 0
            return
        call, worker.call, worker.idle_since = worker.call, None, time.monotonic()
        # The next call goes out before anybody is told of this one, so that the process need not wait.
        self._hand_out()
        fine, answer = pickle.loads(said)
        if call and fine:
            call.future.set_result(answer)
        elif call:
            call.future.set_exception(answer)

    def _pass_on_the_call_of(self, worker: Worker) -> None:
        """Give the call of a process that died before it began with it to another one, unless calls are ended.

        Raises BrokenExecutor when this has happened to several in a row.
        """
        self._remove(worker)
        if worker.call and self._ends_calls:
            worker.call.future.set_exception(WorkerDiedError("its process was ended before it began"))
            return
        self._stillborn_count += 1
        if worker.call:
            with self._lock:
                self._waiting.appendleft(worker.call)
        if self._stillborn_count >= _STILLBORN_LIMIT:
            raise BrokenExecutor(
                f"processes end before they begin with a run ({worker.ended()}); see what they wrote to standard error"
            )

    def _lose(self, worker: Worker, reason: str) -> None:
        self._remove(worker)
        if worker.call is not None and worker.begun is not None:
            wall = time.monotonic() - worker.begun
            worker.call.future.set_exception(
                WorkerDiedError(reason.format(ended=worker.ended()), wall, platform.node())
            )

    def _remove(self, worker: Worker) -> None:
        worker.kill()
        self._workers.remove(worker)

    def _give_up(self, error: BaseException) -> None:
        with self._lock:
            self._closing = True
            calls = list(self._waiting)
        calls += [worker.call for worker in self._workers if worker.call]
        for future in [call.future for call in calls]:
            if not future.done() and (future.running() or future.set_running_or_notify_cancel()):
                future.set_exception(error)

    def _end_those_over_their_limits(self) -> None:
        begun = [(worker, worker.call.limits, worker.begun) for worker in self._workers if worker.call and worker.begun]
        measured = any(limits.memory_bytes < math.inf for _, limits, _ in begun)
        memory = memory_of_workers({worker.number: worker.mark for worker in self._workers}) if measured else {}
        for worker, limits, since in begun:
            reason = limits.exceeded(time.monotonic() - since, memory.get(worker.number, 0))
            if reason:
                self._lose(worker, reason)


def available_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


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
    # One for all threads of a worker of the cluster; its processes keep the kernels that they have loaded for further
    # runs.
    return LocalExecutor(available_cores())
