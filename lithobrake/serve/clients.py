"""The clients of a server: where it listens for them, how many it takes at once, and for how long each may ask."""

import ipaddress
import select
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from socketserver import TCPServer
from typing import Any

# Requests that are read or wait for their turn; further clients are turned away.
MOST_CLIENTS = 256
# A client has so long to send its whole request [s].
REQUEST_TIME = 10.0
# Whether a client is still there is looked at so often while it waits for its turn [s].
LOOK = 0.2
_TURNED_AWAY = (
    b"HTTP/1.0 503 Service Unavailable\r\nContent-Type: application/json\r\n\r\n"
    b'{"error": {"type": "InvalidInput", "message": "the server has as many clients as it takes; ask again"}}'
)


class ClientGoneError(ConnectionError):
    """A client that has left before its answer."""


class ClientServer(ThreadingHTTPServer):
    """A server that bounds what its clients may take: their number, the time of a request, one evaluation at a time."""

    daemon_threads = True
    request_queue_size = MOST_CLIENTS

    def __init__(self, host: str, port: int, handler: type[BaseHTTPRequestHandler]) -> None:
        """Bind. Raises ValueError for an empty host or no port, OSError where the address is not to be had."""
        self.host = host
        self.address_family, address = _resolved(host, port)
        # The models share compiled kernels and files that are made once.
        self._alone = threading.Lock()
        self._room = threading.BoundedSemaphore(MOST_CLIENTS)
        self._asking: dict[socket.socket, float] = {}
        try:
            super().__init__(address, handler)
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

    def has_asked(self, client: socket.socket) -> None:
        """Note that a client has sent its whole request, and waits."""
        self._asking.pop(client, None)

    def service_actions(self) -> None:
        """Leave those clients alone that have not sent their request in time; asked twice a second."""
        late = time.monotonic() - REQUEST_TIME
        for client in [client for client, since in list(self._asking.items()) if since < late]:
            self._asking.pop(client, None)
            with suppress(OSError):
                client.shutdown(socket.SHUT_RDWR)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Answer a client in a thread, or turn it away where there are too many."""
        if not self._room.acquire(blocking=False):
            with suppress(OSError):
                request.sendall(_TURNED_AWAY)
            self.shutdown_request(request)
            return
        self._asking[request] = time.monotonic()
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
            self._asking.pop(request, None)
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
