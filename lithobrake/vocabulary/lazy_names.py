"""Public names of a part that are imported when they are first used, so that a command starts at once."""

import sys
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any


def lazy_names(part: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Make `__getattr__` and `__dir__` of a part from the imports under `if TYPE_CHECKING:` in its `__init__.py`.

    Those imports are the one list of its public names: type checkers follow them, and here they are read as text.
    """
    module = sys.modules[part]

    @cache
    def files() -> dict[str, str]:
        """Full name of the file that each public name stands in."""
        import ast
        from pathlib import Path

        tree = ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8"))
        block = next(node for node in tree.body if isinstance(node, ast.If))
        lines = [node for node in block.body if isinstance(node, ast.ImportFrom)]
        return {alias.name: str(line.module) for line in lines for alias in line.names}

    def public_names() -> list[str]:
        return sorted(files())

    def public_name(name: str) -> Any:
        if name == "__all__":
            return public_names()
        if name not in files():
            raise AttributeError(f"module {part!r} has no attribute {name!r}", name=name, obj=module)
        return getattr(import_module(files()[name]), name)

    return public_name, public_names
