"""Journeys of a study by the emulator of its touchdowns: more of its landers, and the landers of its journeys again."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from lithobrake.pipeline.emulated.arrivals import Arrivals
from lithobrake.pipeline.emulated.landers import EmulatedLanders
from lithobrake.pipeline.emulated.touchdown_emulator import FILE as EMULATOR
from lithobrake.pipeline.emulated.touchdown_emulator import TouchdownEmulator, fit_touchdowns
from lithobrake.pipeline.emulated.touchdown_explorer import FILE as EXPLORER
from lithobrake.pipeline.emulated.touchdown_explorer import write_explorer, write_reason
from lithobrake.pipeline.fly.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.vocabulary.quantities import EMULATED, EMULATED_FILE, JOURNEY_DESIGN

FILES = (EMULATOR, EXPLORER, EMULATED_FILE)
# Landers that the study has not followed, and those of its journeys.
FRESH, OWN = "fresh", "own"
# How often the emulator follows each lander of the journeys, each time by another refit.
COPIES = 20
# Landings where the emulator has no answer, over all touchdowns of the journeys, at most.
MOST_LANDINGS = 0.1
LANDINGS_ALONE = "Landers that are delivered as states are followed by landings alone, and by no emulator."


def emulated_dependencies(study: Study) -> Any:
    """What emulated journeys depend on beside the journeys."""
    return [None if study.journey is None else study.journey.emulated_count, tuple(EMULATED)]


def make_emulated(job: Job) -> None:
    """Fit the emulator to all touchdowns, follow landers by it, and write touchdown_emulator.json and emulated.csv."""
    why = fit_touchdowns(job)
    rows = _followed(job) if why is None else []
    if why is not None:
        write_reason(job, why)
        job.say(why)
    write_table(job.folder, EMULATED_FILE, tuple(EMULATED), rows, EMULATED)


def _followed(job: Job) -> list[list[Any]]:
    """Write the explorer of the emulator, and follow landers by it where the study asks for any."""
    emulator = TouchdownEmulator.read(job.design, job.folder)
    write_explorer(job, emulator)
    assert job.study.journey is not None
    if job.design.is_flown:
        job.say(LANDINGS_ALONE)
        return []
    return [*_fresh(job, emulator), *_own(job, emulator)] if job.study.journey.emulated_count else []


def most_landings(job: Job) -> int:
    """How many landings may be made where the emulator has no answer."""
    return int(MOST_LANDINGS * DesignRuns.load(job.folder, JOURNEY_DESIGN).run_count)


def _fresh(job: Job, emulator: TouchdownEmulator) -> Sequence[list[Any]]:
    """Rows of landers that come after those of the journeys."""
    assert job.study.journey is not None
    followed = len(job.design.rows)
    begin = Arrivals.drawn(job.design, job.site, followed, job.study.journey.emulated_count)
    return _rows(job, emulator, FRESH, begin, most_landings(job))


def _own(job: Job, emulator: TouchdownEmulator) -> Sequence[list[Any]]:
    """Rows of the landers of the journeys, each by refits that have not seen its bed, without any landing."""
    begin = Arrivals.drawn(job.design, job.site, 0, len(job.design.rows))
    unseen = {bed: emulator.unseen(bed) for bed in {int(row["bed"]) for row in begin.rows}}
    pairs = [
        (lander, refit)
        for lander, row in enumerate(begin.rows)
        for refit in np.resize(unseen[int(row["bed"])], COPIES).tolist()
    ]
    which, refit = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return _rows(job, emulator, OWN, begin.taken(which, refit), 0)


def _rows(job: Job, emulator: TouchdownEmulator, name: str, begin: Arrivals, most: int) -> list[list[Any]]:
    """Follow landers, and give their rows of emulated.csv."""
    landers = EmulatedLanders.of(job, emulator, f"{name} landers by the emulator", begin)
    landers.follow(most)
    columns = (
        begin.number,
        begin.refit,
        landers.end,
        (landers.beyond != "").astype(int),
        landers.landings,
        landers.time,
    )
    return [[name, *row] for row in zip(*(one.tolist() for one in columns), strict=True)]
