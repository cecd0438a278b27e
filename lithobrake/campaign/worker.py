"""One process that takes calls through a pipe, and the script that its model stands in."""

import contextlib
import gc
import io
import multiprocessing
import os
import pickle
import pickletools
import runpy
import signal
import subprocess
import sys
import threading
import time
import types
from concurrent.futures import Future
from dataclasses import dataclass
from multiprocessing.connection import Connection, Pipe, wait
from typing import Any

from lithobrake.campaign.processes import end_marked, new_mark
from lithobrake.campaign.single_run import Limits

MAIN = "__main__"
# The script goes by this name in a worker process, so that what stands under `if __name__ == "__main__":` is not run.
_IMPORTED = "__mp_main__"
# How a process finds a script: "name" or "path", and which.
Source = tuple[str, str]
_UNREACHABLE = (
    "the model is defined in a notebook, an interactive session or a piped script, which worker processes cannot "
    "import; write it to a file, say model.py, and import it from there"
)
# One run fills one core; a numerical library that starts threads of its own would only slow the others down.
_THREAD_COUNTS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
# What a process says when it has all that a call needs and begins with it.
BEGUN = b"begun"
# What a process begins with: the modules that the coordinator finds, and then its calls. Nothing here imports the
# coordinator's script, as the processes of the standard library do: it may be piped, or start a campaign unguarded.
_START = """
import sys
from multiprocessing.connection import Connection
calls, life = map(Connection, map(int, sys.argv[1:]))
sys.path[:], sys.argv, main, mark = calls.recv()
from lithobrake.campaign.worker import serve
serve(calls, life, main, mark)
"""


class MainModuleError(ValueError):
    """A model of a script that no worker process can import."""


class MainModule:
    """The script of the coordinator in a worker process, imported when it is asked for the first time."""

    importing = False

    def __init__(self, source: Source | None) -> None:
        self._source = source
        self._is_there = False

    def ensure(self) -> None:
        """Import it as `__main__`. Raises MainModuleError where there is none, or it starts a campaign itself."""
        if self._is_there:
            return
        if self._source is None:
            raise MainModuleError(_UNREACHABLE)
        kind, where = self._source
        MainModule.importing = True
        try:
            run = runpy.run_module if kind == "name" else runpy.run_path
            names = run(where, run_name=_IMPORTED)
        finally:
            MainModule.importing = False
        module = types.ModuleType(_IMPORTED)
        module.__dict__.update(names)
        # Calls refer to what the script defines by the first name, objects that are made here by the second.
        sys.modules[MAIN] = sys.modules[_IMPORTED] = module
        self._is_there = True


def main_source() -> Source | None:
    """How a process of its own finds the script that is run here; None where it cannot, as in a notebook."""
    module = sys.modules.get(MAIN)
    spec = getattr(module, "__spec__", None)
    # Of a package that is run there is no module to import beside the program itself.
    if spec is not None:
        return None if spec.name.rpartition(".")[2] == MAIN else ("name", spec.name)
    path = getattr(module, "__file__", None)
    return ("path", os.path.abspath(path)) if path and os.path.isfile(path) else None


def refuse_unreachable(sent: bytes) -> None:
    """Raise MainModuleError for a pickle with something of the script that is run here, where none can import that."""
    if MAIN.encode() not in sent or main_source() is not None:
        return
    # The search of the bytes above saves going through the operations of every pickle.
    if any(argument == MAIN for _, argument, _ in pickletools.genops(sent)):
        raise MainModuleError(_UNREACHABLE)


def pickled(what: str, content: object) -> bytes:
    """The pickle that is sent to a process of its own; what: the content in words, as "the model".

    Raises ValueError for what cannot be sent, MainModuleError where no process can import it.
    """
    try:
        sent = pickle.dumps(content)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ValueError(
            f"{what} cannot be sent to a process ({error}); a model may be a function of a file, outside of any other "
            "function, or an object whose attributes can be sent"
        ) from error
    refuse_unreachable(sent)
    return sent


def refuse_while_importing() -> None:
    """Raise MainModuleError where a script that a worker process imports would start a campaign of its own."""
    if MainModule.importing:
        raise MainModuleError(
            "worker processes import this script, because it defines the model, and would start the campaign again; "
            'what starts it belongs under: if __name__ == "__main__":, or the model into a file of its own'
        )


