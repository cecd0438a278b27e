"""Draw what periodic_ground.py found, and write its page, docs/validation/periodic_ground.md.

    python validation/periodic_ground_figures.py

Reads periodic_ground.json beside it; writes periodic_ground.png and periodic_ground.md to docs/validation.
"""

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from periodic_ground import GROUNDS, WAYS

from lithobrake.report.figures.style import QUIET, TEST, TRAINING

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document
from page import made, table, write_page

HERE = Path(__file__).parent
Entry = dict[str, Any]
# What is drawn and tabulated of a landing: name, unit, and what an SI value is multiplied by.
OUTPUTS = {
    "speed_out": ("rebound speed", "cm/s", 100.0),
    "elevation_out": ("rebound elevation", "deg", 180.0 / math.pi),
    "spin_out": ("rebound spin rate", "rad/s", 1.0),
    "penetration": ("penetration", "cm", 100.0),
}
MEANS = [f"{label} [{unit}]" for label, unit, _ in OUTPUTS.values()]
WORDS = {"walls": "walls", "periodic": "period"}
OUTCOMES = {
    "captured": "captured", "clear": "rebounded", "left_sideways": "left laterally", "time_limit": "time limit",
}  # fmt: skip
# Beds between walls as they grow, and then periodic ones, from the narrowest on.
ORDER = sorted(GROUNDS, key=lambda name: (GROUNDS[name].sides != "walls", GROUNDS[name].width))
# Study files by the title that they had when they ran.
STUDY_FILES = {
    "Quick look: CubeSat on Didymos": "`scenarios/first_bounce.toml`",
    "A CubeSat on Didymos, with few landings": "`validation/studies/drawn_170.toml`",
}


def in_words(way: str) -> str:
    speed, incidence, _ = WAYS[way]
    return f"{100 * speed:g} cm/s, {incidence:g} deg"


def draw(grounds: dict[str, Entry]) -> None:
    """Every output in every way, by ground, with two standard errors."""
    known = [name for name in ORDER if grounds[name]["beds"]]
    shape = (len(OUTPUTS), len(WAYS), (9.2, 8.4))
    with figure(PAGES / "periodic_ground.png", *shape, dpi=150, sharex=True, squeeze=False) as (drawn, axes):
        for row, (key, (label, unit, scale)) in enumerate(OUTPUTS.items()):
            for column, way in enumerate(WAYS):
                axis = axes[row, column]
                for place, name in enumerate(known):
                    entry = grounds[name][way][key]
                    if entry:
                        colour = TEST if GROUNDS[name].sides == "walls" else TRAINING
                        bar = 2.0 * scale * entry["standard_error"]
                        axis.errorbar(place, scale * entry["mean"], bar, fmt="o", color=colour, capsize=3, ms=4.5)
                axis.margins(0.12, 0.25)
                axis.axvline(sum(GROUNDS[name].sides == "walls" for name in known) - 0.5, color=QUIET, lw=0.6)
                if row == 0:
                    axis.set_title(in_words(way))
                if column == 0:
                    axis.set_ylabel(f"{label} [{unit}]")
                words = [f"{WORDS[GROUNDS[name].sides]}\n{GROUNDS[name].width:g}" for name in known]
                axis.set_xticks(range(len(known)), words, fontsize=6.5)
        drawn.supxlabel("width between walls, or period [m]; bars: two standard errors, over beds", fontsize=9)


def bed_table(grounds: dict[str, Entry]) -> str:
    """A line a ground: how its beds lie, and what they cost."""
    lines = []
    for name in ORDER:
        entry = grounds[name]
        cells = [name, str(GROUNDS[name].grain_count), str(entry["beds"])]
        for key, digits in (("solid_fraction", 3), ("coordination_number", 2), ("cpu_s", 1)):
            value = entry.get(key)
            cells.append(f"{value['mean']:.{digits}f} ({value['standard_deviation']:.{digits}f})" if value else "")
        lines.append(cells)
    heads = ("bed", "grains", "beds", "solid fraction", "coordination number", "CPU time of a bed [s]")
    return table(heads, lines)


def landing_table(grounds: dict[str, Entry], way: str) -> str:
    """A line a ground: what became of the landings of a way."""
    lines = []
    for name in ORDER:
        entry = grounds[name][way]
        if not entry["landings"]:
            continue
        ends, far = entry["outcomes"], entry["farther_than_period"]
        cells = [name, str(entry["landings"]), str(ends.get("left_sideways", 0)), str(ends.get("captured", 0))]
        lines.append([*cells, "-" if far is None else str(far), *means(entry), _value(entry["cpu_s"], 1.0)])
    return table(("bed", "landings", "lost", "captured", "displacement > period", *MEANS, "CPU time [s]"), lines)


def means(entry: Entry) -> list[str]:
    return [_value(entry[key], scale) for key, (_, _, scale) in OUTPUTS.items()]


