"""Write docs/decisions/engine_speed.md from grains_speed.json, step_parts.json and engine_switches.json beside it.

python benchmarks/write_engine_speed.py
"""

import json
from pathlib import Path
from textwrap import fill
from typing import Any

HERE = Path(__file__).parent
AIMS = {"hull1000": 2.0, "hull2000": 2.0, "hull4000": 2.0, "landing": 1.5, "sph4000": 8.0}
RATE = "million_particle_steps_a_cpu_second"


def shown(value: Any) -> str:
    """A value in a table."""
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def table(head: list[str], rows: list[list[Any]]) -> list[str]:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *([shown(value) for value in row] for row in rows)]
    return ["| " + " | ".join(line) + " |" for line in lines]


def wrapped(line: str) -> str:
    """A line in lines of 100 characters, those of an item under its first word."""
    inset = "  " if line.startswith("- ") else ""
    return fill(line, 100, subsequent_indent=inset, break_long_words=False, break_on_hyphens=False)


def measured(found: dict[str, Any]) -> str:
    """Where, when and how something was measured."""
    return f"`{found['command']}`, {found['date']}, {found['machine']}, load {found['load']:.2g}."


def beds(found: dict[str, Any]) -> list[str]:
    """Speed on beds at rest and in landings."""
    rows = []
    for name, aim in AIMS.items():
        results = found[name]["result"]
        for result in results if isinstance(results, list) else [results]:
            case = f"6 kg into hull1000 at {result['speed_m_s']} m/s" if name == "landing" else name
            rows.append([case, result["coordination"], result["ms_a_step"], result[RATE], aim, found[name]["load"]])
    return table(["case", "coordination", "ms a step", "million particle-steps a CPU second", "aim", "load"], rows)


def others(found: dict[str, Any]) -> list[str]:
    """All other measurements, a line each."""
    lines = []
    for name, entry in found.items():
        if name not in AIMS:
            for result in entry["result"] if isinstance(entry["result"], list) else [entry["result"]]:
                landings = result.pop("landings", [])
                lines.append(f"- {name}: {listed(result)} ({entry['date']}, load {entry['load']:.2g})")
                lines += [f"    - a landing: {listed(landing)}" for landing in landings]
    return lines


def listed(values: dict[str, Any]) -> str:
    """Names and values on a line."""
    return ", ".join(f"{key.replace('_', ' ')} {shown(value)}" for key, value in values.items())


def step_parts(found: dict[str, Any]) -> list[str]:
    """What a step is made of."""
    rows = [
        [case, row["part"], row["a_body"], row["ns_a_body"]]
        for case, entry in found["cases"].items()
        for row in entry["parts"]
    ]
    return [*table(["case", "part", "number a body", "ns a body"], rows), "", measured(found)]


def switches(found: dict[str, Any]) -> list[str]:
    """What each trick gains, and how far bodies end from where they end with it."""
    cases = ("hull1000", "sph4000", "touchdown")
    rows = [
        [row["without"], *(value for case in cases for value in (row[case]["gain"], row[case]["largest_change_m"]))]
        for row in found["rows"]
    ]
    head = ["trick", *(text for case in cases for text in (f"{case}: gain", "change [m]"))]
    return [*table(head, rows), "", measured(found)]


def main() -> None:
    """Write the page."""
    speed, parts, tricks = (
        json.loads((HERE / name).read_text())
        for name in ("grains_speed.json", "step_parts.json", "engine_switches.json")
    )
    page = [
        "# Speed of the soft-surface engine", "",
        "Written by `python benchmarks/write_engine_speed.py`. What was tried and did not pay: "
        "[performance.md](performance.md).", "",
        "## Beds at rest, and landings", "", *beds(speed), "", measured(speed["hull1000"]), "",
        "The aims were set on a machine of this kind whose searches (the yardstick, below) took 460 ns.", "",
        *others(speed), "",
        "## What a step is made of", "", *step_parts(parts), "",
        "## What each trick gains", "",
        "Time without it over time with it; beside it, how far from where they end with all tricks the bodies end. "
        "Rows that cannot touch a case (spheres' tricks on hulls) show the noise; ratios measured in turns, more "
        "exact ones, stand in performance.md.", "",
        *switches(tricks),
    ]  # fmt: skip
    page = [line if line.startswith("|") else wrapped(line) for line in page]
    (HERE.parent / "docs" / "decisions" / "engine_speed.md").write_text("\n".join(page) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
