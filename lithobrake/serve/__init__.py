"""Models over HTTP in the protocol of UM-Bridge, which clients in many languages speak. Stands alone."""

from lithobrake.serve.server import PORT, ClientGoneError, ClientServer, ServedModel, model_server

__all__ = ["PORT", "ClientGoneError", "ClientServer", "ServedModel", "model_server"]
