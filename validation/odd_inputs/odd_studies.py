"""Odd studies: every key of every section, with a value of another type, sign, unit, size or script, or given twice."""

import json
import math
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import base_studies
import tomli_w
from base_studies import NAMES, Tables
from judge import Case, refuse_nonfinite

import lithobrake
from lithobrake.pipeline import plan_lines, plan_study
from lithobrake.study.quantity import MaybeUncertain, Number, Numbers, Whole
from lithobrake.study.units import limits

Path_ = tuple[str, ...]
# Of those that can be planned, one in so many is run; of those that change the physics one in fewer.
RUN_ONE_IN, RUN_PHYSICS_ONE_IN = 8, 3
PHYSICS = ("sign", "unit", "size", "end", "law")
# Of these a program makes the touchdowns, or emulators of many landers are fitted.
NOT_RUN = ("programmed", "milani", "juventas")
HUGE = 10**400
SIZES = (1e300, -1e300, 1e-300, 1e150, 1e-150, 0.0, 5e-324, 1e17, 2.0**53 + 2, HUGE)
NEVER_SIZES = (math.nan, math.inf, -math.inf)
UNITS = (1e3, 1e-3, math.pi / 180.0, 180.0 / math.pi, 3600.0, 1e6)
SCRIPTS = ("Ünïcode 名前 🚀", "\u202e\u2066x", "a\nb\tc", "\x00", " ", "", "x" * 20_000, "{{ x }}", "../..", "<b>&amp;", "CON",
           "%s%n", "１２", "-1", "٣")  # fmt: skip
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


def study_cases(chance: random.Random, count: int) -> Iterator[Case]:
    """So many odd studies; each key has its turn before any has a second one."""
    tables = {name: base_studies.base(name) for name in NAMES}
    known = list(base_studies.keys_of())
    fields = dict(known)
    owners: dict[Path_, list[tuple[str, Path_]]] = {path: [] for path, _ in known}
    for name in NAMES:
        for path in _paths(tables[name]):
            owners.setdefault(_general(path, fields), []).append((name, path))
    left: list[Path_] = []
    for _ in range(count):
        left = left or chance.sample(list(owners), len(owners))
        key = left.pop()
        # A key that no study has stands in one that has its table, else in any.
        name, path = chance.choice(owners[key] or _places(key, owners) or [(chance.choice(NAMES), key)])
        yield _case(chance, name, path, tables[name], fields.get(key))


def _case(chance: random.Random, name: str, path: Path_, tables: Tables, field: Any) -> Case:
    old = _value(tables, path)
    if old is None and field is not None:
        old = base_studies.fresh_value(field)
    allowed = None if field is None else limits(field)
    kind = chance.choice(_kinds(old, allowed))
    if kind in ("end", "law") and allowed is not None:
        new = _end(chance, allowed) if kind == "end" else _law(chance, allowed)
        text, said, never = _bytes(_with(tables, path, new)), f"{_short(old)} is {_short(new)}", False
    else:
        text, said, never = _mutated(chance, kind, tables, path, old)
    is_run = name not in NOT_RUN and chance.randrange(RUN_PHYSICS_ONE_IN if kind in PHYSICS else RUN_ONE_IN) == 0
    return study_case(kind, f"{name}, {'.'.join(path)}: {said}", text, never, is_run)


def _end(chance: random.Random, allowed: Number) -> Any:
    """A number at an end of what is allowed, or just within; where there is no end, the largest or least of all."""
    low = max(allowed.at_least, allowed.above)
    high = min(allowed.at_most, allowed.below)
    low_in = low if allowed.at_least >= allowed.above else math.nextafter(low, math.inf)
    high_in = high if allowed.at_most <= allowed.below else math.nextafter(high, -math.inf)
    ends = [low_in if math.isfinite(low) else -1e99, high_in if math.isfinite(high) else 1e99]
    found = chance.choice([*ends, 0.5 * (ends[0] + ends[1]), math.nextafter(ends[0], math.inf)])
    if isinstance(allowed, Whole):
        return int(min(max(found, ends[0]), ends[1]))
    return [found] * allowed.count if isinstance(allowed, Numbers) else found


def _law(chance: random.Random, allowed: Number) -> Any:
    """A distribution of odd parameters in place of a number."""
    low, high = sorted((_end(chance, replace_list(allowed)), _end(chance, replace_list(allowed))))
    return chance.choice(
        [
            {"distribution": "uniform", "lower": low, "upper": high},
            {"distribution": "log_uniform", "lower": abs(low) or 1e-99, "upper": abs(high) or 1e-98},
            {"distribution": "log_normal", "mean": chance.choice((-30.0, 0.0, 30.0)), "std": chance.choice((1e-9, 1.0, 30.0))},
            {"distribution": "gamma", "shape": chance.choice((1e-3, 1.0, 1e6)), "scale": chance.choice((1e-9, 1.0, 1e9))},
            {"distribution": "beta", "alpha": 1e-3, "beta": 1e-3, "lower": low, "upper": high},
            {"distribution": "truncated_normal", "mean": 0.0, "std": chance.choice((1e-9, 1.0, 1e9)), "lower": low, "upper": high},
            {"distribution": "exponential", "rate": chance.choice((1e-9, 1.0, 1e9))},
        ]
    )


