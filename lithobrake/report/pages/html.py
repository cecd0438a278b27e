"""The page: one HTML file that needs nothing but itself, and the list of the study's files on it."""

import base64
import re
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from urllib.parse import quote

from lithobrake.report.content import Content, LiveSection, PageSection, PageTable, Panel, Strip, StripColumn, in_html
from lithobrake.statements.answers import Tile
from lithobrake.vocabulary.file_names import CONTENTS
from lithobrake.vocabulary.outcomes import OUTCOME_COLOURS

# More rows or lines than this do not fit on a screen of a phone.
LONG = 15
BEFORE_UNIT = re.compile(r"(?<=\d) (?=(?:s|min|h|deg|m|m/s|cm/s)\b)")
# What every page can do; sections bring scripts of their own. Each is a file beside this one.
SCRIPT = "pages/page.js"
NO_SCRIPT = '<noscript><p class="warning">The parts below need JavaScript, which is not running here.</p></noscript>\n'
FOOTER = (
    "<footer>Written by lithobrake from the result files named above. SI units; degrees where a label says so.</footer>"
)
HINT = '<p class="note hint">Click or tap a figure to enlarge it; click again or press Esc to return.</p>\n'


def page(title: str, facts: str, content: Content, panels: Mapping[str, Panel], kind: str = "Landing study") -> str:
    """Put the page together, with the panels that the plots of the content gave, by name; words are escaped here."""
    numbers = {name: number for number, name in enumerate(_numbered(content, panels), start=1)}
    figures = {plot.name: _panel(numbers.get(plot.name), panels[plot.name]) for plot in content.plots}
    shown = [(section, _section(section, figures)) for section in content.sections]
    shown = [(section, inside) for section, inside in shown if inside]
    live = [one for section, _ in shown for one in section.live]
    scripts = dict.fromkeys([SCRIPT, *(name for one in live for name in one.scripts)])
    return f"""{page_head(title)}
<body>
{_contents([section for section, _ in shown])}
<main>
{_first_screen(kind, title, facts, content, figures)}
{"".join(f"{_opening(section)}{inside}</section>" for section, inside in shown)}{FOOTER}
</main>
<script>
{"".join(own_file(name) for name in scripts)}</script>
</body>
</html>
"""


def page_head(title: str) -> str:
    """What every page begins with, up to its body."""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>
{own_file("pages/style.css")}</style>
</head>"""


def own_file(name: str) -> str:
    """The text of a file of this package that every page has inside."""
    return files("lithobrake.report").joinpath(name).read_text(encoding="utf-8")


def _picture(number: str, svg: bytes, alternative: str) -> str:
    """A picture inside the page that fills the window while its box is ticked.

    No second copy of it, and nothing that a browser may block on disk.
    """
    data = base64.b64encode(svg).decode("ascii")
    return (
        f'<label class="picture"><input type="checkbox" aria-label="{escape(number, quote=True)} in full size"><span>'
        f'<img alt="{escape(alternative, quote=True)}" src="data:image/svg+xml;base64,{data}"></span></label>'
    )


def _numbered(content: Content, panels: Mapping[str, Panel]) -> list[str]:
    """The names of the figures that have a picture, in their order."""
    return [plot.name for plot in content.plots if panels[plot.name].picture is not None]


def _first_screen(kind: str, title: str, facts: str, content: Content, figures: Mapping[str, str]) -> str:
    """The answer, the numbers, and the figure beside them."""
    tiles = "".join(_tile(tile) for tile in content.tiles)
    tiles = f'<ul class="tiles">\n{tiles}</ul>\n' if tiles else ""
    beside = "" if content.first is None else figures.get(content.first.name, "")
    return f"""<header id="answer">
