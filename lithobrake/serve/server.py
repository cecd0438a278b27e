"""A server of models by the standard library (UM-Bridge, protocol version 1.0), its clients, and its answers."""

import ipaddress
import json
import math
import select
import socket
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from socketserver import TCPServer
from typing import Any

from lithobrake.files.reading import unique

LARGEST_FLOAT = sys.float_info.max

# Requests that are read or wait for their turn; further clients are turned away.
MOST_CLIENTS = 256
# A client that sends or takes nothing for so long is left alone [s].
REQUEST_TIME = 10.0
# Whether a client is still there is looked at so often while it waits for its turn [s].
LOOK = 0.2
_TURNED_AWAY = (
    b"HTTP/1.0 503 Service Unavailable\r\nContent-Type: application/json\r\n\r\n"
    b'{"error": {"type": "InvalidInput", "message": "the server has as many clients as it takes; ask again"}}'
)
FEATURES = ("Evaluate", "Gradient", "ApplyJacobian", "ApplyHessian")
PROTOCOL = 1.0
# Of a request [bytes]: vectors here have tens of numbers.
LARGEST = 1 << 20


class ClientGoneError(ConnectionError):
    """Raised when a client disconnects before it receives its result."""


@dataclass(frozen=True)
class ServedModel:
    """A model by its name, the names of its inputs and outputs in their order, and the function.

    evaluate: called with the inputs and what the client configures; it gives the outputs, all finite, and raises
    ValueError for inputs or a configuration that it refuses.
    """

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    evaluate: Callable[[list[float], Mapping[str, Any]], list[float]]

    def __post_init__(self) -> None:
        if not self.inputs or not self.outputs:
            raise ValueError(f"model {self.name} has {len(self.inputs)} inputs and {len(self.outputs)} outputs")


# Evaluates a model at a point with a configuration; the last argument says whether the client has left meanwhile, and
# an evaluation that ends for that raises ClientGoneError.
Evaluate = Callable[[ServedModel, list[float], Mapping[str, Any], Callable[[], bool]], list[float]]


def evaluate_here(
    model: ServedModel, point: list[float], config: Mapping[str, Any], gone: Callable[[], bool]
) -> list[float]:
    """Evaluate in this process, for as long as it takes."""
    return model.evaluate(point, config)


class ClientServer(ThreadingHTTPServer):
    """A server of models that bounds what its clients may take: their number, and one evaluation at a time.

    It is bound and not yet at work: `serve_forever()` answers.
    host: name or address of this machine, IPv4 or IPv6; port: 0 takes a free one. `address` is then where it listens.
    evaluate: makes the evaluations; by default in this process, for as long as they take.
    """

    daemon_threads = True
    request_queue_size = MOST_CLIENTS

    def __init__(self, models: Sequence[ServedModel], host: str, port: int, evaluate: Evaluate = evaluate_here) -> None:
        """Bind. Raises ValueError for an empty host or no port, OSError where the address is not to be had."""
        self.models = {model.name: model for model in models}
        self.evaluate, self.host = evaluate, host
        self.address_family, address = _resolved(host, port)
        # The models share compiled kernels and files that are made once.
        self._alone = threading.Lock()
        self._room = threading.BoundedSemaphore(MOST_CLIENTS)
        try:
            super().__init__(address, _Handler)
        except OSError as error:
            raise OSError(
                f"host {host}, port {port} cannot be listened on ({error.strerror}); name an address of this machine, "
                "or another port"
            ) from error

    def server_bind(self) -> None:
        """Bind without asking for the name of the address, for which a network without a name server takes seconds."""
        TCPServer.server_bind(self)
        self.server_name, self.server_port = self.host, self.server_address[1]

    @property
    def address(self) -> str:
        """Where it listens, as a client writes it."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{host}:{self.server_port}"

    @property
    def is_local(self) -> bool:
        """Whether only this machine can reach it."""
        return ipaddress.ip_address(str(self.server_address[0]).partition("%")[0]).is_loopback

    @contextmanager
    def turn(self, gone: Callable[[], bool]) -> Iterator[None]:
        """Wait until no other client has its turn. Raises ClientGoneError for one that leaves meanwhile."""
        while not self._alone.acquire(timeout=LOOK):
            if gone():
                raise ClientGoneError
        try:
            yield
        finally:
            self._alone.release()

    def process_request(self, request: Any, client_address: Any) -> None:
        """Answer a client in a thread, or turn it away where there are too many."""
        if not self._room.acquire(blocking=False):
            with suppress(OSError):
                request.sendall(_TURNED_AWAY)
            self.shutdown_request(request)
            return
        try:
            super().process_request(request, client_address)
        except RuntimeError:
            # No thread was to be had, and the base class ends the request.
            self._room.release()
            raise

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Answer a client, and make room for the next."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._room.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of a client that left: that is no fault of the server."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)


def has_left(client: socket.socket) -> bool:
    """Whether a client that has sent its request has closed the connection."""
    try:
        readable = bool(select.select([client], [], [], 0.0)[0])
        return readable and client.recv(1, socket.MSG_PEEK) == b""
    except (OSError, ValueError):
        return True


def refuse_empty_host(host: str) -> None:
    """Raise ValueError for a host that would mean every network of this machine without saying so."""
    if not host.strip():
        raise ValueError(
            f"host is {host!r} (an unset variable?) and would open the server to every network of this machine; name "
            "an address: 127.0.0.1 for this machine alone"
        )


def _resolved(host: str, port: int) -> tuple[socket.AddressFamily, tuple[Any, ...]]:
    """The family of a host's address, and what to bind to; IPv4 where it has both kinds."""
    refuse_empty_host(host)
    if not 0 <= port <= 65535:
        raise ValueError(f"port is {port}; allowed: 0 (a free one) to 65535")
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise OSError(f"host {host!r} is no address of this machine ({reason}); name one, say 127.0.0.1") from error
    family, *_, address = min(found, key=lambda one: one[0] != socket.AF_INET)
    return family, address


