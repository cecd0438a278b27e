"""Input files of a program made from templates: {{ name }} in them becomes a number of the run."""

import re
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any

# Names have dots; blanks inside the braces are the author's taste.
PLACE = re.compile(r"\{\{\s*([\w.\-]+)\s*\}\}")


def fill_template(template: Path, folder: Path, question: Mapping[str, Any]) -> None:
    """Write a template with its places filled into a folder, under its own name.

    question: inputs by name; seed; whatever else, by dotted names (setting.bed.grain_count). A number has all its
    digits, a word stands as it is. Raises ValueError for a name that there is not.
    """
    values = dict(question.get("inputs", {}))
    values |= dict(_leaves({name: value for name, value in question.items() if name != "inputs"}))

    def filled(match: re.Match[str]) -> str:
        name = match[1]
        if name not in values:
            close = get_close_matches(name, values, n=1)
            meant = f"; did you mean {close[0]}?" if close else f"; there are: {', '.join(values)}"
            raise ValueError(f"{template} has a place for {name}, which is no number of a run{meant}")
        value = values[name]
        return repr(value) if isinstance(value, float) else str(value)

    text = template.read_text(encoding="utf-8")
    (folder / template.name).write_text(PLACE.sub(filled, text), encoding="utf-8")


def _leaves(table: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Numbers and words of nested tables by dotted name; lists and what is absent have no place in a text."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{above}{name}.")
        elif isinstance(value, str | int | float):
            yield f"{above}{name}", value
