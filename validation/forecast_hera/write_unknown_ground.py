"""Write docs/forecast_hera_unknown_ground.md and its figure: the newest edition on unknown ground without measurements.

    python validation/forecast_hera/write_unknown_ground.py

The last step of write_editions.py. Reads the edition, its landers, and effects.json.
"""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import numpy as np
from answers import FIRST_EDITION, FORECAST, HERE
from assumptions import PRESET, SOFT, SPEEDS, STRENGTHS, UNKNOWN_GROUND
from branches import LANDERS, branches
from drawing import figure
from effects import BOOMS, EFFECTS, SHAPE, WINGS
from harness import Row, command_line, read_document
from landers import RUNS
from measurements import CONTACT_FORCE
from page import table, write_page
from write_page import DOCS, SOIL, percent, plain

from lithobrake.pipeline.site import Site
from lithobrake.report.figures.style import RULE, TRAINING
from lithobrake.study import StudySource
from lithobrake.study.ground_beds import finer_share, finest
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT

Answers = dict[str, Any]
PAGE = "forecast_hera_unknown_ground"
ECCENTRICITY = 0.03  # of the mutual orbit at most [Scheirich-2024]
KIND_WORDS = {"gravel": "gravel", "stones": "stones", "rock": "bare rock"}
LAW_WORDS = {
    "constant": "the same at all speeds", "yields": "falls with speed, by yielding",
    "viscoelastic": "falls with speed, viscoelastic",
}  # fmt: skip
GROUPS = {"by_ground": KIND_WORDS, "by_law": LAW_WORDS}
EFFECT_WORDS = {BOOMS: "four booms of 1.5 m", WINGS: "two wings", SHAPE: "the shape before DART, for the ellipsoid"}


def between(one: dict[str, float], size: float, digits: int = 2) -> str:
    """A median with its interval."""
    value, lower, upper = (plain(one[key] / size, digits) for key in ("q50", "median_lower", "median_upper"))
    return f"{value} ({lower}-{upper})"


def group_table(landers: Answers, key: str, head: str) -> str:
    """Ends and numbers by kind of ground or by law of restitution."""
    rows = []
    for name in landers:
        known = {one["name"]: one for one in landers[name]["soil"][key]}
        for group, said in GROUPS[key].items():
            one = known[group]
            rows.append([
                name.capitalize(), said, f"{100 * one['share']:.0f} %", f"{one['landers']}, {one['beds']}",
                percent(one["at_rest"]), between(one["time_s"], 60.0), between(one["distance"], 1.0),
                between(one["first_speed_ratio"], 1.0),
            ])  # fmt: skip
    heads = (
        "lander", head, "weight", "landers, beds", "at rest", "median time to rest [min]",
        "median distance from the aim point [m]", "median of first rebound speed / impact speed",
    )  # fmt: skip
    return table(heads, rows)


def difference(one: dict[str, float], size: float) -> str:
    value, lower, upper = (f"{size * one[key]:+.0f}" for key in ("value", "lower", "upper"))
    return f"{value} ({lower} to {upper})"


def effects_table(effects: Sequence[Row]) -> str:
    rows = []
    for one in effects:
        before, after, change = (one[key] for key in ("before", "after", "change"))
        rows.append([
            EFFECT_WORDS[one["effect"]], one["lander"].capitalize(),
            f"{before['at_rest']} and {after['at_rest']} of {after['landers']}", difference(change["at_rest"], 100.0),
            difference(change["time_s"], 1.0 / 60.0), difference(change["broad_side"], 100.0),
            difference(change["shift_m"], 1.0),
        ])  # fmt: skip
    heads = (
        "with", "lander", "at rest: without, with", "at rest [percentage points]", "median time to rest [min]",
        "on a broad side [percentage points]", "shift of the mean place [m]",
    )  # fmt: skip
    return table(heads, rows)


def finer_words(lander: str) -> tuple[str, str]:
    """The finest grains of a lander's beds [m], and the share of the ground that is finer [%]."""
    study = StudySource.of_tables(UNKNOWN_GROUND.study(branches(lander)[0], "soil", 1)).study
    return f"{finest(study):.2f}", f"{100 * finer_share(study):.0f}"


