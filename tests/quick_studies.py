"""Studies that take less time at what the tests of their results do not look at: validation of emulators, pictures,
processes, and what only a power cut shows.
"""

import os
import pickle
import sqlite3
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from functools import cache, partial
from typing import Any

import pytest
from matplotlib.figure import Figure

from lithobrake.analysis import half_width
from lithobrake.campaign import LocalExecutor, executors
from lithobrake.campaign.single_run import Limits
from lithobrake.campaign.worker import pickled
from lithobrake.emulator import form_choice
from lithobrake.pipeline import study_run
from lithobrake.pipeline.commands import emulator_job, rare_landings
from lithobrake.pipeline.first_touchdown import flights
from lithobrake.report import reports
from lithobrake.report.figures.style import STYLE

# Parts of the path of a flight, each of which is flown from its start.
PATH_PARTS = 16


class Unsynced(sqlite3.Connection):
    """A file that is as whole as any after a process has died, and no longer after a power cut."""

    def execute(self, sql: str, *values: Any) -> sqlite3.Cursor:
        """Execute a statement, and wait for no disk."""
        return super().execute("PRAGMA synchronous = OFF" if sql.startswith("PRAGMA synchronous") else sql, *values)


class OwnProcess(LocalExecutor):
    """A pool whose only worker, where it has one, is this process: another would import for seconds what it makes runs
    with for milliseconds. Limits are not kept: tests/campaign tests them.
    """

    def submit_limited(
        self, limits: Limits, function: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> "Future[Any]":
        """Make a call here and now, of what a process of its own would be sent."""
        if self.worker_count > 1:
            return super().submit_limited(limits, function, *args, **kwargs)
        future = Future[Any]()
        future.set_running_or_notify_cancel()
        function, args, kwargs = pickle.loads(pickled("a call", (function, args, kwargs)))
        try:
            future.set_result(pickle.loads(pickle.dumps(function(*args, **kwargs))))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def one_process() -> Iterator[None]:
    """Quick studies that have one worker where none are asked for, as on a machine of one core."""
    with quick_studies(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(executors, "available_cores", lambda: 1)
        yield


@contextmanager
def blank_pictures(*kinds: str) -> Iterator[None]:
    """Figures of reports are drawn, and saved as empty pictures of their kind: letters are what takes long to save.

    kinds: those that are empty; all where none is named.
    """

    @cache
    def blank(kind: str) -> bytes:
        return saved(Figure(figsize=(1.0, 1.0)), kind)

    saved = reports._saved
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            reports, "_saved", lambda figure, kind: blank(kind) if kind in kinds or not kinds else saved(figure, kind)
        )
        yield


@contextmanager
def quick_studies() -> Iterator[None]:
    """Emulators are fitted anew without each quarter of the beds, and not without each bed; pictures are coarse; a
    study of one worker makes its runs in this process; nothing that this process writes waits for the disk. Half-widths
    that a plan expects are those of a tenth of the studies that are made up for them, and paths of flights have few
    places.

    What an emulator is worth is tested in tests/emulator, how pages look in tests/report, processes in tests/campaign,
    and expected half-widths in tests/analysis.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(form_choice, "MOST_FOLDS", 4)
        patch.setattr(half_width, "STUDIES", 40)
        patch.setattr(flights, "PARTS", PATH_PARTS)
        patch.setitem(STYLE, "savefig.dpi", 50)
        patch.setattr(os, "fsync", lambda file: None)
        patch.setattr(sqlite3, "connect", partial(sqlite3.connect, factory=Unsynced))
        for module in (study_run, rare_landings, emulator_job):
            patch.setattr(module, "LocalExecutor", OwnProcess)
        yield
