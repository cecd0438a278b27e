"""The stage of journeys, in the place of the drawn runs."""

from pathlib import Path
from typing import Any

from lithobrake.files.hashing import content_hash
from lithobrake.pipeline.fly.flight_paths import FILE as WAYS
from lithobrake.pipeline.fly.run_flights import run_flight_dependencies
from lithobrake.pipeline.fly.stages import PARTS as FLIGHT_PARTS
from lithobrake.pipeline.journeys.journey_tables import FILES
from lithobrake.pipeline.journeys.making_journeys import make_journeys
from lithobrake.pipeline.runs.run_table import file_of
from lithobrake.pipeline.runs.stages import PARTS as RUN_PARTS
from lithobrake.pipeline.runs.stages import drawn_dependencies
from lithobrake.pipeline.stage import Stage, same_files
from lithobrake.study import Study
from lithobrake.study.journey_sections import OWN_KEYS

PARTS = ("pipeline/journeys", "pipeline/site.py", "geometry/great_circle.py", *RUN_PARTS, *FLIGHT_PARTS)


def journey_dependencies(study: Study) -> Any:
    """What the journeys depend on."""
    journey = None if study.journey is None else study.journey.model_dump(exclude={"count", "emulated_count"})
    return [drawn_dependencies(study), run_flight_dependencies(study), journey, *_delivery(study)]


def _delivery(study: Study) -> list[Any]:
    """What the states and correlations of a delivery depend on; nothing for one that has neither."""
    if study.delivery is None:
        return []
    given = study.delivery.model_dump(include=set(OWN_KEYS), exclude_none=True)
    if study.delivery.states is not None:
        # A table counts with its content, wherever it lies.
        given["states"] = content_hash(Path(study.delivery.states))
    return [given] if given else []


JOURNEYS = Stage(
    "runs",
    "journeys",
    same_files(file_of("drawn"), file_of("touchdowns"), *FILES, "body.obj", WAYS),
    make_journeys,
    ("bed",),
    journey_dependencies,
    PARTS,
)
