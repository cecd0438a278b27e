"""Odd studies: every key of every section, with a value of another type, sign, unit, size or script, or given twice."""

import json
import math
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import base_studies
import tomli_w
from base_studies import NAMES, Tables
from judge import Case, refuse_nonfinite
from odd_values import kinds_of, odd_value

import lithobrake
from lithobrake.pipeline import plan_lines, plan_study
from lithobrake.study.quantity import Number
from lithobrake.study.units import limits

Path_ = tuple[str, ...]
# Of those that can be planned, one in so many is run; of those that change the physics one in fewer.
RUN_ONE_IN, RUN_PHYSICS_ONE_IN = 40, 10
# Keys of how much is made: a study that asks for more takes longer, which is no fault.
LONG = re.compile(r"count|level|degree\b|half_width|memory|wall_limit")
# One in so many studies has a second odd key, whose value is of the type that it takes.
TWO_ODD_ONE_IN = 3
VALID = ("sign", "unit", "size", "end", "law", "length", "unicode")
PHYSICS = ("sign", "unit", "size", "end", "law")
# Of these a program makes the touchdowns, or emulators of many landers are fitted.
NOT_RUN = ("programmed", "milani", "juventas")
# A letter of another script in place of one that looks like it.
TWINS = {"a": "\u0430", "e": "\u0435", "o": "\u043e", "p": "\u0440", "c": "\u0441", "i": "\u0456"}


