"""Reading a study file, one of the user's or one that is shipped: all that is wrong is said at once."""

import contextlib
import shlex
import shutil
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from lithobrake.files.reading import open_regular
from lithobrake.study.checks import problems
from lithobrake.study.ground_beds import laid_out
from lithobrake.study.ground_sections import SIZES
from lithobrake.study.refusals import sentences
from lithobrake.study.study import Study
from lithobrake.vocabulary.file_names import STUDY_FILE
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES
from lithobrake.vocabulary.plain_text import closest, visible

STUDIES, EXAMPLES = "scenarios", "examples"
# What an example needs beside itself, in the same folder.
BESIDE = {
    "ball_on_plate": ("ball_on_plate.py",),
    "ball_on_plate_campaign": ("ball_on_plate.py",),
    "notebook_first_study": ("ball_on_plate.py",),
    "notebook_own_solver": ("ball_on_plate_campaign.py", "ball_on_plate.py"),
    "notebook_reading_a_study": ("notebook_first_study.py", "ball_on_plate.py"),
    "philae": ("philae_bounce.csv",),
}


# The tables that are one of several distributions of sizes.
SIZED = ("bed.diameter", "bed.boulders.diameter")


@dataclass(frozen=True)
class Shipped:
    """A study or an example: its own file, and those that it needs beside it."""

    path: Path
    beside: tuple[Path, ...]

    @property
    def name(self) -> str:
        return self.path.stem

    @property
    def is_study(self) -> bool:
        return self.path.suffix == ".toml"

    @property
    def title(self) -> str:
        """What it is, on one line: the title of a study, the first words of a program or a notebook."""
        text = self.path.read_text(encoding="utf-8")
        if self.is_study:
            return str(tomllib.loads(text)["title"])
        lines = (line.strip('#" ').partition(":")[0] for line in text.splitlines() if not line.startswith("# %%"))
        return next(line for line in lines if line)

    def write(self, folder: Path) -> list[Path]:
        """Copy its files to a folder, and give their paths. Raises ValueError where one would replace another file.

        A file that is there already with the same content stays as it is.
        """
        pairs = [(path, folder / path.name) for path in (self.path, *self.beside)]
        # All targets are looked at before the first is written, so that a refusal leaves no half of an example behind.
        for source, target in pairs:
            if target.exists() and not (target.is_file() and target.read_bytes() == source.read_bytes()):
                raise ValueError(f"{target} exists, and is not replaced; rename it, or ask from another folder")
        for source, target in pairs:
            if not target.exists():
                shutil.copyfile(source, target)
        return [target for _, target in pairs]


def shipped() -> dict[str, Shipped]:
    """All studies, then all examples, by name."""
    paths = [*_folder(STUDIES).glob("*.toml"), *_folder(EXAMPLES).glob("*.toml"), *_folder(EXAMPLES).glob("*.py")]
    found: dict[str, Shipped] = {}
    for path in paths:
        # The program of a study has its name, and comes with it.
        if path.stem not in found:
            beside = tuple(path.with_name(name) for name in BESIDE.get(path.stem, ()))
            found[path.stem] = Shipped(path, beside)
    return dict(sorted(found.items(), key=lambda one: (not one[1].is_study, one[0])))


def shipped_by_name(name: str) -> Shipped:
    """The study or example of a name. Raises ValueError with the names that there are."""
    known = shipped()
    if name not in known:
        raise ValueError(f"NAME is {name!r}{closest(name, known)}; allowed: {', '.join(known)}")
    return known[name]


def shipped_studies() -> dict[str, Path]:
    """The study files by the names that run them."""
    return {name: one.path for name, one in shipped().items() if one.is_study}


def study_path(path: Path) -> Path:
    """The path of a study file as it is given; of a name that is no file, that of the shipped study of this name."""
    # A file of the user's wins over a shipped study of its name, and a path with a folder is never taken as a name.
    is_name = len(path.parts) == 1 and not path.is_file()
    return shipped_studies().get(path.name, path) if is_name else path


def _folder(name: str) -> Path:
    """Where files of a kind lie: inside the installed package, or at the top of the project that it is run from."""
    package = Path(__file__).parents[1]
    inside = package / "shipped" / name
    return inside if inside.is_dir() else package.parent / name


class StudyError(ValueError):
    """A study file that is refused; `problems` has one sentence for each thing wrong."""

    def __init__(self, problems: list[str]) -> None:
        # A name of the user's own may hold anything, line breaks among it.
        self.problems = [visible(problem) for problem in problems]
        super().__init__("\n".join(self.problems))


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
        with open_regular(path) as file:
            return file.read()
    except (OSError, ValueError) as error:
        said = error.strerror or error if isinstance(error, OSError) else error
        reason, remedy = f"the study file cannot be read ({said})", "name an existing TOML file"
        # Without a suffix it was likely meant as the name of a shipped study.
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


def check_tables(tables: Mapping[str, Any], folder: Path, name: str = STUDY_FILE, function: str | None = None) -> Study:
    """Make a study of the tables; `folder` is where relative paths in it count from.

    function: identity of a Python function that makes the touchdowns in place of the soil.
    Raises StudyError with one sentence for each problem.
    """
    try:
        # The checks below compare values of several keys, so they need all of them in the right types: they run only
        # where the schema has nothing to refuse.
        study = Study.model_validate(_absolute(tables, folder)).with_function(function).of_file(name)
    except ValidationError as error:
        found = [f"{name}: {text}" for text in sentences(_once(error.errors()), known_keys() | _keys_of_sizes())]
        raise StudyError(found) from error
    study, found = laid_out(study, _bed_of(tables))
    if found := [study.said(text) for text in found or problems(study)]:
        raise StudyError(found)
    return study


def _bed_of(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    bed = tables.get("bed")
    return bed if isinstance(bed, Mapping) else {}


def _keys_of_sizes() -> dict[str, tuple[str, ...]]:
    """The keys of each distribution of sizes, by the dotted name of the table and the distribution."""
    kinds = {get_args(kind.model_fields["distribution"].annotation)[0]: (*kind.model_fields,) for kind in SIZES}
    return {f"{path}.{name}": keys for path in SIZED for name, keys in kinds.items()}


def _once(errors: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The errors of the schema without those of a key of [delivery] in the table that it stands for."""
    told = [(error["loc"], error.get("input")) for error in errors]
    return [
        error
        for error in errors
        if error["loc"][:1] not in (("impact",), ("site",))
        or (("delivery", *error["loc"][1:]), error.get("input")) not in told
    ]


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
    if not isinstance(table, Mapping) or not isinstance(table.get(key), str):
        return table
    return {**table, key: str(folder / table[key])}


def _absolute(tables: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The tables with each path of a mesh, kernel, program or template counted from the folder of the study file."""
    # Nothing has been validated yet: what is of a wrong type is passed on as it is, for the schema to refuse it by its
    # key.
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

        # Quotes that do not match are refused by the checks (checks.py).
        with contextlib.suppress(ValueError):
            # The program is started in a folder of each run, where a relative path would lead elsewhere.
            solver["command"] = shlex.join(absolute_words(solver["command"], folder))
    return result