@dataclass(frozen=True)
class Call:
    """A pickled call, who waits for its answer, and what it may take."""

    future: "Future[Any]"
    content: bytes
    limits: Limits


class Worker:
    """A process, as its coordinator sees it.

    call: that it is at, or None. begun: when it began with it, idle_since: since when it has none, on the monotonic
    clock [s].
    """

    def __init__(self) -> None:
        refuse_while_importing()
        self.connection, calls = Pipe()
        # With the only other end in the coordinator, this one tells its end, however it ends.
        life, self._life = Pipe(duplex=False)
        ends = [calls.fileno(), life.fileno()]
        # Options of this interpreter, as for warnings, are those of the process too.
        options = subprocess._args_from_interpreter_flags()  # type: ignore[attr-defined]
        self.mark = new_mark()
        # It leads a session of its own: Ctrl-C is the coordinator's, which keeps what is finished and then ends it.
        self._process = subprocess.Popen(
            [sys.executable, *options, "-c", _START, *map(str, ends)],
            stdin=subprocess.DEVNULL,
            pass_fds=ends,
            env=os.environ | dict.fromkeys((*_THREAD_COUNTS, self.mark), "1"),
            start_new_session=True,
        )
        # With the only other end in the process itself, the pipe closes when the process dies.
        calls.close()
        life.close()
        self.number = self._process.pid
        self.call: Call | None = None
        self.begun: float | None = None
        self.idle_since = time.monotonic()
        # One that has died already is found dead by its first call.
        with contextlib.suppress(OSError):
            self.connection.send((sys.path, sys.argv, main_source(), self.mark))

    def take(self, call: Call) -> bool:
        """Send a call; False when the process is dead."""
        try:
            self.connection.send_bytes(call.content)
        except OSError:
            return False
        self.call, self.begun = call, None
        return True

    def kill(self) -> None:
        with contextlib.suppress(ProcessLookupError):
            # The worker leads its session, so a program that its model has started ends with it.
            os.killpg(self.number, signal.SIGKILL)
        self._process.kill()
        # So does one that has left the session.
        end_marked(self.mark)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout=5)

    def end(self) -> None:
        """Let an idle process end by itself, as what it has printed is written then."""
        self.connection.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout=5)
        self.kill()

    def ended(self) -> str:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout=5)
        code = self._process.returncode
        return f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"


def serve(connection: "Connection[Any, Any]", life: "Connection[Any, Any]", main: Source | None, mark: str) -> None:
    """Take calls until the coordinator closes the pipe or ends, which `life` tells.

    main: how its script is found; mark: of this process and all that it starts.
    """
    threading.Thread(target=_end_with_the_coordinator, args=(life, mark), daemon=True).start()
    # A model that starts processes of its own does so beside the thread above, which no fork has.
    multiprocessing.set_start_method("spawn")
    script = MainModule(main)
    while True:
        try:
            call = connection.recv_bytes()
        except (EOFError, OSError):
            break
        answer = _answer(call, connection, script)
        try:
            connection.send_bytes(answer)
        except OSError:
            break
    # At its end Python would free compiled kernels and all else object by object, for as long as this took to load.
    gc.collect()
    gc.freeze()


class _CallUnpickler(pickle.Unpickler):
    """Reads a call, and imports the coordinator's script where the call names something of it."""

    def __init__(self, call: bytes, script: MainModule) -> None:
        super().__init__(io.BytesIO(call))
        self._script = script

    def find_class(self, module_name: str, global_name: str) -> Any:
        if module_name == MAIN:
            self._script.ensure()
        return super().find_class(module_name, global_name)


def _answer(call: bytes, connection: "Connection[Any, Any]", script: MainModule) -> bytes:
    """Make a call; whatever it raises is its answer."""
    try:
        function, args, kwargs = _CallUnpickler(call, script).load()
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


def _end_with_the_coordinator(life: "Connection[Any, Any]", mark: str) -> None:
    wait([life])
    end_marked(mark)
    os.killpg(os.getpid(), signal.SIGKILL)
