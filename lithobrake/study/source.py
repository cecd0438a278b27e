"""A study with where it comes from, and a study at given numbers."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from lithobrake.study.body_checks import body_problems, rotation_problems
from lithobrake.study.checks import landing_problems
from lithobrake.study.lander_section import PartSection
from lithobrake.study.quantity import is_number
from lithobrake.study.reader import StudyError, check_tables, known_keys, parse_tables, read_bytes, study_path
from lithobrake.study.refusals import sentences
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import closest, show
from lithobrake.vocabulary.quantities import ORIENTATION

# What a study of tables is called in messages, and the stem of its folder.
TABLES = "study"
# No key takes more levels of tables and lists.
DEEPEST = 10
INPUTS, SITE = "solver.inputs.", "site."


@dataclass(frozen=True)
class StudySource:
    """A study that was read and checked; tables: as written; content: of its file; path: of that, None for tables."""

    study: Study
    tables: Mapping[str, Any]
    content: bytes
    path: Path | None

    @classmethod
    def read(cls, path: Path, function: str | None = None, folder: Path | None = None) -> "StudySource":
        """Read a study file, or the shipped study of a name.

        function: identity of a Python function that makes the touchdowns in place of the soil. folder: from which
        relative paths count, where the file is a copy; None: its own.

        Raises StudyError with one sentence for each problem.
        """
        path = study_path(path)
        content = read_bytes(path)
        tables = parse_tables(path, content)
        return cls(check_tables(tables, folder or path.resolve().parent, path.name, function), tables, content, path)

    @classmethod
    def of_tables(cls, tables: Mapping[str, Any], function: str | None = None) -> "StudySource":
        """Check the tables of a study; relative paths in them count from the current folder.

        Values may also be paths, and scalars and arrays of NumPy. Raises StudyError.
        """
        import tomli_w

        plain = plain_tables(tables, f"{TABLES}.toml")
        # Tables are turned into a file, since a folder is matched to its study by a copy with the same bytes.
        study = check_tables(plain, Path.cwd(), function=function)
        return cls(study, plain, tomli_w.dumps(plain).encode(), None)

    @property
    def name(self) -> str:
        """The name that messages use."""
        return f"{TABLES}.toml" if self.path is None else self.path.name

    @property
    def stem(self) -> str:
        """The name without its suffix."""
        return TABLES if self.path is None else self.path.stem


def plain_tables(tables: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The same in dicts, lists, text and Python's own numbers; those of NumPy and paths are turned into these.

    name: that messages use. Raises StudyError that names the first key with a value of another type.
    """
    plain = _plain(tables, "", name, DEEPEST)
    assert isinstance(plain, dict)
    return plain


def _plain(value: Any, key: str, name: str, levels: int) -> Any:
    """One value, at a dotted key, in so many more levels."""
    import numpy as np

    if isinstance(value, np.ndarray | np.generic):
        # Those of long doubles give themselves.
        value = float(value) if isinstance(value, np.longdouble) else value.tolist()
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    # Tables that hold themselves would go on for ever.
    if levels == 0:
        raise StudyError([f"{name}: {key} is nested too deeply; no key takes more than a few levels"])
    if isinstance(value, Mapping):
        for inner in value:
            if not isinstance(inner, str):
                raise StudyError([f"{name}: {key or 'the study'} has the key {inner!r}; allowed: names in text"])
            _text(inner, f"a key of {key or 'the study'}", name)
        return {inner: _plain(entry, _dotted(key, inner), name, levels - 1) for inner, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry, _dotted(key, str(place)), name, levels - 1) for place, entry in enumerate(value)]
    if isinstance(value, str):
        return _text(value, key, name)
    if isinstance(value, bool | int | float):
        return value
    raise StudyError(
        [
            f"{name}: {key} is {show(value)}, of the type {type(value).__name__}; allowed: numbers, text, true or "
            "false, and lists and tables of these; convert it, say by float() or str()"
        ]
    )


