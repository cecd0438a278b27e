"""Damaged files: whatever is wrong with one, the sentence names it and says what to do."""

import json
from pathlib import Path

import h5py
import pytest

from lithobrake.files.reading import NUMBER, DamagedFileError, check, parsed, read_json, read_rows, reading

FORM = {"files": {str: {"key": str}}, "wall_s": {str: NUMBER}, "names": [str]}
GOOD = {"files": {"a.csv": {"key": "1f"}}, "wall_s": {"bed": 1.5, "fly": 2}, "names": ["a"]}
DAMAGED = {
    "nothing": "", "no JSON": "{", "no text": b"\xff\xfe\x00", "a list": "[1, 2]", "a number": "3", "null": "null",
    "a table is a list": json.dumps(GOOD | {"files": []}),
    "an entry is a number": json.dumps(GOOD | {"files": {"a.csv": 3}}),
    "a name is a number": json.dumps(GOOD | {"names": [3]}),
    "a table is missing": json.dumps({"files": {}, "names": []}),
    "a number of 400 digits": json.dumps(GOOD).replace("1.5", "9" * 400),
    "a number of 5000 digits": json.dumps(GOOD).replace("1.5", "9" * 5000),
    "a number without end": json.dumps(GOOD).replace("1.5", "1e999"),
    "no number": json.dumps(GOOD).replace("1.5", "NaN"), "3000 brackets": "[" * 3000 + "]" * 3000,
    "3000 tables": '{"a":' * 3000 + "1" + "}" * 3000,
}  # fmt: skip


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
    assert parsed('{"seed": 9007199254740993, "x": 0.1, "y": -1e-300}', {str: NUMBER}) == {
        "seed": 9007199254740993, "x": 0.1, "y": -1e-300
    }  # fmt: skip


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
