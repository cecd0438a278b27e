"""Landers followed on other ground: hard, equivalent to the soil, and the soil by the expansion."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.pipeline.design.dependencies import design_dependencies
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown import bounce_laws
from lithobrake.pipeline.first_touchdown.flights import write_table
from lithobrake.pipeline.first_touchdown.run_flights import run_flight_dependencies
from lithobrake.pipeline.first_touchdown.samples import Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.ground_touchdowns import SlowArrivals, sliding
from lithobrake.pipeline.journeys.landers import StudyLanders, followed
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.smallbody.ground_touchdowns import Bounces
from lithobrake.smallbody.touchdown import Touchdown
from lithobrake.study import Study
from lithobrake.vocabulary.file_names import REST_FILE
from lithobrake.vocabulary.quantities import FOLLOWED

if TYPE_CHECKING:
    from lithobrake.smallbody import HardSurface

HARD, EQUIVALENT, EXPANSION = "hard", "equivalent", "expansion"


def hard_ground_files(study: Study) -> list[str]:
    """What the stage writes: nothing where no lander is followed on other ground."""
    if not study.hard_ground.count:
        return []
    return [REST_FILE, *([bounce_laws.RESTITUTION_FILE] if has_equivalent(study) else [])]


def has_equivalent(study: Study) -> bool:
    """Whether samples of the emulator say which hard ground is equivalent to the soil."""
    return study.expansion is None and bool(study.sample_count) and bounce_laws.why_no_soil(study) is None


def has_expansion(study: Study) -> bool:
    """Whether the expansion can be asked about the impacts after the first, on the one soil that it knows."""
    return study.expansion is not None and not study.soil and bounce_laws.why_no_soil(study) is None


def hard_ground_dependencies(study: Study) -> Any:
    """What these journeys depend on; a table with other columns or law is made anew."""
    # The measured line is no key of the study: a better measurement has to outdate the journeys, too.
    law = bounce_laws.INTERCEPT, bounce_laws.SLOPE
    own = study.hard_ground.model_dump(exclude_none=True)
    return own | {
        "columns": tuple(FOLLOWED),
        "sliding_law": law,
        "duration": study.journey.duration,
        "landers": [design_dependencies(study), study.seed, study.design.run_count],
        "flights": run_flight_dependencies(study),
    }


def hard_surface(study: Study) -> "HardSurface":
    from lithobrake.smallbody import HardSurface

    return HardSurface(**study.hard_ground.model_dump(exclude={"count", "rolling_friction"}))


def on_hard_ground(design: DrawnDesign, begin: Arrivals, title: str = "") -> Touchdown:
    """Touchdowns on hard ground; title: names random numbers."""
    bounces = Bounces(hard_surface(design.study), design.study.seed, f"{title} hard ground")
    return sliding(design, begin, bounces, np.full(len(begin.rows), design.study.hard_ground.friction))


def further_landers(design: DrawnDesign, count: int) -> Arrivals:
    """Landers that the study has not followed, with numbers behind those of its journeys.

    Of landers that are flown to the ground those of the journeys, as many as reach it.
    """
    if design.descents is None:
        return Arrivals.drawn(design, len(design.beds), count)
    every = Arrivals.of_descents(design.descents, design.rows, design.beds)
    down = np.flatnonzero(design.descents.touches_down)[:count]
    return every.taken(down, every.refit[down])


def follow_on_hard_ground(job: Job) -> None:
    """Follow landers on hard ground, and on the others that the study has, and write rest.csv."""
    begin = further_landers(job.design, job.study.hard_ground.count)
    why = bounce_laws.why_no_soil(job.study)
    if why is not None and (job.study.expansion is not None or job.study.sample_count):
        job.say(bounce_laws.hard_ground_only(why))
    rows = []
    for ground, touchdown in _grounds(job, begin):
        rows += followed_rows(ground, followed(job, begin, touchdown, f"landers, {ground} ground"))
    write_table(job.folder, REST_FILE, tuple(FOLLOWED), rows, FOLLOWED)


def _grounds(job: Job, begin: Arrivals) -> Iterator[tuple[str, Touchdown]]:
    """What answers the touchdowns on each ground."""
    yield HARD, on_hard_ground(job.design, begin)
    if has_equivalent(job.study):
        table = bounce_laws.restitution_table(job.study, Samples.load(job.folder), DesignRuns.load(job.folder, "drawn"))
        table.save(job.folder / bounce_laws.RESTITUTION_FILE)
        yield EQUIVALENT, sliding(job.design, begin, Bounces(table, job.study.seed, "equivalent ground"))
    if has_expansion(job.study):
        from lithobrake.pipeline.expansion.expansion_journeys import soil_bounce

        inputs = {name: begin.column(name) for name in job.design.inputs}
        bounces = Bounces(soil_bounce(job, inputs), job.study.seed, "ground of the expansion")
        yield EXPANSION, sliding(job.design, begin, SlowArrivals.of(job.design, begin, bounces))


def followed_rows(ground: str, landers: StudyLanders) -> list[list[Any]]:
    """A row of rest.csv for each lander; what is not on the ground has no place, on the partner no distance."""
    bodies, ways = np.array(landers.design.site.ground_names)[landers.ground], landers.ways_from_aims.astype(object)
    ways[landers.ground > 0] = ""
    columns = (
        *(landers.begin.number, landers.end, bodies, landers.time, landers.latitude, landers.longitude, ways),
        *(landers.touchdowns, landers.path_length, landers.contact_length, landers.contact_time),
    )
    rows = [[ground, *row] for row in zip(*(column.tolist() for column in columns), strict=True)]
    for lander in np.flatnonzero(~landers.is_down).tolist():
        rows[lander][3] = ""
        rows[lander][5:8] = ["", "", ""]
    return rows
