"""What the documents tell a reader to type works: Python is run, commands are parsed, data have the keys that exist."""

import ast
import json
import os
import re
import runpy
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
import typer
from blocks import PAGES, ROOT, Block, all_blocks, blocks
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.study import known_keys

LANGUAGES = {"python", "sh", "toml", "json", "text", "math"}
# Blocks that say why they are not run: two that take minutes, the rest other people's programs, kernels, a cluster.
LEFT_OUT = 10
PAGES_WITH_PYTHON = [page for page in PAGES if any(block.language == "python" for block in blocks(page))]
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


def run_script(path: Path) -> None:
    """Run a script as a reader would, one that has no worker processes without another start of Python."""
    if "__main__" not in path.read_text(encoding="utf-8"):
        assert runpy.run_path(str(path), run_name="__main__")
        return
    setting = {**os.environ, "PYTHONPATH": str(ROOT)}
    found = subprocess.run([sys.executable, path], env=setting, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr


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
    run_script(path)


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


def test_commands_that_are_marked_run(workplace: Path) -> None:
    marked = [block for block in all_blocks("sh") if block.remark == "run"]
    assert marked
    for block in marked:
        for words in commands(block):
            found = CliRunner().invoke(app, words)
            assert found.exit_code == 0, f"{block}: {found.output}"


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
NAMED_TABLES = ("lander.part", "soil")


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
