"""A lock is a file of lithobrake's own: whatever else has its name is left as it is, and refused."""

import json
import os
from pathlib import Path

import pytest

from lithobrake.files.atomic import atomic_path, lock_holder, locked


def as_notes(path: Path, victim: Path) -> None:
    path.write_text("notes of mine\n")


def as_json(path: Path, victim: Path) -> None:
    path.write_text('{"process": "mine"}')


def as_long_file(path: Path, victim: Path) -> None:
    path.write_bytes(b" " * 10_000 + b"the end")


def as_link(path: Path, victim: Path) -> None:
    path.symlink_to(victim)


def as_hard_link(path: Path, victim: Path) -> None:
    path.hardlink_to(victim)


def as_link_to_nothing(path: Path, victim: Path) -> None:
    path.symlink_to(victim.with_name("not there"))


def as_pipe(path: Path, victim: Path) -> None:
    os.mkfifo(path)


def as_folder(path: Path, victim: Path) -> None:
    path.mkdir()


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such locks")
@pytest.mark.parametrize(
    "make", [as_notes, as_json, as_long_file, as_link, as_hard_link, as_link_to_nothing, as_pipe, as_folder]
)
def test_what_is_no_lock_is_refused_and_left_as_it_is(tmp_path, make):
    victim, path = tmp_path / "victim.txt", tmp_path / ".lock"
    victim.write_text("a file outside the folder")
    make(path, victim)
    before = path.lstat(), path.read_bytes() if path.is_file() else b""
    with pytest.raises(ValueError, match=r"\.lock is .*no lock of lithobrake; move it away"), locked(path, "busy"):
        pass
    assert victim.read_text() == "a file outside the folder"
    after = path.lstat(), path.read_bytes() if path.is_file() else b""
    assert (after[0].st_mtime_ns, after[0].st_mode, after[1]) == (before[0].st_mtime_ns, before[0].st_mode, before[1])
    assert not (tmp_path / "not there").exists()


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such locks")
@pytest.mark.parametrize("content", [b"", b"\0" * 1024, json.dumps({"process": 1, "host": "a"}).ljust(1024).encode()])
def test_a_lock_that_was_left_behind_is_taken(tmp_path, content):
    path = tmp_path / ".lock"
    path.write_bytes(content)
    with locked(path, "busy") as note:
        note(stage="bed")
        holder = lock_holder(path)
        assert (holder["process"], holder["stage"]) == (os.getpid(), "bed")
        assert len(path.read_bytes()) == 1024
    assert lock_holder(path) is None


def test_a_folder_is_no_name_for_a_file(tmp_path):
    with pytest.raises(ValueError, match="is a folder; name a file"), atomic_path(tmp_path) as draft:
        draft.write_text("never written")
    assert list(tmp_path.parent.glob(f".{tmp_path.name}*")) == []
