"""Finished studies of a plate, whose folders and files are made odd: one of first touchdowns, one of journeys."""

import contextlib
import os
import shutil
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest import mock

import base_studies
import tomli_w
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.emulator import validation
from lithobrake.report.figures.style import STYLE

FIRST, JOURNEYS = "first", "journeys"
CHANGES: dict[str, tuple[str, dict[str, Any]]] = {
    FIRST: ("first_bounce", {"limit_states": {"fast": "speed_out > 0.1"}, "monte_carlo": {"sample_count": 100}}),
    JOURNEYS: ("one_ground", {"journey": {"emulated_count": 4}}),
}


@dataclass(frozen=True)
class Finished:
    """A folder with both studies: NAME.toml and the folder NAME of each, and the files that they name."""

    path: Path

    @classmethod
    def made(cls, path: Path) -> "Finished":
        """Make both in an empty folder; their touchdowns by a program."""
        base_studies.write_files(path)
        for name, (base, changes) in CHANGES.items():
            solver = {"command": f"{sys.executable} -S program.py"}
            tables = base_studies.merged(base_studies.base(base), {"solver": solver, **changes})
            (path / f"{name}.toml").write_bytes(tomli_w.dumps(tables).encode())
            with quick():
                command(path, "run", f"{name}.toml", "--out", name, "--workers", "1")
        return cls(path)

    def copied(self, folder: Path) -> None:
        """Copy all of it into a folder."""
        shutil.copytree(self.path, folder, dirs_exist_ok=True)


@contextlib.contextmanager
def quick() -> Iterator[None]:
    """Pictures are coarse, emulators are fitted anew without few beds, and nothing is opened or served."""
    with (
        mock.patch.dict(STYLE, {"savefig.dpi": 30}),
        mock.patch.object(validation, "MOST_FOLDS", 2),
        mock.patch("webbrowser.open", return_value=True),
        mock.patch("lithobrake.view.show"),
        mock.patch("lithobrake.serve.ClientServer.serve_forever"),
    ):
        yield


def command(folder: Path, *words: str) -> str:
    """What a command prints, given in a folder. Raises ValueError with what it says where it is refused."""
    here = os.getcwd()
    try:
        os.chdir(folder)
        found = CliRunner().invoke(app, list(words))
    finally:
        os.chdir(here)
    if found.exception is not None and not isinstance(found.exception, SystemExit):
        raise found.exception
    if found.exit_code:
        raise ValueError(found.stderr or "no word is said, and the exit code is not 0")
    return found.stdout
