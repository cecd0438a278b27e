"""The folder of a study as it is read: its files as they were made, its summary, its tables of rows."""

import json
import math
import os
import shlex
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from lithobrake.files.atomic import lock_holder
from lithobrake.files.reading import DamagedFileError, content_hash, read_json, read_rows, reading
from lithobrake.vocabulary import file_names
from lithobrake.vocabulary.quantities import JOURNEY, TOUCHDOWN_COST, Quantity, quantity

if TYPE_CHECKING:
    from pydantic import TypeAdapter

    from lithobrake.campaign import Record
    from lithobrake.results.table import Table

# What the folder notes about its files, what is held while a study is at work there, and the copy of its file.
KEYS, LOCK = "keys.json", ".lock"
JOURNEYS, TOUCHDOWNS, TOUCHDOWN_RUNS = file_names.JOURNEYS_FILE, file_names.TOUCHDOWNS_FILE, "designs/touchdowns.csv"
# Columns that every table of journeys has; one of an earlier version lacks attitudes.
NEEDED = tuple(name for name in JOURNEY if not name.startswith("attitude_"))
# Columns of the runs that the table of touchdowns has already.
_TWICE = ("input:journey", "input:touchdown", "key", "outcome")
SUMMARY_FORMAT = 5
# Columns that hold no numbers.
_WORDS = {"key", "design", "outcome", "reason", "status", "ground", "end", "body", "face", "soil"}
# Files of what samples of an emulator or an expansion came to, which a study without samples has none of.
OF_SAMPLES = (
    file_names.SAMPLES_FILE,
    file_names.SAMPLE_FLIGHTS_FILE,
    file_names.REST_FILE,
    file_names.EMULATOR_FILE,
    file_names.EXPLORER_FILE,
)
T = TypeVar("T")
# What reads and writes values of a kind.
_FORMS: dict[type, "TypeAdapter[Any]"] = {}


def folder_of_paths(folder: Path, remedy: str) -> Path:
    """From where relative paths count in the copy of a study: where its file lay, or the current folder for tables."""
    if not (folder / KEYS).is_file():
        return Path.cwd()
    notes = read_json(folder / KEYS, dict, remedy)
    with reading(folder / KEYS, remedy):
        # Notes of the first format name no study file.
        file = notes.get("study", {}).get("file", "")
        return (folder / file).resolve().parent if file else Path.cwd()


def intact_file(folder: Path, name: str, remedy: str) -> Path:
    """The path of a file of a folder, there or not.

    A file of which the folder notes nothing, as in an archive, is taken as it stands, and so is any other while a study
    is at work there and may be making it. Raises DamagedFileError, with the remedy, for one that changed after it was
    made, and for a folder, a pipe or a device in its place.
    """
    path, keys = folder / name, folder / KEYS
    # Reading a pipe waits for whoever writes to it, and some devices have no end.
    if path.exists() and not path.is_file():
        raise DamagedFileError(f"{path} cannot be read (it is no regular file); {remedy}")
    if not (path.is_file() and keys.is_file()) or lock_holder(folder / LOCK):
        return path
    notes = read_json(keys, dict, remedy)
    with reading(keys, remedy):
        noted = notes.get("study", {}) if name == file_names.STUDY_FILE else notes.get("files", {}).get(name, {})
        sha256 = noted.get("sha256")
    if sha256 and content_hash(path) != sha256:
        raise DamagedFileError(f"{path} changed after it was made, as its hash in {KEYS} tells; {remedy}")
    return path


def joined_touchdowns(
    touchdowns: Sequence[Mapping[str, Any]], runs: Iterable[Mapping[str, Any]], ledger: "Iterable[Record]"
) -> list[dict[str, Any]]:
    """Rows of touchdowns.csv, each with the inputs and outputs of its run, by its key, and what that cost.

    A touchdown whose run is in neither has nothing there.
    """
    by_key = {row["key"]: {name: cell for name, cell in row.items() if _of_run(name)} for row in runs}
    costs = {record.key: {name: _cost(record, name) for name in TOUCHDOWN_COST} for record in ledger}
    return [{**row, **by_key.get(row["key"], {}), **costs.get(row["key"], {})} for row in touchdowns]


def _of_run(name: str) -> bool:
    """Whether a column of a design is only in there."""
    return name.split(" ")[0] not in _TWICE


def _cost(record: "Record", name: str) -> float:
    value = getattr(record, name)
    return math.nan if value is None else float(value)


