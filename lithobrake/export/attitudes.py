"""How the lander of a journey turns, and attitudes as Attitude Ephemeris Messages (KVN)."""

import logging
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.export.flown import ExportOptions, Flown, has_journeys
from lithobrake.export.oem import RESOLUTION, Frame, comment_lines, epoch_texts, header_lines, number_texts
from lithobrake.files.atomic import write_whole
from lithobrake.geometry.attitude import arriving, attitude_of, from_frame, quaternion, spin_of
from lithobrake.results import StudyResults, Table
from lithobrake.results.motions import landing_study
from lithobrake.smallbody import tumble
from lithobrake.smallbody.bounce import impact_frame
from lithobrake.smallbody.grounds import BodyGround, Moments, grounds_of
from lithobrake.smallbody.tumbling import turned_freely
from lithobrake.study import Study
from lithobrake.touchdown.lander_model import lander
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, VELOCITY_OUT

Row = Mapping[str, Any]
# An impact with so small a part of its velocity along the ground has no direction there.
VERTICAL = 1e-9
log = logging.getLogger(__name__)
VERSION = "2.0"
# Between two states a lander turns no farther, unless the user chooses a step; beyond the second a step says nothing of
# the way between [rad].
STEP_ANGLE, BLIND_ANGLE = math.radians(10.0), math.radians(90.0)
# Of the polynomials between states.
DEGREE = 7
QUATERNION = (
    "Each quaternion (Q1, Q2, Q3, QC; QC is its scalar) turns components along REF_FRAME_A into those along the "
    "lander's own axes, SC_BODY_1, which are those of its shape in the study."
)


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
    spin: Array
    inertia: Array | None
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

    def at(self, time: Array, axes: Frame) -> Rotation:
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
    rate, time = 2.0 * math.pi / float(flown.spin_period[flight]), float(flown.end_time[flight])
    ground = _ground(flown, row)
    shape, one = ground.body.shape, np.array([flight])
    normal = shape.normals[shape.nearest(place)[1]]
    inertia, begin = _inertia(study, row), Moments(flown.start_time, flown.mass, flown.spin_period).at(one)
    if is_first:
        down, spin = arriving(row, impact_frame(incoming[None], normal[None])[0])
        down, spin = _in_flight(ground, begin._replace(time=begin.time + time), down, spin)
        # Back in time from the touchdown.
        attitude, spin = turned_freely(inertia, down, spin, float(flown.spin_period[flight]), -time)
    else:
        local = np.array([row[name] for name in VELOCITY_OUT])
        _, outgoing = ground.states_on_ground(flown.position[one], flown.velocity[one], begin)
        frame = from_frame(_axes(normal, incoming, outgoing[0], local))
        attitude, spin = _in_flight(ground, begin, frame * attitude_of(row), frame.apply(spin_of(row)))
    what = "the flight to the first touchdown" if is_first else f"the flight after touchdown {row['touchdown']:.0f}"
    return Turn(float(flown.begin[flight]), time, attitude, spin, inertia, rate, what)


def _ground(flown: Flown, row: Row) -> BodyGround:
    """The ground of the touchdown of this row."""
    partner, grounds = flown.body.partner, grounds_of(flown.body)
    return grounds[-1] if partner is not None and row["body"] == partner.body.name else grounds[0]


def _in_flight(ground: BodyGround, when: Moments, attitude: Rotation, spin: Array) -> tuple[Rotation, Array]:
    """Attitude, and spin against the stars [rad/s], along the axes of flights, from those against a ground."""
    whole, turns = spin + ground.spin(when)[0], ground.turns(when)
    return (attitude, whole) if turns is None else (Rotation.from_matrix(turns[0].T) * attitude, whole @ turns[0])


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


def _axes(normal: Array, incoming: Array, outgoing: Array, local: Array) -> Array:
    """Axes of a touchdown in rows, [3, 3]; local: the outgoing velocity along them [m/s]."""
    level = incoming - (incoming @ normal) * normal
    ahead = outgoing - (outgoing @ normal) * normal
    if np.linalg.norm(level) > VERTICAL * np.linalg.norm(incoming) or not np.any(ahead):
        found: Array = impact_frame(incoming[None], normal[None])[0]
        return found
    # A vertical impact has no direction along the ground, and what leaves has one.
    ahead /= np.linalg.norm(ahead)
    angle = math.atan2(local[1], local[0])
    x = math.cos(angle) * ahead - math.sin(angle) * np.cross(normal, ahead)
    return np.stack([x, np.cross(normal, x), normal])


