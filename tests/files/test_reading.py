"""Files: damaged ones are named with the remedy, locks, formats, and hashes of the package's own code."""

import ast
import json
import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import h5py
import pytest

from lithobrake.files.atomic import atomic_path, lock_holder, locked, write_whole
from lithobrake.files.reading import NUMBER, DamagedFileError, check, parsed, read_json, read_rows, reading, source_hash

from ..syntax_trees import syntax_tree

FORM = {"files": {str: {"key": str}}, "wall_s": {str: NUMBER}, "names": [str]}
GOOD = {"files": {"a.csv": {"key": "1f"}}, "wall_s": {"bed": 1.5, "fly": 2}, "names": ["a"]}
DAMAGED = {"nothing": "", "no JSON": "{", "no text": b"\xff\xfe\x00", "a list": "[1, 2]", "a number": "3",
    "null": "null", "a table is a list": json.dumps(GOOD | {"files": []}),
    "an entry is a number": json.dumps(GOOD | {"files": {"a.csv": 3}}),
    "a name is a number": json.dumps(GOOD | {"names": [3]}),
    "a table is missing": json.dumps({"files": {}, "names": []}),
    "a number of 400 digits": json.dumps(GOOD).replace("1.5", "9" * 400),
    "a number of 5000 digits": json.dumps(GOOD).replace("1.5", "9" * 5000),
    "a number without end": json.dumps(GOOD).replace("1.5", "1e999"),
    "no number": json.dumps(GOOD).replace("1.5", "NaN"), "3000 brackets": "[" * 3000 + "]" * 3000,
    "3000 tables": '{"a":' * 3000 + "1" + "}" * 3000}  # fmt: skip


def test_what_is_of_the_form_is_read(tmp_path: Path) -> None:
    (tmp_path / "keys.json").write_text(json.dumps(GOOD | {"more": [None]}))
    assert read_json(tmp_path / "keys.json", FORM, "run again") == GOOD | {"more": [None]}


@pytest.mark.parametrize("text", DAMAGED.values(), ids=DAMAGED)
def test_a_damaged_json_file_is_one_sentence_with_its_name_and_the_remedy(text: str | bytes, tmp_path: Path) -> None:
    path = tmp_path / "keys.json"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(DamagedFileError) as refused:
        read_json(path, FORM, "run again")
    said = str(refused.value)
    assert said.startswith(f"{path} cannot be read (")
    assert said.endswith("); run again")
    assert len(said) < len(str(path)) + 200
    assert "\n" not in said


def test_what_is_not_of_the_form_is_named_by_its_keys() -> None:
    with pytest.raises(ValueError, match=r"files\.a\.csv\.key is 3, not of type str"):
        check(GOOD | {"files": {"a.csv": {"key": 3}}}, FORM)
    with pytest.raises(ValueError, match=r"files\.a\.csv lacks key"):
        check(GOOD | {"files": {"a.csv": {}}}, FORM)
    with pytest.raises(ValueError, match=r"names\[1\] is None"):
        check(GOOD | {"names": ["a", None]}, FORM)


def test_numbers_are_what_they_were() -> None:
    assert parsed('{"seed": 9007199254740993, "x": 0.1, "y": -1e-300}', {str: NUMBER}) == {"seed": 9007199254740993,
        "x": 0.1, "y": -1e-300}  # fmt: skip


def test_a_truncated_hdf5_file_and_one_without_a_dataset_are_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "samples.h5"
    with h5py.File(path, "w") as file:
        file["outputs"] = list(range(1000))
    lacks = pytest.raises(DamagedFileError, match=r"samples\.h5 cannot be read \(.*inputs")
    with lacks, reading(path, "run again"), h5py.File(path) as file:
        file["inputs"]
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(DamagedFileError, match=r"samples\.h5 cannot be read \(.*truncated"), reading(path, "run again"):
        h5py.File(path)


@pytest.mark.parametrize("text", ["", "a\n1\n", "a,b\n1,2\n3\n", "a,b\n1,2,3\n", 'a,b\n1,"2\n'])
def test_a_table_without_its_columns_or_with_half_a_row_is_one_sentence(text: str, tmp_path: Path) -> None:
    (tmp_path / "flights.csv").write_text(text)
    with pytest.raises(DamagedFileError, match=r"flights\.csv cannot be read \((it lacks|row \d has|unexpected end)"):
        read_rows(tmp_path / "flights.csv", ("a", "b"), "run again")


def test_a_sentence_is_said_once(tmp_path: Path) -> None:
    with pytest.raises(DamagedFileError) as refused, reading("outer", "no"), reading("inner", "run again"):
        raise TypeError("'int' object is not iterable")
    said = str(refused.value)
    assert said.startswith("inner ")
    assert said.endswith("; run again")
    assert "outer" not in said
    assert said.count("'int' object is not iterable") == 1


# What may stand at the path of a lock, beside a file that is not to be changed.
NO_LOCKS = {
    "notes": lambda path, victim: path.write_text("notes of mine\n"),
    "JSON": lambda path, victim: path.write_text('{"process": "mine"}'),
    "a long file": lambda path, victim: path.write_bytes(b" " * 10_000 + b"the end"),
    "a link": lambda path, victim: path.symlink_to(victim),
    "a hard link": lambda path, victim: path.hardlink_to(victim),
    "a link to nothing": lambda path, victim: path.symlink_to(victim.with_name("not there")),
    "a pipe": lambda path, victim: os.mkfifo(path),
    "a folder": lambda path, victim: path.mkdir(),
}


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such locks")
@pytest.mark.parametrize("make", NO_LOCKS.values(), ids=NO_LOCKS)
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


def test_a_file_without_a_folder_is_one_sentence(tmp_path):
    with pytest.raises(ValueError, match=r"p\.csv cannot be written \(there is no folder .*such\); make it"):
        write_whole(tmp_path / "no" / "such" / "p.csv", "")


def test_a_name_that_stands_twice_is_refused() -> None:
    with pytest.raises(ValueError, match="it has 'a' twice; write each name once"):
        parsed('{"b": {"a": 1, "a": 2}}', dict)


PACKAGE = Path(__file__).parents[2] / "lithobrake"


def written_formats() -> Iterator[str]:
    """What the package's code assigns to a constant FORMAT, or to the entry "format" of a file."""
    sources = {path: path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")}
    for path in (path for path, text in sources.items() if "FORMAT" in text or '"format"' in text):
        for node in ast.walk(syntax_tree(path)):
            if isinstance(node, ast.Assign):
                for target in node.targets:
                    yield from _formats(target, node.value)


def _formats(target: ast.expr, value: ast.expr) -> Iterator[str]:
    match target, value:
        case ast.Tuple(elts=targets), ast.Tuple(elts=values) if len(targets) == len(values):
            for one, other in zip(targets, values, strict=True):
                yield from _formats(one, other)
        case (
            (ast.Name(id="FORMAT") | ast.Subscript(slice=ast.Constant(value="format"))),
            ast.Constant(value=str(words)),
        ):
            yield words


def test_no_two_kinds_of_files_have_one_format() -> None:
    counts = Counter(written_formats())
    # Expansion, emulator, bed, landing and world at least.
    assert len(counts) >= 5
    assert set(counts.values()) == {1}


def test_each_part_of_the_code_has_a_hash_of_its_own() -> None:
    assert source_hash("files") != source_hash("files/reading.py") != source_hash("vocabulary")


def test_a_part_that_there_is_not_is_refused() -> None:
    with pytest.raises(ValueError, match=r"outputs\.py"):
        source_hash("files", "outputs.py")
