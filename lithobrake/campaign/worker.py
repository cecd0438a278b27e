"""One process that takes calls through a pipe: the coordinator's side of it, and its own."""

import contextlib
import multiprocessing
import os
import pickle
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any

from lithobrake.campaign.limits import Limits

# One run fills one core; a numerical library that starts threads of its own would only slow the others down.
_THREAD_COUNTS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
# What a process says when it has all that a call needs and begins with it.
BEGUN = b"begun"


@dataclass(frozen=True)
class Call:
    """A pickled call, who waits for its answer, and what it may take."""

    future: "Future[Any]"
    content: bytes
    limits: Limits


class Worker:
    """A process, as its coordinator sees it.

    call: that it is at, or None. begun: when it began with it, on the monotonic clock [s].
    """

    def __init__(self) -> None:
        """Start the process."""
        context = multiprocessing.get_context("spawn")
        self.connection, other_end = context.Pipe()
        self._process = context.Process(target=serve, args=(other_end,), daemon=True)
        # The process reads the variables while its interpreter starts.
        with _environment(dict.fromkeys(_THREAD_COUNTS, "1")):
            self._process.start()
        # With the only other end in the process itself, the pipe closes when the process dies.
        other_end.close()
        self.number = int(self._process.pid or 0)
        self.call: Call | None = None
        self.begun: float | None = None

    def take(self, call: Call) -> bool:
        """Send a call; False when the process is dead."""
        try:
            self.connection.send_bytes(call.content)
        except OSError:
            return False
        self.call, self.begun = call, None
        return True

    def kill(self) -> None:
        """End the process and all that it has started."""
        if hasattr(os, "killpg"):
            # It leads a group of its own from its first moment in `serve`; before that there is no such group.
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.number, signal.SIGKILL)
        self._process.kill()

    def ended(self) -> str:
        """How the process ended, in words."""
        self._process.join(timeout=5)
        code = self._process.exitcode
        return f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"


def serve(connection: "Connection[Any, Any]") -> None:
    """Take calls until the coordinator closes the pipe or ends."""
    if hasattr(os, "setsid"):
        # Ctrl-C is the coordinator's, which keeps what is finished and then ends its processes.
        os.setsid()
    threading.Thread(target=_end_with_the_coordinator, daemon=True).start()
    while True:
        try:
            call = connection.recv_bytes()
        except (EOFError, OSError):
            return
        answer = _answer(call, connection)
        try:
            connection.send_bytes(answer)
        except OSError:
            return


def _answer(call: bytes, connection: "Connection[Any, Any]") -> bytes:
    """Make a call; whatever it raises is its answer."""
    try:
        function, args, kwargs = pickle.loads(call)
        connection.send_bytes(BEGUN)
        return pickle.dumps((True, function(*args, **kwargs)))
    except BaseException as error:
        try:
            answer = pickle.dumps((False, error))
            pickle.loads(answer)
        except Exception:
            # An exception that does not survive the way goes as its words.
            return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
        return answer


def _end_with_the_coordinator() -> None:
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    wait([parent.sentinel])
    if hasattr(os, "killpg"):
        os.killpg(os.getpid(), signal.SIGKILL)
    os._exit(1)


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
