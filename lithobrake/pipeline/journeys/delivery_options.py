"""Every delivery option: the landers of the study with other arrivals, followed to their ends."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import with_side_down
from lithobrake.pipeline.first_touchdown.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.delivered_landers import DeliveredLanders
from lithobrake.pipeline.journeys.emulated_journeys import follow_emulated, most_landings
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.hard_ground import hard_ground_dependencies, on_hard_ground
from lithobrake.pipeline.journeys.landers import StudyLanders, followed
from lithobrake.pipeline.journeys.touchdown_emulator import TouchdownEmulator, why_no_emulator
from lithobrake.study import Study
from lithobrake.study.delivery_sections import ERROR_KEYS, arrival_key
from lithobrake.study.design_sections import SIDE
from lithobrake.study.lander_section import directions_of_sides
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.file_names import AIM_FILE, TOUCHDOWN_EMULATOR_FILE
from lithobrake.vocabulary.quantities import AIM_COLUMNS, ERRORS, IMPACT_AZIMUTH, ORIENTATION, REST_NUMBERS, Row

SITE = "site."
Options = Sequence[Mapping[str, float]]


def option_files(study: Study) -> list[str]:
    """What the stage writes: nothing where the study has no options to choose from."""
    return [AIM_FILE] if study.aim.names else []


def option_dependencies(study: Study) -> Any:
    own = [study.aim.grid, study.aim.sides, study.aim.lander_count, AIM_COLUMNS]
    return [*own, hard_ground_dependencies(study)]


def follow_options(job: Job) -> None:
    """Follow the landers of every option and write aim.csv, one option after the other.

    All have the same landers: soil, bed, site and refit of each are drawn once, and only what is chosen differs. With
    [hard_ground] they are followed on hard ground too.
    """
    landers = option_landers(job.design, job.study.aim.aims(), job.study.aim.lander_count * REFIT_COUNT)
    begin, rows, emulator_file = landers.begin, [], job.folder.read_json(TOUCHDOWN_EMULATOR_FILE)
    if why_no_emulator(emulator_file) is None:
        emulator = TouchdownEmulator.read(job.design, job.folder)
        # At most a tenth as many landings as the journeys had touchdowns, so that the cost stays theirs.
        found = follow_emulated(job, emulator, begin, "landers at the delivery options", most_landings(job))
        rows += _rows(job, "soil", landers, found.landers)
    else:
        rows += _rows(job, "soil", landers, None)
    if job.study.hard_ground.count:
        hard = on_hard_ground(job.design, begin, "options")
        rows += _rows(job, "hard", landers, followed(job, begin, hard, "landers at the delivery options, hard ground"))
    write_table(job.folder, AIM_FILE, AIM_COLUMNS, rows)


def option_landers(design: DrawnDesign, options: Options, count: int) -> DeliveredLanders:
    """So many landers of each option, one option after the other; all options have the same landers.

    options: values by dotted key of [delivery], and the factor of all its errors; what an option does not name is
    sampled.
    """
    if not design.is_flown:
        return DeliveredLanders.at_surface(option_arrivals(design, options, count))
    studies = [_delivered_so(design.study, option) for option in options]
    return DeliveredLanders.joined([DeliveredLanders.flown(DrawnDesign(study), count) for study in studies])


def _delivered_so(study: Study, option: Mapping[str, float]) -> Study:
    """The study with other offsets of its release or states, and errors of the release so many times as large."""
    delivery = study.delivery
    assert delivery is not None
    changed: dict[str, Any] = {name.partition(".")[2]: value for name, value in option.items() if name != ERRORS}
    if ERRORS in option:
        assert delivery.release is not None
        changed["release"] = delivery.release.with_errors(option[ERRORS])
    return study.model_copy(update={"delivery": delivery.model_copy(update=changed)})


def _rows(job: Job, ground: str, options: DeliveredLanders, landers: StudyLanders | None) -> list[list[Any]]:
    """Rows of aim.csv; without landers nothing is known of any that touches down."""
    count, unknown = job.study.aim.lander_count * REFIT_COUNT, [[0.0, *[""] * (len(REST_NUMBERS) - 1)]]
    rest = unknown * len(options.place) if landers is None else landers.rest_rows(landers.ways_from_aims)
    columns = zip(options.refit.tolist(), options.ends(landers).tolist(), options.rest_rows(rest), strict=True)
    return [[ground, one // count, refit, end, *row] for one, (refit, end, row) in enumerate(columns)]


def option_arrivals(design: DrawnDesign, options: Options, lander_count: int) -> Arrivals:
    """So many landers of each option that arrive at the surface, one option after the other."""
    study, place = design.study, design.site
    one = Arrivals.drawn(design, len(design.rows), lander_count)
    count = len(one.rows)
    rows, site = [], {key: np.tile(values, len(options)) for key, values in one.site.items()}
    for number, option in enumerate(options):
        chosen = {arrival_key(name): value for name, value in option.items() if name != ERRORS}
        own = slice(number * count, (number + 1) * count)
        factor = option.get(ERRORS, 1.0)
        # Options without the key keep their errors to the last bit.
        for key in ERROR_KEYS if factor != 1.0 else ():
            # All errors are one input: they go together as before, and a bias stays.
            site[key][own] = place.medians[key] + factor * (one.site[key] - place.medians[key])
        for name, value in chosen.items():
            if name.startswith(SITE):
                site[name.removeprefix(SITE)][own] = value
        side = chosen.pop(SIDE, None)
        attitudes = [{}] * count if side is None else _attitudes(study, study.aim.sides[int(side)], one)
        of_impact = {name: value for name, value in chosen.items() if not name.startswith(SITE)}
        rows += [row | of_impact | attitude for row, attitude in zip(one.rows, attitudes, strict=True)]
    numbers, refit = (np.tile(values, len(options)) for values in (one.number, one.refit))
    return Arrivals.of(place, numbers, rows, site, refit)


def _attitudes(study: Study, side: str, landers: Arrivals) -> list[Row]:
    random = np.random.default_rng(hashed_seed(study.seed, "attitudes of options"))
    directions, count = np.array(directions_of_sides(study.lander)[side]), len(landers.rows)
    down = directions[random.integers(len(directions), size=count)]
    turned = with_side_down(down, landers.column(IMPACT_AZIMUTH), random.random(count))
    return [dict(zip(ORIENTATION, one, strict=True)) for one in turned.tolist()]
