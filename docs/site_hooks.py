"""What the site does beside mkdocs: equations become MathML, figures lead to their files, the showcase is copied.

Pages stay readable without it: `$x$` and blocks marked math are what other viewers of Markdown take as LaTeX, and
links to ../showcase/ lead to its pictures in the repository. The built pages need no script and no font of others.
"""

import re
from html import unescape
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert
from pymdownx.arithmatex import arithmatex_fenced_format

SHOWCASE = Path(__file__).parents[1] / "showcase"
# Says where numbers come from, for a test.
SOURCES = re.compile(r"\n *<!-- numbers\b.*?-->", flags=re.DOTALL)
FIGURE = re.compile(r'<p>(<img [^>]*?src="([^"]+)"[^>]*>)</p>')
EQUATION = re.compile(r'<(span|div) class="arithmatex">\s*\\[(\[](.*?)\\[)\]]\s*</\1>([,.;:)]*)', flags=re.DOTALL)


def on_config(config: Any) -> Any:
    """Let blocks marked math be equations."""
    fence = {"name": "math", "class": "arithmatex", "format": arithmatex_fenced_format(mode="generic")}
    config.mdx_configs.setdefault("pymdownx.superfences", {}).setdefault("custom_fences", []).append(fence)
    return config


def on_files(files: Any, config: Any) -> Any:
    """Add the pictures of the showcase to the site."""
    from mkdocs.structure.files import File

    for picture in sorted(SHOWCASE.rglob("*.png")):
        name = picture.relative_to(SHOWCASE.parent).as_posix()
        files.append(File.generated(config, name, abs_src_path=str(picture)))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Keep decisions out of the search, let links to the showcase lead into the site, and drop sources of numbers."""
    if page.file.src_uri.startswith("decisions/"):
        page.meta["search"] = {"exclude": True}
    markdown = SOURCES.sub("", markdown)
    return markdown.replace("](../showcase/", "](showcase/") if "/" not in page.file.src_uri else markdown


def on_page_content(html: str, **_: Any) -> str:
    """Turn each equation of a page into MathML, and let each figure lead to its file."""
    return FIGURE.sub(r'<p class="figure"><a href="\2">\1</a></p>', EQUATION.sub(as_mathml, html))


def as_mathml(equation: re.Match[str]) -> str:
    """An equation as MathML, with the comma or full stop behind it on the same line."""
    kind, latex, stop = equation.groups()
    display = "block" if kind == "div" else "inline"
    return f'<{kind} class="equation">{convert(unescape(latex).strip(), display=display)}{stop}</{kind}>'
