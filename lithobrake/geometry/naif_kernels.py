"""Shape, rotation and partner of a body from SPICE kernels, by NAIF's own routines in a process of their own."""

import importlib
import importlib.util
import io
import json
import math
import os
import re
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.constants import DAY
from lithobrake.vocabulary.extra_library import extra_library
from lithobrake.vocabulary.known_bodies import KNOWN_BODIES

INSTALL = 'pip install "lithobrake[spice]"'
# Shapes of millions of plates take some seconds; a damaged kernel may lead round in a circle [s].
TIME_LIMIT = 300.0
_PROGRAM = f"from {__name__} import answer; answer()"
# Bodies that SPICE's own table of names may lack.
NUMBERS = {key: body.kernel_number for key, body in KNOWN_BODIES.items() if body.kernel_number is not None}
# What others, older kernels among them, call the same two bodies.
OLD_NUMBERS = dict.fromkeys((2065803, 20065803), NUMBERS["didymos"])
PLATE_MODEL = 2  # data type of a segment
VERTEX_SIZE, PLATE_SIZE = 24, 12  # in a kernel [bytes]
# Of a text kernel: what stands between marks, and in it a name with the strings that it is given.
_DATA = re.compile(rb"^\s*\\begindata\b(.*?)(?:^\s*\\begintext\b|\Z)", re.DOTALL | re.MULTILINE)
_GIVEN = re.compile(rb"(\w+)\s*\+?=\s*(\((?:'(?:[^']|'')*'|[^')])*\)|'(?:[^']|'')*')")
_STRING = re.compile(rb"'((?:[^']|'')*)'")
Plates = tuple[NDArray[np.float64], NDArray[np.int64]]


def spice() -> Any:
    """The package spiceypy. Raises ImportError, with how to install it, where it is absent."""
    return extra_library("spiceypy", "spiceypy, which reads the kernels of SPICE,", "spice")


def kernel_files(kernels: Sequence[str]) -> list[str]:
    """All files that are read when these kernels are loaded: they, and those that meta-kernels among them name."""
    return [path for kernel in kernels for path in (kernel, *_named(kernel))]


def _named(kernel: str) -> list[str]:
    """The files that a meta-kernel names; none of other kernels, and of one that cannot be read."""
    try:
        content = Path(kernel).read_bytes()
    except OSError:
        return []
    given: dict[bytes, list[str]] = {}
    if b"KERNELS_TO_LOAD" in content:
        for name, value in (pair for data in _DATA.findall(content) for pair in _GIVEN.findall(data)):
            given.setdefault(name, []).extend(os.fsdecode(one.replace(b"''", b"'")) for one in _STRING.findall(value))
    # A path that goes on in the next string ends with a plus.
    paths = re.sub(r"\+\n", "", "\n".join(given.get(b"KERNELS_TO_LOAD", []))).split("\n")
    symbols = zip(given.get(b"PATH_SYMBOLS", []), given.get(b"PATH_VALUES", []), strict=False)
    for symbol, value in sorted(symbols, key=lambda pair: -len(pair[0])):
        paths = [path.replace(f"${symbol}", value) for path in paths]
    return [path for path in paths if path]


class Reply(NamedTuple):
    """What a call gave: arrays or numbers, or the words of its ValueError, and those of its warnings."""

    values: list[NDArray[Any]]
    refusal: str | None
    warnings: list[str]

    def unpacked(self, stacklevel: int = 2) -> list[NDArray[Any]]:
        """The values; warns, with the stack level of `warnings.warn`, and raises as the call did."""
        for text in self.warnings:
            warnings.warn(text, stacklevel=stacklevel + 1)
        if self.refusal is not None:
            raise ValueError(self.refusal)
        return self.values


