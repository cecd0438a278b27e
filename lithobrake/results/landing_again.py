"""A touchdown of a study made once more, for its frames; nothing is written."""

import shlex
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.reading import read_json
from lithobrake.results.moving_bodies import MovingBodies
from lithobrake.study import Study, check_tables, load_tables
from lithobrake.study.touchdown_model import TouchdownModel, engine_hash, lander, landing, stored_bed, touchdown_version

if TYPE_CHECKING:
    from lithobrake.campaign import Record
    from lithobrake.touchdown import Outcome

# Keys of [site] that name the body and its files.
OF_FILES = ("body", "name", "unit", "gravity_facets", "partner", "kernels", "kernel_body", "epoch")


def land_again(
    folder: Path, record: "Record", frame_count: int, progress: Callable[[float, str], None]
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
    folder: Path, record: "Record", frame_count: int, progress: Callable[[float, str], None]
) -> MovingBodies:  # fmt: skip
    """Land as land_again does, and return the hulls with their frames; the lander is the last of them."""
    outcome, study = land_again(folder, record, frame_count, progress), landing_study(folder)
    bed = stored_bed(folder / f"beds/bed_{round(record.inputs['bed'])}.h5")
    return MovingBodies.of_landing(outcome, bed, lander(study, record.inputs), landing(study, record.inputs))


def landing_study(folder: Path) -> Study:
    """The study of a folder, as far as a landing reads it."""
    # Nothing of a landing follows from the shape of the body, from the states from which landers were flown to the
    # ground, or from the sky; no file of these need be where this folder was taken. Its soil is among its inputs.
    tables = {key: table for key, table in load_tables(folder / "study.toml").items() if key not in ("sky", "soil")}
    site, delivery = (tables.get(name, {}) for name in ("site", "delivery"))
    tables["site"] = {key: value for key, value in site.items() if key not in OF_FILES}
    if "states" in delivery:
        still = {"position": [0.0, 0.0, 0.0], "velocity": [0.0, 0.0, 0.0]}
        tables["delivery"] = {key: value for key, value in delivery.items() if key != "states"} | {"release": still}
    noted = {"file": ""}
    if (folder / "keys.json").is_file():
        noted = read_json(folder / "keys.json", {"study": {"file": str}}, "put a copy of it back")["study"]
    # Paths in a study file count from where it lies, which is not where its copy does.
    return check_tables(tables, (folder / noted["file"]).resolve().parent if noted["file"] else Path.cwd())


def _refuse_another_landing(name: str, record: "Record", outcome: "Outcome", again: str) -> None:
    """Raise ValueError unless a landing gave what the ledger has, bit for bit."""
    found = {"outcome": outcome.status, **outcome.outputs}
    for key, known in {"outcome": record.outcome, **record.outputs}.items():
        if found.get(key) != known:
            raise ValueError(
                f"{name} has {known} for {key}, and landing again gave {found.get(key)}: the study, its bed or this "
                f"machine is another; make the study again with: {again}"
            )
