"""The stages that make the runs of the paper method."""

from collections.abc import Sequence

from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper.expansions import screened_inputs
from lithobrake.pipeline.paper.paper_designs import points, replicate_count
from lithobrake.pipeline.runs.making_runs import make_rows, say_gravity
from lithobrake.pipeline.runs.touchdown_runs import drawn_rows


def make_screening_runs(job: Job) -> None:
    """Make the runs in which all inputs vary, at the nodes of the screening design."""
    say_gravity(job)
    make_runs(job, "screening")


def make_refined_runs(job: Job) -> None:
    """Make the runs in which the inputs vary that the screening keeps."""
    make_runs(job, "refined", screened_inputs(job))


def make_test_runs(job: Job) -> None:
    """Make the runs that no expansion is fitted to: the kept inputs vary, then all of them."""
    kept = screened_inputs(job)
    for design in ("test_kept", "test_all"):
        make_runs(job, design, kept)


def make_runs(job: Job, design: str, kept: Sequence[str] = ()) -> None:
    """Make the runs of a design, all points once, then again if asked; those that the ledger has are read from it.

    Which runs they are is noted before they are made, so that whoever looks can tell them from all others.
    Raises ValueError when too many have failed, or those that failed lie together.
    """
    x = points(job.design, design, kept)
    replicates = range(replicate_count(job.study, design))
    make_rows(job, design, [drawn_rows(job.design, x, replicate) for replicate in replicates])
