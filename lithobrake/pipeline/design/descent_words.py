"""What becomes of landers on their way to the ground, in sentences."""

from collections import Counter

import numpy as np

from lithobrake.geometry.great_circle import directions
from lithobrake.pipeline.design.descents import Descents
from lithobrake.pipeline.site import Site
from lithobrake.vocabulary.outcomes import FlightStatus

WORDS = {FlightStatus.ESCAPED: "escape", FlightStatus.PARTNER: "land on the partner"}


def descents_in_words(descents: Descents) -> str:
    """Return how many landers reach the ground, when, how fast and where; and what the others do."""
    flights, down = descents.flights, descents.touches_down
    others = Counter(flights.status[~down].tolist())
    said = f"Delivery: {int(down.sum())} of {len(flights)} landers reach the ground"
    if down.any():
        speed, hours = flights.impact_speed[down], flights.time[down] / 3600.0
        said += (
            f", {hours.min():.3g} to {hours.max():.3g} h after their state, at {100.0 * speed.min():.3g} to "
            f"{100.0 * speed.max():.3g} cm/s"
        )
    ends = [f"{number} {WORDS.get(FlightStatus(one), 'still fly')}" for one, number in others.items()]
    return "; ".join([said, *ends]) + "." + (_places(descents) if down.any() else "")


def _places(descents: Descents) -> str:
    """Where the first touchdowns lie about the aim point, whose distance is an arc of the radius there."""
    site, places = Site(descents.study), descents.flights.position[descents.touches_down]
    near, middle, far = np.quantile(site.ways_from_aim(places), (0.05, 0.5, 0.95))
    shape = site.body.shape
    latitude, longitude = shape.latitude_longitude(directions(*shape.latitude_longitude(places)).mean(axis=0))
    return (
        f" First touchdowns lie {middle:.3g} m from the aim point in the median (5 to 95 %: {near:.3g} to {far:.3g} "
        f"m), about latitude {latitude:.1f} deg, longitude {longitude:.1f} deg; the aim point is at {site.aim[0]:.1f}, "
        f"{site.aim[1]:.1f}."
    )
