"""All that was found out about an installation, in words and as JSON values."""

import platform
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from lithobrake import __version__
from lithobrake.doctor.libraries import EXTRAS, NeededLibrary, needed_libraries
from lithobrake.doctor.machine import FoundCache, FoundMachine

if TYPE_CHECKING:
    from lithobrake.doctor.speed import MeasuredSpeed

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
        machine, cache = self.machine, self.machine.cache
        return {
            "version": __version__,
            "python": platform.python_version(),
            "libraries": [
                {"name": one.name, "lowest": one.lowest, "version": one.version, "extra": one.extra or None,
                 "serves": one.serves, "remedy": None if one.serves else one.remedy}
                for one in self.libraries
            ],
            "machine": asdict(machine) | {"cache": cache and cache.to_json()},
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
