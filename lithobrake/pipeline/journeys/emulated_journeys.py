"""Journeys by the emulator of touchdowns: more landers, those of the study again, and every delivery option."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import AttitudeTerms, directions
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import PREFIX, with_side_down
from lithobrake.pipeline.first_bounces.bounces_to_rest import ways_from_aims
from lithobrake.pipeline.first_bounces.emulator import REFIT_COUNT, save_explorer, tables_of_refits
from lithobrake.pipeline.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys import touchdown_emulator
from lithobrake.pipeline.journeys.emulated_landers import EmulatedLanders
from lithobrake.pipeline.runs.energy_bound import bound_numbers
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.table import ExplorerAttitude
from lithobrake.study import Study
from lithobrake.study.delivery_sections import arrival_key
from lithobrake.study.design_sections import SIDE
from lithobrake.study.lander_section import directions_of_sides, side_words
from lithobrake.vocabulary.file_names import AIM_FILE, TOUCHDOWN_EXPLORER_FILE
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import (
    AIM_COLUMNS,
    EMULATED,
    EMULATED_FILE,
    IMPACT_AZIMUTH,
    JOURNEY_DESIGN,
    ORIENTATION,
    SPIN,
    UNKNOWN_END,
)

EMULATED_FILES: tuple[str, ...] = (touchdown_emulator.TOUCHDOWN_EMULATOR_FILE, TOUCHDOWN_EXPLORER_FILE, EMULATED_FILE)
# Landers that the study has not followed, and those of its journeys.
FRESH, OWN = "fresh", "own"
# How often the emulator follows each lander of the journeys, each time by another refit.
COPIES = 20
# Landings where the emulator has no answer, over all touchdowns of the journeys, at most.
MOST_LANDINGS = 0.1
LANDINGS_ALONE = "Landers that are delivered as states are followed by landings alone, and by no emulator."
SITE = "site."


def write_explorer(job: Job, emulator: touchdown_emulator.TouchdownEmulator) -> None:
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
    save_explorer(job.folder / TOUCHDOWN_EXPLORER_FILE, replace(tables, attitude=_attitude(job.study, emulator.terms)))


def _attitude(study: Study, terms: AttitudeTerms | None) -> ExplorerAttitude | None:
    if terms is None:
        return None
    names = tuple(f"{PREFIX}{name}" for name in terms.ranges)
    sides = {side_words(study.lander, side): downs for side, downs in directions_of_sides(study.lander).items()}
    return ExplorerAttitude(names, terms.axes.tolist(), terms.has_sides, terms.is_cube, sides)


def write_reason(job: Job, why: str) -> None:
    import h5py

    with atomic_path(job.folder / TOUCHDOWN_EXPLORER_FILE) as draft, h5py.File(draft, "w") as file:
        file.attrs["why"] = why


def emulated_dependencies(study: Study) -> Any:
    return [None if study.journey is None else study.journey.emulated_count, tuple(EMULATED)]


def make_emulated(job: Job) -> None:
    why = touchdown_emulator.fit_touchdowns(job)
    rows = _followed(job) if why is None else []
    if why is not None:
        write_reason(job, why)
        job.say(why)
    write_table(job.folder, EMULATED_FILE, tuple(EMULATED), rows, EMULATED)


def _followed(job: Job) -> list[list[Any]]:
    emulator = touchdown_emulator.TouchdownEmulator.read(job.design, job.folder)
    write_explorer(job, emulator)
    assert job.study.journey is not None
    if job.design.is_flown:
        job.say(LANDINGS_ALONE)
        return []
    return [*_fresh(job, emulator), *_own(job, emulator)] if job.study.journey.emulated_count else []


def most_landings(job: Job) -> int:
    return int(MOST_LANDINGS * DesignRuns.load(job.folder, JOURNEY_DESIGN).run_count)


def _fresh(job: Job, emulator: touchdown_emulator.TouchdownEmulator) -> Sequence[list[Any]]:
    assert job.study.journey is not None
    # Numbers behind those of the journeys: other points of the sequence, so other landers.
    followed = len(job.design.rows)
    begin = touchdown_emulator.Arrivals.drawn(job.design, followed, job.study.journey.emulated_count)
    return _rows(job, emulator, FRESH, begin, most_landings(job))


def _own(job: Job, emulator: touchdown_emulator.TouchdownEmulator) -> Sequence[list[Any]]:
    """Rows of the landers of the journeys, each by refits that have not seen its bed, without any landing."""
    begin = touchdown_emulator.Arrivals.drawn(job.design, 0, len(job.design.rows))
    unseen = {bed: emulator.unseen(bed) for bed in {int(row["bed"]) for row in begin.rows}}
    pairs = [
        (lander, refit)
        for lander, row in enumerate(begin.rows)
        # Some (1 - 1/B)^B of the refits, about a third, have not seen one of B beds: where these are fewer, some are
        # taken twice.
        for refit in np.resize(unseen[int(row["bed"])], COPIES).tolist()
    ]
    which, refit = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return _rows(job, emulator, OWN, begin.taken(which, refit), 0)


def _rows(
    job: Job, emulator: touchdown_emulator.TouchdownEmulator, name: str, begin: touchdown_emulator.Arrivals, most: int
) -> list[list[Any]]:
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


def option_files(study: Study) -> list[str]:
    """What the stage writes: nothing where the study has no options to choose from."""
    return [AIM_FILE] if study.aim.names else []


def option_dependencies(study: Study) -> Any:
    return [study.aim.grid, study.aim.sides, study.aim.lander_count]


def follow_options(job: Job) -> None:
    """Follow the landers of every option and write aim.csv, one option after the other.

    All have the same landers: soil, bed, site and refit of each are drawn once, and only what is chosen differs.
    """
    begin = option_arrivals(job.design)
    count = job.study.aim.lander_count * REFIT_COUNT
    end, time = np.full(len(begin.rows), UNKNOWN_END, dtype=object), np.zeros(len(begin.rows))
    distance = time
    if touchdown_emulator.why_no_emulator(job.folder.read_json(touchdown_emulator.TOUCHDOWN_EMULATOR_FILE)) is None:
        landers = EmulatedLanders.of(
            job,
            touchdown_emulator.TouchdownEmulator.read(job.design, job.folder),
            "landers at the delivery options",
            begin,
        )
        # At most a tenth as many landings as the journeys had touchdowns, so that the cost stays theirs.
        landers.follow(most_landings(job))
        there = directions(*job.site.body.shape.latitude_longitude(landers.position))
        end, time, distance = landers.end, landers.time, ways_from_aims(job.site.body, begin.site, there)
    rests = end == JourneyEnd.AT_REST
    rows = [
        ["soil", number // count, refit, str(word), seconds, way if at_rest else ""]
        for number, (refit, word, seconds, way, at_rest) in enumerate(
            zip(begin.refit.tolist(), end, time.tolist(), distance.tolist(), rests, strict=True)
        )
    ]
    write_table(job.folder, AIM_FILE, AIM_COLUMNS, rows)


def option_arrivals(design: DrawnDesign) -> touchdown_emulator.Arrivals:
    """The landers of all options, one option after the other."""
    study, place = design.study, design.site
    options = study.aim.aims()
    one = touchdown_emulator.Arrivals.drawn(design, len(design.rows), study.aim.lander_count * REFIT_COUNT)
    count = len(one.rows)
    rows, site = [], {key: np.tile(values, len(options)) for key, values in one.site.items()}
    for number, option in enumerate(options):
        chosen = {arrival_key(name): value for name, value in option.items()}
        for name, value in chosen.items():
            if name.startswith(SITE):
                site[name.removeprefix(SITE)][number * count : (number + 1) * count] = value
        side = chosen.pop(SIDE, None)
        attitudes = [{}] * count if side is None else _attitudes(study, study.aim.sides[int(side)], one)
        of_impact = {name: value for name, value in chosen.items() if not name.startswith(SITE)}
        rows += [row | of_impact | attitude for row, attitude in zip(one.rows, attitudes, strict=True)]
    numbers, refit = (np.tile(values, len(options)) for values in (one.number, one.refit))
    return touchdown_emulator.Arrivals.of(place, numbers, rows, site, refit)


def _attitudes(study: Study, side: str, landers: touchdown_emulator.Arrivals) -> list[dict[str, float]]:
    random = np.random.default_rng(hashed_seed(study.seed, "attitudes of options"))
    directions, count = np.array(directions_of_sides(study.lander)[side]), len(landers.rows)
    down = directions[random.integers(len(directions), size=count)]
    turned = with_side_down(down, landers.column(IMPACT_AZIMUTH), random.random(count))
    return [dict(zip(ORIENTATION, one, strict=True)) for one in turned.tolist()]
