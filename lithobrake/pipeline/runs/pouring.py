"""Beds that are poured at once, one a worker: each takes a core for seconds to minutes, and none needs another."""

from collections.abc import Callable, Mapping
from concurrent.futures import FIRST_COMPLETED, wait
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.kernels import compile_flights, compile_kernels
from lithobrake.study.touchdown_model import engine_hash, in_words_of_the_study, refuse_other_code

if TYPE_CHECKING:
    from lithobrake.touchdown import BedRecipe

# Which beds are being poured is looked at so often [s].
_POLL_INTERVAL = 0.5


def pour_at_once(job: Job, beds: "Mapping[int, tuple[BedRecipe, Path]]") -> None:
    """Pour beds, each by its number with its recipe and the path of its file, on the workers of a study.

    Raises ValueError that names the beds which cannot be poured, when all others are there.
    """
    # Workers that start afterwards find the kernels on the disk, where else each would compile them.
    compile_kernels(job.progress, busy=compile_flights(job))
    failures = _pour_here(job, beds) if len(beds) == 1 else _pour_on_workers(job, beds)
    if failures:
        raise ValueError(_refusal(failures, job.study.bed_count))


def pour_one(
    recipe: "BedRecipe", path: Path, engine: str, tell: Callable[[float, str], None] | None = None
) -> None:  # fmt: skip
    """Write the bed of a recipe to a file, in this process; engine: hash of the code of the coordinator.

    Raises ValueError or FloatingPointError for a bed that does not come to rest, ValueError where the code is another.
    """
    from lithobrake.touchdown import pour_bed, stored_or_poured

    refuse_other_code(engine)
    with in_words_of_the_study():
        # Another study may have poured it meanwhile, and a worker on another machine may have a library of its own.
        stored_or_poured(recipe, path, lambda: pour_bed(recipe, progress=tell))


def _pour_here(job: Job, beds: "Mapping[int, tuple[BedRecipe, Path]]") -> dict[str, list[int]]:
    """Pour a single bed and show how far it is, which a worker cannot; give the reason if it fails."""
    ((number, bed),) = beds.items()
    count = job.study.bed_count
    numbered = f"bed {number + 1} of {count}: " if count > 1 else ""
    try:
        pour_one(*bed, engine_hash(), lambda done, what: job.progress(done, 1.0, f"{numbered}{what}"))
    except (ValueError, FloatingPointError) as error:
        return {_reason(error): [number]}
    return {}


def _pour_on_workers(job: Job, beds: "Mapping[int, tuple[BedRecipe, Path]]") -> dict[str, list[int]]:
    """Pour beds on the workers; give the numbers of those that failed, by their reasons."""
    engine = engine_hash()
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
