"""What the columns of a study's tables are: unit, words, and the frame in which a direction is measured."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lithobrake.results.table import Column

LOCAL = "of the touchdown: x along the incoming horizontal velocity, z along the outward normal"
FIXED = "of the body, turning with it"
# Unit, words and frame of what touchdowns give and of what flights and journeys tell; "": a pure number or a word.
KNOWN: dict[str, tuple[str, str, str]] = {
    "speed_out": ("m/s", "speed after the touchdown", LOCAL),
    "elevation_out": ("rad", "angle of the velocity after the touchdown above the mean surface", LOCAL),
    "azimuth_out": ("rad", "angle of the horizontal velocity after the touchdown from x toward y", LOCAL),
    "spin_out": ("rad/s", "size of the angular velocity after the touchdown", ""),
    "velocity_out_x": ("m/s", "velocity after the touchdown along x", LOCAL),
    "velocity_out_y": ("m/s", "velocity after the touchdown along y", LOCAL),
    "velocity_out_z": ("m/s", "velocity after the touchdown along z", LOCAL),
    "contact_duration": ("s", "time during which the lander touches the soil", ""),
    "penetration": ("m", "largest depth of the lander below the surface", ""),
    "peak_acceleration": ("m/s2", "largest acceleration of the lander", ""),
    "energy_lost": ("J", "energy that the lander has lost", ""),
    "key": ("", "key of the run in the ledger", ""),
    "design": ("", "design that asks for the run first", ""),
    "outcome": ("", "how the touchdown ended", ""),
    "reason": ("", "why the run failed", ""),
    "wall_s": ("s", "time that the run took", ""),
    "cpu_s": ("s", "CPU time that the run took", ""),
    "sample": ("", "row of the sample, from 0", ""),
    "ground": ("", "what the lander bounces on", ""),
    "status": ("", "how the flight or the journey ended", ""),
    "start_speed": ("m/s", "speed after the touchdown", LOCAL),
    "start_elevation_deg": ("deg", "angle of that velocity above the surface", LOCAL),
    "velocity_x": ("m/s", "velocity after the touchdown along x", LOCAL),
    "velocity_y": ("m/s", "velocity after the touchdown along y", LOCAL),
    "velocity_z": ("m/s", "velocity after the touchdown along z", LOCAL),
    "time_s": ("s", "time until the end of the flight or the journey", ""),
    "latitude_deg": ("deg", "planetocentric latitude of the end", FIXED),
    "longitude_deg": ("deg", "east longitude of the end", FIXED),
    "facet": ("", "facet of the body that was hit, from 0", ""),
    "impact_speed": ("m/s", "speed of the last impact against the ground", ""),
    "impact_incidence_deg": ("deg", "angle of that velocity from the inward normal", ""),
    "rebounds": ("", "impacts after which the lander went on", ""),
    "path_length": ("m", "sum of the straight lines between impacts", ""),
}


def described(name: str, values: Sequence[Any] | np.ndarray, units: Mapping[str, str]) -> Column:
    """A column with what it is; units: of the numbers of a study file by dotted key."""
    unit, words, frame = KNOWN.get(name, ("", "", ""))
    if name in units:
        unit = units[name]
    site = name.removeprefix("site_")
    if site != name:
        unit, words = units.get(f"site.{site}", ""), f"{site.replace('_', ' ')} of the sample"
    return Column(np.asarray(values), unit.removeprefix("-"), words or name.replace("_", " ").replace(".", ", "), frame)
