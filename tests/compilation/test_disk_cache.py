"""Kernels on disk that nobody but this user can have written, and that are compiled with what they call."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

import lithobrake.compilation.lighter_compilation as lighter_compilation
from lithobrake.compilation.compiled import CPUDispatcher
from lithobrake.compilation.disk_cache import PLACE, DiskCache, user_key
from lithobrake.compilation.lighter_compilation import InnerKernel, KernelFlags, is_known

NAME = hashlib.sha256(b"a kernel").hexdigest()
# A newer Numba than the known ones is to fail here, so that it is looked at; an older one compiles in its own way.
LIGHTER = pytest.mark.skipif(
    tuple(map(int, numba.__version__.split(".")[:2])) < (0, 68), reason="Numba before 0.68 compiles in its own way"
)


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty home, and the current folder beside it."""
    for folder in ("home", "here"):
        (tmp_path / folder).mkdir()
    for variable in ("LITHOBRAKE_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path / "home"


def prepare(folder: Path, content: bytes) -> None:
    """A file as anyone can make it, who knows how a cache is laid out but not the key of this user."""
    folder.mkdir(mode=0o700, parents=True)
    (folder / NAME).write_bytes(content + hashlib.sha256(NAME.encode() + b"\0" + content).digest())
    (folder / NAME).chmod(0o600)


@pytest.mark.parametrize("variable", ["LITHOBRAKE_CACHE", "XDG_CACHE_HOME"])
@pytest.mark.parametrize("root", ["cache", "./cache", "../here/cache"])
def test_nothing_that_lies_in_the_current_folder_is_read(home, monkeypatch, variable, root):
    prepare(Path("cache/lithobrake/dem-1"), b"prepared")
    monkeypatch.setenv(variable, root)
    cache = DiskCache("dem-1")
    assert cache.read(NAME) is None
    cache.write(NAME, b"made")
    assert (Path("cache/lithobrake/dem-1") / NAME).read_bytes().startswith(b"prepared")


def test_a_relative_root_is_refused_and_one_of_xdg_ignored(home, monkeypatch, caplog):
    monkeypatch.setenv("XDG_CACHE_HOME", "cache")
    assert DiskCache("dem-1").folder == home / ".cache/lithobrake/dem-1"
    assert caplog.messages == []
    monkeypatch.setenv("LITHOBRAKE_CACHE", "cache")
    assert DiskCache("dem-1").folder is None
    (told,) = caplog.messages
    assert "LITHOBRAKE_CACHE is 'cache'; allowed: an absolute path" in told
    monkeypatch.setenv("LITHOBRAKE_CACHE", "~/kept")
    assert DiskCache("dem-1").folder == home / "kept/lithobrake/dem-1"


def test_a_file_that_came_with_a_download_is_made_again(home, monkeypatch, caplog):
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(Path("cache").absolute()))
    prepare(Path("cache/lithobrake/dem-1"), b"prepared")
    cache = DiskCache("dem-1")
    assert cache.read(NAME) is None
    assert "was not written with this user's key: it is made again." in caplog.messages[0]
    cache.write(NAME, b"made")
    assert DiskCache("dem-1").read(NAME) == b"made"
    # Nor does what another user, with another key, has signed.
    (home / PLACE).unlink()
    assert DiskCache("dem-1").read(NAME) is None


@pytest.mark.parametrize("level", ["", "lithobrake", "lithobrake/dem-1"])
def test_every_level_is_closed_to_others(home, monkeypatch, caplog, level):
    root = home / "cache"
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(root))
    folder = DiskCache("dem-1").folder
    assert folder is not None
    (root / level).chmod(0o770)
    assert DiskCache("dem-1").folder is None
    assert caplog.messages[-1].startswith(f"{root / level} belongs to another user or can be written by others, so")
    # In a sticky folder nobody removes what is another's; where the files themselves lie nobody else may write at all.
    (root / level).chmod(0o1777)
    assert DiskCache("dem-1").folder == (None if level.endswith("dem-1") else folder)


def test_the_key_is_made_once_and_for_this_user_alone(home):
    key = user_key()
    assert len(key) == 32
    assert user_key() == key
    assert (home / PLACE).stat().st_mode & 0o777 == 0o600
    assert [path.name for path in (home / PLACE).parent.iterdir()] == [PLACE.name]


