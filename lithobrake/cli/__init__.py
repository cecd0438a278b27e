"""The command line. Everything heavy is imported inside the command that needs it, so that --help answers at once."""

# Each file of commands adds its own to the application; --help lists them in this order.
from lithobrake.cli import studies, results, exports, one_offs  # noqa: F401  # isort: skip
from lithobrake.cli.arguments import app

__all__ = ["app"]
