"""Show the arguments that a docstring explains as a list: "position   [m], shape [count, 3]" or "threads: count"."""

import re
from typing import Any

import griffe

ALIGNED = re.compile(r"^(\w+(?:, \w+)*) {2,}(\S.*)$")
NAMED = re.compile(r"^(\w+): (\S.*)$")


class DocstringArguments(griffe.Extension):
    """Turns lines of arguments into items before the pages are made; the sources stay as they are."""

    def on_object(self, *, obj: griffe.Object, **kwargs: Any) -> None:
        """Rewrite the docstring of a function or class, where it has one."""
        if obj.docstring and not obj.is_module:
            known = {parameter.name for parameter in getattr(obj, "parameters", [])} | set(obj.members)
            obj.docstring.value = with_items(obj.docstring.value, known)


def with_items(text: str, known: set[str]) -> str:
    """The text with an item for each line that explains an argument."""
    lines: list[str] = []
    listing = False
    for line in text.splitlines():
        named = NAMED.match(line)
        entry = ALIGNED.match(line) or (named if named and named.group(1) in known else None)
        if entry:
            lines += [] if listing else [""]
            lines.append(f"- **{entry.group(1)}**: {entry.group(2)}")
        elif listing and line.strip() and line.startswith(" "):
            lines.append(f"    {line.strip()}")
        elif listing and line.strip() and not lines[-1]:
            lines.append(line)
        else:
            lines += ["", line] if listing and line.strip() else [line]
        listing = bool(entry) or (listing and line.startswith(" "))
    return "\n".join(lines)