def test_processes_that_start_together_have_one_key(home):
    words = [sys.executable, "-c", "from lithobrake.compilation.disk_cache import user_key; print(user_key().hex())"]
    processes = [subprocess.Popen(words, env=os.environ, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert {process.communicate()[0].strip() for process in processes} == {user_key().hex()}


def spoil_by_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such modes")
@pytest.mark.parametrize(("spoil", "word"), [
    (lambda path: path.chmod(0o640), "can be read by others; delete it"),
    (lambda path: path.write_bytes(b"short"), "has 5 bytes for 32; delete it"),
    (spoil_by_pipe, "is no regular file"),
])  # fmt: skip
def test_a_key_that_is_none_keeps_nothing_and_says_so(home, caplog, spoil, word):
    user_key()
    spoil(home / PLACE)
    cache = DiskCache("dem-1")
    cache.write(NAME, b"made")
    assert cache.read(NAME) is None
    (told,) = caplog.messages
    assert word in told


def test_a_folder_in_the_place_of_a_file_keeps_the_others(home, caplog):
    cache = DiskCache("beds")
    (cache.folder / NAME).mkdir()
    cache.write(NAME, b"made")
    assert "is a folder" in caplog.messages[-1]
    cache.write("another", b"made")
    assert cache.read("another") == b"made"


def test_without_a_home_nothing_is_kept(home, monkeypatch, caplog):
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(home / "cache"))
    (home / "file").write_text("no folder")
    monkeypatch.setenv("HOME", str(home / "file"))
    assert DiskCache("dem-1").folder is None
    assert "there is no key to sign files with" in caplog.messages[0]
    monkeypatch.setenv("HOME", "here")
    assert DiskCache("dem-1").folder is None
    assert "HOME is 'here'; allowed: an absolute path" in caplog.messages[1]


def test_room_is_made_of_what_the_library_keeps_alone(home):
    folder = DiskCache("beds").folder
    ours = [hashlib.sha256(bytes([number])).hexdigest() for number in range(3)]
    foreign = {"scan.raw": b"0" * 2000, ".notes": b"1" * 2000, f"{ours[0]}.h5": b"2" * 2000, f".{ours[0]}": b"3" * 2000}
    for name, content in foreign.items():
        (folder / name).write_bytes(content)
        os.utime(folder / name, (1.6e9, 1.6e9))
    (folder / ours[2]).mkdir()
    library = DiskCache("beds", limit=1500)
    for number, name in enumerate(ours[:2]):
        library.write(name, b"x" * 1000)
        os.utime(folder / name, (1.7e9 + number,) * 2)
    library.write(ours[1], b"x" * 1000)
    assert {name: (folder / name).read_bytes() for name in foreign} == foreign
    assert (folder / ours[2]).is_dir()
    assert not (folder / ours[0]).exists()
    assert library.read(ours[1]) == b"x" * 1000


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes")
def test_a_pipe_or_a_device_in_place_of_a_file_is_not_waited_for(home, caplog):
    cache = DiskCache("dem-1")
    cache.write(NAME, b"a kernel")
    path = home / ".cache" / "lithobrake" / "dem-1" / NAME
    for put in (lambda: os.mkfifo(path), lambda: path.symlink_to("/dev/zero")):
        path.unlink()
        put()
        assert cache.read(NAME) is None
        assert "cannot be read (it is no regular file): it is made again" in caplog.messages[-1]


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


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of what compiles, with kernels in the place of those of smallbody."""
    folder = tmp_path_factory.mktemp("package")
    room = folder / "lithobrake"
    source = Path(lighter_compilation.__file__).parents[1]
    for name in ("compilation", "files", "__init__.py", "__init__.pyi", "vocabulary"):
        target = room / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.symlink_to(source / name)
    (room / "smallbody").mkdir()
    (room / "smallbody" / "__init__.py").write_text("")
    (room / "smallbody" / "test_kernels_of_springs.py").write_text(KERNELS)
    return folder


def call(package: Path, *versions: str) -> tuple[list[str], str]:
    """What a process of its own prints, and what it logs, with Numba as if it had another version."""
    environment = {**os.environ, "LITHOBRAKE_CACHE": str(package / "cache"), "PYTHONPATH": str(package)}
    ended = subprocess.run([sys.executable, "-c", CALLER, *versions], env=environment, cwd=package, capture_output=True,
        text=True, check=True)  # fmt: skip
    return ended.stdout.splitlines(), ended.stderr


@pytest.fixture(scope="module")
def first(package: Path) -> list[str]:
    """What the first process prints, which compiles."""
    return call(package)[0]


def test_another_process_finds_what_was_compiled_and_inner_kernels_raise(package, first):
    again, told = call(package)
    assert int(first[1]) > 0
    assert again == [first[0], "0", "a spring is shorter than nothing"]
    assert first[2] == again[2]
    assert "Compiling" not in told


@LIGHTER
def test_another_version_of_numba_compiles_in_its_own_way_with_the_same_bits(package, first):
    assert not any("kernel-" in path.name for path in package.rglob("cache/**/*"))
    plain, told = call(package, "0.1000.0")
    assert "Numba 0.1000 with llvmlite 0.50 compiles in its own way, which takes twice as long" in told
    assert "install Numba 0.68 with llvmlite 0.50." in told
    assert (plain[0], plain[2]) == (first[0], first[2])
    # Each kernel is then kept for kernels that call it, too.
    assert any("kernel-" in path.name for path in package.rglob("cache/**/*"))
    assert call(package, "0.1000.0")[0] == [plain[0], "0", plain[2]]


@LIGHTER
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


@LIGHTER
def test_kernels_are_counted_as_they_are_compiled(package, tmp_path):
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
    environment = {**os.environ, "LITHOBRAKE_CACHE": str(tmp_path / "cache"), "PYTHONPATH": str(package)}
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
