"""Show the arguments that a docstring explains as a list: "position   [m], shape [count, 3]" or "threads: count"."""

import re
from typing import Any

import griffe

ALIGNED = re.compile(r"^(\w+(?:, \w+)*) {2,}(\S.*)$")


class DocstringArguments(griffe.Extension):
    """Turns lines of arguments into items before the pages are made; the sources stay as they are."""

    def on_object(self, *, obj: griffe.Object, **kwargs: Any) -> None:
        """Rewrite the docstring of a function or class, where it has one."""
        if obj.docstring and (obj.is_function or obj.is_class):
            known = {parameter.name for parameter in obj.parameters} | set(obj.members)
            obj.docstring.value = with_items(obj.docstring.value, known)


def with_items(text: str, known: set[str]) -> str:
    """The text with an item for each argument; an item goes on while lines are indented or a sentence is not over."""
    names = "|".join(sorted(map(re.escape, known), key=len, reverse=True)) or "(?!)"
    lines: list[str] = []
    is_item = False
    # Several arguments may share a line: "seed: of all draws. count: how many".
    for line in re.sub(rf"[.;] (?=(?:{names}):\s)", ".\n", text).splitlines():
        named = re.match(rf"^({names}): ?(.*)$", line)
        entry = ALIGNED.match(line) or named
        if entry:
            lines += [*([] if is_item else [""]), f"- **{entry.group(1)}**: {entry.group(2)}"]
        elif is_item and line.strip() and (line.startswith(" ") or not lines[-1].endswith(".")):
            lines.append(f"    {line.strip()}")
            continue
        else:
            lines += ["", line] if is_item else [line]
        is_item = entry is not None
    return "\n".join(lines)
