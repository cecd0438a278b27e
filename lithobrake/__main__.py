"""`python -m lithobrake` is the command line too."""

from lithobrake.cli import app

if __name__ == "__main__":
    app()
