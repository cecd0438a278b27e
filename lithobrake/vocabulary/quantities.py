"""What comes out of a study, by name: unit, words and frame of every number that its files and tables hold.

Light, so that whoever only looks at a study need not load how it is checked. What a study is given has its units in
the schema of the study file (`lithobrake.study.units`).
"""

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, get_args

OutputName = Literal["speed_out", "elevation_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z"]
# What every touchdown gives that leaves the surface, and an expansion is fitted to.
OUTPUTS: tuple[OutputName, ...] = get_args(OutputName)
# The designs of a study in two stages, in the order in which their runs are made, and of a drawn one.
PAPER_DESIGNS = ("screening", "refined", "test_kept", "test_all")
DRAWN_DESIGNS = ("drawn", "soil_pairs", "twins")
# Every touchdown of the journeys of a study; the first of each are also its drawn runs.
JOURNEY_DESIGN = "touchdowns"
# The unit of a number that has none, where a header has to say so.
PURE = "-"


class Quantity(NamedTuple):
    """What a number is: its unit ("" for a pure number or a word), in words, in which frame ("": in none).

    title: in few words, for an axis or a row; "" where it has no other than its name.
    """

    units: str
    long_name: str
    frame: str = ""
    title: str = ""

    @property
    def attributes(self) -> dict[str, str]:
        """The same as other programs keep it beside the values."""
        frame = {"frame": self.frame} if self.frame else {}
        return {"units": self.units, "long_name": self.long_name, **frame}


LOCAL = "of the touchdown: x along the incoming horizontal velocity, z along the outward normal"
FIXED = "of the body, turning with it"
BED = "of the bed: origin in the middle of the floor, x and y along its sides, z upward"
HULL = "of each hull: origin at its centroid, turning with it"

# All inputs of one touchdown by the dotted keys of the study file, in its units: what the ledger keeps, and what a
# program of the user's own is given.
Row = dict[str, float]
VELOCITY_OUT = ("velocity_out_x", "velocity_out_y", "velocity_out_z")
# How a lander arrives at a touchdown, by the keys of the study file.
IMPACT_SPEED, IMPACT_INCIDENCE, IMPACT_AZIMUTH = "impact.speed", "impact.incidence_deg", "impact.azimuth_deg"
ARRIVAL = (IMPACT_SPEED, IMPACT_INCIDENCE)
# A delivery option beside the keys of [delivery]: the factor of all errors, one input however these go together.
ERRORS = "delivery.errors"
# Where on the bed the lander's centre of mass starts [m].
PLACE = ("impact.place.x", "impact.place.y")
# Attitude and spin of a lander as a touchdown begins, in the frame of the bed.
ORIENTATION = ("impact.orientation.w", "impact.orientation.x", "impact.orientation.y", "impact.orientation.z")
SPIN = ("impact.spin_x", "impact.spin_y", "impact.spin_z")
# How the lander turns and stands when it leaves, beside what is fitted; a program of the user's own may leave them out.
SPIN_OUT = ("spin_out_x", "spin_out_y", "spin_out_z")
ORIENTATION_OUT = ("orientation_out_w", "orientation_out_x", "orientation_out_y", "orientation_out_z")
OVER_RIM = "over_rim"
# What is left of a journey [s], at most, for one of its touchdowns.
TIME_LEFT = "journey.time_left"
# The kind of ground of a bed, by its place in the study file, and the mean diameter of its grains [m]: inputs of a
# touchdown where the ground is unknown.
GROUND_KIND, GROUND_SIZE = "ground.kind", "ground.grain_size"
# The acceleration of a touchdown, by the keys of the study file.
GROUND = ("surface.gravity", "surface.slope_deg", "surface.slope_azimuth_deg")
# What differs from touchdown to touchdown of a journey, beside the attitude.
OF_TOUCHDOWN = (IMPACT_SPEED, IMPACT_INCIDENCE, *GROUND[:2])
# How the ground turns, by the keys of the study file.
ROTATION = ("surface.rotation_x", "surface.rotation_y", "surface.rotation_z")
# Of touchdowns that are followed to rest: see Landing.hop_height.
TO_REST = ("displacement_x", "displacement_y", "duration", "contacts", "displacement_z")
# Only on beds that repeat.
PERIODS_TRAVELLED = "periods_travelled"

