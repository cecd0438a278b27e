"""Draw what one_bed.py found, and write its tables, one_bed.md; docs/one_bed_is_not_enough.md tells of both.

    python validation/one_bed_figures.py

Reads one_bed.json beside it; writes one_bed_seeds.png, one_bed_grains.png and one_bed.md to docs/validation.
"""

import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from one_bed import ELEVATION, SPEED

from lithobrake.report.figures.style import INK, INPUT_COLOURS, QUIET, TEST, TRAINING

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document
from page import made, table, write_page, yes

HERE = Path(__file__).parent
Entry = dict[str, Any]
PARTS = {"soil": "soil", "attitude": "attitude", "bed": "bed", "place": "everything else", "chaos": "chaos"}
INPUTS = {
    "grain.friction": "friction", "grain.young_modulus": "Young's modulus", "grain.restitution": "grain restitution",
    "grain.poisson_ratio": "Poisson's ratio", "lander.restitution": "lander restitution",
}  # fmt: skip
OUTPUTS = {
    "speed_out": "rebound speed", "elevation_out": "rebound elevation", "spin_out": "rebound spin rate",
    "returns": "return fraction",
}  # fmt: skip
LANDER_EDGE = 0.1  # m, the short edges


def of_kind(studies: list[Entry], kind: str) -> list[Entry]:
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
    with figure(PAGES / "one_bed_seeds.png", 1, 2, (7.4, 3.6), dpi=180, sharey=True) as (_, axes):
        for axis, kind, colour, title in (
            (axes[0], "one place", TEST, "Expansion, one bed each"),
            (axes[1], "draws", TRAINING, "Randomised landings"),
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
            axis.set_xlabel(f"seed of the study ({sum(held)} of {len(held)} pairs agree)")
            axis.set_xticks([one["seed"] for one in found][::2])
        axes[0].set_ylabel("return fraction [%]")
        # Room for the words below.
        axes[0].set_ylim(bottom=axes[0].get_ylim()[0] - 4.0)
        axes[0].text(0.02, 0.02, "bars: 90 %, sampling of flights alone", transform=axes[0].transAxes, color=INK)
        axes[1].text(
            0.02, 0.02, "bars: 90 %, over beds, impact points, attitudes", transform=axes[1].transAxes, color=INK
        )


def parts_of(studies: list[Entry]) -> dict[str, str]:
    """The parts of a variance that any of the studies tells apart, in words; attitude is else in what is left."""
    known = [shares for one in studies for shares in one["variance_shares"].values() if shares]
    return {part: word for part, word in PARTS.items() if any(shares.get(part) for shares in known)}


def draw_grains(studies: list[Entry]) -> None:
    found = sorted(of_kind(studies, "grain sizes"), key=lambda one: -one["diameter_m"])
    words = parts_of(found)
    with figure(PAGES / "one_bed_grains.png", 1, len(OUTPUTS), (9.2, 3.6), dpi=150, sharey=True) as (drawn, axes):
        for axis, (output, symbol) in zip(axes, OUTPUTS.items(), strict=True):
            for number, (one, colour) in enumerate(zip(found, INPUT_COLOURS, strict=False)):
                parts = [(one["variance_shares"][output] or {}).get(part) for part in words]
                for place, part in enumerate(parts):
                    if part:
                        middle = min(max(part["share"], 0.0), 1.0)
                        ends = [max(middle - part["lower"], 0.0), max(part["upper"] - middle, 0.0)]
                        x, bars = place + 0.2 * number - 0.1, [[100.0 * end] for end in ends]
                        axis.errorbar(x, 100.0 * middle, bars, fmt="os^"[number], color=colour, capsize=2, ms=4)
            axis.axhline(0.0, color=QUIET, lw=0.6, zorder=0)
            axis.set_xticks(range(len(words)), [name.replace(" ", "\n") for name in words.values()])
            axis.tick_params(axis="x", labelsize=7.5)
            axis.set_title(symbol)
        axes[0].set_ylabel("fraction of the variance [%], 90 % interval")
        for number, (one, colour) in enumerate(zip(found, INPUT_COLOURS, strict=False)):
            label = f"grains of {100 * one['diameter_m']:g} cm"
            axes[0].plot([], [], "os^"[number], color=colour, ms=4, label=label)
        drawn.legend(loc="outside lower center", ncols=3)


def _interval(one: Entry) -> str:
    returns = one["returns"]
    if returns["lower"] is None:
        return f"{100 * returns['share']:.1f}"
    return f"{100 * returns['share']:.1f} ({100 * returns['lower']:.1f} to {100 * returns['upper']:.1f})"


def seed_table(studies: list[Entry]) -> str:
    """A line a pair of seeds."""
    lines, places = [], {one["seed"]: one for one in of_kind(studies, "one place")}
    for first, second in pairs(of_kind(studies, "draws")):
        seeds, known = (first["seed"], second["seed"]), [(first, second)]
        if set(seeds) <= places.keys():
            known.append((places[seeds[0]], places[seeds[1]]))
        cells = [cell for two in known for cell in (f"{_interval(two[0])}; {_interval(two[1])}", yes(holds(*two)))]
        lines.append([f"{seeds[0]}, {seeds[1]}", *cells, *[""] * (4 - len(cells))])
    heads = (f"{name}: return fraction [%]" for name in ("randomised landings", "expansion on one bed"))
    return table(["seeds", *(one for head in heads for one in (head, "agree"))], lines)


def place_table(studies: list[Entry]) -> str:
    """A line a study by an expansion on one bed."""
    lines = []
    for one in of_kind(studies, "one place"):
        name, share = max(one["sobol_first"].items(), key=lambda item: item[1])
        speed = f"{100 * one['mean'][SPEED]:.1f} ± {100 * one['std'][SPEED]:.1f}"
        steep = f"{math.degrees(one['mean'][ELEVATION]):.0f} ± {math.degrees(one['std'][ELEVATION]):.0f}"
        fraction = f"{100 * one['returns']['share']:.1f} ± {100 * one['returns']['flight_sampling']:.1f}"
        lines.append([str(one["seed"]), fraction, speed, steep, INPUTS[name], f"{share:.2f}", f"{one['q2']:.2f}"])
    heads = ("seed", "return fraction [%]", "rebound speed [cm/s]", "rebound elevation [deg]",
             "dominant input for the speed", "its Sobol index", "Q2 of the speed")  # fmt: skip
    return table(heads, lines)


def grain_table(studies: list[Entry]) -> str:
    """Parts of the variance by grain size, with intervals."""
    found, lines = of_kind(studies, "grain sizes"), []
    words = parts_of(found)
    for one in sorted(found, key=lambda entry: -entry["diameter_m"]):
        beside = (one["runs"]["side_runs"] or {}).get("soil_total_effect", {})
        for output, symbol in OUTPUTS.items():
            shares = one["variance_shares"].get(output)
            cells = [share_words((shares or {}).get(part)) for part in words] + [share_words(beside.get(output))]
            sizes = f"{100 * one['diameter_m']:.1f}", f"{LANDER_EDGE / one['diameter_m']:.1f}"
            lines.append([*sizes, symbol, *cells])
    heads = ("grains [cm]", "lander's short edge / grain", "output", *words.values(), "total effect of the soil")
    return table(heads, lines)


def share_words(part: dict[str, float] | None) -> str:
    """A fraction of a variance as it can be, with its interval: an estimate may come out below 0 or above 1."""
    return f"{min(max(part['share'], 0.0), 1.0):.2f} ({part['lower']:.2f} to {part['upper']:.2f})" if part else ""


def answer(studies: list[Entry]) -> str:
    """Return how far studies of both methods are apart, and how many pairs agree."""
    sentences = []
    for kind, name in (("draws", "of randomised landings"), ("one place", "by an expansion on one bed")):
        found = of_kind(studies, kind)
        shares = [100.0 * one["returns"]["share"] for one in found]
        agree = [holds(*pair) for pair in pairs(found)]
        sentences.append(
            f"{len(found)} studies {name} give return fractions of {min(shares):.0f} to "
            f"{max(shares):.0f} %, and {sum(agree)} of {len(agree)} pairs agree."
        )
    return " ".join(sentences)


def main() -> None:
    content = read_document(HERE / "one_bed.json")
    studies = content["studies"]
    draw_seeds(studies)
    draw_grains(studies)
    command = f"python {content['command'].removeprefix('python ')}"
    write_page(
        "one_bed", answer=answer(studies), seeds=seed_table(studies), places=place_table(studies),
        grains=grain_table(studies), made=f"The studies: {made(content | {'command': command})}.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
