"""The page: one HTML file that needs nothing but itself."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from importlib.resources import files


@dataclass(frozen=True)
class Panel:
    """A figure of the page: title, one sentence that says what it shows, and the picture (PNG) if there is one."""

    title: str
    sentence: str
    picture: bytes | None


@dataclass(frozen=True)
class Tile:
    """One of the few numbers that a reader takes away."""

    value: str
    unit: str
    words: str


@dataclass(frozen=True)
class Table:
    """A table of the page; a column whose name stands in `numbers` is set to the right."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""
    numbers: frozenset[str] = field(default_factory=frozenset)


def page(
    title: str,
    answer: str,
    tiles: Sequence[Tile],
    panels: Sequence[Panel],
    tables: Sequence[Table],
    provenance: Sequence[Table],
    study_text: str,
) -> str:
    """Put the page together; all words are plain text and are escaped here."""
    style = files("lithobrake.report").joinpath("style.css").read_text(encoding="utf-8")
    pictures = "\n".join(_figure(number, panel) for number, panel in enumerate(panels, start=1))
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>
{style}</style>
</head>
<body><main>
<header>
<p class="kind">Landing study</p>
<h1>{escape(title)}</h1>
<p class="answer">{escape(answer)}</p>
</header>
<ul class="tiles">
{"".join(_tile(tile) for tile in tiles)}</ul>
<h2>Figures</h2>
{pictures}
<h2>Tables</h2>
{"".join(_table(table) for table in tables)}
<h2>Provenance</h2>
{"".join(_table(table) for table in provenance)}
<h3>The study file</h3>
<pre>{escape(study_text)}</pre>
<footer>Written by lithobrake from the files of the study's folder. SI units; degrees where a label says so.</footer>
</main></body>
</html>
"""


def _tile(tile: Tile) -> str:
    return f"<li><b>{escape(tile.value)} <small>{escape(tile.unit)}</small></b><span>{escape(tile.words)}</span></li>\n"


def _figure(number: int, panel: Panel) -> str:
    """One figure with the picture inside the page, or a place that says there is none."""
    caption = f"<figcaption><b>Figure {number}. {escape(panel.title)}.</b> {escape(panel.sentence)}</figcaption>"
    if panel.picture is None:
        absent = '<div class="absent">No picture: the sentence says why.</div>'
        return f'<figure id="figure-{number}">{absent}{caption}</figure>'
    data = base64.b64encode(panel.picture).decode("ascii")
    alternative = escape(f"{panel.title}. {panel.sentence}", quote=True)
    return (
        f'<figure id="figure-{number}"><img alt="{alternative}" src="data:image/png;base64,{data}">{caption}</figure>'
    )


def _table(table: Table) -> str:
    kinds = [' class="number"' if name in table.numbers else "" for name in table.columns]
    head = "".join(f"<th{kind}>{escape(name)}</th>" for name, kind in zip(table.columns, kinds, strict=True))
    body = "".join(
        "<tr>" + "".join(f"<td{kind}>{escape(cell)}</td>" for cell, kind in zip(row, kinds, strict=True)) + "</tr>\n"
        for row in table.rows
    )
    note = f'<p class="note">{escape(table.note)}</p>' if table.note else ""
    return f"<h3>{escape(table.title)}</h3>{note}<table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table>\n"


def flat(tree: Mapping[str, object], prefix: str = "") -> list[tuple[str, str]]:
    """A nested mapping as rows (dotted name, value in words), in its own order."""
    rows: list[tuple[str, str]] = []
    for name, value in tree.items():
        key = f"{prefix}.{name}" if prefix else str(name)
        if isinstance(value, Mapping):
            rows += flat(value, key)
        else:
            rows.append((key, show(value)))
    return rows


def show(value: object) -> str:
    """A value of a results file in words: numbers to four digits, lists in one line."""
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "none"}[value]
    if isinstance(value, float):
        return number(value, 4)
    if isinstance(value, list | tuple):
        return ", ".join(show(entry) for entry in value)
    return str(value)


def fixed(value: float, digits: int = 2) -> str:
    """A number to some digits behind the point, without a sign when they are all zeros."""
    text = f"{value:.{digits}f}"
    return text if float(text) else text.removeprefix("-")


def number(value: float, digits: int = 3, *, zeros: bool = False) -> str:
    """A number to some digits, very large and very small ones with a power of ten; zeros: keep those at the end."""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        text = f"{value:#.{digits}g}" if zeros else f"{value:.{digits}g}"
        return f"{value:.0f}" if "e" in text else text.removesuffix(".")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    if not zeros and "." in mantissa:
        mantissa = mantissa.rstrip("0").removesuffix(".")
    raised = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{mantissa} × 10{raised}"
