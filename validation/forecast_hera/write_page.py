"""Write docs/forecast_hera.md and its figures from landers.csv, runs.json, forecast.json and variants.json.

    python validation/forecast_hera/write_page.py

The last step of forecast.py.
"""

import json
import math
import sys
from itertools import product
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from answers import FORECAST, HERE
from figures import draw_map, draw_shares
from harness import command_line, read_rows
from landers import KINDS, RUNS, TABLE
from page_text import broken, table
from page_words import ABOUT, LEFT_OUT, METHOD, REPRODUCE, SCORING, VARIANTS_SAY
from samples import BINS, ENDS, FACES, GROUNDS

DOCS = Path(__file__).parents[2] / "docs"
UNLIKELY = 0.02
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
    """A share with its interval."""
    return f"{100 * one['share']:.0f} % ({100 * one['lower']:.0f}-{100 * one['upper']:.0f})"


def plain(value: float, digits: int = 2) -> str:
    """A number to so many digits, without an exponent."""
    if value == 0.0:
        return "0"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, places):.{max(places, 0)}f}"


def ends_table(landers: Answers) -> str:
    """Ends of each lander on each ground."""
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
    """Where."""
    rows = []
    for name in landers:
        for one in landers[name]["soil"]["regions"]:
            area, lower, upper = (plain(one[key], 3) for key in ("area_m2", "lower", "upper"))
            ground = f"{100 * one['of_ground']:.0f} %"
            rows.append([name.capitalize(), f"{100 * one['share']:.0f} %", f"{area} ({lower}-{upper})", ground])
    return table(("lander", "fraction of the landers", "area [m2]", "fraction of the surface"), rows)


def variants_part(compared: list[dict[str, Any]]) -> list[str]:
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
    return [broken(METHOD["variants"]), table(head, rows), broken(VARIANTS_SAY)] if rows else []


def faces_table(landers: Answers) -> str:
    """Which side is down."""
    rows = [
        [name.capitalize(), *(f"{100 * one:.0f} %" for one in landers[name]["soil"]["scored"]["face"])]
        for name in landers
    ]
    return table(("lander", *(f"{face} down" for face in FACES)), rows)


def branches_table(landers: Answers) -> str:
    """Ends by branch."""
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
    """A bin in words."""
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
    """What the forecast was made of."""
    rows = [[f"`scenarios/{name}.toml`", f"`{one}`"] for name, one in digests["studies"].items()]
    return table(("what", "SHA-256"), rows + [[words, f"`{digests[key]}`"] for key, words in DIGEST_WORDS.items()])


def by_part(text: str) -> str:
    """Text with its paragraphs filled, and its commands as they are."""
    before, commands, after = text.partition("```sh")
    inside, fence, rest = after.partition("```")
    return f"{broken(before)}\n\n{commands}{inside}{fence}\n\n{broken(rest)}"


def first_line(landers: Answers) -> str:
    """The answer."""
    said = [f"{name.capitalize()} {percent(landers[name]['soil']['ends']['at_rest'])}" for name in landers]
    hits = [
        f"{of['soil']['touched_down']['at_rest']} of {of['soil']['touched_down']['landers']} of {name.capitalize()}"
        for name, of in landers.items()
    ]
    return (
        f"Probability of coming to rest on Dimorphos: {', '.join(said)} (90 % intervals). "
        f"Of the simulated landers that touch down, {' and '.join(hits)} come to rest."
    )


def page(document: dict[str, Any], cost: str) -> str:
    """The text of the page; cost: what the landers took, in a sentence."""
    landers = document["landers"]
    counts = ", ".join(
        f"{name.capitalize()} {of['soil']['landers']} on soil and {of['hard']['landers']} on hard ground"
        for name, of in landers.items()
    )
    parts = [
        broken(ABOUT.format(made=document["made"], first=first_line(landers), counts=counts)),
        ends_table(landers), "![Fraction at rest by branch](forecast_hera_shares.png)",
        broken(METHOD["numbers"]), numbers_table(landers),
        broken(METHOD["place"]), regions_table(landers), "![Places of rest](forecast_hera_map.png)",
        broken(METHOD["faces"]), faces_table(landers),
        broken(METHOD["decides"]), decides_table(landers),
        broken(METHOD["branches"]), branches_table(landers),
        *variants_part(json.loads((HERE / "variants.json").read_text(encoding="utf-8"))["compared"]),
        broken(METHOD["priors"]), (HERE / "priors.md").read_text(encoding="utf-8").strip(),
        broken(METHOD["falsified"].format(unlikely=100 * UNLIKELY)), falsified_table(landers),
        by_part(SCORING), broken(LEFT_OUT), by_part(REPRODUCE.format(cost=cost)), digests_table(document["sha256"]),
    ]  # fmt: skip
    return "\n\n".join(parts) + "\n"


def cost_words(runs: dict[str, Any]) -> str:
    """What the landers took, in a sentence; none where it is not noted."""
    if "cpu_s" not in runs:
        return ""
    return f"All studies took {runs['cpu_s'] / 60.0:.0f} minutes of CPU time."


def write_page(out: Path, docs: Path) -> None:
    """Write page and figures of the forecast in a folder to another."""
    document = json.loads((out / FORECAST).read_text(encoding="utf-8"))
    draw_shares(document["landers"], docs / "forecast_hera_shares.png")
    draw_map(read_rows(out / TABLE, KINDS), document["landers"], docs / "forecast_hera_map.png")
    runs = json.loads((out / RUNS).read_text(encoding="utf-8"))
    (docs / "forecast_hera.md").write_text(page(document, cost_words(runs)), encoding="utf-8")


def main() -> None:
    """Write them to docs/."""
    write_page(command_line(__doc__, out=HERE).parse_args().out, DOCS)


if __name__ == "__main__":
    main()
