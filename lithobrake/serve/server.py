"""A server of models by the standard library: the requests of UM-Bridge, protocol version 1.0.

Source: [Seelinger-2023]
"""

import json
from collections.abc import Mapping, Sequence
from http.server import BaseHTTPRequestHandler
from typing import Any

from lithobrake.serve.answers import Evaluate, RequestError, ServedModel, answer, evaluate_here
from lithobrake.serve.clients import ClientGoneError, ClientServer, has_left

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
