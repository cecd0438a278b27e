"""Hulls and how they moved: touchdowns of a study made once more, on ground that repeats."""

import shlex
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.reading import reading
from lithobrake.results.study_files import folder_of_paths
from lithobrake.study import Study, check_tables, load_tables
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.touchdown_model import TouchdownModel, engine_hash, landing, stored_bed, touchdown_version
from lithobrake.vocabulary.callbacks import Progress
from lithobrake.vocabulary.file_names import LANDING_FILE, STUDY_FILE
from lithobrake.vocabulary.plain_text import short_repr

if TYPE_CHECKING:
    from lithobrake.campaign import Record
    from lithobrake.touchdown import Bed, Lander, Landing, Outcome
    from lithobrake.vocabulary.array_types import Array, Integers

# Keys of [site] that name the body and its files.
OF_FILES = ("body", "name", "unit", "gravity_facets", "partner", "kernels", "kernel_body", "epoch")


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
    faces: "tuple[Integers, ...]"
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
            path = Path(folder) / LANDING_FILE
            outcome.save_frames(path, bed, lander, landing)
            return cls.read(path, "land again")


def _parts(rows: Any, start: Any) -> tuple[Any, ...]:
    """The rows of each body."""
    return tuple(rows[first:last] for first, last in pairwise(start))


def land_again(
    folder: Path, record: "Record", frame_count: int, progress: Progress
) -> "Outcome":  # fmt: skip
    """Land with the inputs of a run on its bed, and record frame_count frames at least.

    progress: called with the fraction that is done of what is being done.
    Raises ValueError for a run that has no landing to show, and where what comes out is not what the ledger has.
    """
    name, again = f"run {record.key}", f"lithobrake run STUDY.toml --out {shlex.quote(str(folder))}"
    if record.version.partition("+")[2] == "":
        raise ValueError(
            f"{name} was made by a program or function of the study's own, whose motion nobody here knows; "
            "ask that program for its frames"
        )
    if record.outcome is None:
        raise ValueError(f"{name} has no outcome ({record.reason or record.status}); choose a run that has one")
    if record.version != touchdown_version():
        raise ValueError(
            f"{name} was made by the code {record.version}, and this is {touchdown_version()}, which may land "
            f"elsewhere; use that version of lithobrake, or make the study again with: {again}"
        )
    beds = tuple(folder / f"beds/bed_{number}.h5" for number in range(round(record.inputs["bed"]) + 1))
    if not beds[-1].is_file():
        raise ValueError(f"{beds[-1]}, the bed of {name}, is not there; make it again with: {again}")
    outcome = TouchdownModel(landing_study(folder), beds, engine_hash()).land(record.inputs, frame_count, progress)
    _refuse_another_landing(name, record, outcome, again)
    return outcome


def bodies_again(
    folder: Path, record: "Record", frame_count: int, progress: Progress
) -> MovingBodies:  # fmt: skip
    """Land as land_again does, and return the hulls with their frames; the lander is the last of them."""
    outcome, study = land_again(folder, record, frame_count, progress), landing_study(folder)
    bed = stored_bed(folder / f"beds/bed_{round(record.inputs['bed'])}.h5")
    return MovingBodies.of_landing(outcome, bed, lander(study, record.inputs), landing(study, record.inputs))


def landing_study(folder: Path) -> Study:
    """The study of a folder, as far as a landing reads it."""
    # Nothing of a landing follows from the shape of the body, from the states from which landers were flown to the
    # ground, or from the sky; no file of these need be where this folder was taken. Its soil is among its inputs.
    tables = {key: table for key, table in load_tables(folder / STUDY_FILE).items() if key not in ("sky", "soil")}
    site, delivery = (tables.get(name, {}) for name in ("site", "delivery"))
    tables["site"] = {key: value for key, value in site.items() if key not in OF_FILES}
    if "states" in delivery:
        still = {"position": [0.0, 0.0, 0.0], "velocity": [0.0, 0.0, 0.0]}
        tables["delivery"] = {key: value for key, value in delivery.items() if key != "states"} | {"release": still}
    return check_tables(tables, folder_of_paths(folder, "put a copy of it back"))


def _refuse_another_landing(name: str, record: "Record", outcome: "Outcome", again: str) -> None:
    """Raise ValueError unless a landing gave what the ledger has, bit for bit."""
    found = {"outcome": outcome.status, **outcome.outputs}
    for key, known in {"outcome": record.outcome, **record.outputs}.items():
        if found.get(key) != known:
            raise ValueError(
                f"{name} has {known} for {key}, and landing again gave {found.get(key)}: the study, its bed or this "
                f"machine is another; make the study again with: {again}"
            )


def with_images(landing: MovingBodies) -> MovingBodies:
    """Return a landing with those images of its grains that lie in the tile around the lander in any frame.

    Whether an image does is told by where its grain was in the first frame. It moves as its grain does, and the lander
    is the last body again. A landing between walls is returned as it is, and so is a bed, of which one tile is shown.
    """
    facts = landing.attributes
    if (facts.get("format"), facts.get("sides")) != ("lithobrake landing", "periodic"):
        return landing
    width, start = np.array(facts["width"]), landing.position[0, :-1, :2]
    path = landing.position[:, -1, :2]
    first = np.ceil((path.min(axis=0) - start.max(axis=0)) / width - 0.5).astype(int)
    last = np.floor((path.max(axis=0) - start.min(axis=0)) / width + 0.5).astype(int)
    numbers, shifts = [], []
    for tile in np.ndindex(*(last - first + 1)):
        shift = (first + tile) * width
        way = np.abs(start + shift - path[:, None])
        (near,) = np.nonzero((way <= 0.5 * width).all(axis=2).any(axis=0))
        numbers.append(near)
        shifts.append(np.tile([*shift, 0.0], (len(near), 1)))
    lander = landing.position.shape[1] - 1
    bodies, shift = np.concatenate([*numbers, [lander]]), np.concatenate([*shifts, np.zeros((1, 3))])
    return replace(
        landing,
        vertices=tuple(landing.vertices[body] for body in bodies),
        faces=tuple(landing.faces[body] for body in bodies),
        position=landing.position[:, bodies] + shift,
        orientation=landing.orientation[:, bodies],
        force=None if landing.force is None else landing.force[:, bodies],
    )