class RequestError(Exception):
    """What a client is answered in place of a result: a kind of error, a sentence, a status of HTTP."""

    def __init__(self, kind: str, message: str, status: int = 400) -> None:
        super().__init__(message)
        self.kind, self.status = kind, status


def answer(
    models: Mapping[str, ServedModel],
    path: str,
    request: Mapping[str, Any],
    evaluate: Callable[[ServedModel, list[float], Mapping[str, Any]], list[float]],
) -> dict[str, Any]:
    """What a request for a model is answered. Raises RequestError, and ClientGoneError where nobody waits for it."""
    name = request.get("name")
    model = models.get(name) if isinstance(name, str) else None
    if model is None:
        raise RequestError("ModelNotFound", f"model {name!r} is not served; there are: {', '.join(models)}")
    if path == "/ModelInfo":
        # The names are more than the protocol asks for: its vectors have none.
        names = {"inputs": list(model.inputs), "outputs": list(model.outputs)}
        return {"support": {feature: feature == "Evaluate" for feature in FEATURES}, **names}
    if path == "/InputSizes":
        return {"inputSizes": [len(model.inputs)]}
    if path == "/OutputSizes":
        return {"outputSizes": [len(model.outputs)]}
    if path != "/Evaluate":
        raise RequestError("UnsupportedFeature", f"{path} is not supported; model {name} supports /Evaluate alone")
    point = _point(model, request.get("input"))
    try:
        outputs = [float(value) for value in evaluate(model, point, request.get("config", {}))]
    except ClientGoneError:
        raise
    except (ValueError, TypeError, OverflowError) as error:
        raise RequestError("InvalidInput", str(error)) from error
    # Whatever else a model raises is its own failure, and the server goes on.
    except Exception as error:
        raise RequestError("InvalidOutput", f"{type(error).__name__}: {error}", 500) from error
    if len(outputs) != len(model.outputs) or not all(map(math.isfinite, outputs)):
        raise RequestError("InvalidOutput", f"model {name} gave {outputs}, not {len(model.outputs)} numbers", 500)
    return {"output": [outputs]}


def _point(model: ServedModel, given: Any) -> list[float]:
    fits = isinstance(given, list) and len(given) == 1 and isinstance(given[0], list)
    if not fits or len(given[0]) != len(model.inputs):
        raise RequestError(
            "InvalidInput",
            f"input of model {model.name} is a list of one list of {len(model.inputs)} numbers: "
            f"{', '.join(model.inputs)}",
        )
    numbers = given[0]
    if not all(
        isinstance(one, int | float) and not isinstance(one, bool) and abs(one) <= LARGEST_FLOAT for one in numbers
    ):
        raise RequestError("InvalidInput", f"input of model {model.name} is {numbers}; allowed: finite numbers")
    return [float(number) for number in numbers]


class _Handler(BaseHTTPRequestHandler):
    """Answers the requests of a client."""

    server: ClientServer
    # Of each read and write.
    timeout = REQUEST_TIME

    def do_GET(self) -> None:
        """Say which models there are."""
        if self.path != "/Info":
            self._answer(404, _error("UnsupportedFeature", f"GET {self.path} is not known; allowed: /Info"))
            return
        self._answer(200, {"protocolVersion": PROTOCOL, "models": list(self.server.models)})

    def do_POST(self) -> None:
        """Answer a request for a model."""
        try:
            self._answer(200, answer(self.server.models, self.path, self._request(), self._evaluate))
        except RequestError as error:
            self._answer(error.status, _error(error.kind, str(error)))

    def _evaluate(self, model: ServedModel, point: list[float], config: Mapping[str, Any]) -> list[float]:
        """Evaluate when no other evaluation is under way; a client that leaves does not hold up those behind it."""

        def gone() -> bool:
            return has_left(self.connection)

        with self.server.turn(gone):
            return self.server.evaluate(model, point, config, gone)

    def _request(self) -> dict[str, Any]:
        length = self.headers.get("Content-Length", "")
        # Python reads no whole number of thousands of digits.
        if not (length.isdecimal() and len(length) <= len(str(LARGEST)) and int(length) <= LARGEST):
            raise RequestError("InvalidInput", f"a request has its length, at most {LARGEST} bytes", 413)
        body = self.rfile.read(int(length))
        if len(body) < int(length):
            raise ClientGoneError
        try:
            content = json.loads(body, object_pairs_hook=unique)
        except (ValueError, RecursionError) as error:
            raise RequestError("InvalidInput", f"the request is not JSON ({error})") from error
        if not isinstance(content, dict) or not isinstance(content.get("config", {}), dict):
            raise RequestError("InvalidInput", "the request is no JSON object, or its config is none")
        return content

    def _answer(self, status: int, content: Mapping[str, Any]) -> None:
        body = json.dumps(content, allow_nan=False).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing: a campaign asks thousands of times."""


def _error(kind: str, message: str) -> dict[str, Any]:
    return {"error": {"type": kind, "message": message}}
