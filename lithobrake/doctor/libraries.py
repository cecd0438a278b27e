"""The libraries that the package asks for, and which of them are installed, as the metadata of packages say."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, requires, version

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
        """The command that installs it."""
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
