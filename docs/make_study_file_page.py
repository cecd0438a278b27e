"""Write docs/study_file.md, which has every key of the study file with its meaning, unit, range and default.

The words are those beneath the fields of lithobrake/study, which `lithobrake new --full` writes too.
"""

import math
import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from textwrap import wrap
from typing import Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lithobrake.study import Study, known_keys
from lithobrake.study.quantity import DISTRIBUTIONS, MaybeUncertain, Number, Numbers
from lithobrake.study.template import toml_value
from lithobrake.study.units import is_named, limits, table

LINE = 100  # characters, as on every page of the documentation
HEAD = """# The study file

<!-- Made by docs/make_study_file_page.py from the fields of lithobrake/study. -->

A study file is written in TOML: a table for each section, a key for each quantity. This page lists
all of them with meaning, unit, range and default. `lithobrake new NAME` writes a short study that
is ready to run; `lithobrake new NAME --full` writes all keys of this page as a file to fill in. An
unknown key or a value outside its range is refused before anything is computed, with a message that
names the range and the remedy.

Angles are in degrees and have `_deg` in their names; everything else is in SI units. Ranges are
intervals: (0, 1] is above 0 and at most 1. Paths are relative to the folder of the study file.

## Uncertain numbers

A key marked ± takes a distribution instead of the number. The whole distribution must lie within
the range of the key:

```toml
[grain]
friction = { distribution = "uniform", lower = 0.3, upper = 0.9 }
```

| distribution | parameters |
|---|---|
"""
DISTRIBUTION_ROWS = [
    f"| `{kind}` | {', '.join(f'`{one}`' for one in names)} |" for kind, names in DISTRIBUTIONS.items()
]
LOG_NORMAL = "`mean` and `std` of `log_normal` are those of the natural logarithm."
TABLE = ["", "| key | meaning | unit | range | default |", "|---|---|---|---|---|"]
DOTTED = sorted((f"{place}.{key}" for place, keys in known_keys().items() if place for key in keys), reverse=True)
TABLES = sorted(known_keys().keys() - {""})
# What of a meaning is typed into a file: dotted keys with their values, names of tables, placeholders, powers, words.
TYPED = re.compile(
    rf"""(?<![`\w])(?:(?:{"|".join(map(re.escape, DOTTED))})(?:\ =\ (?:"\w+"|\w+))?"""
    rf"""|\[(?:{"|".join(map(re.escape, TABLES))})\]"""
    r"""|{{.*?}}|\w\*\*-\w+|"[\w:/.\- ]+")(?![`\w])""",
    flags=re.VERBOSE,
)


def as_markdown(words: str) -> str:
    """Words of one line in which what is typed into a file is code, pages are links and bars do not end a cell."""
    words = TYPED.sub(lambda found: f"`{found.group()}`", " ".join(words.split())).replace("|", "\\|")
    words = re.sub(r"(`[^`]*`)|\*", lambda found: found.group(1) or r"\*", words)
    return re.sub(r"docs/(\w+)\.md", r"[\1.md](\1.md)", words)


def interval(range_: Number) -> str:
    """A range as an interval, or by one sign where it has one end."""
    lower, lower_open = (range_.above, True) if math.isfinite(range_.above) else (range_.at_least, False)
    upper, upper_open = (range_.below, True) if math.isfinite(range_.below) else (range_.at_most, False)
    if math.isfinite(lower) and math.isfinite(upper):
        return f"{'(' if lower_open else '['}{lower:g}, {upper:g}{')' if upper_open else ']'}"
    if math.isfinite(lower):
        return f"{'>' if lower_open else '≥'} {lower:g}"
    return f"{'<' if upper_open else '≤'} {upper:g}" if math.isfinite(upper) else "any"


def choices(field: FieldInfo) -> str:
    """The words that a field chooses from."""
    kinds = [field.annotation, *get_args(field.annotation)]
    words = next((get_args(kind) for kind in kinds if get_origin(kind) is Literal), ())
    return ", ".join(f"`{toml_value(word)}`" for word in ((True, False) if bool in kinds else words))


def range_words(field: FieldInfo) -> str:
    """What values a field takes; ± where they may be uncertain."""
    found = limits(field)
    if found is None:
        return choices(field)
    count = f"{found.count} numbers, " if isinstance(found, Numbers) else ""
    word = f', `"{found.word}"`' if found.word else ""
    return f"{count}{interval(found)}{word}{' ±' if isinstance(found, MaybeUncertain) else ''}"


def default_words(field: FieldInfo) -> str:
    """What holds where the key is absent."""
    if field.is_required():
        return "needed"
    return "" if field.default is None else f"`{toml_value(field.default)}`"


def row(key: str, field: FieldInfo) -> str:
    """The row of a key that is no table."""
    found = limits(field)
    unit = found.unit if found else ""
    words = (as_markdown(field.description or ""), unit, range_words(field), default_words(field))
    return f"| `{key}` | {' | '.join(words)} |"


def rows(fields: dict[str, FieldInfo], above: str = "") -> Iterator[str]:
    """A row for each key, those of tables within the table by dotted names."""
    for name, field in fields.items():
        inner = table(field)
        if inner is None:
            yield row(f"{above}{name}", field)
        else:
            yield f"| `{above}{name}` | {as_markdown(field.description or inner.__doc__ or '')} | | table | |"
            yield from rows(inner.model_fields, f"{above}{name}.")


def paragraph(words: str | None) -> list[str]:
    """Words in lines of the page."""
    return ["", *wrap(as_markdown(words or ""), LINE, break_on_hyphens=False, break_long_words=False)]


def section(name: str, model: type[BaseModel]) -> list[str]:
    """A heading, and a table of the keys that each class of the section adds, below its words."""
    lines = ["", f"## `[{name}]`", *paragraph(model.__doc__)]
    owners = {key: base for base in model.__mro__ if base.__doc__ for key in getattr(base, "model_fields", ())}
    for owner, keys in groupby(model.model_fields, key=owners.__getitem__):
        lines += [] if owner is model else paragraph(owner.__doc__)
        lines += [*TABLE, *rows({key: model.model_fields[key] for key in keys})]
    return lines


def page() -> str:
    """docs/study_file.md."""
    top = {name: field for name, field in Study.model_fields.items() if table(field) is None}
    lines = [HEAD.rstrip(), *DISTRIBUTION_ROWS, "", LOG_NORMAL, "", "## Above all sections", *TABLE, *rows(top)]
    for name, field in Study.model_fields.items():
        if (model := table(field)) is not None:
            lines += section(f"{name}.NAME" if is_named(field) else name, model)
    return "\n".join([*lines, ""])


if __name__ == "__main__":
    Path(__file__).with_name("study_file.md").write_text(page(), encoding="utf-8")
