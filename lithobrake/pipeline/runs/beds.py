"""The beds of a study: what they follow from, and how they are poured, with the kernels compiled first."""

import logging
from collections.abc import Callable, Mapping
from concurrent.futures import FIRST_COMPLETED, wait
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from lithobrake.campaign import LocalExecutor, available_cores
from lithobrake.pipeline.design.dependencies import bed_files, pour_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job
from lithobrake.study import Study
from lithobrake.study.ground_beds import on_ground
from lithobrake.touchdown import touchdown_model
from lithobrake.touchdown.soil import boulders, grain, grain_sizes
from lithobrake.touchdown.study_keys import by_study_keys
from lithobrake.vocabulary.callbacks import Progress, silent

if TYPE_CHECKING:
    from lithobrake.touchdown import BedRecipe

WHAT = "compiling kernels"
# Which beds are being poured is looked at so often [s].
_POLL_INTERVAL = 0.5


def compile_kernels(tell: Callable[..., None], busy: int = 0, joined: bool = False) -> None:
    """Compile what beds and landings call, unless it lies on disk; workers that start afterwards find it there.

    tell: called as the progress of a job, with how many kernels are done, of how many. busy: cores that compile
    something else. joined: for landers with parts on hinges.
    """
    from lithobrake.compilation.compiled import Kernel, disk_cache, lies_on_disk, watched
    from lithobrake.dem.example_world import step_locally, step_together
    from lithobrake.dem.stepping.time_loop import advance

    tell(0, 1, WHAT)
    # Where Numba is told to compile nothing, they are plain functions.
    if isinstance(advance, Kernel) and disk_cache("dem").keeps and not lies_on_disk(advance):
        _compile_apart(tell, 2 if available_cores() >= 2 + busy else 1, joined)
    # Loads what lies on disk, and compiles the rest.
    with watched("dem", lambda done, total: tell(done, total, WHAT, f"{done} of {total} kernels")):
        step_locally(joined)
        step_together()
    tell(1, 1, WHAT)


def _compile_apart(tell: Callable[..., None], process_count: int, joined: bool) -> None:
    """Compile in processes that end then, as a compiler leaves 300 MB behind; two are sooner done, at more CPU time.

    What both of them call is prepared twice. Where one fails, nothing has been compiled.
    """
    from lithobrake.compilation.compiled import announce
    from lithobrake.dem.example_world import step_locally, step_together

    announce("dem")
    executor = LocalExecutor(process_count)
    try:
        with TemporaryDirectory() as folder:
            count = Path(folder) / "count"
            pending = {
                executor.submit(_quietly, _counted, count, partial(step_locally, joined)),
                executor.submit(_quietly, step_together),
            }
            while pending:
                _, pending = wait(pending, _POLL_INTERVAL)
                # Empty while it is being written.
                if count.exists() and (words := count.read_text().split()):
                    tell(*map(int, words), WHAT, f"{words[0]} of {words[1]} kernels")
    finally:
        executor.shutdown(cancel_futures=True)


def _counted(count: Path, function: Callable[[], None]) -> None:
    """Call a function; write how many kernels it has compiled, and how many there are."""
    from lithobrake.compilation.compiled import watched

    def write(done: int, total: int) -> None:
        count.write_text(f"{done} {total}")

    with watched("dem", write):
        function()


def compile_flights(job: Job) -> int:
    """Have a process compile what flights and journeys call where there are several workers, unless it lies on disk.

    Returns how many processes are at it. Nobody waits for it; where it fails the flights will compile, and say why.
    """
    from lithobrake.compilation.compiled import disk_cache, lies_on_disk
    from lithobrake.smallbody.integration import integrate_flights

    if not isinstance(job.executor, LocalExecutor) or job.executor.worker_count == 1:
        return 0
    # Without a cache on the disk no other process would find what was compiled.
    if lies_on_disk(integrate_flights) or not disk_cache("smallbody").keeps:
        return 0
    executor = LocalExecutor(1)
    executor.submit(_quietly, fly_briefly, job.study)
    # It ends when it has compiled, with what a compiler leaves behind.
    executor.shutdown(wait=False)
    return 1


def fly_briefly(study: Study) -> None:
    """Fly one lander from the site of a study for a second, find its facet there and its weight.

    Makes the gravity table.
    """
    from lithobrake.smallbody import fly

    site = DrawnDesign(study).site
    origin, axes = site.frames(site.columns(1))
    site.body.effective_acceleration(origin)
    site.body.shape.nearest(origin)
    fly(site.body, origin, axes[:, 2], 1.0, gravity=study.flight.gravity)


def _quietly(function: Callable[..., None], *arguments: object) -> None:
    """Call a function and say nothing of what is compiled: the process that waits for it says so."""
    logging.disable(logging.WARNING)
    try:
        function(*arguments)
    finally:
        logging.disable(logging.NOTSET)


def pour_at_once(job: Job, beds: "Mapping[int, tuple[BedRecipe, Path]]") -> None:
    """Pour beds, each by its number with its recipe and the path of its file, on the workers of a study.

    Raises ValueError that names the beds which cannot be poured, when all others are there.
    """
    # Workers that start afterwards find the kernels on the disk, where else each would compile them.
    compile_kernels(job.progress, compile_flights(job), job.study.lander.is_hinged)
    failures = _pour_here(job, beds) if len(beds) == 1 else _pour_on_workers(job, beds)
    if failures:
        raise ValueError(_refusal(failures, job.study.bed_count))


