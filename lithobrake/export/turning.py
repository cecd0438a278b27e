"""How the lander of a journey turns: freely in each flight, and with the body where it rests."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from lithobrake.export.flown import Flown, has_journeys
from lithobrake.export.frames import Frame
from lithobrake.geometry.contact_frame import arriving, attitude_of, from_frame, quaternion, spin_of
from lithobrake.results import StudyResults, Table
from lithobrake.results.landing_again import landing_study
from lithobrake.smallbody import tumble
from lithobrake.smallbody.free_rotation import turned_freely
from lithobrake.smallbody.hopping import impact_frame
from lithobrake.study import Study
from lithobrake.study.touchdown_model import lander
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, VELOCITY_OUT

Floats = NDArray[np.float64]
Row = Mapping[str, Any]
# An impact with so small a part of its velocity along the ground has no direction there.
VERTICAL = 1e-9


@dataclass(frozen=True)
class Turn:
    """A part of a journey over which the lander touches nothing new.

    begin      since the epoch [s]; duration [s]
    attitude   turns the lander's axes into those that the body has at the beginning
    spin       angular velocity against axes that do not turn, along those axes [rad/s], [3]
    inertia    of the lander [kg m2], [3, 3]; None: it rests, and turns with the body
    rate       of the body about z [rad/s]
    what       in words
    """

    begin: float
    duration: float
    attitude: Rotation
    spin: Floats
    inertia: Floats | None
    rate: float
    what: str

    @property
    def rests(self) -> bool:
        """Whether the lander lies on the ground."""
        return self.inertia is None

    @property
    def fastest(self) -> float:
        """A bound of its rate against axes that do not turn [rad/s]."""
        speed = float(np.linalg.norm(self.spin))
        if self.inertia is None:
            return speed
        moments = np.linalg.eigvalsh(self.inertia)
        # Energy is kept, and all of it may be about the smallest moment.
        return speed * math.sqrt(float(moments[-1] / moments[0]))

    def at(self, time: Floats, axes: Frame) -> Rotation:
        """Attitudes at times since its beginning [s], [count], against these axes."""
        rate = np.array([0.0, 0.0, self.rate])
        if self.inertia is None:
            still = Rotation.from_rotvec(time[:, None] * rate) * self.attitude
        else:
            start = np.tile(quaternion(self.attitude), (len(time), 1))
            turned, _ = tumble(self.inertia, start, np.tile(self.spin, (len(time), 1)), time)
            still = Rotation.from_quat(turned, scalar_first=True)
        if axes.kind == "fixed":
            return Rotation.from_rotvec(-time[:, None] * rate) * still
        return Rotation.from_matrix(axes.axes.T) * Rotation.from_rotvec(self.begin * rate) * still


def turns_of(results: StudyResults, flown: Flown, sample: int) -> list[Turn]:
    """The parts of a journey in their order; flown: flights whose beginnings count from the epoch.

    Raises ValueError for a study without journeys, and where its touchdowns tell no attitude.
    """
    if not has_journeys(results):
        raise ValueError(f"{results.folder} follows no journeys of landings, and attitudes are known of these alone")
    touchdowns = results.touchdowns
    if not set(ORIENTATION_OUT) <= set(touchdowns):
        raise ValueError(f"the touchdowns of {results.folder} tell no attitude; passed on are places alone")
    rows = _rows(touchdowns.where(touchdowns["journey"] == sample))
    flights = [row for row, one in enumerate(flown.sample.tolist()) if one == sample]
    delivery = results.study["delivery"]
    descents = int(any(delivery.get(key) is not None for key in ("states", "release")))
    study, found = landing_study(results.folder), []
    for number, flight in enumerate(flights):
        # Of a lander that never touches down nothing tells the attitude.
        if rows:
            after = rows[number - descents] if number >= descents else None
            found.append(_flight(study, flown, flight, rows[0] if after is None else after, is_first=after is None))
    return [*found, *_rest(results, flown, flights, sample)]


def _flight(study: Study, flown: Flown, flight: int, row: Row, *, is_first: bool) -> Turn:
    """The flight after the touchdown of this row, or the one that ends with it, which is then the first."""
    place, incoming = (np.array([row[f"{of}_{axis}"] for axis in "xyz"]) for of in ("position", "velocity"))
    shape, rate = flown.body.shape, 2.0 * math.pi / float(flown.spin_period[flight])
    time, turning = float(flown.end_time[flight]), np.array([0.0, 0.0, rate])
    normal = shape.normals[shape.nearest(place)[1]]
    inertia = _inertia(study, row)
    if is_first:
        down, spin = arriving(row, impact_frame(incoming[None], normal[None])[0])
        # Back in time from the touchdown.
        attitude, spin = turned_freely(inertia, down, spin + turning, float(flown.spin_period[flight]), -time)
    else:
        local = np.array([row[name] for name in VELOCITY_OUT])
        frame = from_frame(_axes(normal, incoming, flown.velocity[flight], local))
        attitude, spin = frame * attitude_of(row), frame.apply(spin_of(row)) + turning
    what = "the flight to the first touchdown" if is_first else f"the flight after touchdown {row['touchdown']:.0f}"
    return Turn(float(flown.begin[flight]), time, attitude, spin, inertia, rate, what)


def _rest(results: StudyResults, flown: Flown, flights: list[int], sample: int) -> Iterator[Turn]:
    """The lander at rest, over a turn of the body."""
    journeys = results.journeys
    if journeys["end"][sample] != JourneyEnd.AT_REST or not np.isfinite(journeys["attitude_w"][sample]) or not flights:
        return
    last = flights[-1]
    rate = 2.0 * math.pi / float(flown.spin_period[last])
    # Of arcs the beginning of the last counts from the first touchdown, as the end of the journey does.
    arcs = results.arcs.where(results.arcs["sample"] == sample)
    begin = float(flown.begin[last] - arcs["begin_s"][-1] + journeys["time_s"][sample])
    attitude = Rotation.from_quat([journeys[f"attitude_{part}"][sample] for part in "wxyz"], scalar_first=True)
    spin = np.array([0.0, 0.0, rate])
    yield Turn(begin, 2.0 * math.pi / rate, attitude, spin, None, rate, "rest, over a turn of the body")


def _axes(normal: Floats, incoming: Floats, outgoing: Floats, local: Floats) -> Floats:
    """Axes of a touchdown in rows, [3, 3]; local: the outgoing velocity along them [m/s]."""
    level = incoming - (incoming @ normal) * normal
    ahead = outgoing - (outgoing @ normal) * normal
    if np.linalg.norm(level) > VERTICAL * np.linalg.norm(incoming) or not np.any(ahead):
        found: Floats = impact_frame(incoming[None], normal[None])[0]
        return found
    # A vertical impact has no direction along the ground, and what leaves has one.
    ahead /= np.linalg.norm(ahead)
    angle = math.atan2(local[1], local[0])
    x = math.cos(angle) * ahead - math.sin(angle) * np.cross(normal, ahead)
    return np.stack([x, np.cross(normal, x), normal])


def _inertia(study: Study, row: Row) -> Floats:
    """Of the lander about its centroid [kg m2], [3, 3]."""
    body = lander(study, row)
    whole = body.shape.inertia_per_density * (body.mass / body.shape.volume)
    return np.asarray(whole if body.inertia is None else body.inertia)


def _rows(table: Table) -> list[Row]:
    """The rows of a table, by column."""
    return [{name: table[name][row] for name in table} for row in range(table.row_count)]
