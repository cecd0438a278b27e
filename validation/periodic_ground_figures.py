"""Draw what periodic_ground.py found, and write its page, docs/validation/periodic_ground.md.

    python validation/periodic_ground_figures.py

Reads periodic_ground.json beside it; writes periodic_ground.png and periodic_ground.md to docs/validation.
"""

import json
import math
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
from periodic_ground import GROUNDS, WAYS

from lithobrake.report.figures.style import QUIET, STYLE, TEST, TRAINING

HERE = Path(__file__).parent
PAGES = HERE.parent / "docs" / "validation"
Entry = dict[str, Any]
# What is drawn and told of a landing: name, unit, and what an SI value is multiplied by.
OUTPUTS = {
    "speed_out": ("rebound speed", "cm/s", 100.0),
    "elevation_out": ("elevation", "deg", 180.0 / math.pi),
    "spin_out": ("spin", "rad/s", 1.0),
    "penetration": ("depth", "cm", 100.0),
}
HEAD = """# Periodic ground: what walls and images do

Written by `python validation/periodic_ground_figures.py`.

The soil and the lander of the quick study, at the medians of their laws, on beds between walls of
0.7 m, of twice and of four times that width (4 and 16 times the area), and on ground that repeats.
Beds hold as many grains per area. The lander comes down anywhere on ground that repeats, and in the
middle half of a bed with walls, so that these move away from it as beds grow. Grains that are far
from the lander and slower than three hundredths of it are held (`contact.held_speed = 0.03`).

A lander is lost where it crosses the edge of its bed and does not clearly fly: it has no outcome,
and is left out of all means. Means stand with their standard errors, from beds as clusters. Depth
is the penetration. Of the images: does a lander on a small tile feel that its images land beside
it, or that it meets the ground again that it has passed? The tiles of 0.56 to 1.4 m answer that.

![Rebound by ground](periodic_ground.png)

- **Walls select.** At 75 degrees half of the landers leave a bed of 0.7 m laterally, and those with
  an outcome left faster and flatter than all do where none is lost. The farther the walls, the
  fewer are lost, and the nearer speed, elevation and spin come to those of ground that repeats.
- **Walls loosen.** Beds between walls are less dense, the narrower the more.
- **Images do not show.** Speed, elevation and spin have no trend with the width of the tile that
  exceeds their errors, though on the smallest some landers travel farther than it is wide.
- **What it costs.** A pour of as many grains costs no more than between walls. A landing costs
  somewhat more, as the ground is denser, and at 75 degrees more again, as a lander that is lost
  ends early. On the smallest tile a landing that loses nothing costs less than between walls.

"""
SLOPES = """
## Slopes

The same soil with a friction of 0.3, less than the tangent of either slope, 0.4 m/s, 30 degrees
from the normal and downhill. A periodic bed is 0.7 m wide and held by its rough floor, one between
walls 1.4 m, by its lower wall (`python validation/periodic_slopes.py`). Between walls there are
three beds a slope, too few for errors that can be trusted.
"""
STUDIES = """
## The studies of the scenarios

Each with the beds of its file, and with the other sides (the quick study on both widths). Numbers
of all landings that left; returns and shares with their 90 % intervals.
"""
WORDS = {"walls": "walls", "periodic": "tile"}
# Beds between walls as they grow, and then ground that repeats, from the smallest tile on.
ORDER = sorted(GROUNDS, key=lambda name: (GROUNDS[name].sides != "walls", GROUNDS[name].width))


def in_words(way: str) -> str:
    """Speed and incidence of a way to land."""
    speed, incidence, _ = WAYS[way]
    return f"{100 * speed:g} cm/s, {incidence:g} deg"


def draw(grounds: dict[str, Entry]) -> None:
    """Every output in every way, by ground, with two standard errors."""
    known = [name for name in ORDER if grounds[name]["beds"]]
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(
            len(OUTPUTS), len(WAYS), figsize=(9.2, 8.4), constrained_layout=True, sharex=True, squeeze=False
        )
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
        figure.supxlabel(
            "width between walls, or of the tile that repeats [m]; bars: two standard errors, over beds", fontsize=9
        )
        figure.savefig(PAGES / "periodic_ground.png", dpi=150)


