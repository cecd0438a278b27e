"""The tables of journeys: one row a journey, a touchdown, a flight."""

import math
from collections.abc import Sequence
from typing import Any

from lithobrake.pipeline.fly.flights import write_table
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.journeys.journey import Journey
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import (
    ARC,
    FLIGHTS_FILE,
    JOURNEY,
    JOURNEY_TOUCHDOWN,
    JOURNEYS_FILE,
    SOIL,
    TOUCHDOWNS_FILE,
)

FILES = (JOURNEYS_FILE, TOUCHDOWNS_FILE, FLIGHTS_FILE)


def write_journeys(folder: StudyFolder, journeys: Sequence[Journey]) -> None:
    """Write journeys.csv, touchdowns.csv and arcs.csv."""
    write_table(folder, JOURNEYS_FILE, tuple(JOURNEY), [journey_row(journey) for journey in journeys], JOURNEY)
    touchdowns = [list(row.values()) for journey in journeys for row in journey.touchdowns]
    columns = JOURNEY_TOUCHDOWN | (SOIL if any(journey.model.design.study.soil for journey in journeys) else {})
    write_table(folder, TOUCHDOWNS_FILE, tuple(columns), touchdowns, columns)
    flights = [[row[name] for name in ARC] for journey in journeys for row in _flights(journey)]
    write_table(folder, FLIGHTS_FILE, tuple(ARC), flights, ARC)


def _flights(journey: Journey) -> list[dict[str, Any]]:
    """The flights of a journey in their order, with that to its first touchdown."""
    rows = [*([] if journey.descent is None else [journey.descent]), *journey.flights]
    return [{**row, "arc": number} for number, row in enumerate(rows)]


def journey_row(journey: Journey) -> list[Any]:
    """Where a journey ended; what is not on the ground of the body has no place there, what does not rest no side."""
    place: list[Any] = ["", "", "", "", "", ""]
    if journey.end in (JourneyEnd.AT_REST, JourneyEnd.UNDER_WAY) and journey.is_on_ground:
        latitude, longitude = (float(one) for one in journey.model.body.shape.latitude_longitude(journey.origin))
        place = [latitude, longitude, *journey.origin.tolist(), float(journey.model.site.ways_from_aim(journey.origin))]
    side, tilt = ("", "") if journey.lies is None else (journey.lies[0], math.degrees(journey.lies[1]))
    attitude = [""] * 4 if journey.attitude is None else journey.attitude.as_quat(scalar_first=True).tolist()
    counts = [journey.contacts, len(journey.touchdowns), journey.path_length]
    bed = int(journey.row["bed"])
    return [journey.number, bed, str(journey.end), journey.time, *place, *counts, side, tilt, *attitude, journey.reason]