class StudyFiles:
    """A study's folder, for reading only."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """Look at a study's folder. Raises ValueError when it is none."""
        self.folder = Path(folder)
        if not any((self.folder / name).is_file() for name in (file_names.SUMMARY_FILE, KEYS, file_names.RUNS_FILE)):
            raise ValueError(f"{self.folder} holds no results of a study; name the folder of one that ran")
        self.remedy = f"make it again with: lithobrake run STUDY.toml --out {shlex.quote(str(self.folder))}"

    @cached_property
    def _content(self) -> dict[str, Any]:
        path, tables = self._file(file_names.SUMMARY_FILE), dict.fromkeys(("study", "results", "provenance"), dict)
        content: dict[str, Any] = read_json(path, {"format_version": int, **tables}, self.remedy)
        if content["format_version"] != SUMMARY_FORMAT:
            raise DamagedFileError(
                f"{path} has format {content['format_version']}; this version reads {SUMMARY_FORMAT}; {self.remedy}"
            )
        return content

    @property
    def study(self) -> dict[str, Any]:
        """The study as it was understood, with all defaults, as the tables of its file."""
        tables: dict[str, Any] = self._content["study"]
        return tables

    @cached_property
    def study_text(self) -> str:
        """The study file as it was written."""
        path = self._file(file_names.STUDY_FILE)
        with reading(path, self.remedy):
            return path.read_text(encoding="utf-8")

    def _noted_files(self) -> set[str]:
        """The files that the stages of the study make; none where the folder does not note them."""
        if not (self.folder / KEYS).is_file():
            return set()
        noted = read_json(self.folder / KEYS, dict, self.remedy)
        with reading(self.folder / KEYS, self.remedy):
            return {file for stage in noted.get("stages", {}).values() for file in stage["files"]}

    def _file(self, name: str) -> Path:
        """The path of a file of the folder, there or not.

        Raises ValueError for one that changed after it was made, and for one of samples where landings were followed.
        """
        if name in OF_SAMPLES and not (self.folder / name).is_file() and (self.folder / JOURNEYS).is_file():
            raise ValueError(
                f"{self.folder} has journeys of landings, and no samples of an emulator: ask for journeys or touchdowns"
            )
        return intact_file(self.folder, name, self.remedy)

    def _rows(self, name: str, columns: Sequence[str]) -> list[dict[str, Any]]:
        """The rows of a CSV file, numbers as numbers; columns: that it has to have."""
        path = self._file(name)
        with reading(path, self.remedy):
            return [
                {title: cell if title in _WORDS else float(cell or "nan") for title, cell in row.items()}
                for row in read_rows(path, columns, self.remedy)
            ]

    def _table(
        self, row: str, rows: Sequence[Mapping[str, Any]], first: Sequence[str], known: Mapping[str, Quantity]
    ) -> "Table":
        """A table of rows by title; a row that lacks a number has none there. first: columns that it has at least."""
        absent = {title: "" if title in _WORDS else math.nan for title in (*first, *(t for one in rows for t in one))}
        names = {title: title.removeprefix("input:").removeprefix("output:") for title in absent}
        columns = {names[title]: [one.get(title, none) for one in rows] for title, none in absent.items()}
        return self._described(row, columns, known)

    def _described(self, row: str, columns: Mapping[str, Any], known: Mapping[str, Quantity]) -> "Table":
        from lithobrake.results.table import Table

        return Table.of(row, {name: (quantity(name, known, self._units), values) for name, values in columns.items()})

    @cached_property
    def _units(self) -> dict[str, str]:
        from lithobrake.study.units import input_units

        return input_units()


def json_values(value: Any) -> Any:
    """Results as objects, lists, numbers, words and None. Raises ValueError for a value that is none of its field."""
    return _form(type(value)).dump_python(value, mode="json", by_alias=True, exclude_defaults=True, warnings="error")


def _form(kind: type[Any]) -> "TypeAdapter[Any]":
    """What reads and writes values of a kind, made once, as that takes a tenth of a second."""
    from pydantic import TypeAdapter

    if kind not in _FORMS:
        _FORMS[kind] = TypeAdapter(kind)
    return _FORMS[kind]


def results_in(kind: type[T], content: Any, place: str = "") -> T:
    """Results of a dataclass in JSON values, of the kind alone that its fields have.

    place: of the value in its file, "results". Raises KeyError for a key that is not there, with its place, and
    ValueError for a value that is none of its field.
    """
    from pydantic import ValidationError

    try:
        # Of a text a list may become a tuple, and nothing else another thing than it is.
        result: T = _form(kind).validate_json(json.dumps(content), strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        lacking = first["loc"][-1:] if first["type"] == "missing" else ()
        keys = _keys_to(content, first["loc"][: len(first["loc"]) - len(lacking)]) or []
        where = ".".join(map(str, [*([place] if place else []), *keys, *lacking]))
        if lacking:
            raise KeyError(where) from None
        raise ValueError(f"{where} is {first['input']!r}: {first['msg']}") from None
    return result


def _keys_to(content: Any, location: Sequence[int | str]) -> list[int | str] | None:
    """The keys that lead to a place in JSON values, which pydantic names by fields besides; None where none do."""
    if not location:
        return []
    first, rest = location[0], location[1:]
    if isinstance(first, int) if isinstance(content, list) else isinstance(content, dict) and first in content:
        found = _keys_to(content[first], rest)
        if found is not None:
            return [first, *found]
    return _keys_to(content, rest) if rest else None
