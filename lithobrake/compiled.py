"""Compilation of numerical kernels, with a disk cache that is never stale.

Numba's own cache looks only at the file a function stands in, so an edited function in another file would go unnoticed.
Here the cache folder is named by a hash of all sources of the part that it belongs to, and the compiler's version.
"""

import hashlib
import logging
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba

log = logging.getLogger(__name__)
Function = TypeVar("Function", bound=Callable[..., Any])


@cache
def cache_folder(part: str) -> Path:
    """Folder of the compiled kernels of one part (say "dem") for exactly its sources and this compiler.

    A kernel calls only kernels of its own part, so the sources of that part, and this file, are all that matters.
    """
    package = Path(__file__).parent
    digest = hashlib.sha256(numba.__version__.encode())
    for source in [Path(__file__), *sorted((package / part).rglob("*.py"))]:
        digest.update(str(source.relative_to(package)).encode() + b"\0" + source.read_bytes())
    root = os.environ.get("LITHOBRAKE_CACHE") or os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(root) / "lithobrake" / f"{part}-{digest.hexdigest()[:16]}"


@cache
def announce(part: str, what: str) -> None:
    """Say, once, that the kernels of a part have yet to be compiled; nothing where they lie on disk."""
    if next(cache_folder(part).rglob("*.nbi"), None) is None:
        log.warning("Compiling %s for this processor, once: about a minute.", what)


def compiled(function: Function) -> Function:
    """Compile a function on its first call (IEEE arithmetic, no reassociation) and keep it on disk."""
    return _compile(function, {})


def kernel(function: Function) -> Function:
    """Compile a function that allocates nothing into its callers.

    Arrays then travel without reference counts and without copies of their descriptions: a step is 20 times faster.
    """
    return _compile(function, {"_nrt": False, "forceinline": True})


def large_kernel(function: Function) -> Function:
    """Compile a function that allocates nothing and is too large to be copied into each caller."""
    return _compile(function, {"_nrt": False})


def _compile(function: Function, options: dict[str, bool]) -> Function:
    outside = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(cache_folder(function.__module__.split(".")[1]))
    try:
        result: Function = numba.njit(function, cache=True, error_model="numpy", nogil=True, **options)
        return result
    finally:
        numba.config.CACHE_DIR = outside
