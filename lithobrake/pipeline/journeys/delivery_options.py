"""Every delivery option: the landers of the study with other arrivals, followed to their ends."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import with_side_down
from lithobrake.pipeline.first_touchdown.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.emulated_journeys import follow_emulated, most_landings
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.hard_ground import hard_ground_dependencies, on_hard_ground
from lithobrake.pipeline.journeys.landers import StudyLanders, followed
from lithobrake.pipeline.journeys.touchdown_emulator import TouchdownEmulator, why_no_emulator
from lithobrake.smallbody.landers import ENDS
from lithobrake.study import Study
from lithobrake.study.delivered_states import states_of
from lithobrake.study.delivery_sections import arrival_key
from lithobrake.study.design_sections import SIDE
from lithobrake.study.lander_section import directions_of_sides
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.file_names import AIM_FILE, TOUCHDOWN_EMULATOR_FILE
from lithobrake.vocabulary.outcomes import FlightStatus
from lithobrake.vocabulary.quantities import AIM_COLUMNS, IMPACT_AZIMUTH, ORIENTATION, REST_NUMBERS, UNKNOWN_END, Row

SITE = "site."


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
    landers = option_landers(job.design)
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


@dataclass(frozen=True)
class OptionArrivals:
    """The landers of all options, one option after the other.

    begin: those that touch down; place: of each among all [lander_count]; end, refit: of all, "" of those that touch
    down.
    """

    begin: Arrivals
    place: np.ndarray
    end: np.ndarray
    refit: np.ndarray


def option_landers(design: DrawnDesign) -> OptionArrivals:
    """The landers of all options."""
    if design.is_flown:
        return flown_options(design)
    begin = option_arrivals(design)
    count = len(begin.rows)
    return OptionArrivals(begin, np.arange(count), np.full(count, "", dtype=object), begin.refit)


def flown_options(design: DrawnDesign) -> OptionArrivals:
    """Landers that are flown to the ground with the offsets of each option, the same of a release in all of them.

    Of a release, landers that the study has not followed; of a file of states its rows, again where these are fewer.
    """
    count, parts, ends = design.study.aim.lander_count * REFIT_COUNT, [], []
    for option in design.study.aim.aims():
        own = DrawnDesign(_with_offsets(design.study, option))
        first, drawn = len(design.beds), count
        if (delivery := own.study.delivery) is not None and delivery.states is not None:
            first, drawn = 0, min(len(states_of(own.study).time), count)
        descents, rows, beds = own.flown_landers(first, drawn)
        every, down = Arrivals.of_descents(descents, rows, beds, first), descents.touches_down
        which, refit = np.arange(count) % drawn, np.arange(count) % REFIT_COUNT
        parts.append(every.taken(which[down[which]], refit[down[which]]))
        words = [
            "" if lands else str(ENDS[FlightStatus(status)])
            for lands, status in zip(down.tolist(), descents.flights.status.tolist(), strict=True)
        ]
        ends.append(np.array(words, dtype=object)[which])
    end = np.concatenate(ends)
    refits = np.tile(np.arange(count) % REFIT_COUNT, len(ends))
    return OptionArrivals(Arrivals.joined(parts), np.flatnonzero(end == ""), end, refits)


def _with_offsets(study: Study, option: Mapping[str, float]) -> Study:
    """The study with other offsets of its delivery."""
    assert study.delivery is not None
    changed = {name.partition(".")[2]: value for name, value in option.items()}
    return study.model_copy(update={"delivery": study.delivery.model_copy(update=changed)})


def _rows(job: Job, ground: str, options: OptionArrivals, landers: StudyLanders | None) -> list[list[Any]]:
    """Rows of aim.csv; without landers nothing is known of any that touches down."""
    count, nothing = job.study.aim.lander_count * REFIT_COUNT, [""] * (len(REST_NUMBERS) - 1)
    ends = [end or UNKNOWN_END for end in options.end.tolist()]
    rows = [[ground, one // count, refit, ends[one], 0.0, *nothing] for one, refit in enumerate(options.refit.tolist())]
    if landers is not None:
        found = zip(
            options.place.tolist(), landers.end.tolist(), landers.rest_rows(landers.ways_from_aims), strict=True
        )
        for place, end, numbers in found:
            rows[place][3:] = [end, *numbers]
    return rows


def option_arrivals(design: DrawnDesign) -> Arrivals:
    """The landers of all options, one option after the other."""
    study, place = design.study, design.site
    options = study.aim.aims()
    one = Arrivals.drawn(design, len(design.rows), study.aim.lander_count * REFIT_COUNT)
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


def _attitudes(study: Study, side: str, landers: Arrivals) -> list[Row]:
    random = np.random.default_rng(hashed_seed(study.seed, "attitudes of options"))
    directions, count = np.array(directions_of_sides(study.lander)[side]), len(landers.rows)
    down = directions[random.integers(len(directions), size=count)]
    turned = with_side_down(down, landers.column(IMPACT_AZIMUTH), random.random(count))
    return [dict(zip(ORIENTATION, one, strict=True)) for one in turned.tolist()]
