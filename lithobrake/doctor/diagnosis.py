"""What is installed and what this machine offers, in words and as JSON values."""

import os
import platform
import re
import shutil
import sys
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake import __version__

if TYPE_CHECKING:
    from lithobrake.doctor.speed import MeasuredSpeed

# What each extra is for; those that only serve the making of this package are left out.
EXTRAS = {
    "dask": "runs on a cluster",
    "spice": "NAIF's kernels of shape, spin and place",
    "thin": "meshes of millions of facets",
    "yaml": "answers of your own program as YAML",
    "infer": "inference where few points carry weight",
    "data": "results as pandas and xarray",
    "view": "windows and films of landings",
}
_REQUIREMENT = re.compile(
    r"(?P<name>[\w.-]+)[^;>]*(?:>=\s*(?P<lowest>[\d.]+))?"  # numpy>=1.26
    r"[^;]*(?:;.*extra\s*==\s*[\"'](?P<extra>\w+))?"  # ; extra == "data"
)


@dataclass(frozen=True)
class NeededLibrary:
    """A library that the package asks for: lowest version that serves, version found (None: not there), its extra."""

    name: str
    lowest: str
    version: str | None
    extra: str

    @property
    def serves(self) -> bool:
        """Whether it is there and new enough."""
        return self.version is not None and _numbers(self.version) >= _numbers(self.lowest)

    @property
    def state(self) -> str:
        """Its version, or what is the matter with it."""
        if self.version is None:
            return "missing"
        return self.version if self.serves else f"{self.version} is too old; needed: {self.lowest} or newer"

    @property
    def remedy(self) -> str:
        return f'pip install --upgrade "lithobrake{f"[{self.extra}]" if self.extra else ""}"'


def needed_libraries() -> list[NeededLibrary]:
    """What the installed package asks for, its extras included; nothing where it only lies in a folder."""
    try:
        return list(parsed(requires("lithobrake") or ()))
    except PackageNotFoundError:
        return []


def parsed(requirements: Iterable[str]) -> Iterable[NeededLibrary]:
    """Read requirements such as 'pandas>=2.0; extra == "data"', and look up what is installed of each."""
    for requirement in requirements:
        found = _REQUIREMENT.match(requirement)
        if found is None:
            raise ValueError(f"the package asks for {requirement!r}, which is no requirement; install it again")
        name, extra = found["name"], found["extra"] or ""
        if not extra or extra in EXTRAS:
            yield NeededLibrary(name, found["lowest"] or "0", _installed(name), extra)


