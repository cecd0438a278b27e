"""Reading a study file: all that is wrong with it is said at once, before anything runs."""

import contextlib
import math
import shlex
import shutil
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from lithobrake.campaign import absolute_words
from lithobrake.quantity import Scalar, Uncertain, uncertain
from lithobrake.study import BUILT_IN_BODIES, Study
from lithobrake.wording import sentences

# A bed narrower than this many lander diameters would hold the lander between its walls.
BED_WIDTH_PER_LANDER = 2.0
# Fewer grains across are no bed.
BED_WIDTH_PER_GRAIN = 3.0


class StudyError(ValueError):
    """A study file that is refused; `problems` has one sentence for each thing wrong."""

    def __init__(self, problems: list[str]) -> None:
        """Join the sentences to one message."""
        super().__init__("\n".join(problems))
        self.problems = problems


def read(path: Path) -> Study:
    """Read and check a study file; paths of meshes in it become absolute.

    Raises StudyError with one sentence for each problem.
    """
    return check(load(path), folder=path.resolve().parent, name=path.name)


def load(path: Path) -> dict[str, Any]:
    """Read the tables of a TOML file as they stand. Raises StudyError when it is not there or is not TOML."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise StudyError([f"{path.name}: this is not TOML: {error}; mend that line"]) from error
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError([f"{path}: the study file cannot be read ({error}); name an existing TOML file"]) from error


def check(tables: Mapping[str, Any], folder: Path, name: str = "study.toml") -> Study:
    """Make a study of the tables; `folder` is where relative paths in it count from.

    Raises StudyError with one sentence for each problem.
    """
    try:
        study = Study.model_validate(_absolute(tables, folder))
    except ValidationError as error:
        raise StudyError([f"{name}: {text}" for text in sentences(error.errors(), known_keys())]) from error
    study, problems = _with_site_gravity(study)
    problems = [f"{name}: {text}" for text in (*problems, *_problems(study))]
    if problems:
        raise StudyError(problems)
    return study


def _with_site_gravity(study: Study) -> tuple[Study, list[str]]:
    """The study with the acceleration at its site where it asks for that, and what stands in the way."""
    if study.surface.gravity != "site":
        return study, []
    from lithobrake.site import with_site_gravity

    # A stand-in, so that the other checks can go on.
    stand_in = study.model_copy(update={"surface": study.surface.model_copy(update={"gravity": 1.0})})
    if list(_site_problems(study)):
        return stand_in, []
    try:
        return with_site_gravity(study), []
    except ValueError as error:
        return stand_in, [f"surface.gravity: {error}"]


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


def _absolute(tables: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The tables with each mesh path counted from the folder of the study file."""
    result = {key: dict(value) if isinstance(value, Mapping) else value for key, value in tables.items()}
    for section, key in (("lander", "file"), ("site", "body")):
        table = result.get(section)
        if isinstance(table, dict) and isinstance(table.get(key), str) and table[key] not in BUILT_IN_BODIES:
            table[key] = str(folder / table[key])
    solver = result.get("solver")
    if isinstance(solver, dict) and isinstance(solver.get("command"), str):
        # Quotes that do not match are told by _solver_problems.
        with contextlib.suppress(ValueError):
            solver["command"] = shlex.join(absolute_words(solver["command"], folder))
    return result


def _problems(study: Study) -> Iterator[str]:
    """What is wrong between keys that are each right in themselves."""
    yield from _shape_problems(study)
    yield from _grain_problems(study)
    yield from _place_problems(study)
    yield from _design_problems(study)
    yield from _solver_problems(study)
    gravity = study.surface.gravity
    if study.bed.settle_gravity is None and not isinstance(gravity, str) and _reach(gravity)[0] <= 0:
        yield (
            "surface.gravity reaches zero or points outward, and no bed settles under that; "
            "give bed.settle_gravity an inward value, say 2e-5 m/s2 (the touchdown keeps surface.gravity)"
        )
    yield from _site_problems(study)


def _site_problems(study: Study) -> Iterator[str]:
    if study.site.body not in BUILT_IN_BODIES:
        if not Path(study.site.body).is_file():
            names = ", ".join(f'"{name}"' for name in BUILT_IN_BODIES)
            yield f'site.body is "{study.site.body}"; allowed: {names} or the path of a mesh; no such file'
        for key in ("mass", "spin_period"):
            if getattr(study.site, key) is None:
                yield f"site.{key} is missing; a body read from a mesh needs its {key.replace('_', ' ')}"


def _grain_problems(study: Study) -> Iterator[str]:
    sizes = study.bed.diameter.model_dump()
    largest = sizes["upper"] if "upper" in sizes else sizes["value"]
    if sizes.get("lower", 0) >= largest:
        yield f"bed.diameter reaches from {sizes['lower']:g} to {largest:g} m; allowed: lower below upper; swap them"
    limit = min(study.bed.width) / BED_WIDTH_PER_GRAIN
    # A grain of exactly a third may not fail by the rounding of the division.
    if largest > limit * (1 + 1e-12):
        yield (
            f"bed.diameter reaches to {largest:g} m; allowed: at most {limit:.3g} m, a third of bed.width; "
            "widen the bed or take smaller grains"
        )


