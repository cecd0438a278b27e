"""Journeys by the emulator of all touchdowns: more landers, and those of the study again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import PREFIX
from lithobrake.pipeline.first_touchdown.explorer_tables import explorer_attitude, save_explorer, tables_of_refits
from lithobrake.pipeline.first_touchdown.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.delivered_landers import DeliveredLanders
from lithobrake.pipeline.journeys.emulated_touchdowns import EmulatedTouchdowns
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.ground_touchdowns import SlowArrivals, sliding
from lithobrake.pipeline.journeys.landers import StudyLanders, followed
from lithobrake.pipeline.journeys.simulated_touchdowns import WithLandings
from lithobrake.pipeline.journeys.touchdown_emulator import TouchdownEmulator, fit_touchdowns
from lithobrake.pipeline.runs.energy_bound import bound_numbers
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.smallbody.touchdown import Touchdown
from lithobrake.study import Study
from lithobrake.vocabulary.file_names import TOUCHDOWN_EMULATOR_FILE, TOUCHDOWN_EXPLORER_FILE
from lithobrake.vocabulary.quantities import EMULATED, EMULATED_FILE, JOURNEY_DESIGN, SPIN

EMULATED_FILES: tuple[str, ...] = (TOUCHDOWN_EMULATOR_FILE, TOUCHDOWN_EXPLORER_FILE, EMULATED_FILE)
# Landers that the study has not followed, and those of its journeys.
FRESH, OWN = "fresh", "own"
# How often the emulator follows each lander of the journeys, each time by another refit.
COPIES = 20
# Landings where the emulator has no answer, over all touchdowns of the journeys, at most.
MOST_LANDINGS = 0.1
LANDINGS_ALONE = "Landers that are delivered by a file of states are followed by landings alone, and by no emulator."


def write_explorer(job: Job, emulator: TouchdownEmulator) -> None:
    runs = DesignRuns.load(job.folder, JOURNEY_DESIGN)
    # Only the size of the spin counts for the energy: an arrival without one of its own has that of the median.
    spin = np.linalg.norm([runs.inputs[name] for name in SPIN], axis=0)
    bound = {
        **bound_numbers(job.design, emulator.bed_height),
        **dict(zip(SPIN, (float(np.median(spin)), 0.0, 0.0), strict=True)),
        "across": emulator.across,
        "time_limit": 0.0,
    }
    tables = tables_of_refits(emulator.refits, bound)
    attitude = explorer_attitude(job.study, [name for name in emulator.inputs if name.startswith(PREFIX)])
    save_explorer(job.folder / TOUCHDOWN_EXPLORER_FILE, replace(tables, attitude=attitude))


def write_reason(job: Job, why: str) -> None:
    import h5py

    with atomic_path(job.folder / TOUCHDOWN_EXPLORER_FILE) as draft, h5py.File(draft, "w") as file:
        file.attrs["why"] = why


def emulated_dependencies(study: Study) -> Any:
    # The friction of the soil and whether landers roll decide how far those slide that the emulator has captured.
    return [study.journey.emulated_count, study.hard_ground.rolling_friction, tuple(EMULATED)]


def make_emulated(job: Job) -> None:
    why = fit_touchdowns(job)
    rows = _followed(job) if why is None else []
    if why is not None:
        write_reason(job, why)
        job.say(why)
    write_table(job.folder, EMULATED_FILE, tuple(EMULATED), rows, EMULATED)


def _followed(job: Job) -> list[list[Any]]:
    emulator = TouchdownEmulator.read(job.design, job.folder)
    write_explorer(job, emulator)
    delivery = job.study.delivery
    if delivery is not None and delivery.states is not None:
        job.say(LANDINGS_ALONE)
        return []
    if not job.study.journey.emulated_count:
        return []
    # Journeys that stop after some touchdowns have no end to compare with, and what a release owes to its flights is
    # the same for both.
    own = _own(job, emulator) if job.study.journey.touchdowns is None and not job.design.is_flown else []
    return [*_fresh(job, emulator), *own]


def most_landings(job: Job) -> int:
    """Landings in place of answers, at most: none where the study itself stops after some touchdowns."""
    if job.study.journey.touchdowns is not None:
        return 0
    return int(MOST_LANDINGS * DesignRuns.load(job.folder, JOURNEY_DESIGN).run_count)


def _fresh(job: Job, emulator: TouchdownEmulator) -> Sequence[list[Any]]:
    # Numbers behind those of the journeys: other points of the sequence, so other landers.
    count, followed = job.study.journey.emulated_count or 0, len(job.design.rows)
    if job.design.is_flown:
        return _rows(job, emulator, FRESH, DeliveredLanders.flown(job.design, count), most_landings(job))
    begin = DeliveredLanders.at_surface(Arrivals.drawn(job.design, followed, count))
    return _rows(job, emulator, FRESH, begin, most_landings(job))


def _own(job: Job, emulator: TouchdownEmulator) -> Sequence[list[Any]]:
    """Rows of the landers of the journeys, each by refits that have not seen its bed, without any landing."""
    begin = Arrivals.drawn(job.design, 0, len(job.design.rows))
    unseen = {bed: emulator.unseen(bed) for bed in {int(row["bed"]) for row in begin.rows}}
    pairs = [
        (lander, refit)
        for lander, row in enumerate(begin.rows)
        # Some (1 - 1/B)^B of the refits, about a third, have not seen one of B beds: where these are fewer, some are
        # taken twice.
        for refit in np.resize(unseen[int(row["bed"])], COPIES).tolist()
    ]
    which, refit = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return _rows(job, emulator, OWN, DeliveredLanders.at_surface(begin.taken(which, refit)), 0)


def _rows(job: Job, emulator: TouchdownEmulator, name: str, delivered: DeliveredLanders, most: int) -> list[list[Any]]:
    found = follow_emulated(job, emulator, delivered.begin, f"{name} landers by the emulator", most)
    columns = (
        *(delivered.number, delivered.refit, delivered.ends(found.landers)),
        *(delivered.of_all(one) for one in ((found.beyond != "").astype(int), found.landings)),
    )
    # As of the journeys, also where each lander has an aim of its own.
    rest = delivered.rest_rows(found.landers.rest_rows(job.design.site.ways_from_aim(found.landers.position)))
    rows = zip(*(one.tolist() for one in columns), strict=True)
    return [[name, *row, *numbers] for row, numbers in zip(rows, rest, strict=True)]


@dataclass(frozen=True)
class EmulatedLanders:
    """Landers that the emulator has followed to their ends.

    beyond: the input of an impact that the emulator did not know, the last one of each lander, or ""; landings: that
    were simulated for each; [lander_count].
    """

    landers: StudyLanders
    beyond: np.ndarray
    landings: np.ndarray


def follow_emulated(
    job: Job, emulator: TouchdownEmulator, begin: Arrivals, title: str, most_landings: int
) -> EmulatedLanders:
    """Follow landers by the emulator, with at most so many landings where it has no answer.

    title: of the landers, which names their random numbers.
    """
    emulated = EmulatedTouchdowns(emulator, begin, title)
    touchdown = WithLandings(job, begin, _to_rest(job.design, begin, emulated), most_landings)
    landers = followed(job, begin, touchdown, title)
    return EmulatedLanders(landers, emulated.beyond, touchdown.landings)


def _to_rest(design: DrawnDesign, begin: Arrivals, emulated: EmulatedTouchdowns) -> Touchdown:
    """The emulator, and what it does not know to rest where it was fitted to the first touchdowns alone."""
    journey = design.study.journey
    if journey.touchdowns is None:
        return emulated
    slow = SlowArrivals.of(design, begin, emulated)
    # Touchdowns that end as soon as the energy is too low to leave say nothing of what comes then.
    return sliding(design, begin, slow) if journey.hop_height == 0.0 else slow