def pour_one(
    recipe: "BedRecipe", path: Path, engine: str, tell: Progress = silent
) -> None:  # fmt: skip
    """Write the bed of a recipe to a file, in this process; engine: hash of the code of the coordinator.

    Raises ValueError or FloatingPointError for a bed that does not come to rest, ValueError where the code is another.
    """
    from lithobrake.touchdown import pour_bed, stored_or_poured

    touchdown_model.refuse_other_code(engine)
    with by_study_keys():
        # Another study may have poured it meanwhile, and a worker on another machine may have a library of its own.
        stored_or_poured(recipe, path, lambda: pour_bed(recipe, progress=tell))


def _pour_here(job: Job, beds: "Mapping[int, tuple[BedRecipe, Path]]") -> dict[str, list[int]]:
    """Pour a single bed and show how far it is, which a worker cannot; give the reason if it fails."""
    ((number, bed),) = beds.items()
    count = job.study.bed_count
    numbered = f"bed {number + 1} of {count}: " if count > 1 else ""
    try:
        pour_one(*bed, touchdown_model.engine_hash(), lambda done, what: job.progress(done, 1.0, f"{numbered}{what}"))
    except (ValueError, FloatingPointError) as error:
        return {_reason(error): [number]}
    return {}


def _pour_on_workers(job: Job, beds: "Mapping[int, tuple[BedRecipe, Path]]") -> dict[str, list[int]]:
    """Pour beds on the workers; give the numbers of those that failed, by their reasons."""
    engine = touchdown_model.engine_hash()
    numbers = {job.executor.submit(pour_one, *bed, engine): number for number, bed in beds.items()}
    failures: dict[str, list[int]] = {}
    pending, total = set(numbers), len(numbers)
    while pending:
        running = sorted(numbers[future] + 1 for future in pending if future.running())
        done = total - len(pending)
        detail = f"{done} of {total} beds, at work: {', '.join(map(str, running)) or 'none'}"
        job.progress(done, total, "pouring beds", detail)
        ended, pending = wait(pending, _POLL_INTERVAL, FIRST_COMPLETED)
        for future in ended:
            # The other beds go on: when the study is run again only those that failed are poured.
            if error := future.exception():
                failures.setdefault(_reason(error), []).append(numbers[future])
    job.progress(total, total, "pouring beds")
    return failures


def _reason(error: BaseException) -> str:
    """What a bed could not be poured for; what its user did not cause asks for nothing but another try."""
    if isinstance(error, ValueError | FloatingPointError):
        return str(error)
    return f"{type(error).__name__}: {error}; give the same command again"


def _refusal(failures: Mapping[str, list[int]], bed_count: int) -> str:
    """All beds that failed, by their reasons, counted from 1."""
    parts = []
    for reason, found in failures.items():
        beds = f"bed{'s' * (len(found) > 1)} {', '.join(str(number + 1) for number in sorted(found))}"
        parts.append(f"{beds} of {bed_count} cannot be poured ({reason})")
    return "; ".join(parts)


def pour_beds(job: Job) -> None:
    """Put every bed into the folder that is not there yet, or no longer good: from the library, or poured.

    Raises ValueError that names the beds which cannot be poured, when all others are there.
    """
    from lithobrake.touchdown import take_stored

    (job.folder / "beds").mkdir(exist_ok=True)
    names = {index: name for index, name in enumerate(bed_files(job.study)) if name in job.wanted}
    with by_study_keys():
        recipes = {index: bed_recipe(job.study, index) for index in names}
        new = {index: recipe for index, recipe in recipes.items() if not take_stored(recipe, job.folder / names[index])}
    found = len(names) - len(new)
    if found:
        job.say(f"bed: {found} of {len(names)} {'was' if found == 1 else 'were'} in the library of beds")
    if new:
        # Absolute, as a worker may have another current folder.
        pour_at_once(job, {index: (recipe, job.folder.path.absolute() / names[index]) for index, recipe in new.items()})


def bed_recipe(study: Study, index: int) -> "BedRecipe":
    """What the bed of a number follows from, uncertain quantities at their median."""
    from lithobrake.touchdown import BedRecipe

    study = on_ground(study, index)
    values, friction = study.touchdown_medians(), study.bed.pour_friction
    # Grains of a pour meet far harder than they ever do on the body, where they rest without yielding: it knows one
    # restitution.
    material = replace(grain(values), yield_strength=0.0, restitution_speed=0.0)
    return BedRecipe(
        grain_count=study.bed.grain_count,
        sizes=grain_sizes(study),
        cloud_point_count=study.bed.cloud_point_count,
        width=study.bed.width,
        material=material if friction is None else replace(material, friction=friction),
        gravity=touchdown_model.acceleration(values, study.bed.settle_gravity or values["surface.gravity"]),
        pour_gravity=study.bed.pour_gravity,
        seed=pour_seed(study, index),
        contact=touchdown_model.contact(study),
        sides=study.bed.sides,
        boulders=boulders(study),
    )
