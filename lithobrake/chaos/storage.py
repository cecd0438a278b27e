"""An expansion as one readable JSON file. Loading reads numbers and names; nothing in the file is executed."""

import hashlib
import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.chaos.kinds import distribution
from lithobrake.chaos.polynomials import Array
from lithobrake.chaos.surrogate import Surrogate

FORMAT = "lithobrake expansion"
FORMAT_VERSION = 1


def data_hash(x: Array, y: Array) -> str:
    """Hash of training data x [count, input_count] and y [count, output_count], the same on every machine."""
    digest = hashlib.sha256()
    for array in (x, y):
        digest.update(str(array.shape).encode() + np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()


def save(surrogate: Surrogate, path: str | os.PathLike[str]) -> None:
    """Write an expansion; the file is complete or absent, and numbers come back bit for bit."""
    from lithobrake import __version__

    content = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "written_by": f"lithobrake {__version__}",
        "inputs": [{"name": name, **entry.to_json()} for name, entry in surrogate.inputs.items()],
        "output_names": surrogate.output_names,
        "one_dimensional": surrogate.one_dimensional,
        "multi_indices": surrogate.multi_indices.tolist(),
        "coefficients": surrogate.coefficients.reshape(surrogate.term_count, -1).tolist(),
        "report": surrogate.report,
        "residuals": surrogate.residuals.tolist(),
    }
    with atomic_path(path) as draft:
        draft.write_text(_readable(content) + "\n", encoding="utf-8")


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


def load(path: str | os.PathLike[str]) -> Surrogate:
    """Read an expansion that `Surrogate.save` wrote. Raises ValueError if the file is another thing or damaged."""
    name = Path(path)
    try:
        content = json.loads(name.read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{name} is not JSON ({error}): give a file that Surrogate.save wrote") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ValueError(f"{name} is not a {FORMAT}: give a file that Surrogate.save wrote")
    version = content.get("format_version")
    if not isinstance(version, int) or not 1 <= version <= FORMAT_VERSION:
        raise ValueError(f"{name} has format_version {version}, but 1 to {FORMAT_VERSION} can be read here")
    try:
        return _surrogate_of(content)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{name} is damaged ({error}): save the expansion again") from error


def _surrogate_of(content: dict[str, Any]) -> Surrogate:
    inputs = {}
    for entry in content["inputs"]:
        parameters = {key: value for key, value in entry.items() if key not in ("name", "kind")}
        inputs[str(entry["name"])] = distribution(entry["kind"], **parameters)
    names = [str(name) for name in content["output_names"]]
    indices = np.array(content["multi_indices"], dtype=np.int64).reshape(-1, len(inputs))
    coefficients = np.array(content["coefficients"], dtype=float)
    if coefficients.shape != (len(indices), len(names)) or (indices < 0).any():
        raise ValueError(f"coefficients have shape {coefficients.shape}, not {(len(indices), len(names))}")
    return Surrogate(
        inputs,
        indices,
        coefficients,
        output_names=names,
        one_dimensional=bool(content["one_dimensional"]),
        residuals=np.array(content["residuals"], dtype=float).reshape(-1, len(names)),
        report=dict(content["report"]),
    )
