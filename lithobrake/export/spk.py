"""Flights as ephemerides of SPICE (SPK), and pole, spin and names of the body as its text constants (PCK)."""

import importlib
import os
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.export.flight_segments import checked_step, flight_segments
from lithobrake.export.flown import Flown
from lithobrake.export.frames import POLE, Frame
from lithobrake.export.oem import Segment
from lithobrake.files.atomic import atomic_path
from lithobrake.geometry.body_kernels import DAY, NUMBERS
from lithobrake.geometry.kernel_process import INSTALL, spice
from lithobrake.results import StudyResults
from lithobrake.vocabulary.progress import Progress, silent

# Number of lander N is FIRST - N: no spacecraft has one so low. Frames of users begin at the second.
FIRST, FRAME = -1_000_000, 1_400_000
FLIGHTS, CONSTANTS = "flights.bsp", "body.tpc"
# Epoch of J2000 as a Julian date.
J2000 = 2_451_545.0


def write_spk(
    results: StudyResults,
    folder: Path,
    samples: Sequence[int],
    *,
    epoch: str | None = None,
    step: float | None = None,
    body_number: int | None = None,
    progress: Progress = silent,
) -> list[Path]:
    """Write flights.bsp, with a segment for each flight of the chosen samples, and body.tpc; give their paths.

    Segments are of type 13 (Hermite) in the axes J2000, those of ICRF within a tenth of an arc second, about the body,
    in the time of SPICE (TDB); they are named "SAMPLE N FLIGHT K". Lander N has the number -1000000 - N. The constants
    have pole, angle of longitude 0 and spin of the body, its name, and its axes as the frame NAME_FIXED.

    samples, epoch, step   as write_ephemerides has them, with frame = "icrf"
    body_number   of the body in SPICE; absent: that of a built-in body, or of kernel_body in the study
    Raises ValueError for a body without a number, and as write_ephemerides does; ImportError without spiceypy, pyerfa.
    """
    if not samples:
        raise ValueError("no sample is chosen whose flights are passed on; name some with --flight, from 0")
    number = _number(results) if body_number is None else body_number
    axes, flown = Frame.of(results, "icrf", epoch), Flown.of(results)
    chosen = axes.timed(results, flown.journeys(results, list(dict.fromkeys(samples))))
    start = ephemeris_time(axes.epoch)
    segments = flight_segments(chosen, axes, checked_step(flown, step), progress)
    with atomic_path(folder / FLIGHTS) as draft:
        _write_segments(draft, segments, number, start)
    with atomic_path(folder / CONSTANTS) as draft:
        period = float(np.median(flown.spin_period))
        draft.write_text(_constants(results, axes, number, start, period, list(segments)), encoding="ascii")
    return [folder / FLIGHTS, folder / CONSTANTS]


def ephemeris_time(epoch: datetime) -> float:
    """Time of SPICE, TDB since J2000 [s], of a UTC epoch. Raises ImportError without pyerfa."""
    erfa = _erfa()
    second = epoch.second + 1e-6 * epoch.microsecond
    utc = erfa.dtf2d("UTC", epoch.year, epoch.month, epoch.day, epoch.hour, epoch.minute, second)
    whole, part = erfa.taitt(*erfa.utctai(*utc))
    return float(((whole - J2000) + part) * DAY + erfa.dtdb(whole, part, 0.0, 0.0, 0.0, 0.0))


def _erfa() -> Any:
    try:
        return importlib.import_module("erfa")
    except ImportError as error:
        raise ImportError(f"pyerfa, which knows the time scales of SPICE, is not installed: {INSTALL}") from error


def _number(results: StudyResults) -> int:
    site = results.study["site"]
    if site["body"] in NUMBERS:
        return NUMBERS[site["body"]]
    try:
        return int(site.get("kernel_body") or "")
    except ValueError:
        raise ValueError(
            f"the body {Path(site['body']).name} has no number in SPICE; give it with --body-number, or write it as "
            "site.kernel_body"
        ) from None


def _write_segments(path: Path, segments: dict[int, list[Segment]], number: int, start: float) -> None:
    """Write segments whose times count from a time of SPICE [s]."""
    library = spice()
    handle = library.spkopn(os.fspath(path), "lithobrake", 0)
    for sample, parts in segments.items():
        for flight, part in enumerate(parts):
            # A flight that ends as it begins has no way between states.
            if part.interpolation_degree is None:
                continue
            times: NDArray[np.float64] = start + part.time
            states, name = np.ascontiguousarray(part.state * 1e-3), f"SAMPLE {sample} FLIGHT {flight}"
            ends, degree = (times[0], times[-1]), part.interpolation_degree
            library.spkw13(
                handle, FIRST - sample, number, "J2000", *ends, name, degree, len(times), states.tolist(), times
            )
    library.spkcls(handle)


def _constants(
    results: StudyResults, axes: Frame, number: int, start: float, spin_period: float, samples: Sequence[int]
) -> str:
    """Text of the constants; start: the time of SPICE at which site.meridian_deg holds [s]."""
    right_ascension, declination, meridian = (float(results.study["site"][key]) for key in POLE)
    at_j2000 = (meridian - 360.0 * start / spin_period) % 360.0
    frame = FRAME + abs(number) % 100_000
    assigned = [(axes.body, number), *((f"SAMPLE_{sample}", FIRST - sample) for sample in samples)]
    names = "".join(
        f"NAIF_BODY_NAME += ( '{name}' )\nNAIF_BODY_CODE += ( {code} )\n" for name, code in assigned
    )  # fmt: skip
    return (
        "KPL/PCK\n\n"
        f"Pole, angle of longitude 0 and spin of {axes.body}, from a study of lithobrake; the spin period is the\n"
        f"median of its samples, {spin_period!r} s. Its axes are the frame {axes.body}_FIXED.\n\n"
        "\\begindata\n"
        f"BODY{number}_POLE_RA = ( {right_ascension!r} 0. 0. )\n"
        f"BODY{number}_POLE_DEC = ( {declination!r} 0. 0. )\n"
        f"BODY{number}_PM = ( {at_j2000!r} {360.0 * DAY / spin_period!r} 0. )\n"
        f"FRAME_{axes.body}_FIXED = {frame}\n"
        f"FRAME_{frame}_NAME = '{axes.body}_FIXED'\nFRAME_{frame}_CLASS = 2\n"
        f"FRAME_{frame}_CLASS_ID = {number}\nFRAME_{frame}_CENTER = {number}\n"
        f"{names}\\begintext\n"
    )
