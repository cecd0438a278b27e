"""A study at given numbers: these are checked as if they stood in the study file."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ValidationError

from lithobrake.study.body_checks import body_problems
from lithobrake.study.checks import landing_problems
from lithobrake.study.lander_section import PartSection
from lithobrake.study.quantity import is_number
from lithobrake.study.reader import StudyError, known_keys
from lithobrake.study.refusals import sentences
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import closest, show

# An attitude stands in the study file as one list.
ATTITUDE = tuple(f"impact.orientation.{part}" for part in "wxyz")
INPUTS, SITE = "solver.inputs.", "site."


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
        fixed = Study.model_validate(tables).with_function(study.function)
    except ValidationError as error:
        raise StudyError(sentences(error.errors(), known_keys())) from error
    loose = [f"{key} is {show(value)}; allowed: one number" for key, value in values.items() if not is_number(value)]
    if loose:
        raise StudyError(loose)
    # A landing reads nothing of the site, and a flight nothing else.
    of_site = all(key.startswith(SITE) for key in values)
    read = list(fixed.site_values()) if of_site else [*fixed.touchdown_values(), *ATTITUDE]
    between = body_problems if of_site else landing_problems
    found = [_unread(key, read) for key in values if key not in read] or list(between(fixed))
    if found:
        raise StudyError(found)
    return fixed


def _table(section: Any) -> Any:
    if not isinstance(section, BaseModel):
        return section
    return {name: getattr(section, name) for name in type(section).model_fields}


def _put(tables: dict[str, Any], key: str, value: Any) -> None:
    """Put a number where the study file has it."""
    section, _, name = key.partition(".")
    table = tables.setdefault(section, {})
    if not isinstance(table, dict):
        raise StudyError([_unread(key, [])])
    if key in ATTITUDE:
        given = table["orientation"]
        attitude = [1.0, 0.0, 0.0, 0.0] if isinstance(given, str) else list(given)
        attitude[ATTITUDE.index(key)] = value
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
        table |= {name: value, "kernels": [], "kernel_body": None, "epoch": None}
    else:
        table[name] = value


def _unread(key: str, read: list[str]) -> str:
    return f"{key} is not read here{closest(key, read)}; allowed: the numbers of a run by the keys of the study file"
