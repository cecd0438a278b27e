"""The page in a real browser, from disk: what a reader moves moves, and nothing leaves the machine."""

import json
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


@pytest.fixture(scope="module", params=["paper_folder", "first_folder", "asked_folder"])
def report(request: pytest.FixtureRequest) -> Path:
    """The page of each study."""
    return Path(request.getfixturevalue(request.param)) / "report" / "index.html"


@pytest.fixture(scope="module")
def first(first_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of first touchdowns away from its folder: it needs nothing but itself."""
    alone = tmp_path_factory.mktemp("alone") / "index.html"
    shutil.copy(first_folder / "report" / "index.html", alone)
    return alone


@pytest.mark.parametrize(("width", "dark"), [(PHONE, False), (TABLET, True), (LAPTOP, False)])
def test_no_width_scrolls_sideways_and_the_console_is_clean(
    page: Page, report: Path, width: int, dark: bool, tmp_path: Path
) -> None:
    page.events.clear()
    page.open(report, width, dark=dark)
    assert page.value(STARTED) is True
    assert page.value("document.documentElement.scrollWidth") == width
    ground = page.value("getComputedStyle(document.body).backgroundColor")
    assert ground == ("rgb(20, 25, 31)" if dark else "rgb(255, 255, 255)")
    # A picture of the whole page makes a browser draw what lies below the first screen, which takes seconds.
    if width == LAPTOP:
        page.picture(tmp_path / "page.png")
        assert (tmp_path / "page.png").read_bytes().startswith(b"\x89PNG")
    assert page.complaints == []
    assert page.requests == [report.as_uri()]


def test_paper_has_all_warnings_and_neither_controls_nor_files(page: Page, report: Path) -> None:
    page.open(report, PAPER, print_=True)
    assert page.value("document.documentElement.scrollWidth") <= PAPER
    heights = "['nav', '.live', '#files', '#appendix'].map((one) => document.querySelector(one).offsetHeight)"
    assert page.value(heights) == [0, 0, 0, 0]
    folded = "document.querySelectorAll('.warnings:not([open])').length"
    before = page.value(folded)
    page.value("dispatchEvent(new Event('beforeprint'))")
    assert page.value(folded) == 0
    page.value("dispatchEvent(new Event('afterprint'))")
    assert page.value(folded) == before


@pytest.mark.parametrize(("width", "height"), [(PHONE, 844), (TABLET, 1024), (LAPTOP, 800)])
def test_the_first_screen_has_the_answer_the_numbers_and_the_map(
    page: Page, report: Path, width: int, height: int
) -> None:
    page.open(report, width, height)
    top, bottom = page.value(
        "(() => { const box = (one) => document.querySelector(one).getBoundingClientRect();"
        "return [box('.first img').top, box('.tiles').bottom]; })()"
    )
    assert bottom < height
    # On a phone the map begins there, else it is whole.
    assert top < 0.8 * height
    whole = page.value("document.querySelector('.first img').getBoundingClientRect().bottom")
    assert width == PHONE or whole < height


def test_the_contents_stay_in_view_and_mark_where_one_is(page: Page, report: Path) -> None:
    page.open(report, PHONE, 844)
    marked = "document.querySelector('nav a[aria-current]').textContent"
    assert page.value(marked) == "Answer"
    page.value("document.querySelector('#how-sure').scrollIntoView()")
    page.value("new Promise((done) => setTimeout(done, 200))")
    assert page.value(marked) == "How sure"
    assert page.value("document.querySelector('nav').getBoundingClientRect().top") == 0


def test_a_figure_fills_the_window_until_it_is_left(page: Page, report: Path) -> None:
    page.open(report, PHONE)
    show = "(() => { const one = document.querySelector('.picture img').getBoundingClientRect();"
    show += " return [one.width, one.height]; })()"
    small = page.value(show)
    page.value("document.querySelector('.picture img').click()")
    width, height = page.value(show)
    assert [width, height] == page.value("[innerWidth, innerHeight]")
    assert width > small[0]
    page.value("dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' }))")
    assert page.value(show) == small


def test_a_page_is_light_enough_to_be_sent(report: Path) -> None:
    assert report.stat().st_size < LARGEST_PAGE


def test_tables_are_sorted_by_a_click_and_come_back(page: Page, report: Path) -> None:
    page.open(report, LAPTOP)
    title = "Data files"
    click = "table.querySelectorAll('th button')[2].click();"
    read = "[...table.tBodies[0].rows].map((row) => row.cells[2].textContent)"
    begin = (
        "const table = [...document.querySelectorAll('details')].find((one) => "
        f"one.querySelector('h3')?.textContent.startsWith('{title}')).querySelector('table');"
    )
    came, up, down, back = page.value(
        f"(() => {{ {begin} const read = () => {read}; const found = [read()];"
        f"for (let turn = 0; turn < 3; turn++) {{ {click} found.push(read()); }} return found; }})()"
    )
    numbers = [float(cell.split()[0]) for cell in up]
    assert numbers == sorted(numbers)
    assert sorted(came) == sorted(down)
    assert [float(cell.split()[0]) for cell in down] == numbers[::-1]
    assert back == came


def test_short_tables_stand_before_long_ones_in_each_part(page: Page, report: Path) -> None:
    page.open(report, LAPTOP)
    found = page.value(
        "[...document.querySelectorAll('section')].map((one) =>"
        " [...one.querySelectorAll(':scope > details')].map((table) => table.open))"
    )
    assert all(part == sorted(part, reverse=True) for part in found)
    assert sum(map(len, found)) > 5
    assert not all(map(all, found))


def test_an_end_of_an_input_moves_every_number(page: Page, first: Path) -> None:
    page.open(first, LAPTOP)
    read = "[...document.querySelectorAll('#explorer figcaption, #explorer .share')].map((one) => one.textContent)"
    before = page.value(read)
    # Two ends of each of the seven inputs.
    assert page.value("document.querySelectorAll('#explorer input[type=range]').length") == 14
    # The density of the grains, between its median and its end.
    page.value(
        "(() => { const end = document.querySelector('#explorer input'); end.value = 0.9;"
        "end.dispatchEvent(new Event('input')); })()"
    )
    # What is read is what the law gives there, as soon as all draws are made.
    share = page.value(
        "(() => { const { explorer } = explorers;"
        "const found = explorer.at([[0.9, 1], ...Array.from({ length: 6 }, () => [0, 1])]);"
        "return shareWords(explorer, found); })()"
    )
    page.value(
        "new Promise((done) => { const look = () => document.querySelector('#explorer .share').textContent === "
        f"{json.dumps(share)} ? done() : setTimeout(look, 50); look(); }})"
    )
    after = page.value(read)
    assert len(before) == len(after) == 5
    assert all(old != new for old, new in zip(before[:4], after[:4], strict=True))
    assert page.value("document.querySelector('#explorer output').textContent") == "2850 to 3000 kg/m³"


def test_the_landing_moves_as_it_was_stored(page: Page, first: Path, first_folder: Path) -> None:
    page.open(first, LAPTOP)
    assert page.value(STARTED) is True
    moving = open_study(first_folder).median_landing
    quantum = 0.5 * float(np.ptp(moving.position, axis=0).max()) / 32767
    for frame in (0, 3, len(moving.time) - 1):
        place = page.value(f"landing3d.then((view) => {{ view.moment = {frame}; view.draw(); return view.lander(); }})")
        assert place == pytest.approx(moving.position[frame, -1], abs=0.51 * quantum + 1e-6)
    # The bodies, the floor and its grid.
    assert page.value("landing3d.then((view) => view.drawCalls)") == 3
    # Something is seen, and it is another picture when the lander is followed.
    look = "landing3d.then((view) => { view.follows = %s; view.draw(); return view.canvas.toDataURL(); })"
    assert page.value(look % "false") != page.value(look % "true")
    colour = "landing3d.then((view) => { view.colourBy(%s); view.draw(); return view.canvas.toDataURL(); })"
    assert len({page.value(colour % name) for name in ("null", "'speed'", "'force'")}) == 3


def test_the_choice_of_colour_is_what_the_landing_has(page: Page, first: Path) -> None:
    page.open(first, LAPTOP)
    assert page.value(STARTED) is True
    names = "[...document.querySelectorAll('#landing-3d select option')].map((one) => one.value)"
    assert page.value(names) == ["body", "speed", "force"]
    chosen = page.value(
        "(() => { const colour = document.querySelector('#landing-3d select'); colour.value = 'force';"
        "colour.dispatchEvent(new Event('change')); return landing3d.then((view) => view.shade); })()"
    )
    assert chosen == "force"


def test_the_slider_of_the_landing_tells_the_time(page: Page, first: Path) -> None:
    page.open(first, LAPTOP)
    assert page.value(STARTED) is True
    page.value(
        "(() => { const slider = document.querySelector('#landing-3d input[type=range]'); slider.value = slider.max;"
        "slider.dispatchEvent(new Event('input')); })()"
    )
    assert page.value("document.querySelector('#landing-3d output').textContent") == "t = 0.700 s"


def test_the_marker_moves_along_the_way_of_a_lander(page: Page, first: Path, first_folder: Path) -> None:
    page.open(first, LAPTOP)
    assert page.value(STARTED) is True
    place = open_study(first_folder).flight_paths[0]
    for way, part in ((0, 0.0), (0, 1.0), (1, 0.5)):
        found = page.value(
            f"(() => {{ const [choice, slider] = document.querySelectorAll('#body-3d select, #body-3d input');"
            f"choice.value = {way}; choice.dispatchEvent(new Event('change')); slider.value = {part} * slider.max;"
            "slider.dispatchEvent(new Event('input')); return body3d.then((view) => view.lander()); })()"
        )
        assert found == pytest.approx(place[way, round(part * (place.shape[1] - 1))], abs=1e-3)
    words = "[...document.querySelectorAll('#body-3d .stage span')].map((one) => one.textContent)"
    bar, *labels = page.value(words)
    assert bar.endswith(" m")
    assert labels[:2] == ["north", "aim point"]
