"""A commented study file, written from the schema itself, so that the two never differ."""

import textwrap
from collections.abc import Iterator
from functools import cache
from itertools import groupby
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lithobrake.study.quantity import DISTRIBUTIONS, MaybeUncertain
from lithobrake.study.study import Study
from lithobrake.study.units import is_named, limits, table

_HEAD = """\
# A landing study. A key marked "number or table" also takes a distribution instead of the number, as in
#     friction = { distribution = "uniform", lower = 0.3, upper = 0.9 }
# with one of:
"""


DISTRIBUTION_WORDS = (
    "".join(f"#     {kind}: {', '.join(names)}\n" for kind, names in DISTRIBUTIONS.items())
    + "# (mean and std of log_normal are those of ln x)\n"
)


@cache
def template() -> str:
    """The text of a study of the first bounce in which every key stands with its meaning, unit, range and default.

    Keys that may be left out, and are, stand behind a comment sign.
    """
    needed = (field.is_required() or field.default is not None for field in Study.model_fields.values())
    parts = (text if is_needed else commented(text) for text, is_needed in zip(sections(), needed, strict=True))
    return "\n".join([_HEAD + DISTRIBUTION_WORDS, *parts])


def sections() -> Iterator[str]:
    """The text of each key of a study that is no table, and of each table with its keys, in their order."""
    for name, field in Study.model_fields.items():
        model = table(field)
        if model and is_named(field):
            yield _named_table(f"{name}.NAME", field).lstrip()
        else:
            yield _section(name, model) if model else _key(name, field)


def commented(section: str) -> str:
    return "".join(line if line.startswith("#") else f"# {line}" for line in section.splitlines(keepends=True))


def _section(name: str, model: type[BaseModel]) -> str:
    """A table with its keys; those that it has from a base stand together below what the base says of them."""
    lines = f"{_comment(model.__doc__ or '')}[{name}]\n"
    # model_fields holds inherited keys too; the last class of the order of inheritance that has a key is the one that
    # declares it.
    owners = {key: base for base in model.__mro__ if base.__doc__ for key in getattr(base, "model_fields", ())}
    plain = [key for key, field in model.model_fields.items() if not (is_named(field) and table(field))]
    for owner, keys in groupby(plain, key=owners.__getitem__):
        heading = "" if owner is model else f"\n{_comment(owner.__doc__ or '')}\n"
        lines += heading + "".join(_key(key, model.model_fields[key]) for key in keys)
    for key in (key for key in model.model_fields if key not in plain):
        lines += _named_table(f"{name}.{key}.NAME", model.model_fields[key])
    return lines


def _named_table(name: str, field: FieldInfo) -> str:
    """A table with a name of the user's own behind comment signs, and its keys."""
    inner = table(field)
    assert inner is not None
    keys = "".join(commented(_key(key, one)) for key, one in inner.model_fields.items())
    return f"\n{_comment(inner.__doc__ or '')}# [{name}]\n{keys}"


def _key(name: str, field: FieldInfo) -> str:
    allowed = limits(field)
    notes = [field.description or ""]
    if allowed is not None:
        notes.append(f"Allowed: {allowed}" + ("; number or table." if isinstance(allowed, MaybeUncertain) else "."))
    if not field.is_required() and field.default is not None:
        notes.append(f"Default: {toml_value(field.default)}.")
    inner = table(field)
    if inner and any(one.examples for one in inner.model_fields.values()):
        return _inner_table(name, inner)
    if inner:
        keys = ", ".join(f"{key} = {'[-0.1, 0.1]' if _is_pair(inner, key) else '0.0'}" for key in inner.model_fields)
        line = f"# {name} = {{ {keys} }}"
    elif field.examples:
        line = f"{name} = {field.examples[0]}"
    else:
        line = f"# {name} = {toml_value(field.default)}" if field.default is not None else f"# {name} ="
    return f"{_comment(' '.join(notes))}{line}\n"


def _inner_table(name: str, model: type[BaseModel]) -> str:
    """A table within a table by dotted keys, each with its meaning; all may be left out."""
    keys = "".join(commented(_key(f"{name}.{key}", field)) for key, field in model.model_fields.items())
    return _comment(f"{model.__doc__ or ''} As {name} = {{ ... }}, or key by key:") + keys


def _is_pair(model: type[BaseModel], key: str) -> bool:
    allowed = limits(model.model_fields[key])
    return allowed is not None and not isinstance(allowed, MaybeUncertain)


def _comment(text: str) -> str:
    return textwrap.fill(" ".join(text.split()), width=110, initial_indent="# ", subsequent_indent="# ") + "\n"


def toml_value(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_value(entry) for entry in value) + "]"
    return str(value).lower() if isinstance(value, bool) else repr(value)
