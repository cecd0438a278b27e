"""Write the page of a forecast and its figures from its landers.csv, runs.json, forecast.json, and variants.json.

    python validation/forecast_hera/write_page.py --out FOLDER

The last step of forecast.py.
"""

import math
import sys
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from answers import FORECAST, HERE
from drawing import figure
from harness import ROOT, Row, command_line, read_document, read_rows
from landers import KINDS, RUNS, TABLE
from page import broken, table, words_of, write_page
from samples import BINS, ENDS, FACES, GROUNDS

from lithobrake.report.figures.style import INK, QUIET, RULE, TRAINING
from lithobrake.vocabulary.outcomes import END_COLOURS, JourneyEnd

DOCS = ROOT / "docs"
UNLIKELY = 0.02
SOIL, HARD = END_COLOURS[JourneyEnd.AT_REST], QUIET
Answers = dict[str, Any]
GROUND_WORDS = {"soil": "soil", "hard": "hard ground, restitution from 0 to 1"}
END_WORDS = {
    "at_rest": "at rest on Dimorphos", "escaped": "escaped from both bodies", "partner": "on Didymos",
    "under_way": "still moving after three days",
}  # fmt: skip
# Words of a number, and its unit in SI.
NUMBER_WORDS = {
    "time_s": ("time from the first contact to rest [min]", 60.0), "contacts": ("contacts", 1.0),
    "distance": ("distance from the aim point to rest [m]", 1.0),
    "first_speed_ratio": ("first rebound speed / impact speed", 1.0),
}  # fmt: skip
VARIANT_WORDS = {
    "held_speed 0.03": "grains are frozen below 0.03 of the lander's speed, instead of 0.1 (`contact.held_speed`)",
    "shape model alone": "shape from before DART, without Didymos, instead of an ellipsoid without Didymos",
}
BIN_WORDS = {
    "time_min": "minutes from the first contact to rest", "contacts": "contacts until rest",
    "first_speed_ratio": "first rebound speed / impact speed",
}  # fmt: skip
INPUT_WORDS = {
    "mass_kg": "mass of Dimorphos", "speed": "speed of the first impact",
    "incidence_deg": "incidence of the first impact", "grain_friction": "friction of the grains",
    "grain_restitution": "restitution of the grains", "grain_cohesion_n": "cohesion of the grains",
    "young_modulus": "modulus of the grains", "hull_restitution": "restitution of the lander",
    "hull_friction": "friction of the lander", "hull_cohesion_n": "cohesion of the lander",
    "lander_mass": "mass of the lander",
}  # fmt: skip
DIGEST_WORDS = {
    "branches": "branches.py, descent.py, grounds.py, landers.py, hard_ground.py",
    "code": "all files of the package, in the order of their paths", "results": "landers.csv",
}  # fmt: skip


def percent(one: dict[str, float]) -> str:
    return f"{100 * one['share']:.0f} % ({100 * one['lower']:.0f}-{100 * one['upper']:.0f})"


def plain(value: float, digits: int = 2) -> str:
    """A number to so many digits, without an exponent."""
    if value == 0.0:
        return "0"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, places):.{max(places, 0)}f}"


def ends_table(landers: Answers) -> str:
    rows = [
        [name.capitalize(), GROUND_WORDS[ground], *(percent(landers[name][ground]["ends"][end]) for end in ENDS)]
        for name in landers
        for ground in GROUNDS
    ]
    return table(("lander", "ground", *(END_WORDS[end] for end in ENDS)), rows)


def numbers_table(landers: Answers) -> str:
    """When and how far, of the landers at rest."""
    rows = []
    for name, ground in product(landers, GROUNDS):
        for key, (words, size) in NUMBER_WORDS.items():
            found = landers[name][ground]["at_rest"][key]
            one = {level: f"{v:.0f}" if key == "contacts" else plain(v / size) for level, v in found.items()}
            median = f"{one['q50']} ({one['median_lower']}-{one['median_upper']})"
            rows.append([name.capitalize(), GROUND_WORDS[ground], words, one["q05"], median, one["q95"]])
    return table(("lander", "ground", "quantity", "5 %", "median (90 % interval)", "95 %"), rows)


def regions_table(landers: Answers) -> str:
    rows = []
    for name in landers:
        for one in landers[name]["soil"]["regions"]:
            area, lower, upper = (plain(one[key], 3) for key in ("area_m2", "lower", "upper"))
            ground = f"{100 * one['of_ground']:.0f} %"
            rows.append([name.capitalize(), f"{100 * one['share']:.0f} %", f"{area} ({lower}-{upper})", ground])
    return table(("lander", "fraction of the landers", "area [m2]", "fraction of the surface"), rows)


