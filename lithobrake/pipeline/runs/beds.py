"""The beds of a study: what they follow from, and how they are poured."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.hashing import content_hash, hashed_seed
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.pouring import pour_at_once
from lithobrake.pipeline.runs.solver import solver_reads
from lithobrake.study import Study
from lithobrake.study.touchdown_model import (
    acceleration,
    contact,
    engine_hash,
    grain,
    grain_sizes,
    in_words_of_the_study,
    medians,
    touchdown_version,
)

if TYPE_CHECKING:
    from lithobrake.touchdown import BedRecipe


def bed_files(study: Study) -> list[str]:
    """Names of the bed files; a solver of the user's own has its own surface."""
    if not study.has_soil:
        return []
    return [f"beds/bed_{index}.h5" for index in range(study.bed_count)]


def bed_reads(study: Study) -> dict[str, Any]:
    """What the beds depend on: uncertain quantities count with their medians."""
    values = medians(study)
    return {
        "seed": pour_seed(study, 0),
        "bed": study.bed.model_dump(exclude={"bed_count"}),
        "values": {name: value for name, value in values.items() if name.startswith(("grain.", "surface."))},
        "contact": study.contact.model_dump(exclude={"stepping", "held_speed"}),
        "engine": engine_hash(),
    }


def pour_beds(job: Job) -> None:
    """Put every bed into the folder that is not there yet, or no longer good: from the library, or poured.

    Raises ValueError that names the beds which cannot be poured, when all others are there.
    """
    from lithobrake.touchdown import take_stored

    (job.folder / "beds").mkdir(exist_ok=True)
    names = {index: name for index, name in enumerate(bed_files(job.study)) if name in job.wanted}
    with in_words_of_the_study():
        recipes = {index: bed_recipe(job.study, index) for index in names}
        new = {index: recipe for index, recipe in recipes.items() if not take_stored(recipe, job.folder / names[index])}
    found = len(names) - len(new)
    if found:
        job.say(f"bed: {found} of {len(names)} {'was' if found == 1 else 'were'} in the library of beds")
    if new:
        pour_at_once(job, {index: (recipe, job.folder.path.absolute() / names[index]) for index, recipe in new.items()})


def bed_recipe(study: Study, index: int) -> "BedRecipe":
    """What the bed of a number follows from, uncertain quantities at their median."""
    from lithobrake.touchdown import BedRecipe

    values = medians(study)
    return BedRecipe(
        grain_count=study.bed.grain_count,
        sizes=grain_sizes(study),
        cloud_point_count=study.bed.cloud_point_count,
        width=study.bed.width,
        material=grain(values),
        gravity=acceleration(values, study.bed.settle_gravity or values["surface.gravity"]),
        pour_gravity=study.bed.pour_gravity,
        seed=pour_seed(study, index),
        contact=contact(study),
    )


def pour_seed(study: Study, index: int) -> int:
    """Seed of the pour of a bed: two seeds of studies share none."""
    # Studies of this method keep the beds that they have always had.
    if study.design.method == "paper":
        return hashed_seed(study.seed, "bed", index)
    state = np.random.SeedSequence(study.seed, spawn_key=(index,)).generate_state(1, np.uint64)
    # Below 2**53, so that it is the same number in every file.
    return int(state[0]) >> 11


def touchdown_reads(study: Study) -> dict[str, Any]:
    """What a touchdown depends on beside its values: the options, the lander's mesh, the beds, the engine."""
    if not study.has_soil:
        return solver_reads(study)
    return {
        "bed": bed_reads(study),
        "lander": study.lander.model_dump(include={"shape", "edges", "inertia", "unit"}),
        "mesh": None if study.lander.file is None else content_hash(Path(study.lander.file)),
        "stepping": study.contact.stepping,
        "held_speed": study.contact.held_speed,
        "time_limit": study.landing.time_limit,
        "version": touchdown_version(),
    }