def _value(entry: Entry | None, scale: float) -> str:
    """A mean with its standard error, to the digits of the latter."""
    if entry is None:
        return ""
    error = scale * entry["standard_error"]
    digits = max(0, 1 - math.floor(math.log10(error))) if error > 0.0 else 2
    return f"{scale * entry['mean']:.{digits}f} ({error:.{digits}f})"


def slope_table() -> str:
    """A line a slope and kind of ground."""
    lines = []
    for one in read_document(HERE / "periodic_slopes.json")["slopes"]:
        ends = one["outcomes"]
        counts = [sum(ends.values()), ends.get("left_sideways", 0), ends.get("captured", 0)]
        lines.append([f"{one['slope_deg']:g}", one["sides"], *(str(count) for count in counts), *means(one)])
    return table(("slope [deg]", "sides", "landings", "lost", "captured", *MEANS), lines)


def study_table() -> str:
    """A line a study that periodic_studies.py read."""
    lines = []
    for one in read_document(HERE / "periodic_studies.json")["studies"]:
        bed, shares = one["bed"], (one["returns"], one["shares"]["escaped"])
        ends = ", ".join(f"{count} {OUTCOMES[word]}" for word, count in sorted(one["outcomes"].items()))
        cells = [STUDY_FILES[one["title"]], f"{bed['sides']}, {bed['grain_count']} on {bed['width'][0]:g} m", ends]
        cells += [f"{100 * of['share']:.1f} ({100 * of['lower']:.1f} to {100 * of['upper']:.1f})" for of in shares]
        lines.append([*cells, *means(one), f"{one['solid_fraction']:.3f}"])
    heads = ("study", "bed", "outcomes", "return fraction [%]", "escape [%]", *MEANS, "solid fraction")
    return table(heads, lines)


def trends(grounds: dict[str, Entry]) -> list[tuple[float, str, str]]:
    """Return slopes of speed, elevation and spin over the logarithm of the period, in their standard errors.

    With the output and the way to land of each; weighted least squares over the periodic beds.
    """
    names = [name for name in ORDER if GROUNDS[name].sides != "walls" and grounds[name]["beds"]]
    x = np.log([GROUNDS[name].width for name in names])
    found = []
    for way in WAYS:
        for key in ("speed_out", "elevation_out", "spin_out"):
            of = [grounds[name][way][key] for name in names]
            weight = np.array([1.0 / one["standard_error"] ** 2 for one in of])
            away = x - np.average(x, weights=weight)
            slope = weight * away @ np.array([one["mean"] for one in of]) / (weight @ away**2)
            found.append((float(slope * math.sqrt(weight @ away**2)), OUTPUTS[key][0], in_words(way)))
    return sorted(found, key=lambda one: -abs(one[0]))


def lost_of(entry: Entry) -> str:
    return f"{entry['outcomes'].get('left_sideways', 0)} of {entry['landings']}"


def speed_and_elevation(entry: Entry) -> str:
    return " and ".join(f"{_value(entry[key], OUTPUTS[key][2])} {OUTPUTS[key][1]}"
                        for key in ("speed_out", "elevation_out"))  # fmt: skip


def findings(grounds: dict[str, Entry]) -> dict[str, Any]:
    way = list(WAYS)[1]
    walls = [name for name in ORDER if GROUNDS[name].sides == "walls"]
    tiles = [name for name in ORDER if GROUNDS[name].sides != "walls"]
    slopes = trends(grounds)
    (most, output, at), (following, *_) = slopes[:2]
    solid = {name: grounds[name]["solid_fraction"]["mean"] for name in ORDER}
    return {
        "way": in_words(way), "lost": ", ".join(f"{lost_of(grounds[name][way])} ({name})" for name in walls),
        "narrow": speed_and_elevation(grounds[walls[0]][way]), "wide": speed_and_elevation(grounds[tiles[-1]][way]),
        "walls": ", ".join(f"{solid[name]:.3f}" for name in walls),
        "tiles": f"{min(solid[name] for name in tiles):.3f} to {max(solid[name] for name in tiles):.3f}",
        "most": f"{most:.1f}", "output": output, "at": at, "next": f"{following:.1f}", "count": len(slopes),
    }  # fmt: skip


def main() -> None:
    content = read_document(HERE / "periodic_ground.json")
    grounds = content["grounds"]
    draw(grounds)
    landings = [f"### {in_words(way)}\n\n{landing_table(grounds, way)}" for way in WAYS]
    write_page(
        "periodic_ground", **findings(grounds), beds=bed_table(grounds), landings="\n\n".join(landings),
        slopes=slope_table(), studies=study_table(),
        made=made(content, "one process", f"load {content['load']:.0f}"),
    )  # fmt: skip


if __name__ == "__main__":
    main()
