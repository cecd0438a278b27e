"""Models over HTTP in the protocol of UM-Bridge, which clients in many languages speak. Stands alone."""

from lithobrake.serve.clients import ClientGoneError, ClientServer
from lithobrake.serve.server import PORT, ServedModel, model_server

__all__ = ["PORT", "ClientGoneError", "ClientServer", "ServedModel", "model_server"]
