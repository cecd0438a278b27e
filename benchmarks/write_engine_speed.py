"""Write docs/decisions/engine_speed.md from grains_speed.json, step_parts.json and engine_switches.json beside it.

python benchmarks/write_engine_speed.py
"""

from pathlib import Path
from textwrap import fill
from typing import Any

from harness import ROOT, read_document
from page import made, table, write_page

HERE = Path(__file__).parent
AIMS = {"hull1000": 2.0, "hull2000": 2.0, "hull4000": 2.0, "landing": 1.5, "sph4000": 8.0}
RATE = "million_particle_steps_a_cpu_second"


def shown(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def shown_table(heads: list[str], rows: list[list[Any]]) -> str:
    return table(heads, ([shown(value) for value in row] for row in rows)).replace("---|", " --- |")


def wrapped(line: str) -> str:
    """A line in lines of 100 characters, those of an item under its first word."""
    inset = "  " if line.startswith("- ") else ""
    return fill(line, 100, subsequent_indent=inset, break_long_words=False, break_on_hyphens=False)


def measured(found: dict[str, Any]) -> str:
    """Where, when and how something was measured."""
    return wrapped(made(found, f"load {found['load']:.2g}."))


def beds(found: dict[str, Any]) -> str:
    rows = []
    for name, aim in AIMS.items():
        results = found[name]["result"]
        for result in results if isinstance(results, list) else [results]:
            case = f"6 kg into hull1000 at {result['speed_m_s']} m/s" if name == "landing" else name
            rows.append([case, result["coordination"], result["ms_a_step"], result[RATE], aim, found[name]["load"]])
    heads = ["case", "coordination", "ms a step", "million particle-steps a CPU second", "aim", "load"]
    return shown_table(heads, rows)


def others(found: dict[str, Any]) -> str:
    """All other measurements, a line each."""
    lines = []
    for name, entry in found.items():
        if name not in AIMS:
            for result in entry["result"] if isinstance(entry["result"], list) else [entry["result"]]:
                landings = result.pop("landings", [])
                lines.append(f"- {name}: {listed(result)} ({entry['date']}, load {entry['load']:.2g})")
                lines += [f"    - a landing: {listed(landing)}" for landing in landings]
    return "\n".join(wrapped(line) for line in lines)


def listed(values: dict[str, Any]) -> str:
    return ", ".join(f"{key.replace('_', ' ')} {shown(value)}" for key, value in values.items())


def step_parts(found: dict[str, Any]) -> str:
    rows = [
        [case, row["part"], row["a_body"], row["ns_a_body"]]
        for case, entry in found["cases"].items()
        for row in entry["parts"]
    ]
    return shown_table(["case", "part", "number a body", "ns a body"], rows)


def switches(found: dict[str, Any]) -> str:
    """What each trick gains, and how far bodies end from where they end with it."""
    cases = ("hull1000", "sph4000", "touchdown")
    rows = [
        [row["without"], *(value for case in cases for value in (row[case]["gain"], row[case]["largest_change_m"]))]
        for row in found["rows"]
    ]
    head = ["trick", *(text for case in cases for text in (f"{case}: gain", "change [m]"))]
    return shown_table(head, rows)


def main() -> None:
    speed, parts, tricks = (
        read_document(HERE / name) for name in ("grains_speed.json", "step_parts.json", "engine_switches.json")
    )
    write_page(
        "engine_speed", ROOT / "docs" / "decisions", filled=False, beds=beds(speed), others=others(speed),
        measured=measured(speed["hull1000"]), parts=step_parts(parts), parts_measured=measured(parts),
        switches=switches(tricks), switches_measured=measured(tricks),
    )  # fmt: skip


if __name__ == "__main__":
    main()
