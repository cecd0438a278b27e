"""Kernels are compiled with what they call: they raise, are found by other processes, and have the same bits."""

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

import lithobrake.compilation.lighter_compilation as lighter_compilation
from lithobrake.compilation.compiled import CPUDispatcher
from lithobrake.compilation.lighter_compilation import InnerKernel, KernelFlags, is_known

KERNELS = """
from typing import NamedTuple
import numpy as np
from lithobrake.compilation.compiled import compiled, kernel, large_kernel

class Springs(NamedTuple):
    stiffness: np.ndarray
    length: np.ndarray

class Heap(NamedTuple):
    springs: Springs
    weight: np.ndarray

@kernel
def force(springs, i):
    if springs.length[i] < 0.0:
        raise ValueError("a spring is shorter than nothing")
    return springs.stiffness[i] * springs.length[i]

@large_kernel
def total(heap, start):
    result = 0.0
    for i in range(start, len(heap.weight)):
        share = force(heap.springs, i) / 3.0
        heap.weight[i] = share
        result += share
    return result

@compiled
def twice_total(heap):
    doubled = np.zeros(len(heap.weight))
    total(heap, 0)
    for i in range(len(doubled)):
        doubled[i] = 2.0 * heap.weight[i]
    return doubled, total(heap, 1)

def heap(shortest):
    length = np.linspace(0.1, 0.7, 5)
    length[2] = shortest
    return Heap(Springs(np.geomspace(1.0, 7.0, 5), length), np.zeros(5))
"""
CALLER = """
import logging, sys
logging.basicConfig(level=logging.INFO, format="%(message)s")
import numba, numba.core.event as event
if len(sys.argv) > 1:
    numba.__version__ = sys.argv[1]
from lithobrake.smallbody.test_kernels_of_springs import heap, twice_total
with event.install_recorder("numba:compile") as recorded:
    doubled, rest = twice_total(heap(0.3))
print(doubled.tobytes().hex(), float(rest).hex())
print(len([one for _, one in recorded.buffer if one.is_start]))
try:
    twice_total(heap(-1.0))
except ValueError as error:
    print(error)
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A copy of what compiles, with kernels in the place of those of smallbody."""
    room = tmp_path / "lithobrake"
    source = Path(lighter_compilation.__file__).parents[1]
    for name in ("compilation", "files", "__init__.py", "vocabulary"):
        target = room / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.symlink_to(source / name)
    (room / "smallbody").mkdir()
    (room / "smallbody" / "__init__.py").write_text("")
    (room / "smallbody" / "test_kernels_of_springs.py").write_text(KERNELS)
    return tmp_path


def call(package: Path, *versions: str) -> tuple[list[str], str]:
    """What a process of its own prints, and what it logs, with Numba as if it had another version."""
    environment = {**os.environ, "LITHOBRAKE_CACHE": str(package / "cache"), "PYTHONPATH": str(package)}
    ended = subprocess.run(
        [sys.executable, "-c", CALLER, *versions], env=environment, cwd=package, capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    return ended.stdout.splitlines(), ended.stderr


def test_another_process_finds_what_was_compiled_and_inner_kernels_raise(package):
    first, _ = call(package)
    again, told = call(package)
    assert int(first[1]) > 0
    assert again == [first[0], "0", "a spring is shorter than nothing"]
    assert first[2] == again[2]
    assert "Compiling" not in told


def test_another_version_of_numba_compiles_in_its_own_way_with_the_same_bits(package):
    lighter, _ = call(package)
    plain, told = call(package, "0.1000.0")
    assert "Numba 0.1000 with llvmlite" in told
    assert (plain[0], plain[2]) == (lighter[0], lighter[2])
    # Each kernel is then kept for kernels that call it, too.
    assert any("kernel-" in path.name for path in package.rglob("cache/**/*"))
    assert call(package, "0.1000.0")[0] == [plain[0], "0", plain[2]]


def test_this_numba_is_known_and_kernels_use_the_lighter_compilation():
    from lithobrake.dem.bodies.vectors import dot

    assert is_known()
    assert isinstance(dot.within, InnerKernel)
    assert not isinstance(CPUDispatcher(dot.py_func), InnerKernel)


def test_a_function_that_numba_compiles_in_its_own_way_can_call_a_kernel_with_kernels_below_it():
    from lithobrake.dem.narrow_phase.gjk import triangle_weights

    @numba.njit
    def nearest(a, b, c):
        return triangle_weights(a, b, c)

    corners = (1.0, -1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 0.0, 3.0)
    assert nearest(*corners) == triangle_weights(*corners) == (0.5, 0.5, 0.0)


def test_kernels_are_counted_as_they_are_compiled(package):
    """Two kernels stand below one, among three; what is compiled while nobody watches is not told."""
    counted = """
from lithobrake.compilation.compiled import watched
from lithobrake.smallbody.test_kernels_of_springs import heap, total, twice_total
with watched("smallbody", lambda done, count: print(done, count)):
    twice_total(heap(0.3))
total(heap(0.3), 0)
with watched("another", lambda done, count: print("never")):
    total(heap(0.3)._replace(weight=total.py_func.__globals__["np"].zeros(5, dtype="f4")), 0)
"""
    environment = {**os.environ, "LITHOBRAKE_CACHE": str(package / "cache"), "PYTHONPATH": str(package)}
    ended = subprocess.run(
        [sys.executable, "-c", counted], env=environment, cwd=package, capture_output=True, text=True, check=True
    )
    assert ended.stdout.splitlines() == ["1 3", "2 3", "3 3"]


def test_flags_are_equal_when_the_same_options_are_set():
    first, second = KernelFlags(), KernelFlags()
    assert first == second
    first.nrt = True
    assert first != second
    second.nrt = True
    assert first == second.copy()
    assert hash(first) == hash(second)
