"""The visible text of a page, one line for each heading, sentence, tile, caption and row of a table."""

import re
from html.parser import HTMLParser

LINES = {"p", "h1", "h2", "li", "figcaption", "summary", "tr", "pre", "footer", "title"}
HIDDEN = {"script", "style", "noscript", "pre"}
# What another day, machine or version writes otherwise.
OTHERWISE = (
    (r"Study of \d{4}-\d\d-\d\d, \d\d:\d\d UTC", "Study of DATE"),
    (r"\b[\d.]+ [kM]?B\b", "SIZE"),
    # Rounding, and nothing else.
    (r"flights changes by [^ ]+ × [^ ]+ m²/s²", "flights changes by ROUNDING m²/s²"),
    (r"(?m)^((?:date|folder|host|system|cores|python|packages|wall_s|runs\.\w*_s)[\w.-]*) \| .*$", r"\1 | VALUE"),
)


class _Lines(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.lines, self.hidden = [""], 0

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.hidden += tag in HIDDEN
        if tag in LINES:
            self.lines.append("")

    def handle_endtag(self, tag: str) -> None:
        self.hidden -= tag in HIDDEN
        if tag in ("td", "th", "b"):
            self.lines[-1] += " | "
        if tag in LINES:
            self.lines.append("")

    def handle_data(self, data: str) -> None:
        self.lines[-1] += "" if self.hidden else data


def visible_text(page: str) -> str:
    """The words that a reader sees, with what is of the day and the machine replaced."""
    parser = _Lines()
    parser.feed(page)
    lines = (re.sub(r"\s+", " ", line).strip(" |") for line in parser.lines)
    text = "\n".join(line for line in lines if line) + "\n"
    for pattern, words in OTHERWISE:
        text = re.sub(pattern, words, text)
    return text
