"""Reading a study file: all that is wrong with it is said at once, before anything runs."""

import contextlib
import shlex
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from lithobrake.study.checks import problems
from lithobrake.study.flight_sections import BUILT_IN_BODIES
from lithobrake.study.refusals import sentences
from lithobrake.study.shipped import shipped_studies, study_path
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import closest


class StudyError(ValueError):
    """A study file that is refused; `problems` has one sentence for each thing wrong."""

    def __init__(self, problems: list[str]) -> None:
        """Join the sentences to one message."""
        super().__init__("\n".join(problems))
        self.problems = problems


def read_study(path: Path) -> Study:
    """Read and check a study file, or the shipped study of a name; paths of meshes in it become absolute.

    Raises StudyError with one sentence for each problem.
    """
    path = study_path(path)
    return check_tables(load_tables(path), folder=path.resolve().parent, name=path.name)


def load_tables(path: Path) -> dict[str, Any]:
    """Read the tables of a TOML file as they stand. Raises StudyError when it is not there or is not TOML."""
    return parse_tables(path, read_bytes(path))


def read_bytes(path: Path) -> bytes:
    """Read a study file as it lies on the disk. Raises StudyError when it is not there."""
    try:
        return path.read_bytes()
    except OSError as error:
        reason, remedy = f"the study file cannot be read ({error.strerror or error})", "name an existing TOML file"
        if not path.suffix:
            known = shipped_studies()
            reason += closest(path.name, known)
            remedy += f", or a study that comes with the package: {', '.join(known)}"
        raise StudyError([f"{path}: {reason}; {remedy}"]) from error


def parse_tables(path: Path, content: bytes) -> dict[str, Any]:
    """The tables of a study file with this content. Raises StudyError when it is not TOML."""
    try:
        # Some editors begin a file with a mark of its encoding, which "utf-8-sig" takes off.
        return tomllib.loads(content.decode("utf-8-sig"))
    except tomllib.TOMLDecodeError as error:
        raise StudyError([f"{path.name}: this is not TOML: {error}; mend that line"]) from error
    except UnicodeDecodeError as error:
        byte = f"byte {error.start + 1} is 0x{error.object[error.start]:02x}"
        raise StudyError([f"{path.name}: this is not text in UTF-8, {byte}; save it in that encoding"]) from error
    except RecursionError as error:
        raise StudyError(
            [f"{path.name}: brackets are nested too deeply; no key takes more than a few levels"]
        ) from error
    except ValueError as error:
        # What is left are whole numbers so long that Python refuses to read them.
        raise StudyError(
            [f"{path.name}: it holds a number of thousands of digits; no key takes that: cut it"]
        ) from error


def check_tables(
    tables: Mapping[str, Any], folder: Path, name: str = "study.toml", function: str | None = None
) -> Study:
    """Make a study of the tables; `folder` is where relative paths in it count from.

    function: identity of a Python function that makes the touchdowns in place of the soil.
    Raises StudyError with one sentence for each problem.
    """
    try:
        study = Study.model_validate(_absolute(tables, folder)).with_function(function)
    except ValidationError as error:
        raise StudyError([f"{name}: {text}" for text in sentences(error.errors(), known_keys())]) from error
    found = [f"{name}: {text}" for text in problems(study)]
    if found:
        raise StudyError(found)
    return study


def known_keys() -> dict[str, tuple[str, ...]]:
    """The keys of each table, by the table's dotted name ("" for the top)."""
    keys: dict[str, tuple[str, ...]] = {}
    for table, names in _tables("", Study):
        # A table of several kinds takes the keys of all of them.
        keys[table] = tuple(dict.fromkeys((*keys.get(table, ()), *names)))
    return keys


def _tables(path: str, model: type[BaseModel]) -> Iterator[tuple[str, tuple[str, ...]]]:
    yield path, tuple(model.model_fields)
    for name, field in model.model_fields.items():
        for kind in (field.annotation, *get_args(field.annotation)):
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                yield from _tables(f"{path}.{name}".lstrip("."), kind)


def _with_file(table: Any, folder: Path, key: str = "file") -> Any:
    """A table whose file, if it has one, is counted from a folder."""
    if not isinstance(table, Mapping) or not isinstance(table.get(key), str):
        return table
    return {**table, key: str(folder / table[key])}


def _absolute(tables: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The tables with each path of a mesh, kernel, program or template counted from the folder of the study file."""
    result = {key: dict(value) if isinstance(value, Mapping) else value for key, value in tables.items()}
    for section, key in (("lander", "file"), ("site", "body"), ("delivery", "states")):
        table = result.get(section)
        if not isinstance(table, dict) or not isinstance(table.get(key), str):
            continue
        # A proper name may begin with a capital.
        is_built_in = key == "body" and table[key].lower() in BUILT_IN_BODIES
        table[key] = table[key].lower() if is_built_in else str(folder / table[key])
    lander = result.get("lander")
    if isinstance(lander, dict) and isinstance(lander.get("part"), Mapping):
        lander["part"] = {name: _with_file(part, folder) for name, part in lander["part"].items()}
    for section, key in (("solver", "templates"), ("site", "kernels")):
        table = result.get(section)
        if isinstance(table, dict) and isinstance(table.get(key), list):
            table[key] = [str(folder / name) if isinstance(name, str) else name for name in table[key]]
    soil = result.get("soil")
    if isinstance(soil, dict):
        result["soil"] = {name: _with_file(region, folder, "facets") for name, region in soil.items()}
    sky = result.get("sky")
    if isinstance(sky, dict) and isinstance(orbiter := sky.get("orbiter"), Mapping):
        states = orbiter.get("states")
        sky["orbiter"] = {**orbiter, **({"states": str(folder / states)} if isinstance(states, str) else {})}
    solver = result.get("solver")
    if isinstance(solver, dict) and isinstance(solver.get("command"), str):
        from lithobrake.campaign import absolute_words

        # Quotes that do not match are told by study_checks.
        with contextlib.suppress(ValueError):
            solver["command"] = shlex.join(absolute_words(solver["command"], folder))
    return result