TOUCHDOWN = {
    "speed_out": Quantity("m/s", "speed after the touchdown", LOCAL, "rebound speed"),
    "elevation_out": Quantity(
        "rad", "angle of the velocity after the touchdown above the mean surface", LOCAL, "rebound elevation"
    ),
    "azimuth_out": Quantity("rad", "angle of the horizontal velocity after the touchdown from x toward y", LOCAL),
    "spin_out": Quantity("rad/s", "size of the angular velocity after the touchdown", title="rebound spin rate"),
    "velocity_out_x": Quantity("m/s", "velocity after the touchdown along x", LOCAL, "rebound velocity along x"),
    "velocity_out_y": Quantity("m/s", "velocity after the touchdown along y", LOCAL, "rebound velocity along y"),
    "velocity_out_z": Quantity("m/s", "velocity after the touchdown along z", LOCAL, "rebound velocity along z"),
    **{name: Quantity("rad/s", f"angular velocity after the touchdown along {name[-1]}", LOCAL) for name in SPIN_OUT},
    **{
        name: Quantity("", f"{name[-1]} of the unit quaternion that turns the lander as given into place", LOCAL)
        for name in ORIENTATION_OUT
    },
    OVER_RIM: Quantity("", "whether the lander left over the rim of the bed, touching nothing and going up (1 or 0)"),
    "displacement_x": Quantity("m", "horizontal displacement during the touchdown, along x", LOCAL),
    "displacement_y": Quantity("m", "horizontal displacement during the touchdown, along y", LOCAL),
    "displacement_z": Quantity("m", "displacement of the centre of mass during the touchdown, upward", LOCAL),
    "duration": Quantity("s", "simulated time of the touchdown"),
    "contacts": Quantity("", "contacts of lander and soil with a hop before each"),
    "contact_duration": Quantity("s", "time from the first to the last touch of lander and soil"),
    "penetration": Quantity("m", "largest depth of the lander below where it first touched"),
    "peak_acceleration": Quantity("m/s2", "largest acceleration of the lander by contacts"),
    "energy_lost": Quantity("J", "kinetic energy that the lander has lost"),
    PERIODS_TRAVELLED: Quantity(
        "", "horizontal path of the lander from its first to its last touch, over the shorter period of its bed"
    ),
}
RUN = {
    "key": Quantity("", "key of the run in the ledger"),
    "design": Quantity("", "design that asks for the run first"),
    "outcome": Quantity("", "how the touchdown ended"),
    "reason": Quantity("", "why the run failed"),
    "bed": Quantity("", "number of the bed, from 0"),
}
FLIGHT = {
    "sample": Quantity("", "row of the sample, from 0"),
    "ground": Quantity("", "what the lander bounces on"),
    "aim": Quantity("", "place of the aim among those of the summary, from 0"),
    "refit": Quantity("", "refit of the emulator that the lander meets, from 0"),
    "distance": Quantity("m", "way over the ground from the aim to where the lander rests"),
    "status": Quantity("", "how the flight or the journey ended"),
    "start_speed": Quantity("m/s", "speed after the touchdown", LOCAL),
    "start_elevation_deg": Quantity("deg", "angle of that velocity above the surface", LOCAL),
    "velocity_x": Quantity("m/s", "velocity after the touchdown along x", LOCAL),
    "velocity_y": Quantity("m/s", "velocity after the touchdown along y", LOCAL),
    "velocity_z": Quantity("m/s", "velocity after the touchdown along z", LOCAL),
    "time_s": Quantity("s", "time until the end of the flight or the journey"),
    "latitude_deg": Quantity("deg", "planetocentric latitude of the end", FIXED),
    "longitude_deg": Quantity("deg", "east longitude of the end", FIXED),
    "facet": Quantity("", "facet of the body that was hit, from 0"),
    "impact_speed": Quantity("m/s", "speed of the last impact against the ground"),
    "impact_incidence_deg": Quantity("deg", "angle of that velocity from the inward normal"),
}
# Of a flight between two impacts of a journey.
ARC = {
    "sample": FLIGHT["sample"],
    "arc": Quantity("", "number of the flight in the journey of the sample, from 0"),
    "begin_s": Quantity("s", "time from the first touchdown to the beginning of the flight, below 0 before it"),
    "end_s": Quantity("s", "time from the first touchdown to its end"),
    "clock_s": Quantity("s", "time at its beginning in the clock of the partner's motion"),
    **{f"position_{axis}": Quantity("m", f"place of its beginning along {axis}", FIXED) for axis in "xyz"},
    **{f"velocity_{axis}": Quantity("m/s", f"velocity at its beginning along {axis}", FIXED) for axis in "xyz"},
    "site_mass": Quantity("kg", "mass of the body of the sample"),
    "site_spin_period": Quantity("s", "spin period of the body of the sample"),
}
# Of a journey of landings, and of each of its touchdowns.
JOURNEY = {
    "journey": Quantity("", "number of the journey, from 0"),
    "bed": Quantity("", "number of the bed that it meets, from 0"),
    "end": Quantity("", "how the journey ended"),
    "body": Quantity("", "body on whose ground it ended, in whose frame its place and attitude are"),
    "time_s": Quantity(
        "s", "time from the first touchdown to the end, or from delivery where there is none", title="time to rest"
    ),
    "latitude_deg": FLIGHT["latitude_deg"],
    "longitude_deg": FLIGHT["longitude_deg"],
    **{f"position_{axis}": Quantity("m", f"place of the end along {axis}", FIXED) for axis in "xyz"},
    "distance": Quantity("m", "way over the ground from the aim point to the end", title="distance from the aim point"),
    "contacts": Quantity("", "contacts with the ground", title="contacts"),
    "touchdowns": Quantity("", "simulated landings"),
    "path_length": Quantity("m", "sum of the straight lines between impacts, and of ways in contact"),
    "face": Quantity("", "side of the lander that is down, by its own axes"),
    "tilt_deg": Quantity("deg", "angle between that side's axis and the plumb line"),
    **{
        f"attitude_{part}": Quantity("", f"{part} of the quaternion that turns the lander's axes into body-fixed ones")
        for part in "wxyz"
    },
    "reason": Quantity("", "why the journey failed"),
}
# Of a lander that is followed on other ground.
FOLLOWED = {
    "ground": Quantity("", "hard, equivalent (hard ground with the restitution of the soil), or expansion"),
    **{name: JOURNEY[name] for name in ("journey", "end", "body", "time_s")},
    **{name: JOURNEY[name] for name in ("latitude_deg", "longitude_deg", "distance")},
    "touchdowns": Quantity("", "impacts, the last one included"),
    "path_length": JOURNEY["path_length"],
    "slid_length": Quantity("m", "path along the ground, in contact with it"),
    "slid_time_s": Quantity("s", "time of that, part of time_s"),
}
# Of a body in the sky as a lander at rest sees it.
# Sides of a lander by its own axes.
SIDES = ("+x", "-x", "+y", "-y", "+z", "-z")
SKY_WORDS = {"sun": "the Sun", "earth": "Earth", "orbiter": "the orbiter"}
SKY = {
    "journey": JOURNEY["journey"],
    "body": Quantity("", "sun, earth or orbiter"),
    "latitude_deg": Quantity("deg", "latitude over which it stands, the mean over a span of dates", FIXED),
    "day_fraction": Quantity("", "fraction of the time in which it is seen, over a day, a span of days, or an orbit"),
    "least_day_fraction": Quantity("", "the same over the worst day of a span"),
    **{
        f"side_{side}": Quantity("", f"fraction of the time in which it is seen and the side {side} faces it")
        for side in SIDES
    },
}
JOURNEY_TOUCHDOWN = {
    "journey": JOURNEY["journey"],
    "touchdown": Quantity("", "number of the touchdown in its journey, from 0"),
    "key": Quantity("", "key of the landing in the ledger"),
    "outcome": Quantity("", "how the touchdown ended"),
    "body": Quantity("", "body on whose ground it is, in whose frame its place and velocity are"),
    "begin_s": Quantity("s", "time from the first touchdown of the journey to the beginning"),
    "end_s": Quantity("s", "time from the first touchdown of the journey to the end"),
    "latitude_deg": Quantity("deg", "planetocentric latitude of the impact", FIXED),
    "longitude_deg": Quantity("deg", "east longitude of the impact", FIXED),
    **{f"position_{axis}": Quantity("m", f"place of the impact along {axis}", FIXED) for axis in "xyz"},
    **{f"velocity_{axis}": Quantity("m/s", f"velocity of the impact along {axis}", FIXED) for axis in "xyz"},
}
# Where a touchdown is among the regions that have a soil of their own: a column of studies that have any, and the name
# of the ground that has none.
SOIL = {"soil": Quantity("", "region of the study file whose soil the lander meets; elsewhere: that of [grain]")}
ELSEWHERE = "elsewhere"
# Of landers at rest that are followed without landings: what limit states of journeys read.
REST_NUMBERS = ("time_s", "distance", "latitude_deg", "longitude_deg", "touchdowns", "path_length")
# Of the landers at delivery options (docs/aiming.md).
AIM_COLUMNS = ("ground", "aim", "refit", "status", *REST_NUMBERS)
# The end of a lander whose impact the emulator does not know, and for which no landing is made.
UNKNOWN_END = "unknown"
# Of a journey by the emulator of the touchdowns.
EMULATED_FILE = "emulated.csv"
EMULATED = {
    "landers": Quantity("", "fresh: landers that were not followed by landings; own: those of the journeys"),
    "journey": JOURNEY["journey"],
    "refit": FLIGHT["refit"],
    "end": Quantity("", "how it ended; unknown: at an impact that the emulator does not know"),
    "beyond": Quantity("", "whether the emulator had no answer to an impact (1 or 0)"),
    "landings": Quantity("", "simulated landings that were made for it in place of an answer"),
    **{name: JOURNEY[name] for name in REST_NUMBERS},
}
TOUCHDOWN_COST = {
    "wall_s": Quantity("s", "wall time of the landing"),
    "cpu_s": Quantity("s", "CPU time of the landing"),
}
BEDS = {
    "solid_fraction": Quantity("", "share of the volume that grains fill"),
    "coordination_number": Quantity("", "contacts of a grain in the mean"),
    "surface_height_m": Quantity("m", "mean height of the surface above the floor"),
    "mean_diameter_m": Quantity("m", "mean diameter of the grains, as spheres of equal volume"),
    "smallest_width_m": Quantity("m", "smallest width without boundary reflections during the first impact"),
    "smallest_depth_m": Quantity("m", "smallest depth without boundary reflections during the first impact"),
    "large_enough": Quantity("", "whether the bed has that width and depth"),
}
# Data sets of the HDF5 files of beds and landings; the history is that of the settling.
BODIES = {
    "vertices": Quantity("m", "vertices of the hulls, one hull after the other", HULL),
    "vertex_start": Quantity("", "row of the first vertex of each hull, and the number of all"),
    "faces": Quantity("", "triangles of the hulls, as vertices counted from the first of the hull"),
    "face_start": Quantity("", "row of the first triangle of each hull, and the number of all"),
    "position": Quantity("m", "places of the centroids", BED),
    "force": Quantity("N", "sizes of the sums of the contact forces on each body"),
    "orientation": Quantity("", "unit quaternions w, x, y, z that turn the hulls as given into place", BED),
    "diameter": Quantity("m", "diameters of the grains, as spheres of equal volume"),
    "time": Quantity("s", "simulated time"),
    "kinetic_ratio": Quantity("", "kinetic energy over the energy of lifting every grain by its mean diameter"),
    "unbalanced_force": Quantity("", "mean net force on a grain over the mean force of a contact"),
    "gravity": Quantity("m/s2", "size of the gravity"),
}


def quantity(name: str, known: Mapping[str, Quantity], study_units: Mapping[str, str]) -> Quantity:
    """What a column of this name holds, of a table of which these quantities are known.

    study_units: of the numbers of a study file by dotted key. A name of neither is one of the user's own: it keeps its
    words, and has no unit but the degrees that a name may end with.
    """
    if name in known:
        return known[name]
    site = name.removeprefix("site_")
    key, of_sample = (name, "") if site == name else (f"site.{site}", " of the sample")
    units = study_units.get(key, "deg" if name.endswith("_deg") else "").removeprefix(PURE)
    return Quantity(units, f"{site.replace('_', ' ').replace('.', ', ')}{of_sample}")


def describe(file: Any) -> None:
    """Write beside each data set of an open HDF5 file of bodies what it holds."""

    def note(name: str, entry: Any) -> None:
        # A group has no shape.
        if hasattr(entry, "shape"):
            entry.attrs.update(BODIES[name.rpartition("/")[2]].attributes)

    file.visititems(note)
