"""Models over HTTP in the protocol of UM-Bridge, which clients in many languages speak. Stands alone."""

from lithobrake.serve.answers import ServedModel
from lithobrake.serve.clients import ClientGoneError, ClientServer
from lithobrake.serve.server import PORT, model_server

__all__ = ["PORT", "ClientGoneError", "ClientServer", "ServedModel", "model_server"]
