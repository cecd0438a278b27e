"""The page in a browser: it never scrolls sideways, figures grow, and paper shows what was folded."""

import json
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

import pytest

from lithobrake.report import write_report

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(
    BROWSER is None, reason="no chromium on this machine, so the page is seen by no browser"
)

# What the page says of itself, told to the one around it, which gives it the width of a screen.
MEASURE = """<script>addEventListener("load", () => {
  const found = {width: innerWidth, content: document.documentElement.scrollWidth};
  const picture = document.querySelector(".picture img"), small = picture.width;
  picture.click();
  found.grown = picture.width / small;
  found.full = picture.naturalWidth / small;
  const folded = () => document.querySelectorAll("details:not([open])").length;
  found.folded = [folded()];
  for (const event of ["beforeprint", "afterprint"]) { dispatchEvent(new Event(event)); found.folded.push(folded()); }
  parent.postMessage(found, "*");
})</script>"""


@pytest.fixture(scope="module", params=["study_folder", "sequence_folder"])
def page(request: pytest.FixtureRequest) -> str:
    """Text of the page of a study by each method."""
    return write_report(request.getfixturevalue(request.param)).read_text(encoding="utf-8")


def seen(text: str, folder: Path, width: int) -> dict[str, Any]:
    """Open a page in a frame of a width [px], as no window of a desktop is as narrow as a phone; what it measured."""
    (folder / "page.html").write_text(text.replace("</body>", f"{MEASURE}</body>"), encoding="utf-8")
    (folder / "frame.html").write_text(
        '<script>addEventListener("message", (event) => { document.title = JSON.stringify(event.data); })</script>'
        f'<iframe src="page.html" style="border: 0; width: {width}px; height: 800px"></iframe>',
        encoding="utf-8",
    )
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1600,900"]
    options += ["--virtual-time-budget=5000", f"--user-data-dir={folder / 'profile'}"]
    command = [str(BROWSER), *options, "--dump-dom", (folder / "frame.html").as_uri()]
    ended = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    title = re.search(r"<title>(.*?)</title>", ended.stdout)
    assert title is not None, ended.stderr
    found: dict[str, Any] = json.loads(unescape(title[1]))
    return found


@pytest.mark.parametrize("width", [390, 768])
def test_page_on_a_narrow_screen_and_on_paper(page: str, tmp_path: Path, width: int) -> None:
    found = seen(page, tmp_path, width)
    assert found["width"] == found["content"] == width
    assert found["grown"] == pytest.approx(found["full"])
    before, printed, after = found["folded"]
    assert before == after > 0
    assert printed == 0
