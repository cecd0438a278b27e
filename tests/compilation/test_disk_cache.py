"""What is kept on disk counts only where nobody but this user can have written it, and touches no file of others."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

from lithobrake.compilation.cache_key import PLACE, user_key
from lithobrake.compilation.disk_cache import DiskCache

NAME = hashlib.sha256(b"a kernel").hexdigest()


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
    words = [sys.executable, "-c", "from lithobrake.compilation.cache_key import user_key; print(user_key().hex())"]
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
