"""The beds, and one landing on the first of them to look at."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake.hashing import content_hash, hashed_seed
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.kernels import compile_kernels
from lithobrake.pipeline.solver import solver_reads
from lithobrake.study import Study
from lithobrake.touchdown_model import (
    acceleration,
    contact,
    draw,
    engine_hash,
    grain,
    in_words_of_the_study,
    lander,
    landing,
    medians,
    stored_bed,
    touchdown_version,
)

if TYPE_CHECKING:
    from lithobrake.touchdown import BedRecipe

SNAPSHOT_FRAMES = 120


def bed_files(study: Study) -> list[str]:
    """Names of the bed files; a solver of the user's own has its own surface."""
    if not study.has_soil:
        return []
    return [f"beds/bed_{index}.h5" for index in range(study.bed.bed_count)]


def bed_reads(study: Study) -> dict[str, Any]:
    """What the beds depend on: uncertain quantities count with their medians."""
    values = medians(study)
    return {
        "seed": study.seed,
        "bed": study.bed.model_dump(exclude={"bed_count"}),
        "values": {name: value for name, value in values.items() if name.startswith(("grain.", "surface."))},
        "contact": study.contact.model_dump(exclude={"stepping", "held_speed"}),
        "engine": engine_hash(),
    }


def pour_beds(job: Job) -> None:
    """Pour and settle every bed that is not there yet, or no longer good."""
    from lithobrake.touchdown import pour_bed

    compile_kernels(job)
    study = job.study
    (job.folder / "beds").mkdir(exist_ok=True)
    for index, name in enumerate(bed_files(study)):
        if name not in job.wanted:
            continue

        def show(done: float, what: str, index: int = index) -> None:
            numbered = f"bed {index + 1} of {study.bed.bed_count}: " if study.bed.bed_count > 1 else ""
            job.progress(done, 1.0, f"{numbered}{what}")

        with in_words_of_the_study():
            bed = pour_bed(bed_recipe(study, index), progress=show)
        bed.save(job.folder / name)


def bed_recipe(study: Study, index: int) -> "BedRecipe":
    """What the bed of a number follows from, uncertain quantities at their median."""
    from lithobrake.touchdown import BedRecipe, GrainSizes

    values, sizes = medians(study), study.bed.diameter.model_dump()
    if sizes["distribution"] == "constant":
        sizes = {"distribution": "constant", "lower": sizes["value"], "upper": sizes["value"]}
    return BedRecipe(
        grain_count=study.bed.grain_count,
        sizes=GrainSizes(**sizes),
        cloud_point_count=study.bed.cloud_point_count,
        width=study.bed.width,
        material=grain(values),
        gravity=acceleration(values, study.bed.settle_gravity or values["surface.gravity"]),
        pour_gravity=study.bed.pour_gravity,
        seed=hashed_seed(study.seed, "bed", index),
        contact=contact(study),
    )


def landing_files(study: Study) -> list[str]:
    """Name of the file of the landing at the medians."""
    return [] if not study.has_soil else ["landing.h5"]


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


def landing_reads(study: Study) -> dict[str, Any]:
    """What the landing at the medians depends on."""
    return {"touchdown": touchdown_reads(study), "values": draw(study, medians(study), study.seed)}


def land_once(job: Job) -> None:
    """Land at the medians of all inputs and keep the pictures."""
    from lithobrake.touchdown import land

    compile_kernels(job)
    values = draw(job.study, medians(job.study), job.study.seed)
    bed = stored_bed(job.folder / bed_files(job.study)[round(values["bed"])])
    with in_words_of_the_study():
        body, arrival = lander(job.study, values), landing(job.study, values)
        outcome = land(bed, body, arrival, SNAPSHOT_FRAMES, lambda fraction, what: job.progress(fraction, 1.0, what))
    outcome.save_frames(job.folder / "landing.h5", bed, body, arrival)
