"""Landers at every delivery option of a study of journeys, followed by the emulator of its touchdowns."""

from typing import Any

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.geometry.great_circle import directions
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import with_side_down
from lithobrake.pipeline.design.local_ground import AZIMUTH
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulated.arrivals import Arrivals
from lithobrake.pipeline.emulated.emulated_journeys import most_landings
from lithobrake.pipeline.emulated.landers import EmulatedLanders
from lithobrake.pipeline.emulated.touchdown_emulator import FILE as EMULATOR
from lithobrake.pipeline.emulated.touchdown_emulator import TouchdownEmulator, why_no_emulator
from lithobrake.pipeline.fly.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.rest.aiming import ways_from_aims
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.study.journey_sections import arrival_key
from lithobrake.study.lander_sides import directions_of_sides
from lithobrake.study.question_sections import SIDE
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import AIM_COLUMNS, AIM_FILE, ORIENTATION, UNKNOWN_END

SITE = "site."


def option_files(study: Study) -> list[str]:
    """What the stage writes: nothing where the study has no options to choose from."""
    return [AIM_FILE] if study.aim.names else []


def option_dependencies(study: Study) -> Any:
    """What the landers at the options depend on beside the emulator."""
    return [study.aim.grid, study.aim.sides, study.aim.lander_count]


def follow_options(job: Job) -> None:
    """Follow the landers of every option and write aim.csv, one option after the other.

    All have the same landers: soil, bed, site and refit of each are drawn once, and only what is chosen differs.
    """
    begin = option_arrivals(job.design, job.site)
    count = job.study.aim.lander_count * REFIT_COUNT
    end, time = np.full(len(begin.rows), UNKNOWN_END, dtype=object), np.zeros(len(begin.rows))
    distance = time
    if why_no_emulator(job.folder.read_json(EMULATOR)) is None:
        landers = EmulatedLanders.of(
            job, TouchdownEmulator.read(job.design, job.folder), "landers at the delivery options", begin
        )
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


def option_arrivals(design: DrawnDesign, place: Site) -> Arrivals:
    """The landers of all options, one option after the other."""
    study = design.study
    options = study.aim.aims()
    one = Arrivals.drawn(design, place, len(design.rows), study.aim.lander_count * REFIT_COUNT)
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
    return Arrivals.of(place, numbers, rows, site, refit)


def _attitudes(study: Study, side: str, landers: Arrivals) -> list[dict[str, float]]:
    """Attitudes of landers with a side toward the ground, as inputs of their first touchdowns."""
    random = np.random.default_rng(hashed_seed(study.seed, "attitudes of options"))
    directions, count = np.array(directions_of_sides(study.lander)[side]), len(landers.rows)
    down = directions[random.integers(len(directions), size=count)]
    turned = with_side_down(down, landers.column(AZIMUTH), random.random(count))
    return [dict(zip(ORIENTATION, one, strict=True)) for one in turned.tolist()]