def kinds_words() -> str:
    """The kinds of the preset with their weights and sizes."""
    said = []
    for name, one in PRESET["kind"].items():
        size = one.get("grain_size")
        sizes = f" of {size['lower']:g} to {size['upper']:g} m" if size else ""
        said.append(f"{KIND_WORDS[name]}{sizes} ({100 * one['weight']:.0f} %)")
    return f"{', '.join(said[:-1])} or {said[-1]}"


def stone_cohesion() -> str:
    """Bulk cohesions [Pa] that the forces on contacts are, among stones of the middle of their sizes, by Rumpf."""
    size = PRESET["kind"]["stones"]["grain_size"]
    middle = float(np.sqrt(size["lower"] * size["upper"]))
    law = branches(LANDERS[0])[0].tables(1)["grain"]["cohesion_force"]
    ends = (plain(law[key] / CONTACT_FORCE * (0.2 / middle) ** 2, 1) for key in ("lower", "upper"))
    return f"{' to '.join(ends)} Pa among stones of {middle:.2f} m"


def eccentricity_words() -> tuple[str, str]:
    """By how much an orbit of the largest eccentricity changes the tide of Didymos [%], and that over gravity [%].

    The tide at the end of the long axis is 2 G M r / d^3 at the distance d of the period (Kepler), 3 e more or less.
    """
    body = Site(StudySource.of_tables(branches(LANDERS[0])[0].tables(1)).study).body
    assert body.partner is not None
    mass, pull = body.partner.body.mass, GRAVITATIONAL_CONSTANT
    cube = pull * (mass + body.mass) * (body.partner.period / (2.0 * np.pi)) ** 2
    radius = float(body.shape.vertices[:, 0].max())
    share = 3.0 * ECCENTRICITY
    gravity = float(np.linalg.norm(body.acceleration([[radius, 0.0, 0.0]])))
    return f"{100 * share:.0f}", plain(100 * share * 2.0 * pull * mass * radius / cube / gravity, 1)


def spread(landers: Answers, key: str, name: str, value: str) -> str:
    """The least and the greatest of a group's share at rest [%] or median time [min]."""
    rows = landers[name]["soil"][key]
    found = [100 * one["at_rest"]["share"] if value == "at_rest" else one["time_s"]["q50"] / 60.0 for one in rows]
    return f"{min(found):.0f} to {max(found):.0f}"


def drawn_rows(of: Answers, first: Answers) -> list[tuple[str, Row, Row]]:
    """What a row of the figure is of, the fraction at rest and the time to rest, on soil."""
    rows = [
        ("first edition, stones of 0.2 m", first["ends"]["at_rest"], first["at_rest"]["time_s"]),
        ("unknown ground", of["ends"]["at_rest"], of["at_rest"]["time_s"]),
    ]  # fmt: skip
    for key, said in GROUPS.items():
        known = {one["name"]: one for one in of[key]}
        rows += [(words, known[group]["at_rest"], known[group]["time_s"]) for group, words in said.items()]
    return rows


def draw_groups(landers: Answers, first: Answers, path: Path) -> None:
    """Fraction at rest and median time to rest with their intervals: both editions, kinds of ground, laws."""
    with figure(path, 1, 2, (9.6, 3.9), sharey=True) as (drawn, axes):
        for name, shift, colour in zip(landers, (-0.14, 0.14), (SOIL, TRAINING), strict=True):
            rows = drawn_rows(landers[name]["soil"], first[name]["soil"])
            for place, (_, rest, time) in enumerate(rows):
                shares = [100.0 * rest[key] for key in ("share", "lower", "upper")]
                minutes = [time[key] / 60.0 for key in ("q50", "median_lower", "median_upper")]
                for ax, (middle, *ends) in zip(axes, (shares, minutes), strict=True):
                    ax.plot(ends, [place + shift] * 2, color=colour, lw=2.2)
                    ax.plot(middle, place + shift, "o", color=colour, ms=5)
            axes[0].plot([], [], "o-", color=colour, label=name.capitalize())
        axes[0].set_yticks(range(len(rows)), [row[0] for row in rows])
        axes[0].set_ylim(len(rows) - 0.5, -0.5)
        for ax in axes:
            for line in (1.5, 4.5):
                ax.axhline(line, color=RULE, lw=0.8)
        axes[0].set(xlim=(40, 100), xlabel="at rest on Dimorphos [%]")
        axes[1].set_xlabel("median time from the first contact to rest [min]")
        axes[1].set_xlim(left=0.0)
        drawn.legend(loc="outside lower center", ncols=2)


