"""Write docs/forecast_hera.md and its figures from landers.csv and forecast.json.

python validation/forecast_hera/write_page.py
"""

import json
import sys
from pathlib import Path
from typing import Any

from answers import BINS, ENDS, FACES, GROUNDS
from branches import LANDERS
from figures import draw_map, draw_shares
from forecast import FIRST, HERE, KINDS, TABLE
from page_words import ABOUT, LEFT_OUT, METHOD, REPRODUCE, SCORING

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, read_rows
from page_text import broken

DOCS = Path(__file__).parents[2] / "docs"
WORDS = {"at_rest": "at rest", "escaped": "left Dimorphos and Didymos", "partner": "on Didymos", "under_way": "still moving after three days"}
UNLIKELY = 0.02
INPUT_WORDS = {
    "mass_kg": "mass of Dimorphos", "speed": "speed of the first impact", "incidence_deg": "incidence of the first impact",
    "grain_friction": "friction of the grains", "grain_restitution": "restitution of the grains",
    "grain_cohesion_n": "cohesion of the grains", "young_modulus": "modulus of the grains",
    "hull_restitution": "restitution of the lander", "hull_friction": "friction of the lander",
    "hull_cohesion_n": "cohesion of the lander", "lander_mass": "mass of the lander",
}  # fmt: skip


def percent(one: dict[str, float]) -> str:
    """A share with its interval."""
    return f"{100 * one['share']:.0f} % ({100 * one['lower']:.0f}-{100 * one['upper']:.0f})"


def table(head: tuple[str, ...], rows: list[list[str]]) -> str:
    """A table of the page."""
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}", *(f"| {' | '.join(row)} |" for row in rows)]
    return "\n".join(lines)


def ends_table(landers: dict[str, Any]) -> str:
    """Ends of each lander on each ground."""
    grounds = {"soil": "soil", "hard": "hard ground, e from 0 to 1"}
    return table(
        ("lander", "ground", *(WORDS[end] for end in ENDS)),
        [
            [name.capitalize(), grounds[ground], *(percent(landers[name][ground]["ends"][end]) for end in ENDS)]
            for name in landers for ground in GROUNDS
        ],
    )  # fmt: skip


def numbers_table(landers: dict[str, Any]) -> str:
    """When and how far, of the landers at rest."""
    what = {
        "time_s": ("time from the first contact to rest [min]", 60.0), "contacts": ("contacts", 1.0),
        "distance_m": ("distance from the aim to rest [m]", 1.0), "first_speed_ratio": ("first rebound speed over impact speed", 1.0),
    }  # fmt: skip
    rows = []
    for name in landers:
        for ground in GROUNDS:
            for key, (words, size) in what.items():
                one = {level: value / size for level, value in landers[name][ground]["at_rest"][key].items()}
                rows.append([
                    name.capitalize(), ground, words, f"{one['q05']:.2g}",
                    f"{one['q50']:.2g} ({one['median_lower']:.2g}-{one['median_upper']:.2g})", f"{one['q95']:.2g}",
                ])  # fmt: skip
    return table(("lander", "ground", "quantity", "5 %", "median (90 % interval)", "95 %"), rows)


def regions_table(landers: dict[str, Any]) -> str:
    """Where."""
    return table(
        ("lander", "share of the landers at rest", "area of the smallest region [m2]", "largest extent [m]"),
        [
            [name.capitalize(), f"{one['share']:.0%}", f"{one['area_m2']:.3g}", f"{one['largest_extent_m']:.0f}"]
            for name in landers for one in landers[name]["soil"]["regions"]
        ],
    )  # fmt: skip


def faces_table(landers: dict[str, Any]) -> str:
    """Which side is down."""
    return table(
        ("lander", *(f"{face} down" for face in FACES)),
        [[name.capitalize(), *(f"{one:.0%}" for one in landers[name]["soil"]["scored"]["face"])] for name in landers],
    )


def branches_table(landers: dict[str, Any]) -> str:
    """Ends by branch."""
    rows = []
    for name in landers:
        hard = {one["branch"]: one for one in landers[name]["hard"]["by_branch"]}
        for one in landers[name]["soil"]["by_branch"]:
            rows.append([
                name.capitalize(), one["branch"], f"{one['weight']:.3g}", str(one["landers"]),
                *(percent(one[end]) for end in ENDS[:3]), percent(hard[one["branch"]]["at_rest"]),
            ])  # fmt: skip
    return table(("lander", "branch", "weight", "landers", *(WORDS[end] for end in ENDS[:3]), "hard ground: at rest"), rows)


