"""Journeys that begin with a flight: from the state in which a lander is delivered to its first touchdown."""

from typing import Any

from lithobrake.pipeline.design.descents import Descents
from lithobrake.pipeline.journeys.journey import ENDS, Journey, flight_row
from lithobrake.pipeline.journeys.journey_model import JourneyModel
from lithobrake.vocabulary.outcomes import FlightStatus


def begun_aloft(model: JourneyModel, descents: Descents) -> list[Journey]:
    """The journeys before their first touchdowns; those that never touch down have ended with their flight."""
    rows, flights, start = iter(model.design.rows), descents.flights, descents.flights.start
    journeys = []
    for number, (status, bed) in enumerate(zip(flights.status.tolist(), model.design.beds, strict=True)):
        end = ENDS.get(FlightStatus(status))
        journey = Journey(
            *(model, number, {"bed": float(bed)} if end else next(rows)),
            *(flights.position[number], descents.axes[number], float(descents.clock[number])),
            *(float(start.mass[number]), float(start.spin_period[number])),
        )
        journey.end, journey.descent = end, _descent(descents, number, end is None)
        # Times count from the first touchdown; of a lander that has none, from its release.
        journey.time = 0.0 if end is None else float(flights.time[number])
        journeys.append(journey)
    return journeys


def _descent(descents: Descents, number: int, touches_down: bool) -> dict[str, Any]:
    """The flight of a lander to its first touchdown as a row of the table of flights."""
    flights, start = descents.flights, descents.flights.start
    time = float(flights.time[number])
    begin = -time if touches_down else 0.0
    return flight_row(
        number, begin, begin + time, float(start.time[number]), start.position[number], start.velocity[number],
        float(start.mass[number]), float(start.spin_period[number]),
    )  # fmt: skip
