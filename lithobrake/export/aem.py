"""Attitudes of landers as Attitude Ephemeris Messages of the Consultative Committee for Space Data Systems (KVN).

Source: [CCSDS-2024]
"""

import logging
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.export.flown import Flown
from lithobrake.export.frames import RESOLUTION, Frame
from lithobrake.export.oem import comment_lines, epoch_texts, header_lines, number_texts
from lithobrake.export.turning import Turn, turns_of
from lithobrake.files.atomic import atomic_path
from lithobrake.results import StudyResults

log = logging.getLogger(__name__)

VERSION = "2.0"
# Between two states a lander turns no farther, unless the user chooses a step; beyond the second a step says nothing of
# the way between [rad].
STEP_ANGLE, BLIND_ANGLE = math.radians(10.0), math.radians(90.0)
# Of the polynomials between states.
DEGREE = 7
QUATERNION = "Each quaternion (Q1, Q2, Q3, QC; QC is its scalar) turns components along REF_FRAME_A into those along "
QUATERNION += "the lander's own axes, SC_BODY_1, which are those of its shape in the study."


def write_attitudes(
    results: StudyResults,
    folder: Path,
    samples: Sequence[int],
    *,
    frame: str = "inertial",
    epoch: str | None = None,
    step: float | None = None,
) -> list[Path]:
    """Write a file for each chosen journey, with a segment for each flight and one at rest; give their paths.

    In flight the lander turns freely, without torque, from its attitude and spin as it left the ground; while it is in
    contact nothing is noted, and the file has a gap. At rest it turns with the body, for one turn of that.

    samples, frame, epoch   as write_ephemerides has them
    step   between states [s]; absent: as long as the lander takes to turn by 10 degrees at most
    Raises ValueError for a study without journeys of landings, and as write_ephemerides does.
    """
    if not samples:
        raise ValueError("no sample is chosen whose attitude is passed on; name some with --flight, from 0")
    axes, chosen = Frame.of(results, frame, epoch), list(dict.fromkeys(samples))
    flown = axes.timed(results, Flown.of(results).journeys(results, chosen))
    comments = [
        f"Attitudes of landers of a study of lithobrake on {axes.body}. {axes.sentences.split(' Velocities')[0]}",
        *(axes.clock_sentence, QUATERNION),
    ]
    written = []
    for sample in chosen:
        lines = header_lines(f"CCSDS_AEM_VERS = {VERSION}", comments)
        for turn in turns_of(results, flown, sample):
            lines += _segment(turn, sample, axes, step)
        written.append(folder / f"{attitude_name(sample)}.aem")
        with atomic_path(written[-1]) as draft:
            draft.write_text("\n".join(lines), encoding="ascii")
    return written


def attitude_name(sample: int) -> str:
    """Name of the file of a sample, without its ending."""
    return f"attitude_{sample}"


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
