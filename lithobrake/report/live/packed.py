"""Numbers inside the page: arrays bit for bit as base64, and JSON that no browser takes for the end of a script."""

import base64
import json
import zlib
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

TYPES = ("float64", "float32", "int32", "int16", "uint8")


def packed(arrays: Mapping[str, np.ndarray]) -> dict[str, dict[str, Any]]:
    """Arrays as JSON values: type, shape, and little-endian bytes as base64. Raises ValueError for another type."""
    return _values(arrays, lambda data: data)


def deflated(arrays: Mapping[str, np.ndarray]) -> dict[str, dict[str, Any]]:
    """The same with the bytes of each array deflated (RFC 1950), for those of which much is alike."""
    return _values(arrays, lambda data: zlib.compress(data, 9))


def _values(arrays: Mapping[str, np.ndarray], made: Callable[[bytes], bytes]) -> dict[str, dict[str, Any]]:
    found = {}
    for name, array in arrays.items():
        if array.dtype.name not in TYPES:
            raise ValueError(f"{name} has type {array.dtype}, but must have one of {', '.join(TYPES)}")
        data = np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<")).tobytes()
        found[name] = {
            "type": array.dtype.name,
            "shape": list(array.shape),
            "base64": base64.b64encode(made(data)).decode("ascii"),
        }
    return found


def script_data(name: str, content: Mapping[str, Any]) -> str:
    """An element of the page that holds JSON and is read by its name."""
    text = json.dumps(content, allow_nan=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{text}</script>\n'