def down_words(of: Row, lander: str) -> str:
    return f"{of['at_rest']} of {of['landers']} of {lander.capitalize()}"


def effect_parts(effects: Answers) -> dict[str, object]:
    """What the page says of booms, wings and shape."""
    of = {one["effect"]: one for one in reversed(effects["effects"])}
    booms, wings, shape = (of[name]["change"] for name in (BOOMS, WINGS, SHAPE))
    return {
        "effects": effects_table(effects["effects"]), "finest": effects["finest_m"],
        "pair_landers": of[BOOMS]["after"]["landers"], "pair_beds": of[BOOMS]["beds"],
        "boom_cost": f"{cost_ratio(effects['cpu_s'], 'juventas', BOOMS):.0f}",
        "wing_cost": f"{cost_ratio(effects['cpu_s'], 'milani', WINGS):.0f}",
        "boom_rest": difference(booms["at_rest"], 100.0), "boom_time": difference(booms["time_s"], 1.0 / 60.0),
        "wing_rest": difference(wings["at_rest"], 100.0), "wing_time": difference(wings["time_s"], 1.0 / 60.0),
        "wing_side": difference(wings["broad_side"], 100.0), "shape_rest": difference(shape["at_rest"], 100.0),
        "shape_time": difference(shape["time_s"], 1.0 / 60.0), "facets": effects["facets"],
        "shape_sha": effects["shape_sha256"],
    }  # fmt: skip


def wings_words() -> str:
    """What the first page says of wings, which the landers of the forecast do not have."""
    (one,) = (one for one in read_document(HERE / EFFECTS)["effects"] if one["effect"] == WINGS)
    before, after = one["before"], one["after"]
    return (
        f"Landers are boxes without wings and booms. With wings of an assumed size and spring {after['at_rest']} of "
        f"{after['landers']} landers of Milani come to rest, {before['at_rest']} without "
        f"([the pairs]({PAGE}.md#booms-wings-and-the-shape-before-dart))."
    )


def left_out_parts(landers: Answers) -> dict[str, object]:
    """Sizes of what is left out."""
    tide, gravity = eccentricity_words()
    parts: dict[str, object] = {
        "eccentricity": ECCENTRICITY, "tide": tide, "gravity": gravity, "stone_cohesion": stone_cohesion(),
    }  # fmt: skip
    for name in LANDERS:
        parts[f"finest_{name}"], parts[f"finer_{name}"] = finer_words(name)
        parts[f"rest_{name}"] = spread(landers, "by_ground", name, "at_rest")
        parts[f"time_{name}"] = spread(landers, "by_ground", name, "time_s")
    return parts


def write(edition: Path, docs: Path) -> None:
    """Write page and figure of an edition on unknown ground."""
    document, runs, effects = (
        read_document(path) for path in (edition / FORECAST, edition / RUNS, HERE / EFFECTS)
    )  # fmt: skip
    landers, first = document["landers"], read_document(FIRST_EDITION / FORECAST)["landers"]
    draw_groups(landers, first, docs / f"{PAGE}.png")
    write_page(
        PAGE, docs, date=edition.name, preset=kinds_words(),
        kinds=group_table(landers, "by_ground", "ground"), laws=group_table(landers, "by_law", "restitution"),
        strengths=" to ".join(f"{one / 1e3:.0f}" for one in STRENGTHS),
        speeds=" to ".join(f"{one:g}" for one in SPEEDS), soft=SOFT / 1e6,
        counts=" and ".join(f"{landers[name]['soil']['landers']} of {name.capitalize()}" for name in landers),
        down=" and ".join(down_words(landers[name]["soil"]["touched_down"], name) for name in landers),
        beds=sum(one["beds"] for one in landers[LANDERS[0]]["soil"]["by_ground"]),
        cost=f"{runs['cpu_s'] / 60.0:.0f}", code=document["sha256"]["code"], results=document["sha256"]["results"],
        **effect_parts(effects), **left_out_parts(landers),
    )  # fmt: skip


def cost_ratio(costs: dict[str, float], lander: str, effect: str) -> float:
    """CPU time of a study with an effect over that of the box."""
    return costs[f"{lander}: {effect}"] / costs[f"{lander}: box"]


def main() -> None:
    command_line(__doc__).parse_args()
    from edition import assumed_landers

    write(assumed_landers(), DOCS)


if __name__ == "__main__":
    main()
