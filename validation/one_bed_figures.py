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
from page_text import broken

from lithobrake.report.figures.style import INK, INPUT_COLOURS, QUIET, STYLE, TEST, TRAINING

HERE = Path(__file__).parent
PAGES = HERE.parent / "docs" / "validation"
Entry = dict[str, Any]
PARTS = {"soil": "soil", "bed": "bed", "place_and_attitude": "everything else", "chaos": "chaos"}
INPUTS = {
    "grain.friction": "friction", "grain.young_modulus": "Young's modulus", "grain.restitution": "grain restitution",
    "grain.poisson_ratio": "Poisson's ratio", "lander.restitution": "lander restitution",
}  # fmt: skip
OUTPUTS = {
    "speed_out": "rebound speed", "elevation_out": "rebound elevation", "spin_out": "rebound spin rate",
    "returns": "return fraction",
}  # fmt: skip
LANDER_EDGE = 0.1  # m, the short edges
HEAD = """\
# One bed and many: tables

Do two studies that differ in their seed alone agree?

{answer}

[One bed is not enough](../one_bed_is_not_enough.md) explains the studies and their result; this page has the tables.
Brackets contain 90 % intervals.

## Pairs of seeds

![Return fraction, seed by seed](one_bed_seeds.png)

Two studies agree if the interval of their difference contains 0. The paper method gives no interval over beds; the
sampling error of its flights takes its place.

{seeds}

## The paper method on one bed each

The return fraction has the 90 % sampling error of its 5000 flights. The other "±" are standard deviations over the
samples. "Dominant input" is the one with the largest first-order Sobol index in the variance that the expansion
explains. Q2 is on twelve fresh runs over all inputs; below 0 the expansion predicts worse than the mean.

{places}

## Parts of the variance by grain size

![Parts of the variance, for three grain sizes](one_bed_grains.png)

Each entry is a fraction of the variance of the output, with its 90 % interval. Estimates below 0 or above 1 are shown
as 0 or 1. "Everything else" is impact point, attitude and the effects of the soil beyond terms of first and second
degree. "Total effect of the soil" includes interactions with the impact point and the attitude. It comes from paired
landings at one impact point on two soils. All beds have the same volume of grains and are 0.7 m wide.

{grains}

## Limits

The tables hold over the soil ranges of `scenarios/first_bounce.toml` and `scenarios/one_place.toml`, at one speed and
one site. [Soil against impact point](grain_size.md) covers finer grains.

## Reproduce this page

`python validation/one_bed_figures.py` writes the page and its figures. {made}
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
            (axes[0], "one place", TEST, "Paper method, one bed each"),
            (axes[1], "draws", TRAINING, "Drawn method"),
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
        axes[0].set_ylabel("return fraction [%]")
        # Room for the words below.
        axes[0].set_ylim(bottom=axes[0].get_ylim()[0] - 4.0)
        axes[0].text(0.02, 0.02, "bars: 90 %, sampling of flights alone", transform=axes[0].transAxes, color=INK)
        axes[1].text(
            0.02, 0.02, "bars: 90 %, over beds, impact points, attitudes", transform=axes[1].transAxes, color=INK
        )
        figure.savefig(PAGES / "one_bed_seeds.png", dpi=150)


def within(share: float) -> float:
    """A fraction of a variance as it can be: an estimate may come out below 0 or above 1."""
    return min(max(share, 0.0), 1.0)


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
                        middle = within(part["share"])
                        ends = [max(middle - part["lower"], 0.0), max(part["upper"] - middle, 0.0)]
                        x, bars = place + 0.2 * number - 0.1, [[100.0 * end] for end in ends]
                        axis.errorbar(x, 100.0 * middle, bars, fmt="os^"[number], color=colour, capsize=2, ms=4)
            axis.axhline(0.0, color=QUIET, lw=0.6, zorder=0)
            axis.set_xticks(range(len(PARTS)), [name.replace(" ", "\n") for name in PARTS.values()])
            axis.tick_params(axis="x", labelsize=7.5)
            axis.set_title(symbol)
        axes[0].set_ylabel("fraction of the variance [%], 90 % interval")
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
        "| seeds | drawn method: return fraction [%] | agree | paper method: return fraction [%] | agree |",
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
    """Return a line a study of the paper method."""
    lines = [
        "| seed | return fraction [%] | rebound speed [cm/s] | rebound elevation [deg] | dominant input for the speed "
        "| its Sobol index | Q2 of the speed |",
        "|---" * 7 + "|",
    ]
    for one in of_kind(studies, "one place"):
        name, share = max(one["sobol_first"].items(), key=lambda item: item[1])
        speed = f"{100 * one['mean'][SPEED]:.1f} ± {100 * one['std'][SPEED]:.1f}"
        steep = f"{math.degrees(one['mean'][ELEVATION]):.0f} ± {math.degrees(one['std'][ELEVATION]):.0f}"
        lines.append(
            f"| {one['seed']} | {100 * one['returns']['share']:.1f} ± {100 * one['returns']['flight_sampling']:.1f} | "
            f"{speed} | {steep} | {INPUTS[name]} | {share:.2f} | {one['q2']:.2f} |"
        )
    return lines


def grain_table(studies: list[Entry]) -> list[str]:
    """Parts of the variance by grain size, with intervals."""
    lines = [
        "| grains [cm] | lander's short edge / grain | output | "
        + " | ".join(PARTS.values())
        + " | total effect of the soil |"
    ]
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
    return f"{within(part['share']):.2f} ({part['lower']:.2f} to {part['upper']:.2f})" if part else ""


def answer(studies: list[Entry]) -> str:
    """Return how far studies of both methods are apart, and how many pairs agree."""
    sentences = []
    for kind, name in (("draws", "drawn"), ("one place", "paper")):
        found = of_kind(studies, kind)
        shares = [100.0 * one["returns"]["share"] for one in found]
        agree = [holds(*pair) for pair in pairs(found)]
        sentences.append(
            f"{len(found)} studies of the {name} method give return fractions of {min(shares):.0f} to "
            f"{max(shares):.0f} %, and {sum(agree)} of {len(agree)} pairs agree."
        )
    return " ".join(sentences)


def main() -> None:
    """Draw and write."""
    content = json.loads((HERE / "one_bed.json").read_text())
    studies = content["studies"]
    draw_seeds(studies)
    draw_grains(studies)
    page = HEAD.format(
        answer=answer(studies), seeds="\n".join(seed_table(studies)), places="\n".join(place_table(studies)),
        grains="\n".join(grain_table(studies)),
        made=f"The studies: `python {content['command'].removeprefix('python ')}`, {content['date']}, "
        f"{content['machine']}.",
    )  # fmt: skip
    (PAGES / "one_bed.md").write_text(broken(page) + "\n")


if __name__ == "__main__":
    main()