def bed_table(grounds: dict[str, Entry]) -> list[str]:
    """A line a ground: how its beds lie, and what they cost."""
    lines = ["| ground | grains | beds | solid fraction | contacts a grain | CPU of a pour [s] |", "|---" * 6 + "|"]
    for name in ORDER:
        entry = grounds[name]
        cells = [f"{name} | {GROUNDS[name].grain_count} | {entry['beds']}"]
        for key, digits in (("solid_fraction", 3), ("coordination_number", 2), ("cpu_s", 1)):
            value = entry.get(key)
            cells.append(f"{value['mean']:.{digits}f} ({value['standard_deviation']:.{digits}f})" if value else "")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def landing_table(grounds: dict[str, Entry], way: str) -> list[str]:
    """A line a ground: what became of the landings of a way."""
    heads = [f"{label} [{unit}]" for label, unit, _ in OUTPUTS.values()]
    lines = ["| ground | landings | lost | captured | farther than a period | " + " | ".join(heads) + " | CPU [s] |"]
    lines.append("|---" * (6 + len(OUTPUTS)) + "|")
    for name in ORDER:
        entry = grounds[name][way]
        if not entry["landings"]:
            continue
        ends, far = entry["outcomes"], entry["farther_than_period"]
        cells = [name, str(entry["landings"]), str(ends.get("left_sideways", 0)), str(ends.get("captured", 0))]
        cells.append("-" if far is None else str(far))
        cells += [_value(entry[key], scale) for key, (_, _, scale) in OUTPUTS.items()]
        cells.append(_value(entry["cpu_s"], 1.0))
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def _value(entry: Entry | None, scale: float) -> str:
    """A mean with its standard error, to the digits of the latter."""
    if entry is None:
        return ""
    error = scale * entry["standard_error"]
    digits = max(0, 1 - math.floor(math.log10(error))) if error > 0.0 else 2
    return f"{scale * entry['mean']:.{digits}f} ({error:.{digits}f})"


def slope_table() -> list[str]:
    """A line a slope and kind of ground."""
    heads = [f"{label} [{unit}]" for label, unit, _ in OUTPUTS.values()]
    lines = ["| slope [deg] | sides | landings | lost | captured | " + " | ".join(heads) + " |"]
    lines.append("|---" * (5 + len(OUTPUTS)) + "|")
    for one in json.loads((HERE / "periodic_slopes.json").read_text())["slopes"]:
        ends = one["outcomes"]
        counts = [sum(ends.values()), ends.get("left_sideways", 0), ends.get("captured", 0)]
        cells = [f"{one['slope_deg']:g}", one["sides"], *(str(count) for count in counts)]
        lines.append(
            "| " + " | ".join(cells + [_value(one[key], scale) for key, (_, _, scale) in OUTPUTS.items()]) + " |"
        )
    return lines


def study_table() -> list[str]:
    """A line a study that periodic_studies.py read."""
    heads = [f"{label} [{unit}]" for label, unit, _ in OUTPUTS.values()]
    lines = ["| study | bed | outcomes | returns [%] | escape [%] | " + " | ".join(heads) + " | solid fraction |"]
    lines.append("|---" * (6 + len(OUTPUTS)) + "|")
    for one in json.loads((HERE / "periodic_studies.json").read_text())["studies"]:
        bed, returns, escaped = one["bed"], one["returns"], one["shares"]["escaped"]
        ends = ", ".join(f"{count} {word.replace('_', ' ')}" for word, count in sorted(one["outcomes"].items()))
        cells = [one["title"], f"{bed['sides']}, {bed['grain_count']} on {bed['width'][0]:g} m", ends]
        cells += [
            f"{100 * share['share']:.1f} ({100 * share['lower']:.1f} to {100 * share['upper']:.1f})"
            for share in (returns, escaped)
        ]
        cells += [_value(one[key], scale) for key, (_, _, scale) in OUTPUTS.items()]
        lines.append("| " + " | ".join([*cells, f"{one['solid_fraction']:.3f}"]) + " |")
    return lines


def main() -> None:
    """Draw and write."""
    content = json.loads((HERE / "periodic_ground.json").read_text())
    grounds = content["grounds"]
    draw(grounds)
    parts = [HEAD, "## Beds", "", *bed_table(grounds)]
    for way in WAYS:
        parts += ["", f"## {in_words(way)}", "", *landing_table(grounds, way)]
    parts += [SLOPES, *slope_table(), STUDIES, *study_table()]
    made = f"`{content['command']}`, {content['date']}, {content['machine']}, one process, load {content['load']:.0f}."
    parts += ["", made]
    (PAGES / "periodic_ground.md").write_text("\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
