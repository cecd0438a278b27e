"""Libraries that only an extra of the package installs, imported where they are used."""

from importlib import import_module
from typing import Any


def extra_library(module: str, what: str, extra: str, remedy: str = "") -> Any:
    """Import a module of an extra; what: the library in words. Raises ImportError, with a remedy, if it is missing."""
    try:
        return import_module(module)
    except ImportError as error:
        raise ImportError(f'{what} is not installed: pip install "lithobrake[{extra}]"{remedy}') from error
