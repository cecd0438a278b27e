"""The shape as a plate-vertex table: the text of which NAIF's MKDSK makes a shape kernel (its plate data type 1)."""

from pathlib import Path

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.results import StudyResults


def write_plates(results: StudyResults, path: Path) -> None:
    """Write vertices [km] and plates, each with its number from 1, in the order of body.obj."""
    vertices, faces = results.body_shape
    lines = [str(len(vertices))]
    lines += [f"{number} {x!r} {y!r} {z!r}" for number, (x, y, z) in enumerate((vertices * 1e-3).tolist(), 1)]
    lines += [str(len(faces))]
    lines += [f"{number} {a} {b} {c}" for number, (a, b, c) in enumerate((np.asarray(faces) + 1).tolist(), 1)]
    with atomic_path(path) as draft:
        draft.write_text("\n".join(lines) + "\n", encoding="ascii")
