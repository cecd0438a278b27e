"""The beds, and one landing on the first of them to look at."""

from pathlib import Path
from typing import Any

from lithobrake import __version__
from lithobrake.pipeline.folder import content_hash, json_hash
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.kernels import compile_kernels
from lithobrake.pipeline.landings import (
    acceleration,
    contact,
    draw,
    engine_hash,
    grain,
    lander,
    landing,
    medians,
    stored_bed,
)
from lithobrake.pipeline.solver import solver_reads
from lithobrake.study import Study

SNAPSHOT_FRAMES = 120


def bed_files(study: Study) -> list[str]:
    """Names of the bed files; a solver of the user's own has its own surface."""
    if study.solver.command:
        return []
    return [f"beds/bed_{index}.h5" for index in range(study.bed.bed_count)]


def bed_reads(study: Study) -> dict[str, Any]:
    """What the beds depend on: uncertain quantities count with their medians."""
    values = medians(study)
    return {
        "seed": study.seed,
        "bed": study.bed.model_dump(exclude={"bed_count"}),
        "values": {name: value for name, value in values.items() if name.startswith(("grain.", "surface."))},
        "contact": study.contact.model_dump(),
        "engine": engine_hash(),
    }


def pour_beds(job: Job) -> None:
    """Pour and settle every bed that is not there yet, or no longer good."""
    from lithobrake.touchdown import BedRecipe, GrainSizes, pour_bed

    compile_kernels(job)
    study, values = job.study, medians(job.study)
    sizes = study.bed.diameter.model_dump()
    if sizes["distribution"] == "constant":
        sizes = {"distribution": "constant", "lower": sizes["value"], "upper": sizes["value"]}
    settle_gravity = study.bed.settle_gravity or values["surface.gravity"]
    for index, name in enumerate(bed_files(study)):
        if name not in job.wanted:
            continue
        recipe = BedRecipe(
            grain_count=study.bed.grain_count,
            sizes=GrainSizes(**sizes),
            cloud_point_count=study.bed.cloud_point_count,
            width=study.bed.width,
            material=grain(values),
            gravity=acceleration(values, settle_gravity),
            pour_gravity=study.bed.pour_gravity,
            seed=int(json_hash([study.seed, "bed", index])[:12], 16),
            contact=contact(study),
        )

        def show(done: float, what: str, index: int = index) -> None:
            job.progress(index + done, study.bed.bed_count, what)

        pour_bed(recipe, progress=show).save(job.folder / name)


def landing_files(study: Study) -> list[str]:
    """Name of the file of the landing at the medians."""
    return [] if study.solver.command else ["landing.h5"]


def touchdown_reads(study: Study) -> dict[str, Any]:
    """What a touchdown depends on beside its values: the options, the lander's mesh, the beds, the engine."""
    if study.solver.command:
        return solver_reads(study)
    return {
        "bed": bed_reads(study),
        "lander": study.lander.model_dump(include={"shape", "edges", "inertia"}),
        "mesh": None if study.lander.file is None else content_hash(Path(study.lander.file)),
        "time_limit": study.landing.time_limit,
        "version": f"{__version__}+{engine_hash()}",
    }


def landing_reads(study: Study) -> dict[str, Any]:
    """What the landing at the medians depends on."""
    return {"touchdown": touchdown_reads(study), "values": draw(study, medians(study), study.seed)}


def land_once(job: Job) -> None:
    """Land at the medians of all inputs and keep the pictures."""
    from lithobrake.touchdown import land

    compile_kernels(job)
    values = draw(job.study, medians(job.study), job.study.seed)
    bed, body = stored_bed(job.folder / bed_files(job.study)[round(values["bed"])]), lander(job.study, values)
    arrival = landing(job.study, values)
    outcome = land(bed, body, arrival, frame_count=SNAPSHOT_FRAMES)
    outcome.save_frames(job.folder / "landing.h5", bed, body, arrival)