<p class="kind">{escape(kind)}</p>
<h1>{escape(title)}</h1>
<p class="answer">{_unbroken(content.answer)}</p>
<div class="{"first" if beside else "first alone"}">
<div>{_strip(content.strip)}{tiles}{_warnings(content.warnings)}</div>
{beside}<div class="facts"><p>{_unbroken(facts)}</p>
{HINT if figures else ""}</div></div>
</header>"""


def _warnings(warnings: Sequence[str]) -> str:
    """What to beware of: one in full, several behind their number."""
    text = "".join(f'<p class="warning">{_unbroken(warning)}</p>\n' for warning in warnings)
    if len(warnings) < 2:
        return text
    return f'<details class="warnings"><summary>{len(warnings)} warnings</summary>{text}</details>\n'


def _contents(sections: Sequence[PageSection]) -> str:
    links = [f'<a href="#{_anchor(one)}">{escape(one.title)}</a>' for one in sections]
    return f'<nav aria-label="Contents"><a href="#answer">Answer</a> {" ".join(links)}</nav>' if links else ""


def _anchor(section: PageSection) -> str:
    return re.sub(r"[^a-z0-9]+", "-", section.title.lower()).strip("-")


def _opening(section: PageSection) -> str:
    kind = "" if section.is_printed else ' class="screen"'
    return f'<section id="{_anchor(section)}"{kind}>\n<h2>{escape(section.title)}</h2>\n'


def _section(section: PageSection, figures: Mapping[str, str]) -> str:
    """What stands under the heading of a section; nothing for an empty one."""
    said = "".join(f"<p>{_unbroken(sentence)}</p>\n" for sentence in section.said)
    shown = "".join(figures.get(plot.name, "") for plot in section.plots)
    tables = "".join(_table(table) for table in sorted(section.tables, key=_is_long) if table.rows)
    return said + shown + tables + _live(section.live) + "".join(_text(*one) for one in section.texts.items())


def _live(sections: Sequence[LiveSection]) -> str:
    """What a reader moves; without scripts none of it can be seen."""
    text = "".join(section.html for section in sections)
    return f'<div class="live">\n{NO_SCRIPT}{text}</div>\n' if text else ""


def _unbroken(words: str) -> str:
    """Words of the page: units with raised powers, and no line that breaks between a number and its unit."""
    return BEFORE_UNIT.sub("&nbsp;", in_html(words)).replace(" %", "&nbsp;%")


def _tile(tile: Tile) -> str:
    colour = OUTCOME_COLOURS.get(tile.outcome)
    style = f' style="border-color: {colour}"' if colour else ""
    value = f"<b>{escape(tile.value)} <small>{escape(tile.unit)}</small></b>"
    return f"<li{style}>{value}<span>{_unbroken(tile.words)}</span></li>\n"


def _strip(strip: Strip | None) -> str:
    """Answers side by side as a table, each with its mark and its bar; nothing without any."""
    if strip is None:
        return ""
    head = "".join(f'<th scope="col">{in_html(one.words)}</th>' for one in strip.columns)
    rows = "".join(
        f'<tr><th scope="row">{escape(name)} <small>{_unbroken(words)}</small></th>'
        + "".join(_strip_cell(one, place) for one in strip.columns)
        + "</tr>\n"
        for place, (name, words) in enumerate(strip.rows)
    )
    ends = "".join(f"<td><span>0</span><span>{one.end:g}</span></td>" for one in strip.columns)
    return f"""<table class="strip"><caption>{escape(strip.title)}</caption><thead><tr><td></td>{head}</tr></thead>
