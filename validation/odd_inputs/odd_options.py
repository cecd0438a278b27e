"""Odd options: every command of the command line with two of its options or arguments at values of no use."""

import inspect
import random
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, get_args, get_type_hints

import typer
from finished import Finished, command, quick
from judge import Case, Late, Silent

from lithobrake.cli import app

# What each command is given where it is not odd.
USUAL: dict[str, tuple[str, ...]] = {
    "new": ("made",), "examples": (), "doctor": ("--quick",), "plan": ("first.toml", "--out", "first"),
    "status": ("journeys",), "report": ("first",), "runs": ("journeys",), "view": ("first",), "film": ("journeys",),
    "compare": ("first", "first"), "export": ("journeys", "--to", "geojson"), "push": ("journeys", "--speed", "0.01"),
    "sites": ("journeys.toml", "--out", "journeys", "--cells", "4", "--landers", "2"), "land": ("first.toml",),
    "serve": ("first.toml", "--out", "first", "--port", "0"), "infer": ("first",),
    "rare": ("first.toml", "fast", "--out", "first", "--landings", "4", "--workers", "1"),
}  # fmt: skip
OF_STUDY = ("first.toml", "--out", "first", "--workers", "1")
NOT_FINITE = ("nan", "inf", "-inf", "NaN")
NUMBERS = ("0", "-1", "1e300", "-1e300", "1e-300", "5e-324", "", "x", "1_0", "٣", "0x10", "1e3", "9" * 30, "1,5", "5 m",
           "2", "0.5", " 3", *NOT_FINITE)  # fmt: skip
PATHS = ("", " ", "ä 名.csv", "none/such/file", "/dev/null", "/dev/zero", ".", "..", "a\nb.csv", "x" * 300,
         "\u202ex.csv", "%s", "first", "first.toml", "first/runs.sqlite", "states.csv", "journeys/keys.json",
         "body.obj", "x.mp4", "x.png", "x.html", "x.h5", "x.csv")  # fmt: skip
WORDS: dict[str, tuple[str, ...]] = {
    "change": ("grain.friction=nan", "x=1", "grain.friction=", "impact.speed=1e300", "seed=2", "=", "",
               "grain.friction=0.4", "impact.speed=ä", "impact.speed=0.1=0.2", "grain=1", "impact.speed=-1"),
    "at": ("nan,nan", "91,0", "1e300,0", "1", ",", "1,2,3", "ä,1", "0,inf", " 1 , 2 "),
    "scheduler": ("x", "tcp://x:99999", "", "tcp://", "http://127.0.0.1:1"),
    "host": ("", "256.1.1.1", "x y", "ä", "\x00"),
    "to": ("oem", "aem", "spk", "czml", "plates", "facets", "geotiff", "vtkhdf", "sheet", "x", "", "OEM"),
    "frame": ("fixed", "icrf", "x", "", "Inertial"),
    "epoch": ("2027-02-30T00:00:00", "x", "", "2026-11-22T12:00:00", "0001-01-01T00:00:00", "9999-12-31T23:59:60",
              "nan"),
    "body": ("Bennu", "x", "", "ä", "dimorphos", "Phobos"),
    "lander": ("0U", "1U", "13U", "x", "", "-1U", "nanU", "1e300U"),
    "run": ("0", "-1", "x", "", "999999", "٣", "0" * 64, "nan"),
}  # fmt: skip


def option_cases(chance: random.Random, count: int, folder: Path) -> Iterator[Case]:
    """So many commands with two odd options; each command has its turn before any has a second one."""
    folder = folder / "options"
    folder.mkdir()
    finished = Finished.made(folder)
    commands: dict[str, Any] = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    left: list[str] = []
    for _ in range(count):
        left = left or chance.sample(list(commands), len(commands))
        yield _case(chance, finished, commands[left.pop()])


def _case(chance: random.Random, finished: Finished, asked: Any) -> Case:
    name = str(asked.name)
    words, never, kinds = list(USUAL.get(name, OF_STUDY)), False, []
    own = [one for one in asked.params if one.name != "help"]
    hints = get_type_hints(inspect.unwrap(asked.callback))
    for one in chance.sample(own, min(2, len(own))):
        takes = {hints.get(one.name), *get_args(hints.get(one.name))}
        value = _value(chance, one, bool(takes & {int, float}))
        kinds.append(str(one.name))
        never |= value in NOT_FINITE and bool(takes & {int, float})
        if one.param_type_name == "argument":
            place = [other.name for other in own if other.param_type_name == "argument"].index(one.name)
            words[place : place + 1] = [str(value)]
        elif value is None:
            words.append(one.opts[0])
        else:
            # "=" keeps a value that begins with a dash apart from options.
            words = [*_without(words, one), f"{one.opts[0]}={value}"]
    return Case(f"{name}", f"lithobrake {name} {' '.join(map(_short, words))}", never, _given(finished, name, words))


def _value(chance: random.Random, asked: Any, is_number: bool) -> str | None:
    """An odd value of an option; None for a switch."""
    if getattr(asked, "is_flag", False):
        return None
    if str(asked.name) in WORDS:
        return chance.choice(WORDS[str(asked.name)])
    return chance.choice(NUMBERS if is_number else PATHS)


def _without(words: list[str], asked: Any) -> list[str]:
    """Words of a command without an option that takes a value."""
    for sign in asked.opts:
        if sign in words:
            place = words.index(sign)
            words = words[:place] + words[place + 2 :]
    return words


def _given(finished: Finished, name: str, words: list[str]) -> Callable[[Path], None]:
    def plan(folder: Path) -> None:
        finished.copied(folder)
        before = _files(folder)
        try:
            with quick():
                said = command(folder, name, *words)
        except ValueError as error:
            if new := sorted(_files(folder) - before):
                raise Late(f"it is refused after it wrote {', '.join(new)[:200]}: {error}") from error
            raise
        if odd := re.search(r"(?<![\w./-])(nan|inf|NaN|Infinity)(?![\w./-])", said):
            line = next(line for line in said.splitlines() if odd[0] in line)
            raise Silent(f"it says {line.strip()[:200]}")

    return plan


def _files(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.suffix != ".lock"}


def _short(word: str) -> str:
    text = word if word.isprintable() and word.strip() == word and word else repr(word)
    return text if len(text) < 60 else f"{text[:40]}... ({len(text)} characters)"
