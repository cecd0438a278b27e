"""A commented study file, written from the schema itself, so that the two never differ."""

import textwrap
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lithobrake.quantity import DISTRIBUTIONS, MaybeUncertain, Number
from lithobrake.study import Study

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
        model = _model(field)
        parts.append(_section(name, model) if model else _key(name, field))
    return "\n".join(parts)


def _model(field: FieldInfo) -> type[BaseModel] | None:
    """The table that a field takes, if it takes exactly one kind of table."""
    kinds = [field.annotation, *get_args(field.annotation)]
    models = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)]
    return models[0] if len(models) == 1 else None


def _section(name: str, model: type[BaseModel]) -> str:
    keys = "".join(_key(key, field) for key, field in model.model_fields.items())
    return f"{_comment(model.__doc__ or '')}[{name}]\n{keys}"


def _key(name: str, field: FieldInfo) -> str:
    limits = _limits(field)
    notes = [" ".join((field.description or "").split())]
    if limits is not None:
        notes.append(f"Allowed: {limits}" + ("; number or table." if isinstance(limits, MaybeUncertain) else "."))
    if not field.is_required() and field.default is not None:
        notes.append(f"Default: {_toml(field.default)}.")
    inner = _model(field)
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
    limits = _limits(model.model_fields[key])
    return limits is not None and not isinstance(limits, MaybeUncertain)


def _limits(field: FieldInfo) -> Number | None:
    """The range of a field, wherever in its annotation it stands."""
    found = [entry for entry in field.metadata if isinstance(entry, Number)]
    for kind in get_args(field.annotation):
        found += [entry for entry in getattr(kind, "__metadata__", ()) if isinstance(entry, Number)]
    return found[0] if found else None


def _comment(text: str) -> str:
    return textwrap.fill(text, width=110, initial_indent="# ", subsequent_indent="# ") + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(entry) for entry in value) + "]"
    return str(value).lower() if isinstance(value, bool) else repr(value)