<tbody>
{rows}</tbody><tfoot aria-hidden="true"><tr><td></td>{ends}</tr></tfoot></table>
<p class="note">{_unbroken(strip.note)}</p>
"""


def _strip_cell(column: StripColumn, row: int) -> str:
    """An estimate in words, and below them on the scale of its column."""
    found = column.found[row]
    if found is None or not found.is_known:
        return f"<td>{in_html(column.shown[row])}</td>"
    ends = [100.0 * min(max(one / column.end, 0.0), 1.0) for one in (found.bounds or (found.value, found.value))]
    value, mark = column.shown[row].partition(" ("), 100.0 * min(found.value / column.end, 1.0)
    words = f"<b>{in_html(value[0])}</b>{in_html(value[1] + value[2])}"
    bar = f'<i style="left:{ends[0]:.3g}%;width:{ends[1] - ends[0]:.3g}%"></i>'
    bar += f'<i class="mark" style="left:{mark:.3g}%"></i>'
    return f'<td>{words}<span class="scale" aria-hidden="true">{bar}</span></td>'


def _panel(number: int | None, panel: Panel) -> str:
    """One figure with the picture inside the page; without one, what says why."""
    sentence = _unbroken(panel.sentence)
    if panel.picture is None or number is None:
        return f'<p class="note"><b>{escape(panel.title)}.</b> {sentence}</p>\n'
    name = f"Figure {number}"
    shown = _picture(name, panel.picture, f"{panel.title}. {panel.sentence}")
    caption = f"<figcaption><b>{name}. {escape(panel.title)}.</b> {sentence}</figcaption>"
    return f'<figure id="figure-{number}">{shown}{caption}</figure>\n'


def _table(table: PageTable) -> str:
    kinds = [' class="number"' if name in table.numbers else "" for name in table.columns]
    head = "".join(f"<th{kind}>{in_html(name)}</th>" for name, kind in zip(table.columns, kinds, strict=True))
    body = "".join(
        "<tr>"
        + "".join(f"<td{kind}>{_cell(cell, table.links)}</td>" for cell, kind in zip(row, kinds, strict=True))
        + "</tr>\n"
        for row in table.rows
    )
    note = f'<p class="note">{_unbroken(table.note)}</p>' if table.note else ""
    # With a tab stop, so that a box that scrolls sideways can be moved from the keyboard.
    box = f'<div class="scroll" tabindex="0"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>'
    return _folding(table.title, len(table.rows), "rows", note + box)


def _text(title: str, text: str) -> str:
    return _folding(title, len(text.splitlines()), "lines", f"<pre>{escape(text)}</pre>")


def _is_long(table: PageTable) -> bool:
    """Whether a table is folded away, and stands behind those that are not."""
    return len(table.rows) > LONG


def _cell(cell: str, links: Mapping[str, str]) -> str:
    words = in_html(cell)
    return f'<a href="{escape(links[cell], quote=True)}">{words}</a>' if cell in links else words


def _folding(title: str, length: int, unit: str, content: str) -> str:
    """Content under its title, folded away where it is long."""
    is_long = length > LONG
    count = f" <small>{length} {unit}</small>" if is_long else ""
    opening = "<details>" if is_long else "<details open>"
    return f"{opening}<summary><h3>{escape(title)}{count}</h3></summary>{content}</details>\n"


def data_files(folder: Path) -> PageTable:
    """The data files that the folder has; the links hold as long as the page stays in it."""
    found = [(path, words) for name, words in CONTENTS.items() for path in sorted(folder.glob(name))]
    return _files_table("Data files", folder, found)


def picture_files(folder: Path, pictures: Sequence[tuple[str, str]]) -> PageTable:
    """The figures that stand beside the page: name of the file and title of each."""
    return _files_table("Figures as files", folder, [(folder / "report" / name, title) for name, title in pictures])


def _files_table(title: str, folder: Path, found: Sequence[tuple[Path, str]]) -> PageTable:
    names = [path.relative_to(folder).as_posix() for path, _ in found]
    rows = [[name, words, size(path.stat().st_size)] for name, (path, words) in zip(names, found, strict=True)]
    # The page stands in the folder `report`.
    links = {name: f"../{quote(name)}" for name in names}
    return PageTable(title, ["file", "what it holds", "size"], rows, numbers=frozenset({"size"}), links=links)


def size(byte_count: int) -> str:
    """A file's size in words, by powers of a thousand."""
    value, units = float(byte_count), ["B", "kB", "MB"]
    while value >= 999.5 and units[1:]:
        value, units = value / 1000.0, units[1:]
    return f"{value:.0f} {units[0]}" if value >= 99.5 or units[0] == "B" else f"{value:.2g} {units[0]}"