def variants_part(compared: list[dict[str, Any]]) -> str:
    """What choices are worth, heading and all; nothing where no variant was followed."""
    rows = [
        [
            one["lander"].capitalize(), VARIANT_WORDS[one["variant"]],
            f"{one['at_rest']} and {one['at_rest_before']} of {one['landers']}",
            f"{plain(one['median_time_s'] / 60.0)} and {plain(one['median_time_before_s'] / 60.0)}",
            f"{plain(one['time_ratio'])} ({plain(one['lower'])}-{plain(one['upper'])})",
        ]
        for one in compared
    ]  # fmt: skip
    changed = "at rest: with and without the change"
    head = ("lander", "variant", changed, "median time to rest [min]", "ratio (90 % interval)")
    return broken(words_of("forecast_hera_variants").format(table=table(head, rows))) if rows else ""


def faces_table(landers: Answers) -> str:
    rows = [
        [name.capitalize(), *(f"{100 * one:.0f} %" for one in landers[name]["soil"]["scored"]["face"])]
        for name in landers
    ]
    return table(("lander", *(f"{face} down" for face in FACES)), rows)


def branches_table(landers: Answers) -> str:
    rows = []
    for name in landers:
        hard = {one["branch"]: one for one in landers[name]["hard"]["by_branch"]}
        for one in landers[name]["soil"]["by_branch"]:
            shares = [percent(one[end]) for end in ENDS[:3]]
            beside = percent(hard[one["branch"]]["at_rest"])
            rows.append(
                [name.capitalize(), one["branch"], f"{one['weight']:.3g}", str(one["landers"]), *shares, beside]
            )
    words = (END_WORDS[end] for end in ENDS[:3])
    return table(("lander", "branch", "weight", "landers", *words, "at rest on hard ground"), rows)


def decides_table(landers: Answers) -> str:
    """What goes with the end, the time to rest and the first rebound."""
    rows = []
    for name in landers:
        for one in sorted(landers[name]["soil"]["what_decides"], key=lambda one: -abs(one["time_s"]["value"])):
            halves = f"{100 * one['at_rest_lower_half']:.0f}, {100 * one['at_rest_upper_half']:.0f} %"
            ranks = [
                f"{found['value']:+.2f} ({found['lower']:+.2f} to {found['upper']:+.2f})"
                for found in (one["time_s"], one["first_speed_ratio"])
            ]
            rows.append([name.capitalize(), INPUT_WORDS[one["input"]], halves, *ranks])
    correlations = (f"correlation with {output}" for output in ("time to rest", "first speed ratio"))
    head = ("lander", "input", "at rest: lower, upper half", *correlations)
    return table(head, rows)


def bin_words(name: str, number: int) -> str:
    if name == "end":
        return f"end: {END_WORDS[ENDS[number]]}"
    edges = BINS[name]
    if number == len(edges) - 1:
        return f"{BIN_WORDS[name]}: {edges[number]:g} or more"
    if name == "first_speed_ratio" and number == 0:
        return f"{BIN_WORDS[name]}: 0, it stays at the first contact"
    return f"{BIN_WORDS[name]}: {edges[number]:g} to {edges[number + 1]:g}"


def falsified_table(landers: Answers) -> str:
    """What the forecast holds for unlikely, and what hard ground gives it."""
    rows = []
    for name in landers:
        soil, hard = (landers[name][ground]["scored"] for ground in GROUNDS)
        for key in ("end", *BINS):
            for number, (one, other) in enumerate(zip(soil[key], hard[key], strict=True)):
                if one < UNLIKELY:
                    rows.append(
                        [name.capitalize(), bin_words(key, number), f"{100 * one:.1f} %", f"{100 * other:.1f} %"]
                    )
    return table(("lander", "observation", "forecast", "hard ground"), rows)


def digests_table(digests: dict[str, Any]) -> str:
    rows = [[f"`scenarios/{name}.toml`", f"`{one}`"] for name, one in digests["studies"].items()]
    return table(("what", "SHA-256"), rows + [[words, f"`{digests[key]}`"] for key, words in DIGEST_WORDS.items()])


def first_line(landers: Answers) -> str:
    said = [f"{name.capitalize()} {percent(landers[name]['soil']['ends']['at_rest'])}" for name in landers]
    hits = [
        f"{of['soil']['touched_down']['at_rest']} of {of['soil']['touched_down']['landers']} of {name.capitalize()}"
        for name, of in landers.items()
    ]
    return (
        f"Probability of coming to rest on Dimorphos: {', '.join(said)} (90 % intervals). "
        f"Of the simulated landers that touch down, {' and '.join(hits)} come to rest."
    )


