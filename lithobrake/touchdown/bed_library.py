"""Beds that were poured once, kept for this user below the cache of the package.

A bed follows from its recipe, with the seed of its pour, and from what pours it; not from lander, site or the soils
that it is landed on with. So a second study of the same beds pours none.
"""

import math
import os
import platform
from collections.abc import Callable
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from pathlib import Path

from lithobrake.compilation.disk_cache import DiskCache
from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import json_hash, source_hash
from lithobrake.touchdown.bed import Bed
from lithobrake.touchdown.pouring import BedRecipe

SIZE_VARIABLE, DEFAULT_GIGABYTES = "LITHOBRAKE_BED_LIBRARY_GB", "2"
MOST_GIGABYTES = 1e9
# Their releases may round otherwise: drawing, hulls, and the compiler of the engine.
_LIBRARIES = ("numpy", "scipy", "numba")


def stored_or_poured(recipe: BedRecipe, path: Path, pour: Callable[[], Bed]) -> bool:
    """Write the bed of a recipe to a file: that of the library, or one that is poured and kept there.

    Returns whether it was poured. Two processes that ask for one bed pour it once; a damaged file of the library is
    poured anew, and a warning says so. Raises what `pour` raises, and ValueError for a size of the library that is
    none.
    """
    name, library = bed_key(recipe), _library(os.environ.get(SIZE_VARIABLE, DEFAULT_GIGABYTES))
    if library is None:
        pour().save(path)
        return True
    # Few locks for all beds, and yet so many that of some dozen poured at once hardly two wait for each other in vain.
    with library.turn("Another lithobrake pours this bed; waiting for it.", name[:3]):
        if take_stored(recipe, path):
            return False
        pour().save(path)
        library.write(name, path.read_bytes())
        return True


def take_stored(recipe: BedRecipe, path: Path) -> bool:
    """Write the bed of a recipe to a file if the library has it; returns whether it has."""
    library = _library(os.environ.get(SIZE_VARIABLE, DEFAULT_GIGABYTES))
    content = library.read(bed_key(recipe)) if library else None
    if content is None:
        return False
    with atomic_path(path) as draft:
        draft.write_bytes(content)
    return True


def is_stored(recipe: BedRecipe) -> bool:
    """Whether the library has a file for the bed of a recipe, whole or not."""
    library = _library(os.environ.get(SIZE_VARIABLE, DEFAULT_GIGABYTES))
    return library is not None and library.has(bed_key(recipe))


def bed_key(recipe: BedRecipe) -> str:
    """The name of a bed in the library: a hash of its recipe, of the code that pours it, and of what that stands on."""
    table = asdict(recipe)
    # How a landing is stepped; a bed is poured and settled with all contacts at the same steps.
    for name in ("stepping", "resolved_speed", "held_speed"):
        del table["contact"][name]
    return json_hash([table, _code()])


@cache
def _code() -> list[str]:
    # All of both parts: which of their files a pour calls changes more often than anyone would note it here.
    return [
        source_hash("dem", "touchdown", "vocabulary/material_properties.py"),
        platform.machine(),
        *(version(name) for name in _LIBRARIES),
    ]


@cache
def _library(gigabytes: str) -> DiskCache | None:
    try:
        limit = float(gigabytes)
    except ValueError:
        limit = math.nan
    if not 0.0 <= limit <= MOST_GIGABYTES:
        raise ValueError(
            f"{SIZE_VARIABLE} is {gigabytes!r}; allowed: {MOST_GIGABYTES:g} gigabytes at most; write 0 to keep none"
        )
    return DiskCache("beds", "beds", int(1e9 * limit)) if limit > 0.0 else None