def read_apart(
    function: Callable[..., Sequence[Any]], *arguments: str | float | Sequence[str | float], kernels: Sequence[str]
) -> Reply:
    """What a function of a module gives for these arguments, called in another process.

    Raises ValueError that names the kernels where the process ends without a reply, ImportError without spiceypy.
    """
    if importlib.util.find_spec("spiceypy") is None:
        spice()
    asked = json.dumps({"module": function.__module__, "name": function.__name__, "arguments": arguments})
    # The process finds modules where this one does, and nowhere else.
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)}
    words = [sys.executable, "-P", "-c", _PROGRAM]
    try:
        done = subprocess.run(
            words, input=asked.encode(), capture_output=True, env=environment, timeout=TIME_LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        raise _damaged(kernels, f"reading lasted more than {TIME_LIMIT:g} s") from None
    if done.returncode < 0:
        raise _damaged(kernels, f"SPICE ended by {signal.Signals(-done.returncode).name}")
    if done.returncode > 0:
        raise _damaged(kernels, (done.stderr.decode(errors="replace").strip().splitlines() or ["no word"])[-1])
    heading, _, content = done.stdout.partition(b"\n")
    told = json.loads(heading)
    with np.load(io.BytesIO(content), allow_pickle=False) as file:
        return Reply([file[name] for name in file.files], told["refusal"], told["warnings"])


def answer() -> None:
    """Make the call that standard input names, and write what comes of it to standard output."""
    # What SPICE prints must not come among it.
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    asked = json.load(sys.stdin)
    function = getattr(importlib.import_module(asked["module"]), asked["name"])
    found: Sequence[Any] = ()
    refusal = None
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            found = function(*asked["arguments"])
        except ValueError as error:
            refusal = str(error)
    told = {"refusal": refusal, "warnings": [str(one.message) for one in caught]}
    with output:
        output.write(json.dumps(told).encode() + b"\n")
        np.savez(output, *(np.asarray(one) for one in found))


def _damaged(kernels: Sequence[str], words: str) -> ValueError:
    return ValueError(f"{', '.join(kernels)}: not a kernel that SPICE can read ({words}); fetch it again")


def spin(kernels: Sequence[str], body: str | int) -> tuple[float, float, float, float]:
    """The numbers of `SpinState` in its order; raises ValueError as `read_spin` does."""
    with _loaded(kernels) as loaded:
        number = _number(loaded, body)
        right_ascension, declination, meridian = (
            _constants(loaded, number, name) for name in ("POLE_RA", "POLE_DEC", "PM")
        )
        moving = [*right_ascension[1:], *declination[1:], *meridian[2:]]
        if any(moving) or loaded.bodfnd(number, "NUT_PREC_PM"):
            warnings.warn(f"body {number}: precession, nutation and change of its spin are left out", stacklevel=2)
    rate = meridian[1] if len(meridian) > 1 else 0.0
    if rate <= 0.0:
        raise ValueError(
            f"body {number}: BODY{number}_PM turns by {rate} degrees a day; allowed: above 0, as the pole of a small "
            "body is the one about which it turns counter-clockwise"
        )
    return 360.0 / rate * DAY, float(right_ascension[0]), float(declination[0]), float(meridian[0])


def partner(
    kernels: Sequence[str], body: str | int, partner: str | int, time: float
) -> tuple[float, float, float, float]:
    """The numbers of `PartnerPlace` in its order at a time of SPICE [s]; raises ValueError as `read_partner` does."""
    with _loaded(kernels) as loaded:
        number, other = _number(loaded, body), _number(loaded, partner)
        state = 1e3 * np.array(loaded.spkgeo(other, time, "J2000", number)[0])
        fixed = np.array(loaded.tipbod("J2000", number, time)) @ state[:3]
    distance = float(np.linalg.norm(state[:3]))
    rate = float(np.linalg.norm(np.cross(state[:3], state[3:]))) / distance**2
    latitude = math.degrees(math.asin(fixed[2] / distance))
    return distance, latitude, math.degrees(math.atan2(fixed[1], fixed[0])), 2.0 * math.pi / rate


def places(kernels: Sequence[str], body: str | int, target: str, times: Sequence[float]) -> list[np.ndarray]:
    """Body-fixed places of a target [m], [time_count, 3], at times of SPICE [s]; raises ValueError as `read_places`."""
    with _loaded(kernels) as loaded:
        number = _number(loaded, body)
        found = []
        for time in times:
            place = np.array(loaded.spkezp(_number(loaded, target), time, "J2000", "NONE", number)[0])
            found.append(1e3 * (np.array(loaded.tipbod("J2000", number, time)) @ place))
    return [np.array(found)]


@contextmanager
def _loaded(kernels: Sequence[str]) -> Iterator[Any]:
    """SPICE with these kernels, as long as this lasts; what it refuses becomes a ValueError."""
    loaded = spice()
    done: list[str] = []
    try:
        for kernel in kernels:
            loaded.furnsh(kernel)
            done.append(kernel)
        yield loaded
    except (loaded.exceptions.SpiceyError, loaded.exceptions.NotFoundError) as error:
        names = ", ".join(kernels)
        words = " ".join(str(getattr(error, "long", "") or error).split())
        raise ValueError(f"kernels {names}: {words}; add the kernel that has it") from error
    finally:
        for kernel in done:
            loaded.unload(kernel)


def _number(loaded: Any, body: str | int) -> int:
    number = body if isinstance(body, int) else NUMBERS.get(body.lower()) or int(loaded.bods2c(body))
    if number in OLD_NUMBERS:
        warnings.warn(
            f"body {number} is not Didymos in the kernels of DART and Hera, but {OLD_NUMBERS[number]}", stacklevel=3
        )
    return number


def _constants(loaded: Any, number: int, name: str) -> list[float]:
    if not loaded.bodfnd(number, name):
        raise ValueError(f"the kernels have no BODY{number}_{name}; add the constants (PCK) of the body")
    return [float(value) for value in loaded.bodvcd(number, name, 10)[1]]


def read_shape_kernel(path: Path) -> Plates:
    """Vertices [km], shape [vertex_count, 3], and faces, [facet_count, 3], of a kernel with one plate model.

    Raises ValueError for a file that is none, is damaged, or has several segments.
    """
    vertices, faces = read_apart(plates, str(path), kernels=[str(path)]).unpacked()
    return vertices, faces


def plates(path: str) -> Plates:
    """The same, in this process, which SPICE may end where the file is damaged."""
    kernels = spice()
    try:
        handle = kernels.dasopr(path)
    except kernels.exceptions.SpiceyError as error:
        raise ValueError(f"{path}: not a kernel that SPICE opens ({error.short}); give a shape kernel.") from error
    try:
        return _plates(kernels, handle, path)
    except (kernels.exceptions.SpiceyError, kernels.exceptions.NotFoundError) as error:
        words = getattr(error, "short", "") or type(error).__name__
        raise ValueError(f"{path}: a kernel without plates ({words}); give a shape kernel (.bds).") from error
    finally:
        kernels.dascls(handle)


def _plates(kernels: Any, handle: int, path: str) -> Plates:
    segment, count = kernels.dlabfs(handle), 1
    following = segment
    while True:
        try:
            following = kernels.dlafns(handle, following)
        except kernels.exceptions.NotFoundError:
            break
        count += 1
    kind = kernels.dskgd(handle, segment).dtype
    if count != 1 or kind != PLATE_MODEL:
        raise ValueError(
            f"{path}: {count} segments, the first of data type {kind}; allowed: one of type {PLATE_MODEL}, a plate "
            "model: split the kernel, or export the segment with NAIF's DSKEXP."
        )
    vertex_count, plate_count = kernels.dskz02(handle, segment)
    # A damaged kernel may state more plates than memory holds; the file cannot have more than fit into it.
    size = Path(path).stat().st_size
    if min(vertex_count, plate_count) < 1 or VERTEX_SIZE * vertex_count + PLATE_SIZE * plate_count > size:
        raise ValueError(
            f"{path}: {vertex_count} vertices and {plate_count} plates in {size} bytes cannot be; fetch it again."
        )
    vertices = kernels.dskv02(handle, segment, 1, vertex_count)
    faces = kernels.dskp02(handle, segment, 1, plate_count)
    return np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.int64) - 1