def plate(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound from a plate, whose restitution is random."""
    speed, incidence = inputs["impact.speed"], math.radians(inputs["impact.incidence_deg"])
    up = speed * math.cos(incidence) * random.Random(seed).uniform(0.1, 0.5)
    if up < 0.004:
        return {"outcome": "captured", "outputs": {"duration": 10.0, "contacts": 1.0}}
    along = 0.5 * speed * math.sin(incidence)
    return {"outputs": {"velocity_out_x": along, "velocity_out_y": 0.0, "velocity_out_z": up, "spin_out": 0.01}}


def study_cases(chance: random.Random, count: int, names: tuple[str, ...] = NAMES) -> Iterator[Case]:
    """So many odd studies of these names; each key has its turn before any has a second one."""
    tables = {name: base_studies.base(name) for name in names}
    known = list(base_studies.keys_of())
    fields = dict(known)
    owners: dict[Path_, list[tuple[str, Path_]]] = {path: [] for path, _ in known}
    for name in names:
        for path in _paths(tables[name]):
            owners.setdefault(_general(path, fields), []).append((name, path))
    left: list[Path_] = []
    for _ in range(count):
        left = left or chance.sample(list(owners), len(owners))
        key = left.pop()
        # A key that no study has stands in one that has its table, else in any.
        name, path = chance.choice(owners[key] or _places(key, owners) or [(chance.choice(names), key)])
        yield _case(chance, name, path, tables[name], fields)


def _case(chance: random.Random, name: str, path: Path_, tables: Tables, fields: dict[Path_, Any]) -> Case:
    words = ""
    if chance.randrange(TWO_ODD_ONE_IN) == 0:
        other = chance.choice([one for one in _paths(tables) if not isinstance(_value(tables, one), dict)])
        old, allowed = _value(tables, other), _allowed(other, fields)
        kind = chance.choice([kind for kind in kinds_of(old, allowed) if kind in VALID] or [""])
        if kind and other != path:
            new, _ = odd_value(chance, kind, old, allowed)
            tables, words = _with(tables, other, new), f"{'.'.join(other)}: {_short(old)} is {_short(new)}, "
    old, allowed = _value(tables, path), _allowed(path, fields)
    if old is None:
        known = fields.get(_general(path, fields))
        old = {} if known is None else base_studies.fresh_value(known)
    kind = chance.choice(kinds_of(old, allowed))
    text, said, never = _mutated(chance, kind, tables, path, old, allowed)
    share = RUN_PHYSICS_ONE_IN if kind in PHYSICS else RUN_ONE_IN
    is_run = name not in NOT_RUN and not LONG.search(f"{words}{path[-1]}") and chance.randrange(share) == 0
    return study_case(kind, f"{name}, {words}{'.'.join(path)}: {said}", text, never, is_run)


def _allowed(path: Path_, fields: dict[Path_, Any]) -> Number | None:
    field = fields.get(_general(path, fields))
    return None if field is None else limits(field)


def study_case(kind: str, words: str, text: bytes, never: bool, is_run: bool) -> Case:
    """A case of a study file with this content."""

    def plan(folder: Path) -> None:
        base_studies.write_files(folder)
        path = folder / "study.toml"
        path.write_bytes(text)
        found = plan_study(path, folder / "out", 1)
        refuse_nonfinite(found.to_json())
        plan_lines(found)

    def run(folder: Path) -> None:
        tables = base_studies.tomllib.loads(text.decode())
        lithobrake.run(tables, folder / "out", workers=1, model=plate, report=False)
        refuse_nonfinite(json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8")))

    return Case(kind, words, never, plan, run if is_run else None)


def _mutated(
    chance: random.Random, kind: str, tables: Tables, path: Path_, old: Any, allowed: Number | None
) -> tuple[bytes, str, bool]:
    """A study file with one key changed, what was changed, and whether it can never be valid."""
    if kind == "duplicate":
        return _twice(chance, tables, path, old)
    if kind == "name":
        odd = path[-1].translate(str.maketrans(TWINS)) if chance.random() < 0.5 else f"{path[-1]}_"
        renamed = _with(tables, (*path[:-1], odd), old)
        # Of tables with names of a user's own any name is valid.
        free = path[:-1] in (("limit_states",), ("solver", "inputs"), ("soil",), ("lander", "part"))
        return _bytes(renamed), f"{odd!r} is a further key", not free and odd != path[-1]
    new, never = odd_value(chance, kind, old, allowed)
    return _bytes(_with(tables, path, new)), f"{_short(old)} is {_short(new)}", never


def _twice(chance: random.Random, tables: Tables, path: Path_, old: Any) -> tuple[bytes, str, bool]:
    """A key, or its table, that is given twice."""
    text = _bytes(_with(tables, path, old)).decode()
    has_head = isinstance(tables.get(path[0]), dict) and not all(
        isinstance(one, dict) for one in tables[path[0]].values()
    )
    if has_head and chance.random() < 0.3:
        return f"{text}\n[{path[0]}]\n".encode(), "its table is there twice", True
    line = tomli_w.dumps({path[-1]: old}) if not isinstance(old, dict) else f"{path[-1]} = {{}}\n"
    marked = tomli_w.dumps(_with(tables, path, "TWICE")).splitlines(keepends=True)
    place = next(number for number, one in enumerate(marked) if '"TWICE"' in one)
    marked[place] = f"{line}{line}"
    return "".join(marked).encode(), "it is there twice", True


def _bytes(tables: Tables) -> bytes:
    return tomli_w.dumps(tables).encode()


def _with(tables: Tables, path: Path_, value: Any) -> Tables:
    made = base_studies.deepcopy(tables)
    inner = made
    for name in path[:-1]:
        if not isinstance(inner.get(name), dict):
            inner[name] = {}
        inner = inner[name]
    inner[path[-1]] = value
    return made


def _value(tables: Any, path: Path_) -> Any:
    for name in path:
        tables = tables.get(name) if isinstance(tables, dict) else None
    return tables


def _paths(tables: Tables, path: Path_ = ()) -> Iterator[Path_]:
    """Every key of nested tables, and every table."""
    for name, value in tables.items():
        yield (*path, name)
        if isinstance(value, dict):
            yield from _paths(value, (*path, name))


def _general(path: Path_, fields: dict[Path_, Any]) -> Path_:
    """A path as the models know it, with NAME for a name of a user's own."""
    for place in range(1, len(path)):
        named = (*path[:place], "NAME", *path[place + 1 :])
        if named in fields:
            return named
    return path


def _places(key: Path_, owners: dict[Path_, list[tuple[str, Path_]]]) -> list[tuple[str, Path_]]:
    """Studies that have the table of a key, and the path that it has there."""
    return [
        (name, (*path[:-1], key[-1]))
        for other, found in owners.items()
        if other[:-1] == key[:-1]
        for name, path in found
    ]


def _short(value: Any) -> str:
    text = repr(value) if not isinstance(value, int) or abs(value) < 10**30 else f"a number of {len(str(value))} digits"
    return text if len(text) < 100 else f"{text[:60]}... ({len(text)} characters)"
