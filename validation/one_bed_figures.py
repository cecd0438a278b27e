"""Draw what one_bed.py found, and write its tables, one_bed.md; docs/one_bed_is_not_enough.md tells of both.

    python validation/one_bed_figures.py

Reads one_bed.json beside it; writes one_bed_seeds.png, one_bed_grains.png and one_bed.md to docs/validation.
"""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
from one_bed import ELEVATION, SPEED

from lithobrake.report.figures.style import INK, INPUT_COLOURS, QUIET, STYLE, TEST, TRAINING

HERE = Path(__file__).parent
PAGES = HERE.parent / "docs" / "validation"
Entry = dict[str, Any]
PARTS = {"soil": "soil", "bed": "bed", "place_and_attitude": "place and attitude", "chaos": "chaos"}
OUTPUTS = {"speed_out": "V+", "elevation_out": "theta+", "spin_out": "omega+", "returns": "return fraction"}
WORDS = {"V+": "rebound speed", "theta+": "rebound elevation", "omega+": "rebound spin rate"}
LANDER_EDGE = 0.1  # m, the short edges
HEAD = """# One bed and many: the tables

Written by `python validation/one_bed_figures.py`; [One bed is not
enough](../one_bed_is_not_enough.md) says what they mean.

## Ten pairs of seeds
"""
SEEDS = """
Two studies agree where the interval of their difference holds 0. Of the paper's way, which has no
interval, the error of sampling alone stands in its place.

## The paper's way on ten beds
"""
PLACES = """
Mean and standard deviation of the samples. Share: first Sobol index, in the variance that the
expansion explains. Q2: on twelve fresh runs over all inputs.

## Parts of the variance by size of grains
"""
GRAINS = """
Shares of the variance with their 90 % intervals; a share may be a little below 0 where there is
nothing. Soil by pairs: its total effect, interactions with place and attitude included, from
landings at one place on two soils. Beds hold the same volume of grains, 0.7 m wide.
"""


def of_kind(studies: list[Entry], kind: str) -> list[Entry]:
    """Studies of a kind, by seed."""
    return sorted((one for one in studies if one["kind"] == kind), key=lambda one: (one["seed"], one["diameter_m"]))


def pairs(studies: list[Entry]) -> Iterator[tuple[Entry, Entry]]:
    """One after the other, two by two: no study stands in two pairs."""
    yield from zip(studies[::2], studies[1::2], strict=False)


def half_width(one: Entry) -> float:
    """Half the interval of the share; of one bed, what the flights leave, which is all that it can give."""
    returns = one["returns"]
    return 0.5 * (returns["upper"] - returns["lower"]) if returns["lower"] is not None else returns["flight_sampling"]


def holds(first: Entry, second: Entry) -> bool:
    """Whether the interval of the difference of two independent shares holds 0."""
    difference = first["returns"]["share"] - second["returns"]["share"]
    return abs(difference) <= math.hypot(half_width(first), half_width(second))