def replace_list(allowed: Number) -> Number:
    """The range of one number of a list."""
    return Number(allowed.unit, allowed.above, allowed.at_least, allowed.below, allowed.at_most)


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


def _kinds(old: Any, allowed: Number | None) -> list[str]:
    both = ["type", "duplicate", "name"]
    if allowed is not None:
        both += ["end"] * 4 + ["law"] * 2 * isinstance(allowed, MaybeUncertain)
    if isinstance(old, bool):
        return both
    if isinstance(old, int | float):
        return ["sign", "unit", "size", "size", "size", "nan", "type", "duplicate", "name"]
    if isinstance(old, list):
        return [*both, "size", "sign", "nan", "length"] if any(isinstance(one, float | int) for one in old) else [
            *both, "unicode", "length"]  # fmt: skip
    return [*both, "unicode", "unicode", "unicode"] if isinstance(old, str) else both


def _mutated(chance: random.Random, kind: str, tables: Tables, path: Path_, old: Any) -> tuple[bytes, str, bool]:
    """A study file with one key changed, what was changed, and whether it can never be valid."""
    if kind == "duplicate":
        return _twice(chance, tables, path, old)
    if kind == "name":
        odd = path[-1].translate(str.maketrans(TWINS)) if chance.random() < 0.5 else f"{path[-1]}_"
        renamed = _with(tables, (*path[:-1], odd), old)
        # Of tables with names of a user's own any name is valid.
        free = path[:-1] in (("limit_states",), ("solver", "inputs"), ("soil",), ("lander", "part"))
        return _bytes(renamed), f"{odd!r} is a further key", not free and odd != path[-1]
    new, never = _odd_value(chance, kind, old)
    return _bytes(_with(tables, path, new)), f"{_short(old)} is {_short(new)}", never


def _odd_value(chance: random.Random, kind: str, old: Any) -> tuple[Any, bool]:
    if kind == "type":
        return _other_type(chance, old)
    if kind == "unicode":
        new = chance.choice(SCRIPTS)
        return ([new, *old[1:]] if isinstance(old, list) else new), False
    if kind == "length":
        return chance.choice(([], old * 2, old[:-1], [*old, old[-1]] if old else [1])), False
    if isinstance(old, list):
        place = chance.randrange(len(old))
        inner = old[place]
        if not isinstance(inner, int | float):
            return _other_type(chance, old)
        new, never = _odd_value(chance, kind, inner)
        return [*old[:place], new, *old[place + 1 :]], never
    if kind == "nan":
        return chance.choice(NEVER_SIZES), True
    factor = {"sign": (-1.0,), "unit": UNITS}.get(kind)
    if factor is None:
        return chance.choice(SIZES), False
    new = (old or 1) * chance.choice(factor)
    return (round(new) if isinstance(old, int) else new), False


def _other_type(chance: random.Random, old: Any) -> tuple[Any, bool]:
    text = str(old) if not isinstance(old, str) else "5 m"
    others: list[Any] = [{}, {"a": 1}, [[]], {"distribution": "uniform"}, [1, "x"], base_studies.tomllib.loads("x = 07:32:00")["x"]]
    if isinstance(old, bool):
        others += [1, 0, "true", "yes"]
    elif isinstance(old, int | float):
        others += [text, f"{text} m", True, False, [old], "nan"]
    elif isinstance(old, str):
        others += [1, 1.5, True, [old]]
    elif isinstance(old, list):
        others += ["x", True, dict(enumerate_names(old))]
    else:
        others += ["x", 1]
    return chance.choice(others), not isinstance(old, dict)


def enumerate_names(values: list[Any]) -> list[tuple[str, Any]]:
    return [(f"k{place}", value) for place, value in enumerate(values)]


def _twice(chance: random.Random, tables: Tables, path: Path_, old: Any) -> tuple[bytes, str, bool]:
    """A key, or its table, that is given twice."""
    text = _bytes(_with(tables, path, old)).decode()
    has_head = isinstance(tables.get(path[0]), dict) and not all(isinstance(one, dict) for one in tables[path[0]].values())
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
    return [(name, (*path[:-1], key[-1])) for other, found in owners.items() if other[:-1] == key[:-1] for name, path in found]


def _short(value: Any) -> str:
    text = repr(value) if not isinstance(value, int) or abs(value) < 10**30 else f"a number of {len(str(value))} digits"
    return text if len(text) < 100 else f"{text[:60]}... ({len(text)} characters)"
