"""Hulls and how they moved, as the files of beds and landings keep them."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from lithobrake.files.reading import reading
from lithobrake.vocabulary.screen import short_repr

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lithobrake.touchdown import Bed, Lander, Landing, Outcome

    Array = NDArray[np.float64]
    Faces = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MovingBodies:
    """Convex hulls and their frames; in a landing the last is the lander, with all its parts.

    vertices: of each hull [m], shape [vertex_count, 3]; faces: of each, shape [face_count, 3], counted from its first
    vertex; time [s], shape [frame_count]; position [m], shape [frame_count, body_count, 3]; orientation (w, x, y, z),
    shape [frame_count, body_count, 4]; attributes of the file; history of the settling by name, empty for a landing;
    force, the size of the sum of contact forces on each [N], shape [frame_count, body_count], None where it was not
    kept: in beds, and in landings of earlier versions.
    """

    vertices: "tuple[Array, ...]"
    faces: "tuple[Faces, ...]"
    time: "Array"
    position: "Array"
    orientation: "Array"
    attributes: dict[str, Any]
    history: "dict[str, Array]"
    force: "Array | None" = None
    __repr__ = short_repr

    @classmethod
    def read(cls, path: Path, remedy: str) -> "MovingBodies":
        """Read a bed or a landing. Raises DamagedFileError, with the remedy, for a file that is neither."""
        import h5py

        with reading(path, remedy), h5py.File(path, "r") as file:
            if "frames" not in file:
                raise ValueError("it has no group 'frames': it was written without pictures")
            frames = {name: file[f"frames/{name}"][:] for name in ("time", "position", "orientation")}
            force = file["frames/force"][:] if "force" in file["frames"] else None
            history = {name: data[:] for name, data in file["history"].items()} if "history" in file else {}
            return cls(
                vertices=_parts(file["vertices"][:], file["vertex_start"][:]),
                faces=_parts(file["faces"][:], file["face_start"][:]),
                attributes={
                    name: value.tolist() if hasattr(value, "tolist") else value for name, value in file.attrs.items()
                },
                history=history,
                force=force,
                **frames,
            )

    @classmethod
    def of_landing(cls, outcome: "Outcome", bed: "Bed", lander: "Lander", landing: "Landing") -> "MovingBodies":
        """Those of a landing that was recorded, as its file would have them; the lander is the last."""
        with TemporaryDirectory(prefix="lithobrake-") as folder:
            path = Path(folder) / "landing.h5"
            outcome.save_frames(path, bed, lander, landing)
            return cls.read(path, "land again")


def _parts(rows: Any, start: Any) -> tuple[Any, ...]:
    """The rows of each body."""
    return tuple(rows[first:last] for first, last in pairwise(start))
