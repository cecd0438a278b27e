"""One readable JSON file for each expansion. Loading reads numbers and names; nothing in the file is executed."""

import hashlib
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from lithobrake.chaos.basis import LOOKED_AT, Indices
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.numerical_distributions import distribution
from lithobrake.files.atomic import write_whole
from lithobrake.files.reading import UNREADABLE
from lithobrake.vocabulary.array_types import Array

Kept = TypeVar("Kept")

FORMAT_VERSION = 1


def data_hash(x: Array, y: Array) -> str:
    """Hash of training data x [count, input_count] and y [count, output_count], the same on every machine."""
    digest = hashlib.sha256()
    for array in (x, y):
        # The shape counts, or arrays of the same numbers in other rows would have one hash; the byte order is fixed.
        digest.update(str(array.shape).encode() + np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()


def write(kind: str, content: dict[str, Any], path: str | os.PathLike[str]) -> None:
    """Write content [JSON values] under a heading that says what it is and who wrote it.

    The file is complete or absent, and numbers come back bit for bit.
    """
    from lithobrake import __version__

    heading = {"format": kind, "format_version": FORMAT_VERSION, "written_by": f"lithobrake {__version__}"}
    write_whole(path, _readable({**heading, **content}) + "\n")


def inputs_to_json(inputs: Mapping[str, Distribution]) -> list[dict[str, Any]]:
    """Inputs in their order, each with name, kind and parameters."""
    return [{"name": name, **entry.to_json()} for name, entry in inputs.items()]


def inputs_from_json(rows: list[dict[str, Any]]) -> dict[str, Distribution]:
    """Inputs that `inputs_to_json` wrote. Raises ValueError where rows are none, or two have one name."""
    inputs: dict[str, Distribution] = {}
    for row in rows:
        if not isinstance(row, dict) or str(row["name"]) in inputs:
            raise ValueError(f"inputs hold {row!r}; each must be a table with a name of its own")
        parameters = {key: value for key, value in row.items() if key not in ("name", "kind")}
        inputs[str(row["name"])] = distribution(row["kind"], **parameters)
    return inputs


def _readable(content: dict[str, Any]) -> str:
    """JSON with one key a line, and one row a line for tables."""
    lines = []
    for key, value in content.items():
        if isinstance(value, list) and value and isinstance(value[0], list | dict):
            rows = ",\n    ".join(json.dumps(row) for row in value)
            lines.append(f'  "{key}": [\n    {rows}\n  ]')
        else:
            lines.append(f'  "{key}": {json.dumps(value)}')
    return "{\n" + ",\n".join(lines) + "\n}"


def read(kind: str, build: Callable[[dict[str, Any]], Kept], path: str | os.PathLike[str]) -> Kept:
    """Read a file that `write` wrote under the same heading, and build what it holds."""
    name = Path(path)
    # A pipe would be waited for, and a folder has no text.
    if name.exists() and not name.is_file():
        raise ValueError(f"{name} is no regular file: give a file that save wrote")
    try:
        content = json.loads(name.read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ValueError(f"{name} is not JSON ({error}): give a file that save wrote") from None
    if not isinstance(content, dict) or content.get("format") != kind:
        other = content.get("format") if isinstance(content, dict) else None
        what = f", but a {other[:80]}" if isinstance(other, str) else ""
        raise ValueError(f"{name} is not a {kind}{what}: give a file that save wrote")
    version = content.get("format_version")
    if type(version) is not int or not 1 <= version <= FORMAT_VERSION:
        author = content.get("written_by", "an unknown version")
        raise ValueError(
            f"{name} has format_version {version!r} ({author}), but this version reads 1 to {FORMAT_VERSION}: "
            "install the version that wrote it, or a later one"
        )
    try:
        return build(content)
    except UNREADABLE as error:
        raise ValueError(f"{name} is damaged ({error}): save it again") from error


def numbers_from_json(name: str, rows: Any, width: int) -> Array:
    """A table of finite numbers, shape [any, width]. Raises ValueError for anything else."""
    table = np.array(rows, dtype=float)
    if table.size == 0:
        table = table.reshape(0, width)
    if table.ndim != 2 or table.shape[1] != width or not np.isfinite(table).all():
        raise ValueError(f"{name} must be rows of {width} finite numbers")
    return table


def names_from_json(names: Any) -> list[str]:
    """Output names. Raises ValueError unless they are a list of different names."""
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise ValueError(f"output_names are {names!r}; they must be a list of names")
    if len(set(names)) < len(names):
        raise ValueError(f"output_names are {names!r}; each must be there once")
    return names


def indices_from_json(rows: Any, input_count: int) -> Indices:
    """Multi-indices, shape [term_count, input_count], as they were written: nothing is rounded or dropped."""
    whole = isinstance(rows, list) and all(
        isinstance(row, list) and len(row) == input_count and all(type(power) is int for power in row) for row in rows
    )
    if not whole or not rows or not all(0 <= power < LOOKED_AT for row in rows for power in row):
        raise ValueError(f"multi_indices must be rows of {input_count} whole numbers from 0 on")
    if len({tuple(row) for row in rows}) < len(rows):
        raise ValueError("multi_indices hold a term twice")
    return np.array(rows, dtype=np.int64)
