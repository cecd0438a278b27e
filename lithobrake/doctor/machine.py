"""What this machine offers: cores, load, room on the disk, the cache and what is compiled in it, a browser."""

import os
import platform
import shutil
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

BROWSERS = ("chromium", "chromium-browser", "google-chrome")


@dataclass(frozen=True)
class FoundCache:
    """The folder of compiled kernels, gravity tables and beds (None: none to be trusted), and what it has of them."""

    folder: Path | None
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
        return cls(cache.folder and cache.folder.parent, cache.keeps, compiled)

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON values."""
        return asdict(self) | {"folder": self.folder and str(self.folder)}


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
        return cls(
            system=f"{platform.machine()}, {sys.platform}",
            cores=_cores() if has_libraries else os.cpu_count() or 1,
            load=os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
            free_bytes=shutil.disk_usage(Path.cwd()).free,
            browser=next(filter(None, map(shutil.which, BROWSERS)), None),
            cache=FoundCache.look() if has_libraries else None,
        )


def _cores() -> int:
    from lithobrake.campaign import available_cores

    return available_cores()