def _shape_problems(study: Study) -> Iterator[str]:
    lander, takes = study.lander, {"box": "edges", "sphere": "diameter", "hull": "file"}
    needed = takes[lander.shape]
    for key in takes.values():
        if (getattr(lander, key) is None) == (key == needed):
            verb = "is missing" if key == needed else "does not go with this shape"
            yield f'lander.{key} {verb}; allowed: shape = "{lander.shape}" takes {needed} and no other of these'
    if lander.shape == "hull" and lander.file is not None and not Path(lander.file).is_file():
        yield f'lander.file is "{lander.file}"; no such file; give the path of an OBJ or STL mesh'
        return
    if getattr(lander, needed) is None:
        return
    try:
        radius = lander_radius(study)
    except ValueError as error:
        yield f"lander.file: {error}"
        return
    width = min(study.bed.width)
    if width < BED_WIDTH_PER_LANDER * 2 * radius:
        yield (
            f"bed.width is {width:g} m at its narrowest; allowed: at least {BED_WIDTH_PER_LANDER * 2 * radius:.3g} m, "
            f"twice the largest diameter of the lander ({2 * radius:.3g} m); widen the bed and add grains"
        )


def lander_radius(study: Study) -> float:
    """Largest distance of a point of the lander from its centre [m]. Raises ValueError for a mesh that is refused."""
    lander = study.lander
    if lander.edges is not None:
        return math.hypot(*lander.edges) / 2
    if lander.diameter is not None:
        return _reach(lander.diameter)[1] / 2
    from lithobrake.touchdown import read_hull

    hull = read_hull(Path(str(lander.file)))
    return float(((hull.vertices - hull.centroid) ** 2).sum(axis=1).max() ** 0.5)


def _place_problems(study: Study) -> Iterator[str]:
    impact, half = study.impact, [width / 2 for width in study.bed.width]
    if impact.place is not None and impact.region is not None:
        yield "impact.place and impact.region are both given; keep one: a place for all runs, or a region to draw from"
    if isinstance(impact.orientation, tuple) and not any(impact.orientation):
        yield "impact.orientation is [0, 0, 0, 0], which is no rotation; write [1, 0, 0, 0] for none"
    for key, spot in (("place", impact.place), ("region", impact.region)):
        if spot is None:
            continue
        for axis, limit in zip("xy", half, strict=True):
            value = getattr(spot, axis)
            lower, upper = value if isinstance(value, tuple) else _reach(value)
            if lower < -limit or upper > limit:
                yield (
                    f"impact.{key}.{axis} reaches from {lower:g} to {upper:g} m; allowed: -{limit:g} to {limit:g} m, "
                    "counted from the middle of the bed; move it inside or widen the bed"
                )


def _design_problems(study: Study) -> Iterator[str]:
    from lithobrake.chaos import smolyak_count, term_count

    input_count = len(uncertain(study.touchdown_values()))
    if input_count == 0:
        yield (
            "nothing in grain, lander, impact or surface is uncertain; give at least one key a distribution, "
            'such as young_modulus = { distribution = "log_uniform", lower = 1e6, upper = 1e8 }'
        )
        return
    yield from _unbounded_problems(study)
    yield from _replicate_problems(study)
    design = study.design
    for stage, counts in (("screening", [input_count]), ("refined", range(1, input_count + 1))):
        level, degree = getattr(design, f"{stage}_level"), getattr(design, f"{stage}_degree")
        point_count, smolyak = getattr(design, f"{stage}_count"), design.method == "smolyak"
        key = f"design.{stage}_{'level' if smolyak else 'count'}"
        if smolyak == (point_count is not None):
            yield (
                f"design.{stage}_count {'does not go with' if smolyak else 'is missing; it is needed by'} "
                f'design.method = "{design.method}"; allowed: "smolyak" takes levels, every other method counts'
            )
            continue
        for count in counts:
            found = smolyak_count(count, level) if smolyak else int(point_count or 0)
            terms = term_count(count, degree)
            if found < terms and (design.fit == "ols" or design.method == "fekete"):
                where = f"{found} nodes of level {level}" if smolyak else f"{found} points of {key}"
                yield (
                    f"design.{stage}_degree is {degree}; with {count} inputs it has {terms} terms, more than the "
                    f"{where}; lower the degree or raise {key}"
                )
                break


def _unbounded_problems(study: Study) -> Iterator[str]:
    """Inputs that have no end, on a grid that puts nodes at the ends."""
    if study.design.method != "smolyak":
        return
    for name, value in uncertain(study.touchdown_values()).items():
        if not all(map(math.isfinite, _reach(value))):
            yield (
                f'{name} is {value.distribution}, which has no end, and design.method = "smolyak" puts runs at the '
                "ends; give it two limits (truncated_normal, log_uniform, uniform, beta), or take another design.method"
            )


def _replicate_problems(study: Study) -> Iterator[str]:
    """Runs that would be made several times to the same end."""
    impact, count = study.impact, study.design.replicate_count
    drawn = study.bed.bed_count > 1 or impact.region or "random" in (impact.azimuth_deg, impact.orientation)
    if count > 1 and not drawn and not study.solver.command:
        yield (
            f"design.replicate_count is {count}, but runs draw nothing by chance, so all {count} would be equal; "
            'give them something to draw (bed.bed_count, impact.region, azimuth_deg or orientation "random") or write 1'
        )


def _solver_problems(study: Study) -> Iterator[str]:
    solver = study.solver
    if solver.command is None:
        if solver.inputs:
            yield "solver.inputs has numbers, and solver.command is missing; give the command that reads them"
        return
    try:
        words = shlex.split(solver.command)
    except ValueError as error:
        yield f"solver.command is {solver.command!r}; {str(error).lower()}: close every quotation mark"
        return
    if not solver.command.isprintable():
        yield f"solver.command is {solver.command!r}; allowed: what can be shown on one line; write plain words"
        return
    if not words or shutil.which(words[0]) is None:
        yield f'solver.command begins with "{" ".join(words[:1])}", which is no program here; give its path'


def _reach(value: Scalar) -> tuple[float, float]:
    """Smallest and largest possible value."""
    return value.support() if isinstance(value, Uncertain) else (value, value)
