"""What a server allows its clients: where it is reached, how many there are, and for how long."""

import contextlib
import json
import socket
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import pytest

from lithobrake.campaign import ModelServer
from lithobrake.serve import ClientGoneError, ClientServer, ServedModel

SUM = ServedModel("sum", ("x", "y"), ("z",), lambda point, config: [sum(point)])
ASKED = b'{"name": "sum", "input": [[1.0, 2.0]]}'
REQUEST = b"POST /Evaluate HTTP/1.0\r\nContent-Length: %d\r\n\r\n%b" % (len(ASKED), ASKED)


@contextmanager
def running(models: Sequence[ServedModel] = (SUM,), host: str = "127.0.0.1", **more: Any) -> Iterator[ClientServer]:
    with ClientServer(models, host, 0, **more) as server:
        threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()
        yield server
        server.shutdown()


def asked(server: ClientServer, request: bytes) -> bytes:
    """All that a server answers to these bytes."""
    with socket.create_connection(server.server_address[:2]) as client:
        client.sendall(request)
        parts = iter(lambda: client.recv(4096), b"")
        with contextlib.suppress(ConnectionError):
            return b"".join(parts)
    return b""


def awaited(condition: Callable[[], bool]) -> None:
    while not condition():
        time.sleep(0.005)


@pytest.mark.parametrize("host", ["", " ", "\n"])
def test_an_empty_host_is_not_every_network(host: str) -> None:
    with pytest.raises(ValueError, match="an unset variable"):
        ClientServer([SUM], host, 0)


@pytest.mark.parametrize("port", [-1, 65536, 10**30])
def test_a_port_that_there_is_not_is_refused(port: int) -> None:
    with pytest.raises(ValueError, match="allowed: 0"):
        ClientServer([SUM], "127.0.0.1", port)


def test_a_host_without_an_address_is_named() -> None:
    with pytest.raises(OSError, match="host 'no host' is no address of this machine"):
        ClientServer([SUM], "no host", 0)


@pytest.mark.parametrize(
    ("host", "local"), [("127.0.0.1", True), ("localhost", True), ("0.0.0.0", False), ("0", False)]
)
def test_a_server_knows_whether_only_this_machine_reaches_it(host: str, local: bool) -> None:
    with ClientServer([SUM], host, 0) as server:
        assert server.is_local is local
        assert server.address == f"http://{host}:{server.server_port}"


@pytest.mark.skipif(not socket.has_ipv6, reason="no IPv6")
def test_a_server_listens_on_addresses_of_version_six() -> None:
    try:
        socket.create_server(("::1", 0), family=socket.AF_INET6).close()
    except OSError:
        pytest.skip("this machine has no IPv6")
    with running(host="::1") as server:
        assert server.address == f"http://[::1]:{server.server_port}"
        assert server.is_local
        named = ModelServer.of(f"umbridge:{server.address}/sum")
        assert named.evaluate([[1.0, 2.0]], {}) == [[3.0]]


def test_a_length_of_thousands_of_digits_is_refused_without_a_traceback(capsys: pytest.CaptureFixture[str]) -> None:
    with running() as server:
        found = asked(server, b"POST /Evaluate HTTP/1.0\r\nContent-Length: %b\r\n\r\n" % (b"9" * 5000))
    assert found.startswith(b"HTTP/1.0 413")
    assert capsys.readouterr().err == ""


def test_a_client_that_leaves_is_told_to_nobody(capsys: pytest.CaptureFixture[str]) -> None:
    arrived, done = threading.Event(), threading.Event()

    def slow(point: list[float], config: Mapping[str, Any]) -> list[float]:
        arrived.set()
        done.wait()
        return [1.0]

    with running([ServedModel("sum", ("x", "y"), ("z",), slow)]) as server:
        client = socket.create_connection(server.server_address[:2])
        client.sendall(REQUEST)
        arrived.wait()
        # A reset, so that what is written to the client fails.
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        client.close()
        done.set()
        assert asked(server, REQUEST).endswith(b'{"output": [[1.0]]}')
    assert capsys.readouterr().err == ""


def test_an_evaluation_ends_when_its_client_leaves() -> None:
    left, arrived = threading.Event(), threading.Event()

    def evaluate(
        model: ServedModel, point: list[float], config: Mapping[str, Any], gone: Callable[[], bool]
    ) -> list[float]:
        if config.get("endless"):
            arrived.set()
            awaited(gone)
            left.set()
            raise ClientGoneError
        return model.evaluate(point, config)

    endless = json.dumps({"name": "sum", "input": [[1.0, 2.0]], "config": {"endless": True}}).encode()
    with running(evaluate=evaluate) as server:
        with socket.create_connection(server.server_address[:2]) as client:
            client.sendall(b"POST /Evaluate HTTP/1.0\r\nContent-Length: %d\r\n\r\n%b" % (len(endless), endless))
            arrived.wait()
            assert not left.is_set()
        left.wait()
        assert asked(server, REQUEST).endswith(b'{"output": [[3.0]]}')


def test_a_request_that_is_sent_too_slowly_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lithobrake.serve.server._Handler.timeout", 0.05)
    with running() as server:
        assert asked(server, b"POST /Evaluate HTTP/1.0\r\nContent-Le") == b""
        assert asked(server, REQUEST[:-1]) == b""
        assert asked(server, REQUEST).endswith(b'{"output": [[3.0]]}')


def test_more_clients_than_there_is_room_for_are_turned_away(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lithobrake.serve.server.MOST_CLIENTS", 2)
    with running() as server:
        waiting = [socket.create_connection(server.server_address[:2]) for _ in range(2)]
        assert b"503 Service Unavailable" in asked(server, b"")
        for client in waiting:
            client.close()
        awaited(lambda: b'"models"' in asked(server, b"GET /Info HTTP/1.0\r\n\r\n"))