def decides_table(landers: dict[str, Any]) -> str:
    """What moves the share at rest and the time to rest."""
    rows = []
    for name in landers:
        found = sorted(landers[name]["soil"]["what_decides"], key=lambda one: -abs(one["difference"]))
        for one in found:
            times = [f"{value / 60.0:.0f}" if value is not None else "-" for value in one["median_time_s"]]
            gap = f"{100 * one['difference']:+.0f} ({100 * one['difference_lower']:+.0f} to {100 * one['difference_upper']:+.0f})"
            rows.append([
                name.capitalize(), INPUT_WORDS[one["input"]], f"{one['at_rest_lower_third']:.0%}",
                f"{one['at_rest_upper_third']:.0%}", gap, " to ".join(times),
            ])  # fmt: skip
    head = ("lander", "input", "at rest, lower third", "upper third", "difference [points]", "median minutes to rest")
    return table(head, rows)


def bin_words(name: str, number: int) -> str:
    """A bin in words."""
    edges = BINS[name]
    if number == len(edges) - 1:
        return f"{edges[number]:g} and more"
    if name == "first_speed_ratio" and number == 0:
        return "none (the lander stays)"
    return f"{edges[number]:g} to {edges[number + 1]:g}"


def falsified_table(landers: dict[str, Any]) -> str:
    """What the forecast holds for unlikely, and hard ground does not, or the other way round."""
    rows = []
    for name in landers:
        soil, hard = (landers[name][ground]["scored"] for ground in GROUNDS)
        for key in ("end", *BINS):
            for number, (one, other) in enumerate(zip(soil[key], hard[key], strict=True)):
                if one < UNLIKELY:
                    words = WORDS[ENDS[number]] if key == "end" else bin_words(key, number)
                    what = {"end": "it ends", "time_min": "minutes to rest", "contacts": "contacts to rest", "first_speed_ratio": "first rebound speed over impact speed"}[key]
                    rows.append([name.capitalize(), f"{what}: {words}", f"{100 * one:.1f} %", f"{100 * other:.1f} %"])
    return table(("lander", "observation", "forecast", "hard ground"), rows)


def page(document: dict[str, Any], rows: list[Row]) -> str:
    """The text of the page."""
    landers = document["landers"]
    first = " ".join(
        f"{name.capitalize()} comes to rest on Dimorphos with {percent(landers[name]['soil']['ends']['at_rest'])}"
        f"{', ' if name != LANDERS[-1] else ' (90 % intervals).'}"
        for name in LANDERS
    )
    counts = {name: {ground: landers[name][ground]["landers"] for ground in GROUNDS} for name in LANDERS}
    parts = [
        broken(ABOUT.format(made=document["made"], first=first)),
        ends_table(landers), "![Shares at rest by branch](forecast_hera_shares.png)",
        broken(METHOD["numbers"]), numbers_table(landers),
        broken(METHOD["place"]), regions_table(landers), "![Places of rest](forecast_hera_map.png)",
        broken(METHOD["faces"]), faces_table(landers),
        broken(METHOD["decides"]), decides_table(landers),
        broken(METHOD["branches"]), branches_table(landers),
        broken(METHOD["priors"]), (HERE / "priors.md").read_text(encoding="utf-8").strip(),
        broken(METHOD["falsified"].format(unlikely=UNLIKELY)), falsified_table(landers),
        broken(SCORING),
        broken(LEFT_OUT),
        broken(REPRODUCE.format(counts=counts, **{f"sha_{k}": v for k, v in document["sha256"].items() if k != "studies"})),
        table(("what", "SHA-256"), [
            *([f"`scenarios/{name}.toml`", f"`{one}`"] for name, one in document["sha256"]["studies"].items()),
            *([words, f"`{document['sha256'][key]}`"] for key, words in (
                ("branches", "branches.py, descent.py, grounds.py"), ("code", "all files of the package, by path"), ("results", "landers.csv"))),
        ]),
    ]  # fmt: skip
    return "\n\n".join(parts) + "\n"


def main() -> None:
    """Write page and figures."""
    document = json.loads((HERE / "forecast.json").read_text(encoding="utf-8"))
    rows = read_rows(HERE / TABLE, KINDS)
    draw_shares(document["landers"], DOCS / "forecast_hera_shares.png")
    draw_map(rows, document["landers"], DOCS / "forecast_hera_map.png")
    assert set(INPUT_WORDS) == set(FIRST)
    (DOCS / "forecast_hera.md").write_text(page(document, rows), encoding="utf-8")


if __name__ == "__main__":
    main()
