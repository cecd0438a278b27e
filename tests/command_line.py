"""Commands in the process of the tests, where SciPy, Numba and Matplotlib are loaded and the kernels compiled already.

A process of its own is for what only it shows: signals, kills, and what an interpreter loads.
"""

from subprocess import CompletedProcess

from typer.testing import CliRunner

from lithobrake.cli import app


def lithobrake(*words: object) -> CompletedProcess[str]:
    """What a command prints and says, and its exit code; an error that it does not tell as a sentence is raised."""
    given = [str(word) for word in words]
    shown = CliRunner().invoke(app, given)
    if shown.exception is not None and not isinstance(shown.exception, SystemExit):
        raise shown.exception
    return CompletedProcess(given, shown.exit_code, shown.stdout, shown.stderr)
