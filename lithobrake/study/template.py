"""A commented study file, written from the schema itself, so that the two never differ."""

import textwrap
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lithobrake.study.quantity import DISTRIBUTIONS, MaybeUncertain
from lithobrake.study.study import Study
from lithobrake.study.units import limits, table

_HEAD = """\
# A landing study. A key marked "number or table" takes a distribution in place of the number, as in
#     friction = { distribution = "uniform", lower = 0.3, upper = 0.9 }
# with one of:
"""


def template() -> str:
    """The text of a study file in which every key stands with its meaning, unit, range and default.

    Keys that may be left out, and are, stand behind a comment sign.
    """
    kinds = "".join(f"#     {kind}: {', '.join(names)}\n" for kind, names in DISTRIBUTIONS.items())
    parts = [_HEAD + kinds + "# (mean and std of log_normal are those of ln x)\n"]
    for name, field in Study.model_fields.items():
        model = table(field)
        parts.append(_section(name, model) if model else _key(name, field))
    return "\n".join(parts)


def _section(name: str, model: type[BaseModel]) -> str:
    keys = "".join(_key(key, field) for key, field in model.model_fields.items())
    return f"{_comment(model.__doc__ or '')}[{name}]\n{keys}"


def _key(name: str, field: FieldInfo) -> str:
    allowed = limits(field)
    notes = [" ".join((field.description or "").split())]
    if allowed is not None:
        notes.append(f"Allowed: {allowed}" + ("; number or table." if isinstance(allowed, MaybeUncertain) else "."))
    if not field.is_required() and field.default is not None:
        notes.append(f"Default: {_toml(field.default)}.")
    inner = table(field)
    if inner:
        keys = ", ".join(f"{key} = {'[-0.1, 0.1]' if _is_pair(inner, key) else '0.0'}" for key in inner.model_fields)
        line = f"# {name} = {{ {keys} }}"
    elif field.examples:
        line = f"{name} = {field.examples[0]}"
    else:
        line = f"# {name} = {_toml(field.default)}" if field.default is not None else f"# {name} ="
    return f"{_comment(' '.join(notes))}{line}\n"


def _is_pair(model: type[BaseModel], key: str) -> bool:
    """Tell whether a key takes two numbers."""
    allowed = limits(model.model_fields[key])
    return allowed is not None and not isinstance(allowed, MaybeUncertain)


def _comment(text: str) -> str:
    return textwrap.fill(text, width=110, initial_indent="# ", subsequent_indent="# ") + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(entry) for entry in value) + "]"
    return str(value).lower() if isinstance(value, bool) else repr(value)
