"""A server of models: the requests of UM-Bridge, protocol version 1.0, and how each is answered."""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler
from typing import Any

from lithobrake.serve.clients import ClientGoneError, ClientServer, has_left


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


FEATURES = ("Evaluate", "Gradient", "ApplyJacobian", "ApplyHessian")
# Evaluates a model at a point with a configuration; the last argument says whether the client has left meanwhile, and
# an evaluation that ends for that raises ClientGoneError.
Evaluate = Callable[[ServedModel, list[float], Mapping[str, Any], Callable[[], bool]], list[float]]


class RequestError(Exception):
    """What a client is answered in place of a result: a kind of error, a sentence, a status of HTTP."""

    def __init__(self, kind: str, message: str, status: int = 400) -> None:
        super().__init__(message)
        self.kind, self.status = kind, status


def evaluate_here(
    model: ServedModel, point: list[float], config: Mapping[str, Any], gone: Callable[[], bool]
) -> list[float]:
    """Evaluate in this process, for as long as it takes."""
    return model.evaluate(point, config)


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
    if not all(isinstance(one, int | float) and not isinstance(one, bool) and abs(one) < 1e300 for one in numbers):
        raise RequestError("InvalidInput", f"input of model {model.name} is {numbers}; allowed: finite numbers")
    return [float(number) for number in numbers]


PORT = 4242
PROTOCOL = 1.0
# Of a request [bytes]: vectors here have tens of numbers.
LARGEST = 1 << 20


class _Server(ClientServer):
    """Listens, and keeps the models by their names."""

    def __init__(self, models: Sequence[ServedModel], host: str, port: int, evaluate: Evaluate) -> None:
        super().__init__(host, port, _Handler)
        self.models = {model.name: model for model in models}
        self.evaluate = evaluate


class _Handler(BaseHTTPRequestHandler):
    """Answers the requests of a client."""

    server: _Server

    def do_GET(self) -> None:
        """Say which models there are."""
        if self.path != "/Info":
            self._answer(404, _error("UnsupportedFeature", f"GET {self.path} is not known; allowed: /Info"))
            return
        self._answer(200, {"protocolVersion": PROTOCOL, "models": list(self.server.models)})

    def do_POST(self) -> None:
        """Answer a request for a model."""
        try:
            request = self._request()
            self.server.has_asked(self.connection)
            self._answer(200, answer(self.server.models, self.path, request, self._evaluate))
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
            content = json.loads(body)
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


def model_server(
    models: Sequence[ServedModel], host: str, port: int, evaluate: Evaluate = evaluate_here
) -> ClientServer:
    """A server that is bound and not yet at work: `serve_forever()` answers, one evaluation at a time.

    host: name or address of this machine, IPv4 or IPv6; port: 0 takes a free one. `address` is then where it listens.
    evaluate: makes the evaluations; by default in this process, for as long as they take.
    Raises ValueError for an empty host, OSError where the address is not to be had.
    """
    return _Server(models, host, port, evaluate)


def _error(kind: str, message: str) -> dict[str, Any]:
    return {"error": {"type": kind, "message": message}}
