"""The pages of the documentation, what scripts write on them, and what they tell a reader to type."""

import ast
import csv
import json
import math
import re
import runpy
import shlex
import shutil
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, redirect_stdout
from importlib import import_module
from io import StringIO
from itertools import pairwise
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
import typer
from blocks import PAGES, ROOT, Block, all_blocks, blocks
from sources import wrong
from typer.testing import CliRunner

from lithobrake.analysis import half_width
from lithobrake.cli import app
from lithobrake.study import known_keys

from ..pipeline.few_terms import few_terms
from ..quick_studies import one_process

DOCS = ROOT / "docs"
# What only the other parts use has no public names.
INTERNAL = {"files", "vocabulary", "geometry", "compilation", "statements"}
PARTS = sorted({path.parent.name for path in (ROOT / "lithobrake").glob("*/__init__.py")} - INTERNAL)
LONGEST = 100


@pytest.mark.parametrize("part", ["", *PARTS])
def test_every_public_name_is_in_the_reference(part: str) -> None:
    module = f"lithobrake.{part}".rstrip(".")
    page = DOCS / "api" / f"{part or 'package'}.md"
    shown = re.findall(rf"^::: {re.escape(module)}\.(\w+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert sorted(shown) == sorted(import_module(module).__all__)


def test_every_page_is_in_the_navigation_once() -> None:
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:\n")[2]
    listed = re.findall(r"([\w/]+\.md)$", navigation, flags=re.MULTILINE)
    assert sorted(listed) == sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md"))


def test_lines_are_short_outside_tables_and_code() -> None:
    long = []
    for page in PAGES:
        in_code = False
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            in_code ^= line.startswith("```")
            # A picture or an address cannot be wrapped.
            breakable = not in_code and not line.startswith(("|", "```")) and " " in line.strip()[:LONGEST]
            if breakable and len(line) > LONGEST:
                long.append(f"{page.relative_to(ROOT)}:{number}")
    assert long == []


README = (ROOT / "README.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| \[[^\]]+\]\((docs/validation/\w+\.md)\)(.*)\|$", README, flags=re.MULTILINE)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def test_six_rows_stand_there_two_of_which_disagree() -> None:
    verdicts = [cells.split("|")[-1].strip() for _, cells in ROWS]
    assert (len(verdicts), verdicts.count("no")) == (6, 2)


@pytest.mark.parametrize(("page", "cells"), ROWS)
def test_numbers_of_a_row_stand_on_its_page(page: str, cells: str) -> None:
    assert set(NUMBER.findall(cells.split("|")[-2])) <= set(NUMBER.findall((ROOT / page).read_text(encoding="utf-8")))


def test_the_count_of_agreements_is_that_of_the_page() -> None:
    page = (ROOT / "docs" / "validation" / "index.md").read_text(encoding="utf-8")
    count = re.search(r"\d+ of \d+ quantities agree", page)
    assert count.group() in README
    assert count.group() in (ROOT / "docs" / "how_it_works.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("study", ["paper", "drawn_700", "first_bounce", "mission"])
def test_kept_ledgers_have_the_runs_of_their_summaries(study: str) -> None:
    folder = ROOT / "showcase" / study
    results = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["results"]
    analysis = results["expansion"]
    designs = {"drawn": results["runs"]} if analysis is None else analysis["designs"]
    for name, design in designs.items():
        with (folder / "runs" / f"{name}.csv").open(newline="", encoding="utf-8") as file:
            outcomes = Counter(row["outcome"] for row in csv.DictReader(file))
        assert outcomes == design["outcomes"], name


@pytest.fixture(scope="module")
def hooks() -> dict[str, Any]:
    """What docs/site_hooks.py defines."""
    pytest.importorskip("latex2mathml", reason="equations need latex2mathml: pip install -e .[docs]")
    pytest.importorskip("pymdownx", reason="equations need pymdown-extensions: pip install -e .[docs]")
    return runpy.run_path(str(ROOT / "docs" / "site_hooks.py"))


def test_equations_become_mathml_with_the_stop_behind_them(hooks: dict[str, Any]) -> None:
    line = hooks["on_page_content"]('<p>of <span class="arithmatex">\\(a &lt; b\\)</span>, and</p>')
    assert line.startswith('<p>of <span class="equation"><math ')
    assert line.endswith("</math>,</span> and</p>")
    assert 'display="inline"' in line
    block = hooks["on_page_content"]('<div class="arithmatex">\n\\[\n\\frac{1}{2}\n\\]\n</div>')
    assert "<mfrac>" in block
    assert 'display="block"' in block


@pytest.mark.parametrize(
    "page", [one for one in PAGES if "```math" in one.read_text("utf-8")], ids=lambda one: one.name
)
def test_equations_of_a_page_have_no_command_that_is_left_as_it_is(page: Any, hooks: dict[str, Any]) -> None:
    equations = page.read_text("utf-8").split("```math\n")[1:]
    for equation in equations:
        latex = equation.split("```")[0]
        found = hooks["on_page_content"](f'<div class="arithmatex">\\[{latex}\\]</div>')
        assert "\\" not in found, latex
        # An environment that is not known leaves its marks of alignment in the text.
        assert "<mi>&</mi>" not in found, latex


def test_a_figure_leads_to_its_file_and_a_picture_in_a_line_does_not(hooks: dict[str, Any]) -> None:
    picture = '<img alt="a map" src="../map.png" />'
    assert hooks["on_page_content"](f"<p>{picture}</p>") == f'<p class="figure"><a href="../map.png">{picture}</a></p>'
    assert hooks["on_page_content"](f"<p>see {picture}</p>") == f"<p>see {picture}</p>"


def test_pictures_of_the_showcase_are_part_of_the_site(hooks: dict[str, Any]) -> None:
    page = SimpleNamespace(file=SimpleNamespace(src_uri="gallery.md"))
    linked = hooks["on_page_markdown"]("![map](../showcase/mission/figures/figure_1_ends.png)", page=page)
    assert linked == "![map](showcase/mission/figures/figure_1_ends.png)"
    assert (ROOT / "showcase/mission/figures/figure_1_ends.png").is_file()


def test_sources_of_numbers_are_no_part_of_the_site(hooks: dict[str, Any]) -> None:
    page = SimpleNamespace(file=SimpleNamespace(src_uri="method.md"))
    source = "- 3 of 4.\n  <!-- numbers:\n  a = 3\n  a, [4][0]\n  -->\n- More.\n<!-- not run: it takes minutes -->\n"
    shown = hooks["on_page_markdown"](source, page=page)
    assert shown == "- 3 of 4.\n- More.\n<!-- not run: it takes minutes -->\n"


@pytest.mark.parametrize(("name", "is_left_out"), [("decisions/dem.md", True), ("method.md", False)])
def test_decisions_are_not_searched(name: str, is_left_out: bool, hooks: dict[str, Any]) -> None:
    page = SimpleNamespace(file=SimpleNamespace(src_uri=name), meta={})
    assert hooks["on_page_markdown"]("text", page=page) == "text"
    assert page.meta == ({"search": {"exclude": True}} if is_left_out else {})


STUDY_FILE_PAGE = ROOT / "docs" / "study_file.md"


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    """What docs/make_study_file_page.py defines."""
    return runpy.run_path(str(ROOT / "docs" / "make_study_file_page.py"))


def rows(section: str) -> dict[str, str]:
    """The row of each key of a section."""
    # A section whose tables have names of the user's own is headed by one of these.
    heading = rf"## `\[{section}(?:\.NAME)?\]`\n"
    text = re.split(heading, STUDY_FILE_PAGE.read_text(encoding="utf-8"))[1].partition("\n## ")[0]
    return {line.split("`")[1]: line for line in text.splitlines() if line.startswith("| `")}


def test_the_page_is_what_its_script_makes(script: dict[str, Any]) -> None:
    assert STUDY_FILE_PAGE.read_text(encoding="utf-8") == script["page"](), (
        "make it again with: python docs/make_study_file_page.py"
    )


def test_every_section_has_a_row_for_each_of_its_keys() -> None:
    sections = {name: keys for name, keys in known_keys().items() if name and "." not in name}
    assert len(sections) > 15
    for name, keys in sections.items():
        assert set(keys) <= rows(name).keys(), name


@pytest.mark.parametrize(("section", "key", "cells"), [
    ("grain", "poisson_ratio", "|  | [0, 0.5) ± | needed |"),
    ("grain", "young_modulus", "| Pa | > 0 ± | needed |"),
    ("bed", "sides", '| `"walls"`, `"periodic"` | `"periodic"` |'),
    ("surface", "gravity", '| m/s2 | any, `"site"` ± | `"site"` |'),
    ("bed", "boulders.coverage", "|  | (0, 0.3] | needed |"),
    ("flight", "duration", "| s | (0, 1e+11] | `43200.0` |"),
    ("campaign", "memory_limit", "| bytes | ≥ 1e+06 |  |"),
])  # fmt: skip
def test_a_row_has_unit_range_and_default(section: str, key: str, cells: str) -> None:
    assert rows(section)[key].endswith(cells)


def test_what_is_typed_is_code_and_no_letter_is_lost(script: dict[str, Any]) -> None:
    words = script["as_markdown"]
    assert words('as impact.speed, or [site] with "paper"; docs/chaos.md') == (
        'as `impact.speed`, or `[site]` with `"paper"`; [chaos.md](chaos.md)'
    )
    assert words("a | b, R* and R* fall with D**-exponent") == r"a \| b, R\* and R\* fall with `D**-exponent`"


LANGUAGES = {"python", "sh", "toml", "json", "text", "math"}
# Blocks that say why they are not run: two that take minutes, the rest other people's programs, kernels, a cluster.
LEFT_OUT = 14
PAGES_WITH_PYTHON = [page for page in PAGES if any(block.language == "python" for block in blocks(page))]
STUDIES = half_width.STUDIES
COMMANDS = typer.main.get_command(app)


def short(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@pytest.fixture
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with what a reader has who cloned the project: examples and scenarios."""
    for name in ("examples", "scenarios"):
        shutil.copytree(ROOT / name, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@contextmanager
def studies_here() -> Iterator[None]:
    """Studies have this process for a worker, and emulators that choose among little."""
    with one_process(), few_terms():
        yield


def run_script(path: Path) -> tuple[str, dict[str, Any]]:
    """What a script prints and defines, run as a reader would, without another start of Python.

    One with a guard makes a study, by a model of its own.
    """
    makes_study = "__main__" in path.read_text(encoding="utf-8")
    with studies_here() if makes_study else nullcontext(), redirect_stdout(StringIO()) as printed:
        defined = runpy.run_path(str(path), run_name="__main__")
    return printed.getvalue(), defined


def words(line: str) -> list[str]:
    """The words of a line, numbers to four digits, since the last ones differ from machine to machine."""
    return re.sub(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?", lambda one: f"{float(one[0]) + 1e-15:.4g}", line).split()


def not_printed(shown: str, printed: str) -> list[str]:
    """The lines of an output on a page that were not printed; what follows "..." in a line is cut, and "..." lines."""
    found = [words(line) for line in printed.splitlines()]
    begins = {line: words(line.partition("...")[0]) for line in shown.splitlines()}
    return [line for line, begin in begins.items()
            if not any(one[: len(begin)] == begin if "..." in line else one == begin for one in found)]  # fmt: skip


@pytest.mark.parametrize(
    ("shown", "missing"),
    [
        ("ends at 4.1933333333333333 m\n...\nat rest\n", []), ("ends at ...\n", []), ("left 1e-22 kg\n", []),
        ("ends at 4.194 m\nat rest\n", ["ends at 4.194 m"]), ("at rest again\n", ["at rest again"]),
    ],
)  # fmt: skip
def test_an_output_that_nobody_printed_is_found(shown: str, missing: list[str]) -> None:
    assert not_printed(shown, "ends at 4.193333333333336 m\nleft 3.1e-23 kg\nat rest\n") == missing


@pytest.mark.parametrize("page", PAGES_WITH_PYTHON, ids=short)
def test_python_of_a_page_runs_as_one_script(page: Path, workplace: Path) -> None:
    script: list[str] = []
    for block in blocks(page):
        if block.language == "python" and block.is_left_out:
            assert ast.parse(block.text).body
        elif block.language == "python":
            # Lines keep their numbers, so that a failure names the line of the page.
            script += [""] * (block.line - 1 - len(script)) + block.text.splitlines()
    path = workplace / "page.py"
    path.write_text("\n".join(script) + "\n", encoding="utf-8")
    printed, defined = run_script(path)
    assert wrong(page.read_text(encoding="utf-8"), defined) == []
    for above, block in pairwise(blocks(page)):
        if (above.language, block.language) == ("python", "text") and not above.is_left_out:
            assert not_printed(block.text, printed) == [], f"{block}: printed was\n{printed}"


def commands(block: Block) -> Iterator[list[str]]:
    """The words of each lithobrake command of a block."""
    for line in block.text.replace("\\\n", " ").splitlines():
        for part in re.split(r"&&|[|>;]", line.split("  #")[0]):
            words = shlex.split(part, comments=True)
            if words and words[0].endswith("lithobrake"):
                yield words[1:]


def test_commands_have_the_options_that_are_written() -> None:
    parsed = 0
    for block in all_blocks("sh"):
        for name, *words in commands(block):
            if name == "--help":
                continue
            assert name in COMMANDS.commands, f"{block}: lithobrake has no command {name}"
            # Raises where a word or option is not known.
            COMMANDS.commands[name].make_context(name, words)
            parsed += 1
    assert parsed > 10


def test_commands_that_are_marked_run(workplace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    marked = {block.page for block in all_blocks("sh") if block.remark == "run"}
    assert marked
    for above, block in (pair for page in marked for pair in pairwise(blocks(page)) if pair[0].remark == "run"):
        printed = ""
        # Half-widths that a page does not show are those of a few studies that are made up.
        monkeypatch.setattr(half_width, "STUDIES", STUDIES if "half-width" in block.text else 20)
        for arguments in commands(above):
            found = CliRunner().invoke(app, arguments)
            assert found.exit_code == 0, f"{above}: {found.output}"
            printed += found.output
        if block.language == "text":
            assert not_printed(block.text, printed) == [], f"{block}: printed was\n{printed}"


def test_scripts_that_are_named_exist() -> None:
    named = {word for block in all_blocks("sh") for word in re.findall(r"python3? ([\w/]+\.py)", block.text)}
    named |= {
        word
        for page in PAGES
        for word in re.findall(r"`python ((?:benchmarks|docs|examples|validation)/[\w/]+\.py)", page.read_text("utf-8"))
    }
    assert named
    assert [name for name in sorted(named) if not (ROOT / name).is_file()] == []


# Tables whose keys are names of the author's own.
AUTHORS_NAMES = ("solver.inputs", "limit_states", "aim.grid")
NAMED_TABLES = ("lander.part", "soil", "ground.kind")


def key_paths(tables: dict[str, object], above: str = "") -> Iterator[tuple[str, str]]:
    """The table and name of each key of a study file's part."""
    known = known_keys()
    for name, value in tables.items():
        path = f"{above}.{name}".lstrip(".")
        # Tables with names of the author's own have the keys of all such.
        if above in NAMED_TABLES and isinstance(value, dict):
            yield from ((above, key) for key in value)
        elif path in known and isinstance(value, dict):
            yield from key_paths(value, path)
        else:
            yield above, name


def test_study_files_have_known_keys() -> None:
    known, seen = known_keys(), 0
    for block in all_blocks("toml"):
        for table, name in key_paths(tomllib.loads(block.text)):
            assert table in AUTHORS_NAMES or name in known[table], f"{block}: [{table}] {name}"
            seen += 1
    assert seen > 5


def test_json_is_json() -> None:
    found = all_blocks("json")
    assert found
    assert all(json.loads(block.text) for block in found)


def test_every_block_has_a_language_that_is_looked_at() -> None:
    assert {block.language for page in PAGES for block in blocks(page)} <= LANGUAGES


def test_blocks_that_are_not_run_are_few_and_say_why() -> None:
    left_out = [str(block) for page in PAGES for block in blocks(page) if block.is_left_out]
    assert len(left_out) == LEFT_OUT, left_out


PAGE = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
PICTURE = re.compile(r"^!\[([^\]]+)\]\(([^)]+)\)\n\n\*([^*]+)\*\n\n```sh\n(.+)\n```$", flags=re.MULTILINE)
ENTRIES = PICTURE.findall(PAGE)


def test_every_picture_has_a_caption_and_a_command() -> None:
    assert len(ENTRIES) == PAGE.count("![") > 10


@pytest.mark.parametrize(("picture", "command"), [(entry[1], entry[3]) for entry in ENTRIES])
def test_the_picture_and_what_makes_it_exist(picture: str, command: str) -> None:
    assert (ROOT / "docs" / picture).is_file()
    program, *words = command.split()
    assert program in ("lithobrake", "python")
    made_of = next(word for word in words if "/" in word)
    # A study's folder is made by the study of its name.
    path = ROOT / (made_of if "." in made_of else f"scenarios/{made_of.removeprefix('runs/')}.toml")
    assert path.is_file()


@pytest.mark.parametrize(("picture", "command"), [(one[1], one[3]) for one in ENTRIES if one[3].startswith("python")])
def test_the_script_is_of_the_part_that_draws_the_picture(picture: str, command: str) -> None:
    """Some file beside the script, or the script itself, has the name of the picture."""
    script, name = ROOT / command.split()[1], picture.rpartition("/")[2].removesuffix(".png")
    beside = [script] if script.parent.name == "validation" else script.parent.glob("*.py")
    assert any(name in path.read_text(encoding="utf-8") for path in beside)


LEFT_OUT_PAGE = (ROOT / "docs" / "what_the_model_leaves_out.md").read_text(encoding="utf-8")
SCRIPT = runpy.run_path(str(ROOT / "validation" / "experiments" / "left_out.py"))


@pytest.mark.parametrize("table", ["contact_lines", "yield_lines", "cohesion_lines", "force_lines", "duration_lines"])
def test_the_page_has_the_tables_of_the_script(table: str) -> None:
    assert "\n".join(SCRIPT[table]()) in LEFT_OUT_PAGE


def test_a_sphere_on_a_plate_yields_where_johnson_says() -> None:
    """[Johnson-1985], Eq 11.20: density times speed squared over strength is 26 (strength / modulus)^4."""
    density, strength, modulus, radius = 2500.0, 1e6, 1e9, 0.01
    mass = density * 4.0 / 3.0 * math.pi * radius**3
    known = SCRIPT["yield_speed"].__globals__
    known["pair"], known["effective_modulus"] = (lambda: (mass, radius)), (lambda young: young)
    speed = SCRIPT["yield_speed"](strength, modulus)
    assert density * speed**2 / strength == pytest.approx(26.0 * (strength / modulus) ** 4, rel=0.02)


FOLDER = ROOT / "validation" / "experiments"


@pytest.fixture(scope="module")
def oblique_map() -> ModuleType:
    sys.path[:0] = [str(FOLDER), str(ROOT / "benchmarks")]
    try:
        return import_module("oblique_map")
    finally:
        del sys.path[:2]


@pytest.mark.parametrize(
    ("status", "way", "kind"),
    [
        ("captured", 0.02, "stop"), ("clear", 0.02, "bounce"), ("clear", 0.2, "along"),
        ("left_sideways", 0.2, "along"), ("left_sideways", 0.02, "lost"), ("left_sideways", math.nan, "lost"),
        ("time_limit", 0.2, "lost"),
    ],
)  # fmt: skip
def test_a_landing_is_told_by_outcome_and_way(oblique_map: ModuleType, status: str, way: float, kind: str) -> None:
    assert oblique_map.kind({"shape": "sphere", "status": status, "way": way}) == kind


def test_the_summary_is_that_of_the_table(oblique_map: ModuleType) -> None:
    kept = json.loads((FOLDER / "oblique_map.json").read_text(encoding="utf-8"))
    found = json.loads(json.dumps(oblique_map.cells(oblique_map.noted(FOLDER / "oblique_map.csv"))))
    assert found == kept["cells"]
    assert all(sum(share["count"] for share in entry["shares"].values()) == entry["landings"] for entry in found)