def draw_shares(landers: dict[str, Any], path: Path) -> None:
    """Shares at rest with their intervals, on soil and on hard ground, in all and by branch."""
    with figure(path, 1, len(landers), (9.6, 3.3), sharex=True) as (drawn, axes):
        for ax, (name, of) in zip(axes, landers.items(), strict=True):
            rows = [("all branches", *(of[ground]["ends"]["at_rest"] for ground in ("soil", "hard")))]
            hard = {one["branch"]: one["at_rest"] for one in of["hard"]["by_branch"]}
            rows += [(one["branch"], one["at_rest"], hard[one["branch"]]) for one in of["soil"]["by_branch"]]
            for place, (_, soil, rock) in enumerate(rows):
                for one, colour, shift in ((soil, SOIL, -0.13), (rock, HARD, 0.13)):
                    ax.plot([100 * one["lower"], 100 * one["upper"]], [place + shift] * 2, color=colour, lw=2.2)
                    ax.plot(100 * one["share"], place + shift, "o", color=colour, ms=5)
            ax.set_yticks(range(len(rows)), [row[0] for row in rows])
            ax.set_ylim(len(rows) - 0.5, -0.5)
            ax.axhline(0.5, color=RULE, lw=0.8)
            ax.set_xlim(0, 100)
            ax.set_xlabel("at rest on Dimorphos [%]")
            ax.set_title(name.capitalize())
        axes[0].plot([], [], "o-", color=SOIL, label="soil")
        axes[0].plot([], [], "o-", color=HARD, label="hard ground, restitution from 0 to 1")
        drawn.legend(loc="outside lower center", ncols=2)


def draw_map(rows: list[Row], landers: dict[str, Any], path: Path) -> None:
    """Places of rest on soil, with the smallest region that holds half of them (cylinder of equal area)."""
    with figure(path, len(landers), 1, (7.6, 7.4), sharex=True) as (_, axes):
        for ax, (name, of) in zip(axes, landers.items(), strict=True):
            for line in of["soil"]["regions"][0]["outlines"]:
                latitude, longitude = np.array(line).T
                # A line that crosses the date line is not drawn back over the whole map.
                longitude[1:][np.abs(np.diff(longitude)) > 180.0] = np.nan
                ax.plot(longitude, np.sin(np.radians(latitude)), color=INK, lw=1.8)
            own = [row for row in rows if (row["lander"], row["ground"], row["end"]) == (name, "soil", "at_rest")]
            for rotation, colour in zip(("small", "large", "rolling"), (SOIL, "#e69f00", "#a8659a"), strict=True):
                here = [row for row in own if row["branch"].startswith(rotation)]
                ax.plot(
                    [row["longitude_deg"] for row in here], np.sin(np.radians([row["latitude_deg"] for row in here])),
                    "o", ms=2.6, color=colour, label=rotation if rotation == "rolling" else f"{rotation} libration",
                )  # fmt: skip
            ax.plot([0.0, 180.0, -180.0], [0.0] * 3, "+", ms=11, mew=1.8, color=TRAINING, label="aims")
            ticks = np.array([-90, -60, -30, 0, 30, 60, 90])
            ax.set_yticks(np.sin(np.radians(ticks)), [str(one) for one in ticks])
            ax.set_xticks(range(-180, 181, 45))
            ax.grid(True)
            ax.set_xlim(-180, 180)
            ax.set_ylim(-1, 1)
            ax.set_ylabel("latitude [deg]")
            ax.set_title(f"{name.capitalize()}: places of rest, and the smallest region with half of them")
        axes[-1].set_xlabel("east longitude [deg]; 0 faces Didymos while Dimorphos turns with its orbit")
        axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.1), ncols=4)


def write(out: Path, docs: Path) -> None:
    """Write page and figures of the forecast in a folder to another."""
    document, runs = (read_document(out / name) for name in (FORECAST, RUNS))
    landers = document["landers"]
    draw_shares(landers, docs / "forecast_hera_shares.png")
    draw_map(read_rows(out / TABLE, KINDS), landers, docs / "forecast_hera_map.png")
    counts = ", ".join(
        f"{name.capitalize()} {of['soil']['landers']} on soil and {of['hard']['landers']} on hard ground"
        for name, of in landers.items()
    )
    variants = read_document(HERE / "variants.json")["compared"]
    cost = f"All studies took {runs['cpu_s'] / 60.0:.0f} minutes of CPU time." if "cpu_s" in runs else ""
    write_page(
        "forecast_hera_edition", docs, made=document["made"], first=first_line(landers), counts=counts, cost=cost,
        ends=ends_table(landers), numbers=numbers_table(landers), regions=regions_table(landers),
        faces=faces_table(landers), decides=decides_table(landers), branches=branches_table(landers),
        variants=variants_part(variants), priors=(HERE / "priors.md").read_text(encoding="utf-8").strip(),
        unlikely=100 * UNLIKELY, falsified=falsified_table(landers), digests=digests_table(document["sha256"]),
    )  # fmt: skip


def main() -> None:
    folder = command_line(__doc__, out=Path).parse_args().out
    write(folder, folder)


if __name__ == "__main__":
    main()
