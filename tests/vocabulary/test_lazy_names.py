"""Faces whose names are imported late: light to import, complete, and no way round to their own files."""

import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "lithobrake"
FACES = sorted(
    ".".join(path.relative_to(PACKAGE.parent).parts[:-1])
    for path in PACKAGE.rglob("__init__.py")
    if "lazy_loader.attach_stub" in path.read_text(encoding="utf-8")
)
IMPORT_FACES = f"""
import sys
import {", ".join(FACES)}
known = set(sys.modules)
for face in {FACES}:
    assert not hasattr(sys.modules[face], "a_file_of_the_part")
print({{name for name in set(sys.modules) - known if name.startswith("lithobrake")}})
print({{"numpy", "scipy", "sklearn", "numba", "pydantic", "h5py", "matplotlib"}} & set(sys.modules))
"""


def test_faces_import_nothing_until_a_name_is_used() -> None:
    # Neither does a name that is not theirs, as that of a file which is about to be imported.
    finished = subprocess.run([sys.executable, "-c", IMPORT_FACES], capture_output=True, text=True)
    assert (finished.stdout, finished.stderr) == ("set()\nset()\n", "")


@pytest.mark.parametrize("face", FACES)
def test_every_listed_name_is_found(face: str) -> None:
    module = import_module(face)
    names = [name for name in module.__all__ if name != "__version__"]
    assert names == dir(module) == sorted(names)
    assert all(getattr(getattr(module, name), "__name__", name) == name for name in names)


def test_all_names_come_with_a_star() -> None:
    found: dict[str, object] = {}
    exec("from lithobrake.chaos import *", found)
    assert set(import_module("lithobrake.chaos").__all__) <= set(found)
