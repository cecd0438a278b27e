"""Polynomial chaos for any model: inputs with distributions, designs, fits, moments, sensitivity indices."""

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

# Counting needs no arrays: a study file is refused without a wait for them.
from lithobrake.chaos.counts import smolyak_count as smolyak_count
from lithobrake.chaos.counts import term_count as term_count

if TYPE_CHECKING:
    from lithobrake.chaos.public import *  # noqa: F403


def __getattr__(name: str) -> Any:
    """Import the rest when the first of it is asked for."""
    public = import_module("lithobrake.chaos.public")
    if not hasattr(public, name):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}", name=name, obj=sys.modules[__name__])
    return getattr(public, name)


def __dir__() -> list[str]:
    """List the public names; they are imported for it."""
    return list(import_module("lithobrake.chaos.public").__all__)
