"""The page: one HTML file that needs nothing but itself."""

import base64
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files

from lithobrake.report.content import Content, LiveSection, PageTable, Panel, Tile

# More rows or lines than this do not fit on a screen of a phone.
LONG = 15
# What every page can do; sections bring scripts of their own. Each is a file beside this one.
SCRIPT = "pages/page.js"
NO_SCRIPT = '<noscript><p class="warning">What follows needs JavaScript, which does not run here.</p></noscript>\n'
FOOTER = (
    "<footer>Written by lithobrake from the files of the results that it names. SI units; degrees where a label says "
    "so.</footer>"
)
HINT = (
    '<p class="note hint">Click or tap a figure to let it fill the window; click again or press Esc to go back.</p>\n'
)


def _header(kind: str, title: str, content: Content, facts: str) -> str:
    warnings = "".join(f'<p class="warning">{escape(warning)}</p>\n' for warning in content.warnings)
    return f"""<header>
<p class="kind">{escape(kind)}</p>
<h1>{escape(title)}</h1>
<p class="answer">{escape(content.answer)}</p>
{warnings}<p class="facts">{escape(facts)}</p>
</header>"""


def page(
    title: str,
    facts: str,
    content: Content,
    panels: Sequence[Panel],
    provenance: Sequence[PageTable],
    study_texts: Mapping[str, str],
    kind: str = "Landing study",
) -> str:
    """Put the page together, with the panels that the plots gave and study files by title; words are escaped here."""
    style = _own_file("pages/style.css")
    scripts = dict.fromkeys([SCRIPT, *(name for section in content.live for name in section.scripts)])
    pictures = "\n".join(_panel(number, panel) for number, panel in enumerate(panels, start=1))
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
{_header(kind, title, content, facts)}
<ul class="tiles">
{"".join(_tile(tile) for tile in content.tiles)}</ul>
{pictures}
{_live(content.live)}<h2>Tables</h2>
{"".join(_table(table) for table in sorted(content.tables, key=_is_long))}
<h2>Provenance</h2>
{"".join(_table(table) for table in provenance)}
{"".join(_text(*one) for one in study_texts.items())}
{FOOTER}
</main>
<script>
{"".join(_own_file(name) for name in scripts)}</script>
</body>
</html>
"""


def _live(sections: Sequence[LiveSection]) -> str:
    """The sections that a reader moves, each heading once; without scripts none of them can be seen."""
    text, heading = "", ""
    for section in sections:
        text += f"<h2>{escape(section.heading)}</h2>\n" if section.heading != heading else ""
        text, heading = text + section.html, section.heading
    return f'<div class="live">\n{NO_SCRIPT}{text}</div>\n' if text else ""


def _own_file(name: str) -> str:
    """The text of a file of this package that every page has inside."""
    return files("lithobrake.report").joinpath(name).read_text(encoding="utf-8")


def _tile(tile: Tile) -> str:
    return f"<li><b>{escape(tile.value)} <small>{escape(tile.unit)}</small></b><span>{escape(tile.words)}</span></li>\n"


def _heading(number: int, panel: Panel) -> str:
    """The heading of a figure that has one, which the first always has, there with how a figure is enlarged."""
    words = panel.heading or ("Figures" if number == 1 else "")
    return (f"<h2>{escape(words)}</h2>\n" if words else "") + (HINT if number == 1 else "")


def _panel(number: int, panel: Panel) -> str:
    """One figure under its heading, with the tables that belong to it."""
    return f"{_heading(number, panel)}{_figure(number, panel)}{''.join(_table(table) for table in panel.tables)}"


def _figure(number: int, panel: Panel) -> str:
    """One figure with the picture inside the page, or a place that says there is none."""
    caption = f"<figcaption><b>Figure {number}. {escape(panel.title)}.</b> {escape(panel.sentence)}</figcaption>"
    if panel.picture is None:
        absent = '<div class="absent">No picture: the sentence says why.</div>'
        return f'<figure id="figure-{number}">{absent}{caption}</figure>'
    data = base64.b64encode(panel.picture).decode("ascii")
    alternative = escape(f"{panel.title}. {panel.sentence}", quote=True)
    # A picture is enlarged by a box that is ticked: no second copy of it, and nothing that a browser may block on disk.
    return (
        f'<figure id="figure-{number}"><label class="picture"><input type="checkbox" '
        f'aria-label="Figure {number} in full size"><span><img alt="{alternative}" '
        f'src="data:image/png;base64,{data}"></span></label>{caption}</figure>'
    )


def _table(table: PageTable) -> str:
    kinds = [' class="number"' if name in table.numbers else "" for name in table.columns]
    head = "".join(f"<th{kind}>{escape(name)}</th>" for name, kind in zip(table.columns, kinds, strict=True))
    body = "".join(
        "<tr>"
        + "".join(f"<td{kind}>{_cell(cell, table.links)}</td>" for cell, kind in zip(row, kinds, strict=True))
        + "</tr>\n"
        for row in table.rows
    )
    note = f'<p class="note">{escape(table.note)}</p>' if table.note else ""
    # With a tab stop, so that a box that scrolls sideways can be moved from the keyboard.
    box = f'<div class="scroll" tabindex="0"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>'
    return _folding(table.title, len(table.rows), "rows", note + box)


def _text(title: str, text: str) -> str:
    return _folding(title, len(text.splitlines()), "lines", f"<pre>{escape(text)}</pre>")


def _is_long(table: PageTable) -> bool:
    """Whether a table is folded away, and stands behind those that are not."""
    return len(table.rows) > LONG


def _cell(cell: str, links: Mapping[str, str]) -> str:
    words = escape(cell)
    return f'<a href="{escape(links[cell], quote=True)}">{words}</a>' if cell in links else words


def _folding(title: str, length: int, unit: str, content: str) -> str:
    """Content under its title, folded away where it is long."""
    is_long = length > LONG
    count = f" <small>{length} {unit}</small>" if is_long else ""
    opening = "<details>" if is_long else "<details open>"
    return f"{opening}<summary><h3>{escape(title)}{count}</h3></summary>{content}</details>\n"
