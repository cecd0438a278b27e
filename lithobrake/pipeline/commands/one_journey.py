"""One lander of a study followed from delivery to its end, made at once: the same journey as in the study."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.campaign import Record, RunStatus, run_key
from lithobrake.pipeline.commands.one_landing import OneLanding, bed_of, landed
from lithobrake.pipeline.design.dependencies import touchdown_dependencies
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.journeys.delivered_journeys import begun_aloft
from lithobrake.pipeline.journeys.journey import Journey
from lithobrake.pipeline.journeys.journey_model import JourneyModel
from lithobrake.pipeline.journeys.journey_tables import journey_row
from lithobrake.pipeline.journeys.making_journeys import begin
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.results import JourneyMotion, JourneyTrack, TouchdownFacts
from lithobrake.results.journey_track import HEADS
from lithobrake.study import Study
from lithobrake.study.touchdown_model import touchdown_version
from lithobrake.vocabulary.progress import Progress, silent
from lithobrake.vocabulary.quantities import JOURNEY

Row = dict[str, float]


@dataclass(frozen=True, eq=False)
class OneJourney:
    """A journey with the landing of each of its touchdowns, in their order."""

    journey: Journey
    landings: tuple[OneLanding, ...]

    @property
    def track(self) -> JourneyTrack:
        """Where the lander went, and how it ended."""
        model, facts = self.journey.model, map(_facts, self.journey.touchdowns, self.landings)
        row = dict(zip(JOURNEY, journey_row(self.journey), strict=True))
        return JourneyTrack(row, tuple(facts), model.site.aim, model.site.aim_radius, model.body.shape.vertices)

    def motion(self) -> JourneyMotion:
        """The hulls of each touchdown and how they moved."""
        return JourneyMotion(self.track, [landing.bodies() for landing in self.landings])

    def save(self, paths: list[Path]) -> None:
        """Write hulls and frames of each touchdown to an HDF5 file, as a study keeps its landing."""
        for landing, path in zip(self.landings, paths, strict=True):
            landing.save(path)

    def to_json(self) -> dict[str, Any]:
        """The journey as a row of journeys.csv and its touchdowns, for a program; what is not known is null."""
        row = {name: None if cell == "" else cell for name, cell in self.track.row.items()}
        pairs = zip(self.journey.touchdowns, self.landings, strict=True)
        return {**row, "touchdowns": [{**touchdown, **landing.to_json()} for touchdown, landing in pairs]}


def follow_one(
    study: Study, values: Row, tell: Callable[[str], None] = lambda line: None, progress: Progress = silent
) -> OneJourney:
    """Follow the lander whose first touchdown reads these values, see landing_inputs, to its end.

    tell: called with a line for each touchdown as soon as it is known how it ended, heads before the first. The bits
    are those of that journey in the study.
    """
    study = with_site_gravity(study, "the study")
    journey = _begun(study, values)
    bed, landings, context = bed_of(study, round(values["bed"]), progress), [], touchdown_dependencies(study)
    row: Row | None = values
    while row is not None:
        landings.append(landed(study, row, bed, progress))
        row = journey.go_on(_record(study, landings[-1], context))
        for line in [*(HEADS if len(landings) == 1 else ()), _line(journey, landings[-1])]:
            tell(line)
    return OneJourney(journey, tuple(landings))


def _begun(study: Study, values: Row) -> Journey:
    """The journey before its first touchdown, on the ground or after its flight to it."""
    number, design = round(values["journey"]), DrawnDesign(study)
    if not design.is_flown:
        return begin(JourneyModel(design, Site(study)), [values], number)[0]
    design = design.with_run_count(max(study.design.run_count, number + 1))
    assert design.descents is not None
    return begun_aloft(JourneyModel(design, Site(study)), design.descents)[number]


def _record(study: Study, landing: OneLanding, context: Mapping[str, Any]) -> Record:
    """A landing as the ledger of the study has it; context: what it depends on beside its values."""
    outputs = {name: value for name, value in landing.outcome.outputs.items() if not math.isnan(value)}
    return Record(
        key=run_key(landing.values, study.seed, 0, context), status=RunStatus.DONE,
        outcome=str(landing.outcome.status), inputs=landing.values, outputs=outputs, draws={}, seed=0, replicate=0,
        attempts=1, reason=None, wall_s=None, cpu_s=None, host=None, version=touchdown_version(), started=None,
        ended=None,
    )  # fmt: skip


def _line(journey: Journey, landing: OneLanding) -> str:
    """The last touchdown of a journey in a line."""
    facts, there = _facts(journey.touchdowns[-1], landing), None
    if journey.end is None:
        latitude, longitude = journey.model.body.shape.latitude_longitude(journey.origin)
        there = float(latitude), float(longitude)
    return facts.line(facts.to_next(there, journey.model.site.aim_radius, journey.end))


def _facts(touchdown: Mapping[str, Any], landing: OneLanding) -> TouchdownFacts:
    return TouchdownFacts.of({**landing.values, **landing.outcome.outputs, **touchdown})
