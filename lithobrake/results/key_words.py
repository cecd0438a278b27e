"""What is said of the keys of a study's JSON files, looked up by place, and as a page."""

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from textwrap import wrap
from typing import Any

from lithobrake.results.drawn_keys import DRAWN_TABLES
from lithobrake.results.fit_keys import FIT_TABLES, SCORES
from lithobrake.results.summary_keys import SUMMARY, SUMMARY_TABLES

Path = tuple[str, ...]
LINE = 100  # characters, as on every page of the documentation
KEY_TABLES = (*SUMMARY_TABLES, *DRAWN_TABLES, *FIT_TABLES)


def leaves(value: Any, path: Path = ()) -> Iterator[Path]:
    """The place of every number, word and null of a JSON value; of a list of tables, the places in each."""
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from leaves(inner, (*path, key))
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for inner in value:
            yield from leaves(inner, path)
    else:
        yield path


def words_of(file: str, path: Sequence[str]) -> str:
    """What stands at a place of a file of a study. Raises KeyError for one that nothing is said of."""
    for table in KEY_TABLES:
        for place in table.places if file in table.file.split(", ") else ():
            start = place.split(".") if place else []
            if start and _fits(path, start):
                return table.words
            for key, words in table.keys.items():
                if _fits(path, [*start, *key.split(".")]):
                    return words
    if file == SUMMARY and tuple(path[:2]) == ("results", "scores"):
        return words_of(SCORES, path[2:])
    raise KeyError(
        f"{'.'.join(path)} of {file} is described nowhere; describe it in lithobrake/results/summary_keys.py"
    )


def page() -> str:
    """docs/summary.md."""
    lines = [
        "# The keys of summary.json, scores.json and the expansions", "",
        "<!-- Made by docs/make_summary_page.py from lithobrake/results/*_keys.py. -->", "",
        *wrap(
            "`*` stands for any one name: of an output, an input by its dotted key, a design, an outcome. In a list of "
            "tables every table has these keys. Numbers are in SI where no unit is named; `null`: there is no such "
            "number.", LINE,
        ),
    ]  # fmt: skip
    file = ""
    for table in KEY_TABLES:
        if table.file != file:
            file = table.file
            lines += ["", f"## {' and '.join(f'`{name}`' for name in file.split(', '))}"]
        first, *others = (f"`{place}`" if place else "At the top" for place in table.places)
        also = f" Also {', '.join(others)}." if others else ""
        lines += ["", f"### {first}", "", *wrap(f"{table.words}.{also}", LINE, break_on_hyphens=False)]
        if table.keys:
            lines += ["", "| key | meaning |", "|---|---|"]
            lines += [f"| `{key.removesuffix('.**')}` | {words} |" for key, words in table.keys.items()]
    return "\n".join([*lines, ""])


def _fits(path: Sequence[str], pattern: Sequence[str]) -> bool:
    if pattern[-1] == "**":
        return len(path) >= len(pattern) and _fits(path[: len(pattern) - 1], pattern[:-1])
    return len(path) == len(pattern) and all(map(fnmatchcase, path, pattern))
