"""Models over HTTP in the protocol of UM-Bridge, which clients in many languages speak. Stands alone."""

from lithobrake.serve.server import ClientGoneError, ClientServer, ServedModel

__all__ = ["ClientGoneError", "ClientServer", "ServedModel"]
