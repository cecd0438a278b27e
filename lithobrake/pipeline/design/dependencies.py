"""What beds and touchdowns of a study depend on, as JSON values, and the keys of its runs in the ledger."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake import __version__
from lithobrake.campaign import Command, run_key
from lithobrake.files.reading import content_hash
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain
from lithobrake.touchdown.touchdown_model import engine_hash, touchdown_version


def bed_files(study: Study) -> list[str]:
    """Names of the bed files; a solver of the user's own has its own surface."""
    if not study.has_soil:
        return []
    return [f"beds/bed_{index}.h5" for index in range(study.bed_count)]


def bed_dependencies(study: Study) -> dict[str, Any]:
    """What the beds depend on: uncertain quantities count with their medians."""
    values = study.touchdown_medians()
    return {
        "seed": pour_seed(study, 0),
        "bed": bed_setting(study),
        "values": {name: value for name, value in values.items() if name.startswith(("grain.", "surface."))},
        # Options of the touchdown alone: a change of these pours no bed again.
        "contact": study.contact.model_dump(exclude={"stepping", "resolved_speed", "held_speed"}),
        "engine": engine_hash(),
        **_ground_dependencies(study),
    }


def _ground_dependencies(study: Study) -> dict[str, Any]:
    """What the grounds of the beds depend on, as JSON values; empty where all beds have one."""
    if study.ground is None:
        return {}
    found = study.ground.model_dump(exclude_none=True)
    # Each bed has one of the draws of this seed, whatever their number.
    return {"ground": found, "ground_seed": study.seed}


def bed_setting(study: Study) -> dict[str, Any]:
    """What is said of the beds but for their number and seed; nothing of boulders where there are none."""
    return study.bed.model_dump(exclude={"bed_count", "seed"} | ({"boulders"} if study.bed.boulders is None else set()))


def pour_seed(study: Study, index: int) -> int:
    """Seed of the pour of a bed; where the study gives none, two seeds of studies share none."""
    if study.bed.seed is not None:
        return study.bed.seed + index
    state = np.random.SeedSequence(study.seed, spawn_key=(index,)).generate_state(1, np.uint64)
    # Below 2**53, so that it is the same number in every file.
    return int(state[0]) >> 11


def touchdown_dependencies(study: Study) -> dict[str, Any]:
    """What a touchdown depends on beside its values: the options, the lander's mesh, the beds, the engine."""
    if not study.has_soil:
        return solver_dependencies(study)
    return {
        "bed": bed_dependencies(study),
        # The numbers of the lander that a run reads are among its inputs, and so in its key already.
        "lander": study.lander.model_dump(include={"shape", "edges", "inertia", "unit"}),
        "mesh": None if study.lander.file is None else content_hash(Path(study.lander.file)),
        **_part_dependencies(study),
        "stepping": study.contact.stepping,
        "resolved_speed": study.contact.resolved_speed,
        "held_speed": study.contact.held_speed,
        "time_limit": study.landing.time_limit,
        "hop_height": study.journey.hop_height,
        "version": touchdown_version(),
    }


def _part_dependencies(study: Study) -> dict[str, Any]:
    """What a touchdown depends on of the lander's parts, where it has any; a mesh counts with its content."""
    parts = {name: part.model_dump() for name, part in study.lander.part.items()}
    for part in parts.values():
        part["file"] = None if part["file"] is None else content_hash(Path(part["file"]))
    return {"parts": parts} if parts else {}


def solver_dependencies(study: Study) -> dict[str, Any]:
    """What a touchdown by a program depends on beside its values: the program's files, and what it is told."""
    setting = solver_setting(study)
    # A mesh counts with its content, wherever it lies.
    setting["lander"]["file"] = None if study.lander.file is None else content_hash(Path(study.lander.file))
    setting |= _part_dependencies(study)
    identity = [study.function] if study.function else solver_command(study, Path()).identity()
    # Without the hash of the engine, which makes none of these touchdowns: a change of its code repeats no run of a
    # program.
    return {"solver": identity, "setting": setting, "version": __version__}


def solver_setting(study: Study) -> dict[str, Any]:
    """What a program is told beside the values of a run, as it stands in the study file."""
    return {
        "bed": bed_setting(study),
        "lander": study.lander.model_dump(include={"shape", "edges", "inertia", "file", "unit"}),
        **({"parts": study.lander.model_dump(include={"part"})["part"]} if study.lander.part else {}),
        "contact": study.contact.model_dump(),
        "time_limit": study.landing.time_limit,
    }


def solver_command(study: Study, folder: Path) -> Command:
    solver = study.solver
    templates = tuple(Path(name) for name in solver.templates)
    return Command(str(solver.command), folder / "solver", templates=templates, answer=solver.answer)


def design_dependencies(study: Study) -> dict[str, Any]:
    values = study.touchdown_values()
    inputs = uncertain(values)
    fixed = {name: value for name, value in values.items() if name not in inputs}
    laws = {name: value.to_chaos().to_json() for name, value in inputs.items()}
    return {
        "touchdown": touchdown_dependencies(study),
        "drawn": _drawn_dependencies(study),
        "fixed": fixed,
        "inputs": laws,
        **_soil_dependencies(study),
    }


def _soil_dependencies(study: Study) -> dict[str, Any]:
    """What the soils of regions depend on, as JSON values; empty where there are none. A file counts by its content."""
    found = {name: soil.model_dump(exclude_none=True) for name, soil in study.soil.items()}
    for name, soil in study.soil.items():
        if soil.facets is not None:
            found[name]["facets"] = content_hash(Path(soil.facets))
    return {"soil": found} if found else {}


def _drawn_dependencies(study: Study) -> dict[str, Any]:
    return {
        "bed_count": study.bed_count,
        "azimuth": "random" if study.impact.azimuth_deg == "random" else "fixed",
        **study.impact.model_dump(include={"region", "orientation", "pointing_error_deg"}),
    }


def touchdown_keys(study: Study, rows: Sequence[Mapping[str, float]], replicate: int) -> list[str]:
    context = touchdown_dependencies(study)
    return [run_key(row, study.seed, replicate, context) for row in rows]