def _text(value: str, key: str, name: str) -> str:
    if any("\ud800" <= letter <= "\udfff" for letter in value):
        raise StudyError([f"{name}: {key} is {show(value)}, which UTF-8 cannot hold; leave out lone surrogates"])
    return value


def _dotted(key: str, inner: str) -> str:
    return f"{key}.{inner}" if key else inner


def fixed_study(study: Study, values: Mapping[str, Any]) -> Study:
    """The study with these numbers in place of what its file has, uncertain or not.

    values: by dotted key, in the units of the study file: all that a landing reads, with place and attitude of the run
    and without its bed; or all numbers of the site that a flight reads, for which kernels may stand otherwise.
    Raises StudyError where the study file would be refused with one of them, or none of them would be read.
    """
    tables: dict[str, Any] = {name: _table(getattr(study, name)) for name in type(study).model_fields}
    unread = [key for key in values if key.startswith(INPUTS) and key.removeprefix(INPUTS) not in study.solver.inputs]
    if unread:
        raise StudyError([_unread(key, [f"{INPUTS}{name}" for name in study.solver.inputs]) for key in unread])
    # What it says stands in other tables too, which the numbers are put into.
    tables["delivery"] = None
    for key, value in values.items():
        _put(tables, key, value)
    try:
        # Through the schema and the checks of a study file: a number of a client or of --set is refused in the same
        # words.
        fixed = Study.model_validate(tables).with_function(study.function)
    except ValidationError as error:
        raise StudyError(sentences(error.errors(), known_keys())) from error
    loose = [f"{key} is {show(value)}; allowed: one number" for key, value in values.items() if not is_number(value)]
    if loose:
        raise StudyError(loose)
    # A landing reads nothing of the site, and a flight nothing else.
    of_site = all(key.startswith(SITE) for key in values)
    read = list(fixed.site_values()) if of_site else [*fixed.touchdown_values(), *ORIENTATION]
    between = (rotation_problems, body_problems) if of_site else (landing_problems,)
    found = [_unread(key, read) for key in values if key not in read]
    found = found or [problem for problems in between for problem in problems(fixed)]
    if found:
        raise StudyError(found)
    return fixed


def _table(section: Any) -> Any:
    if not isinstance(section, BaseModel):
        return section
    return {name: getattr(section, name) for name in type(section).model_fields}


def _put(tables: dict[str, Any], key: str, value: Any) -> None:
    section, _, name = key.partition(".")
    table = tables.setdefault(section, {})
    if not isinstance(table, dict):
        raise StudyError([_unread(key, [])])
    if key in ORIENTATION:
        given = table["orientation"]
        attitude = [1.0, 0.0, 0.0, 0.0] if isinstance(given, str) else list(given)
        attitude[ORIENTATION.index(key)] = value
        # What is given is the attitude that was drawn with the error.
        table |= {"orientation": attitude, "pointing_error_deg": None}
    elif name.startswith("place."):
        table |= {"place": {**(_table(table["place"]) or {}), name.removeprefix("place."): value}, "region": None}
    elif name.startswith("centre_of_mass."):
        centre = _table(table["centre_of_mass"]) or {}
        table["centre_of_mass"] = {**centre, name.removeprefix("centre_of_mass."): value}
    elif name.startswith("part."):
        part, _, inner = name.removeprefix("part.").partition(".")
        if part not in table["part"] or inner not in PartSection.model_fields:
            raise StudyError([_unread(key, [])])
        table["part"] = {**table["part"], part: {**_table(table["part"][part]), inner: value}}
    elif key.startswith(INPUTS):
        table["inputs"] = {**table["inputs"], key.removeprefix(INPUTS): value}
    elif section == "site":
        # A number next to kernels that give it would be refused as given twice.
        table |= {name: value, "kernels": [], "kernel_body": None, "epoch": None}
    else:
        table[name] = value


def _unread(key: str, read: list[str]) -> str:
    return f"{key} is not read here{closest(key, read)}; allowed: the numbers of a run by the keys of the study file"
