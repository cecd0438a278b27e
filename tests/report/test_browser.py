"""The page in a real browser, from disk: what a reader moves moves, and nothing leaves the machine."""

import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from lithobrake.results import open_study

from .browser import Page, browser_page, needs_browser

pytestmark = needs_browser

PHONE, TABLET, LAPTOP, PAPER = 390, 768, 1366, 720
LARGEST_PAGE = 10e6
# The views begin when their arrays are inflated.
STARTED = "Promise.all([landing3d, body3d]).then((views) => views.every(Boolean))"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with browser_page(tmp_path_factory.mktemp("browser")) as opened:
        yield opened


@pytest.fixture(scope="module")
def alone(first_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the page of first touchdowns in a folder of its own."""
    copy = tmp_path_factory.mktemp("alone") / "index.html"
    shutil.copy(first_folder / "report" / "index.html", copy)
    return copy


@pytest.fixture(scope="module", params=["paper_folder", "asked_folder", "first_folder"])
def report(request: pytest.FixtureRequest) -> Path:
    """The page of each study; that of first touchdowns away from its folder: it needs nothing but itself."""
    if request.param == "first_folder":
        return Path(request.getfixturevalue("alone"))
    return Path(request.getfixturevalue(request.param)) / "report" / "index.html"


@pytest.fixture(scope="module")
def shown(page: Page, report: Path) -> Page:
    """The page of each study, opened once: tests ask for the screen that they need and leave it as they found it."""
    page.events.clear()
    page.open(report, PHONE)
    assert page.value(STARTED) is True
    return page


@pytest.fixture(scope="module")
def first(page: Page, alone: Path) -> Page:
    """The page of first touchdowns, which is open where it was the last of all."""
    if page.value("location.href") == alone.as_uri():
        page.screen(LAPTOP)
    else:
        page.open(alone, LAPTOP)
    assert page.value(STARTED) is True
    return page


def test_no_width_scrolls_sideways_and_the_console_is_clean(
    shown: Page, report: Path, asked_folder: Path, tmp_path: Path
) -> None:
    for width, dark in ((LAPTOP, False), (TABLET, True), (PHONE, False)):
        shown.screen(width, dark=dark)
        assert shown.value("document.documentElement.scrollWidth") == width
        ground = shown.value("getComputedStyle(document.body).backgroundColor")
        assert ground == ("rgb(20, 25, 31)" if dark else "rgb(255, 255, 255)")
    assert shown.value("Promise.all([...document.images].map((one) => one.decode())).then((all) => all.length)") > 5
    # A picture of the whole page makes a browser draw what lies below the first screen, which takes many seconds: that
    # of the study of which all is asked.
    if asked_folder in report.parents:
        shown.picture(tmp_path / "page.png")
        assert (tmp_path / "page.png").read_bytes().startswith(b"\x89PNG")
    assert shown.complaints == []
    assert shown.requests == [report.as_uri()]


def test_paper_has_all_warnings_and_neither_controls_nor_files(shown: Page) -> None:
    shown.screen(PAPER, print_=True)
    assert shown.value("document.documentElement.scrollWidth") <= PAPER
    heights = "['nav', '.live', '#files', '#appendix'].map((one) => document.querySelector(one).offsetHeight)"
    assert shown.value(heights) == [0, 0, 0, 0]
    folded = "document.querySelectorAll('.warnings:not([open])').length"
    before = shown.value(folded)
    shown.value("dispatchEvent(new Event('beforeprint'))")
    assert shown.value(folded) == 0
    shown.value("dispatchEvent(new Event('afterprint'))")
    assert shown.value(folded) == before


def test_the_first_screen_has_the_answer_the_numbers_and_the_map(shown: Page) -> None:
    for width, height in ((PHONE, 844), (TABLET, 1024), (LAPTOP, 800)):
        shown.screen(width, height)
        top, bottom, whole = shown.value(
            "(() => { const box = (one) => document.querySelector(one).getBoundingClientRect();"
            "return [box('.first img').top, box('.tiles').bottom, box('.first img').bottom]; })()"
        )
        assert bottom < height
        # On a phone the map begins there, else it is whole.
        assert top < 0.8 * height
        assert width == PHONE or whole < height


def test_the_contents_stay_in_view_and_mark_where_one_is(shown: Page) -> None:
    shown.screen(PHONE, 844)
    marked = "document.querySelector('nav a[aria-current]').textContent"
    assert shown.value(marked) == "Answer"
    shown.value("document.querySelector('#how-sure').scrollIntoView()")
    # It is marked when the browser next draws; a page that never does runs into the patience of the browser.
    shown.value(
        f"new Promise((done) => {{ const look = () => {marked} === 'How sure' ? done() : setTimeout(look, 20);"
        " look(); })"
    )
    assert shown.value("document.querySelector('nav').getBoundingClientRect().top") == 0
    shown.value("scrollTo(0, 0)")


def test_a_figure_fills_the_window_until_it_is_left(shown: Page) -> None:
    shown.screen(PHONE)
    show = "(() => { const one = document.querySelector('.picture img').getBoundingClientRect();"
    show += " return [one.width, one.height]; })()"
    small = shown.value(show)
    shown.value("document.querySelector('.picture img').click()")
    width, height = shown.value(show)
    assert [width, height] == shown.value("[innerWidth, innerHeight]")
    assert width > small[0]
    shown.value("dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' }))")
    assert shown.value(show) == small


def test_a_page_is_light_enough_to_be_sent(report: Path) -> None:
    assert report.stat().st_size < LARGEST_PAGE


def test_tables_are_sorted_by_a_click_and_come_back(shown: Page) -> None:
    shown.screen(LAPTOP)
    title = "Data files"
    click = "table.querySelectorAll('th button')[2].click();"
    read = "[...table.tBodies[0].rows].map((row) => row.cells[2].textContent)"
    begin = (
        "const table = [...document.querySelectorAll('details')].find((one) => "
        f"one.querySelector('h3')?.textContent.startsWith('{title}')).querySelector('table');"
    )
    came, up, down, back = shown.value(
        f"(() => {{ {begin} const read = () => {read}; const found = [read()];"
        f"for (let turn = 0; turn < 3; turn++) {{ {click} found.push(read()); }} return found; }})()"
    )
    numbers = [float(cell.split()[0]) for cell in up]
    assert numbers == sorted(numbers)
    assert sorted(came) == sorted(down)
    assert [float(cell.split()[0]) for cell in down] == numbers[::-1]
    assert back == came


def test_explorers_run(shown: Page, report: Path, asked_folder: Path) -> None:
    names = ["explorer", "touchdown-explorer"] if asked_folder in report.parents else ["explorer"]
    assert sorted(shown.value("Object.keys(explorers)")) == names
    for name in names:
        assert re.match(r"[\d.]+ % ", shown.value(f"document.querySelector('#{name} .share').textContent"))
    assert shown.complaints == []


def test_short_tables_stand_before_long_ones_in_each_part(shown: Page) -> None:
    shown.screen(LAPTOP)
    found = shown.value(
        "[...document.querySelectorAll('section')].map((one) =>"
        " [...one.querySelectorAll(':scope > details')].map((table) => table.open))"
    )
    assert all(part == sorted(part, reverse=True) for part in found)
    assert sum(map(len, found)) > 5
    assert not all(map(all, found))


def test_an_end_of_an_input_moves_every_number(first: Page) -> None:
    read = "[...document.querySelectorAll('#explorer figcaption, #explorer .share')].map((one) => one.textContent)"
    before = first.value(read)
    # Two ends of each of the seven inputs.
    assert first.value("document.querySelectorAll('#explorer input[type=range]').length") == 14
    # The density of the grains, between its median and its end.
    first.value(
        "(() => { const end = document.querySelector('#explorer input'); end.value = 0.9;"
        "end.dispatchEvent(new Event('input')); })()"
    )
    # What is read is what the law gives there, as soon as all draws are made.
    share = first.value(
        "(() => { const { explorer } = explorers;"
        "const found = explorer.at([[0.9, 1], ...Array.from({ length: 6 }, () => [0, 1])]);"
        "return shareWords(explorer, found); })()"
    )
    first.value(
        "new Promise((done) => { const look = () => document.querySelector('#explorer .share').textContent === "
        f"{json.dumps(share)} ? done() : setTimeout(look, 50); look(); }})"
    )
    after = first.value(read)
    assert len(before) == len(after) == 5
    assert all(old != new for old, new in zip(before[:4], after[:4], strict=True))
    assert first.value("document.querySelector('#explorer output').textContent") == "2850 to 3000 kg/m³"


def test_the_landing_moves_as_it_was_stored(first: Page, first_folder: Path) -> None:
    moving = open_study(first_folder).median_landing
    quantum = 0.5 * float(np.ptp(moving.position, axis=0).max()) / 32767
    for frame in (0, 3, len(moving.time) - 1):
        place = first.value(
            f"landing3d.then((view) => {{ view.moment = {frame}; view.draw(); return view.lander(); }})"
        )
        assert place == pytest.approx(moving.position[frame, -1], abs=0.51 * quantum + 1e-6)
    # The bodies, the floor and its grid.
    assert first.value("landing3d.then((view) => view.drawCalls)") == 3
    # Something is seen, and it is another picture when the lander is followed.
    look = "landing3d.then((view) => { view.follows = %s; view.draw(); return view.canvas.toDataURL(); })"
    assert first.value(look % "false") != first.value(look % "true")
    colour = "landing3d.then((view) => { view.colourBy(%s); view.draw(); return view.canvas.toDataURL(); })"
    assert len({first.value(colour % name) for name in ("null", "'speed'", "'force'")}) == 3


def test_the_choice_of_colour_is_what_the_landing_has(first: Page) -> None:
    names = "[...document.querySelectorAll('#landing-3d select option')].map((one) => one.value)"
    assert first.value(names) == ["body", "speed", "force"]
    chosen = first.value(
        "(() => { const colour = document.querySelector('#landing-3d select'); colour.value = 'force';"
        "colour.dispatchEvent(new Event('change')); return landing3d.then((view) => view.shade); })()"
    )
    assert chosen == "force"


def test_the_slider_of_the_landing_tells_the_time(first: Page) -> None:
    first.value(
        "(() => { const slider = document.querySelector('#landing-3d input[type=range]'); slider.value = slider.max;"
        "slider.dispatchEvent(new Event('input')); })()"
    )
    assert first.value("document.querySelector('#landing-3d output').textContent") == "t = 0.700 s"


def test_the_marker_moves_along_the_way_of_a_lander(first: Page, first_folder: Path) -> None:
    place = open_study(first_folder).flight_paths[0]
    for way, part in ((0, 0.0), (0, 1.0), (1, 0.5)):
        found = first.value(
            f"(() => {{ const [choice, slider] = document.querySelectorAll('#body-3d select, #body-3d input');"
            f"choice.value = {way}; choice.dispatchEvent(new Event('change')); slider.value = {part} * slider.max;"
            "slider.dispatchEvent(new Event('input')); return body3d.then((view) => view.lander()); })()"
        )
        assert found == pytest.approx(place[way, round(part * (place.shape[1] - 1))], abs=1e-3)
    words = "[...document.querySelectorAll('#body-3d .stage span')].map((one) => one.textContent)"
    bar, *labels = first.value(words)
    assert bar.endswith(" m")
    assert labels[:2] == ["north", "aim point"]