def draw_seeds(studies: list[Entry]) -> None:
    """Both answers, seed by seed."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.0), constrained_layout=True, sharey=True)
        for axis, kind, colour, title in (
            (axes[0], "one place", TEST, "One bed, one place, one attitude"),
            (axes[1], "draws", TRAINING, "Every landing a draw"),
        ):
            found = of_kind(studies, kind)
            for one in found:
                share = 100.0 * one["returns"]["share"]
                axis.errorbar(one["seed"], share, 100.0 * half_width(one), fmt="o", color=colour, capsize=3, ms=4.5)
            shares = [100.0 * one["returns"]["share"] for one in found]
            middle = sum(shares) / len(shares)
            axis.axhline(middle, color=QUIET, lw=0.8, zorder=0)
            held = [holds(*pair) for pair in pairs(found)]
            axis.set_title(f"{title}: {min(shares):.0f} to {max(shares):.0f} %")
            axis.set_xlabel(f"seed of the study (in {sum(held)} of {len(held)} pairs the intervals agree)")
            axis.set_xticks([one["seed"] for one in found][::2])
        axes[0].set_ylabel("landers that come down again [%]")
        # Room for the words below.
        axes[0].set_ylim(bottom=axes[0].get_ylim()[0] - 4.0)
        axes[0].text(0.02, 0.02, "bars: 90 %, sampling of flights alone", transform=axes[0].transAxes, color=INK)
        axes[1].text(0.02, 0.02, "bars: 90 %, over beds not yet poured", transform=axes[1].transAxes, color=INK)
        figure.savefig(PAGES / "one_bed_seeds.png", dpi=150)


def draw_grains(studies: list[Entry]) -> None:
    """Parts of the variance by grain size."""
    found = sorted(of_kind(studies, "grain sizes"), key=lambda one: -one["diameter_m"])
    if not found:
        return
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, len(OUTPUTS), figsize=(9.2, 3.6), constrained_layout=True, sharey=True)
        for axis, (output, symbol) in zip(axes, OUTPUTS.items(), strict=True):
            for number, (one, colour) in enumerate(zip(found, INPUT_COLOURS, strict=False)):
                parts = [(one["variance_shares"][output] or {}).get(part) for part in PARTS]
                for place, part in enumerate(parts):
                    if part:
                        ends = [max(part["share"] - part["lower"], 0.0), max(part["upper"] - part["share"], 0.0)]
                        x, bars = place + 0.2 * number - 0.1, [[100.0 * end] for end in ends]
                        axis.errorbar(x, 100.0 * part["share"], bars, fmt="os^"[number], color=colour, capsize=2, ms=4)
            axis.axhline(0.0, color=QUIET, lw=0.6, zorder=0)
            axis.set_xticks(range(len(PARTS)), [name.replace(" and ", "\nand ") for name in PARTS.values()])
            axis.tick_params(axis="x", labelsize=7.5)
            axis.set_title(WORDS.get(symbol, symbol))
        axes[0].set_ylabel("share of the variance [%], 90 % interval")
        for number, (one, colour) in enumerate(zip(found, INPUT_COLOURS, strict=False)):
            label = f"grains of {100 * one['diameter_m']:g} cm"
            axes[0].plot([], [], "os^"[number], color=colour, ms=4, label=label)
        figure.legend(loc="outside lower center", ncols=3)
        figure.savefig(PAGES / "one_bed_grains.png", dpi=150)


def _interval(one: Entry) -> str:
    returns = one["returns"]
    if returns["lower"] is None:
        return f"{100 * returns['share']:.1f}"
    return f"{100 * returns['share']:.1f} ({100 * returns['lower']:.1f} to {100 * returns['upper']:.1f})"


def seed_table(studies: list[Entry]) -> list[str]:
    """A line a pair of seeds."""
    lines = [
        "| seeds | every landing a draw: down again [%] | agree | the paper's way: down again [%] | agree |",
        "|---|---|---|---|---|",
    ]
    places = {one["seed"]: one for one in of_kind(studies, "one place")}
    for first, second in pairs(of_kind(studies, "draws")):
        seeds = first["seed"], second["seed"]
        cells = [f"{seeds[0]}, {seeds[1]}", f"{_interval(first)}; {_interval(second)}", _yes(holds(first, second))]
        if set(seeds) <= places.keys():
            one, other = (places[seed] for seed in seeds)
            cells += [f"{_interval(one)}; {_interval(other)}", _yes(holds(one, other))]
        else:
            cells += ["", ""]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def _yes(true: bool) -> str:
    return "yes" if true else "no"


def place_table(studies: list[Entry]) -> list[str]:
    """What the paper's way says of each bed."""
    lines = [
        "| seed | down again [%] | V+ [cm/s] | theta+ [deg] | what decides V+, and its share | Q2 of V+ |",
        "|---|---|---|---|---|---|",
    ]
    for one in of_kind(studies, "one place"):
        name, share = max(one["sobol_first"].items(), key=lambda item: item[1])
        speed = f"{100 * one['mean'][SPEED]:.1f} ± {100 * one['std'][SPEED]:.1f}"
        steep = f"{math.degrees(one['mean'][ELEVATION]):.0f} ± {math.degrees(one['std'][ELEVATION]):.0f}"
        lines.append(
            f"| {one['seed']} | {100 * one['returns']['share']:.1f} ± {100 * one['returns']['flight_sampling']:.1f} | "
            f"{speed} | {steep} | {name}, {share:.2f} | {one['q2']:.2f} |"
        )
    return lines


def grain_table(studies: list[Entry]) -> list[str]:
    """Parts of the variance by grain size, with intervals."""
    lines = ["| grains [cm] | edge over grain | output | " + " | ".join(PARTS.values()) + " | soil by pairs |"]
    lines.append("|---" * (4 + len(PARTS)) + "|")
    for one in sorted(of_kind(studies, "grain sizes"), key=lambda entry: -entry["diameter_m"]):
        beside = (one["runs"]["side_runs"] or {}).get("soil_total_effect", {})
        for output, symbol in OUTPUTS.items():
            shares = one["variance_shares"].get(output)
            cells = [_share(shares[part]) if shares else "" for part in PARTS] + [_share(beside.get(output))]
            head = f"{100 * one['diameter_m']:.1f} | {LANDER_EDGE / one['diameter_m']:.1f} | {symbol}"
            lines.append(f"| {head} | " + " | ".join(cells) + " |")
    return lines


def _share(part: dict[str, float] | None) -> str:
    return f"{part['share']:.2f} ({part['lower']:.2f} to {part['upper']:.2f})" if part else ""


def main() -> None:
    """Draw and write."""
    content = json.loads((HERE / "one_bed.json").read_text())
    studies = content["studies"]
    draw_seeds(studies)
    draw_grains(studies)
    made = f"`python {content['command'].removeprefix('python ')}`, {content['date']}, {content['machine']}."
    parts = [HEAD, *seed_table(studies), SEEDS, *place_table(studies), PLACES, *grain_table(studies), GRAINS, made]
    (PAGES / "one_bed.md").write_text("\n".join(parts) + "\n")


if __name__ == "__main__":
    main()