def _installed(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _numbers(version: str) -> list[int]:
    """The numbers that a version begins with, for comparison."""
    return [int(number) for number in re.match(r"\d*(?:\.\d+)*", version)[0].split(".") if number]  # type: ignore[index]


BROWSERS = ("chromium", "chromium-browser", "google-chrome")


@dataclass(frozen=True)
class FoundCache:
    """The folder of compiled kernels, gravity tables and beds (None: none to be trusted), and what it has of them."""

    folder: str | None
    is_kept: bool
    is_compiled: dict[str, bool]

    @classmethod
    def look(cls) -> "FoundCache":
        """Look at it, which takes NumPy and the compiler."""
        from lithobrake.compilation.compiled import lies_on_disk
        from lithobrake.compilation.disk_cache import DiskCache
        from lithobrake.dem.stepping.time_loop import advance
        from lithobrake.smallbody.integration import integrate_flights

        cache = DiskCache("beds", "beds")
        compiled = {"soft-surface engine": lies_on_disk(advance), "flights": lies_on_disk(integrate_flights)}
        return cls(str(cache.folder.parent) if cache.folder else None, cache.keeps, compiled)


@dataclass(frozen=True)
class FoundMachine:
    """A machine as it was found.

    load: of the last minute; None where the system tells none. free_bytes: in the current folder. cache: None where a
    library is missing that would tell.
    """

    system: str
    cores: int
    load: float | None
    free_bytes: int
    browser: str | None
    cache: FoundCache | None

    @classmethod
    def look(cls, has_libraries: bool) -> "FoundMachine":
        """Look at this machine, with its cache where the libraries are all there."""
        from lithobrake.campaign import available_cores

        return cls(
            system=f"{platform.machine()}, {sys.platform}",
            cores=available_cores(),
            load=os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
            free_bytes=shutil.disk_usage(Path.cwd()).free,
            browser=next(filter(None, map(shutil.which, BROWSERS)), None),
            cache=FoundCache.look() if has_libraries else None,
        )


# A load above this part of the cores is other work, which makes all of this slower.
BUSY = 0.7
NOT_INSTALLED = (
    "  unknown, since lithobrake lies in a folder and is not installed: pip install FOLDER, with pyproject.toml"
)


@dataclass(frozen=True)
class Diagnosis:
    """An installation and its machine; speeds: empty where they were not measured."""

    libraries: "tuple[NeededLibrary, ...]"
    machine: FoundMachine
    speeds: "tuple[MeasuredSpeed, ...]"

    @property
    def lacking(self) -> list[NeededLibrary]:
        """Libraries without which nothing works."""
        return [one for one in self.libraries if not (one.extra or one.serves)]

    def lines(self) -> list[str]:
        """All of it in words, and at the end what to do."""
        lines = [f"lithobrake {__version__}, Python {platform.python_version()}", "Libraries:"]
        lines += [f"  {one.name:<20} {one.state}" for one in self.libraries if not one.extra] or [NOT_INSTALLED]
        lines += ["Extras:", *(line for extra in EXTRAS for line in self._extra_lines(extra))]
        lines += ["Machine:", *(f"  {line}" for line in self._machine_lines())]
        if self.speeds:
            lines += ["Speed of one core, a CPU second, here and on the reference machine:"]
            lines += [f"  {one.what:<52} {one.here:>10.3g} {one.reference:>10.3g}" for one in self.speeds]
        remedies = dict.fromkeys(one.remedy for one in self.libraries if not one.serves)
        return lines + ([f"To get what is missing: {' && '.join(remedies)}"] if remedies else [])

    def to_json(self) -> dict[str, Any]:
        """The same for a program."""
        return {
            "version": __version__,
            "python": platform.python_version(),
            "libraries": [
                {"name": one.name, "lowest": one.lowest, "version": one.version, "extra": one.extra or None,
                 "serves": one.serves, "remedy": None if one.serves else one.remedy}
                for one in self.libraries
            ],
            "machine": asdict(self.machine),
            "speeds": [asdict(one) for one in self.speeds],
        }  # fmt: skip

    def _extra_lines(self, extra: str) -> Iterator[str]:
        found = [one for one in self.libraries if one.extra == extra]
        for one in found:
            remedy = "" if one.serves else f": {one.remedy}"
            yield f"  {extra:<6} {one.name:<20} {one.state}{remedy} ({EXTRAS[extra]})"

    def _machine_lines(self) -> Iterator[str]:
        machine = self.machine
        busy = machine.load is not None and machine.load > BUSY * machine.cores
        load = "load unknown" if machine.load is None else f"load {machine.load:.1f}"
        yield f"{machine.system}: {machine.cores} cores, {load}{', so other work is slowing this down' if busy else ''}"
        yield f"disk: {machine.free_bytes / 1e9:.1f} GB free in this folder"
        if machine.cache is not None:
            yield from _cache_lines(machine.cache)
        yield f"browser that the tests of the page use: {machine.browser or 'none; get one with: apt install chromium'}"


def _cache_lines(cache: FoundCache) -> Iterator[str]:
    if cache.folder is None or not cache.is_kept:
        yield f"cache: {cache.folder or 'none'}, cannot be written: set LITHOBRAKE_CACHE to a folder of your own"
    else:
        yield f"cache: {cache.folder}, can be written; LITHOBRAKE_CACHE moves it"
    for what, there in cache.is_compiled.items():
        yield f"{what}: {'compiled' if there else 'not compiled yet, which the first run does within a minute'}"


def examine(quick: bool = False) -> Diagnosis:
    """Look at the installation and, unless in a hurry or without its libraries, measure how fast it is."""
    libraries = tuple(needed_libraries())
    complete = all(one.extra or one.serves for one in libraries)
    machine = FoundMachine.look(complete)
    if quick or not complete:
        return Diagnosis(libraries, machine, ())
    from lithobrake.doctor.speed import measured_speeds

    return Diagnosis(libraries, machine, tuple(measured_speeds()))