def _inertia(study: Study, row: Row) -> Array:
    """Of the lander about its centroid [kg m2], [3, 3]."""
    body = lander(study, row)
    whole = body.shape.inertia_per_density * (body.mass / body.shape.volume)
    return np.asarray(whole if body.inertia is None else body.inertia)


def _rows(table: Table) -> list[Row]:
    return [{name: table[name][row] for name in table} for row in range(table.row_count)]


def attitude_names(results: StudyResults, chosen: ExportOptions) -> list[str]:
    return [f"attitude_{sample}.aem" for sample in chosen.samples]


def write_attitudes(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write a file for each chosen journey, with a segment for each flight and one at rest.

    In flight the lander turns freely, without torque, from its attitude and spin as it left the ground; while it is in
    contact nothing is noted, and the file has a gap. At rest it turns with the body, for one turn of that.
    Raises ValueError for a study without journeys of landings, and as write_ephemerides does.
    """
    if not chosen.samples:
        raise ValueError("no sample is chosen whose attitude is passed on; name some with --flight, from 0")
    axes = Frame.of(results, chosen.frame, chosen.epoch)
    flown = axes.timed(results, Flown.of(results).journeys(results, chosen.samples))
    comments = [
        f"Attitudes of landers of a study of lithobrake on {axes.body}. {axes.sentences.split(' Velocities')[0]}",
        *(axes.clock_sentence, QUATERNION),
    ]
    for path, sample in zip(paths, chosen.samples, strict=True):
        lines = header_lines(f"CCSDS_AEM_VERS = {VERSION}", comments)
        for turn in turns_of(results, flown, sample):
            lines += _segment(turn, sample, axes, chosen.step)
        write_whole(path, "\n".join(lines), "ascii")


def sampled(turn: Turn, axes: Frame, step: float | None) -> tuple[np.ndarray, Rotation]:
    """Times since the beginning of a part of a journey [s], with both ends, and the attitudes then."""
    # At rest against axes that turn, too, nothing changes.
    rate = 0.0 if turn.rests and axes.kind == "fixed" else turn.fastest + (turn.rate if axes.kind == "fixed" else 0.0)
    longest = STEP_ANGLE / max(rate, STEP_ANGLE / turn.duration) if step is None else max(step, 10.0 * RESOLUTION)
    if rate * longest > BLIND_ANGLE:
        log.warning(
            "In %s the lander may turn by %.0f degrees between states; a shorter --step shows how.",
            *(turn.what, math.degrees(rate * longest)),
        )
    time = np.append(np.arange(0.0, turn.duration - RESOLUTION, longest), turn.duration)
    return time, turn.at(time, axes)


def one_sided(attitudes: Rotation) -> np.ndarray:
    """Quaternions x, y, z, w, [count, 4], none of which stands opposite to the one before it."""
    found = attitudes.as_quat()
    flips = np.where((found[1:] * found[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    found[1:] *= np.cumprod(flips)[:, None]
    return found


def _segment(turn: Turn, sample: int, axes: Frame, step: float | None) -> list[str]:
    time, attitudes = sampled(turn, axes, step)
    times = epoch_texts(axes.epoch, turn.begin + time)
    return [
        "META_START",
        *comment_lines([f"Sample {sample}: {turn.what}."]),
        *(f"OBJECT_NAME = SAMPLE_{sample}", f"OBJECT_ID = SAMPLE_{sample}", f"CENTER_NAME = {axes.body}"),
        *(f"REF_FRAME_A = {axes.name}", "REF_FRAME_B = SC_BODY_1", "TIME_SYSTEM = UTC"),
        *(f"START_TIME = {times[0]}", f"STOP_TIME = {times[-1]}", "ATTITUDE_TYPE = QUATERNION"),
        *("INTERPOLATION_METHOD = LAGRANGE", f"INTERPOLATION_DEGREE = {min(DEGREE, len(time) - 1)}"),
        *("META_STOP", "", "DATA_START"),
        *(f"{at} {number_texts(one)}" for at, one in zip(times, one_sided(attitudes), strict=True)),
        *("DATA_STOP", ""),
    ]
