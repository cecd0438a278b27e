"""Shipped studies with one or two keys changed at random: none that plan accepts may end later because of its input.

Each study is planned and, where the plan is made, run on a plate in place of the soil, with few landers. The classes of
all are counted; a study that ends late is printed with its changes and its last words, and makes the exit code 1.

    python validation/late_refusals.py --count 20 --seed 1
"""

import argparse
import math
import random
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import tomli_w

import lithobrake
from lithobrake.pipeline import plan_study
from lithobrake.study import load_tables

ROOT = Path(__file__).parents[1]
STUDIES = ("quick", "release", "aim", "milani", "juventas", "first_bounce")
# What makes a study end within seconds.
SMALL: dict[str, dict[str, Any]] = {
    "bed": {"bed_count": 4},
    "journey": {"count": 8, "duration": 20_000.0, "emulated_count": 0},
    "hard_ground": {"count": 10},
    "flight": {"flight_count": 5, "duration": 2000.0},
}
FACTORS = (1e-300, 1e-6, 1e-3, 0.1, 10.0, 1e3, 1e6, 1e300, -1.0, 0.0)
WORDS = ("", "x", "random", "site", "sun")
# Longest plan, and longest run [s].
LONGEST = 120


def plate(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound from a plate, whose restitution is random."""
    speed, incidence = inputs["impact.speed"], math.radians(inputs["impact.incidence_deg"])
    up = speed * math.cos(incidence) * random.Random(seed).uniform(0.1, 0.5)
    if up < 0.004:
        return {"outcome": "captured", "outputs": {"duration": 10.0, "contacts": 1.0}}
    along = 0.5 * speed * math.sin(incidence)
    return {"outputs": {"velocity_out_x": along, "velocity_out_y": 0.0, "velocity_out_z": up, "spin_out": 0.01}}


def leaves(tables: dict[str, Any]) -> Iterator[tuple[dict[str, Any] | list[Any], Any]]:
    """Every number and word of nested tables, as the table and the key that it has there."""
    places: Any = tables.items() if isinstance(tables, dict) else enumerate(tables)
    for key, value in places:
        if isinstance(value, dict | list):
            yield from leaves(value)
        else:
            yield tables, key


def changed(chance: random.Random, tables: dict[str, Any]) -> list[str]:
    """Change one or two values of a study, and say which."""
    said = []
    for _ in range(chance.choice((1, 1, 2))):
        table, key = chance.choice(list(leaves(tables)))
        old = table[key]
        if isinstance(old, bool):
            table[key] = not old
        elif isinstance(old, int | float):
            new = old * chance.choice(FACTORS)
            table[key] = round(new) if isinstance(old, int) and abs(new) < 1e15 else new
        else:
            table[key] = chance.choice(WORDS)
        said.append(f"{key}: {old!r} is {table[key]!r}")
    return said


def small(tables: dict[str, Any]) -> dict[str, Any]:
    """The same study with few landers."""
    made = {name: table for name, table in deepcopy(tables).items() if name not in ("expansion", "monte_carlo")}
    made.get("design", {}).clear()
    for name, keys in SMALL.items():
        made[name] = made.get(name, {}) | keys
    if "aim" in made:
        made["aim"]["lander_count"] = 2
    return made


def ended(tables: dict[str, Any], folder: Path) -> tuple[str, str]:
    """The class of a study, and its last words."""
    path = folder / "study.toml"
    stage = "plan"

    def stop(*_: object) -> None:
        raise TimeoutError(f"{stage} takes longer than {LONGEST} s")

    signal.signal(signal.SIGALRM, stop)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            path.write_bytes(tomli_w.dumps(tables).encode())
            signal.alarm(LONGEST)
            plan_study(path, folder / "out")
            stage = "run"
            signal.alarm(LONGEST)
            lithobrake.run(tables, folder / "out", workers=1, model=plate, report=False)
        return "ran", ""
    except TimeoutError as error:
        return "endless", str(error)
    except (ValueError, ImportError, FloatingPointError) as error:
        return ("refused", "") if stage == "plan" else ("late", str(error))
    # Whatever else a study raises is what is looked for.
    except Exception:
        return "traceback", traceback.format_exc(limit=-3)
    finally:
        signal.alarm(0)


def main() -> int:
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("--count", type=int, default=20, help="studies to make")
    asked.add_argument("--seed", type=int, default=1)
    given = asked.parse_args()
    chance, classes = random.Random(given.seed), Counter[str]()
    for _ in range(given.count):
        name = chance.choice(STUDIES)
        tables = small(load_tables(ROOT / "scenarios" / f"{name}.toml"))
        said = changed(chance, tables)
        with tempfile.TemporaryDirectory() as folder:
            kind, words = ended(tables, Path(folder))
        classes[kind] += 1
        if kind not in ("ran", "refused"):
            print(f"{kind}: {name}, {'; '.join(said)}\n  {words}", flush=True)
    print(", ".join(f"{count} {kind}" for kind, count in classes.most_common()))
    return int(any(kind not in ("ran", "refused") for kind in classes))


if __name__ == "__main__":
    sys.exit(main())
