"""Write docs/validation/experiments.md and its figures from the tables of the experiments.

python validation/experiments/write_page.py --work FOLDER
"""

import argparse
import json
import math
import textwrap
from pathlib import Path

import numpy as np
from beads_part import beads_part
from draw import of_grains, of_gravities
from fits import Estimate, column, gravity_exponents, leaving, mean_of, speeds
from low_gravity_parts import balls_part, packing_part, plate_part
from mascot_part import mascot_part
from page_text import TEXT, WHY
from rebounds_part import rebounds_part
from settling_in_other_gravities import DIAMETER
from sphere_bed import read_rows
from table_lines import FIGURES, HERE, PAGES, Lines, line, said

PAGE = PAGES / "experiments.md"
NOT_YET = "Too few rows yet: run the script."
HEAD = "| quantity | measured | ours, 95 % | rows | ours over measured | agrees |\n|---|---|---|---|---|---|\n"


# Keys of the page's text, and the tables that its sections stand on.
TABLES = {
    "beads": "ball_into_beads", "gravity": "settling_in_other_gravities", "grains": "grain_on_its_own_kind",
    "plate": "plate_into_loose_grains", "packing": "packing_and_cohesion", "balls": "ball_under_gravities",
    "rebounds": "who_rebounds", "mascot": "../mascot/mascot",
}  # fmt: skip


def wrapped(text: str) -> str:
    """Return a paragraph in lines."""
    return "\n".join(textwrap.wrap(text, 98))


def came_from(name: str) -> str:
    """Return command, date, machine and cost of a table."""
    path = HERE / f"{name}.json"
    if not path.exists():
        return ""
    told = json.loads(path.read_text())
    cost = f", {told['cpu_s_of_rows']:g} s of CPU time in its rows" if "cpu_s_of_rows" in told else ""
    return f"`{told['command']}`, {told['date']}, {told['machine']}{cost}."


def gravity_part() -> tuple[Lines, str]:
    """Return rows and a table of the sphere that settles under other gravities."""
    rows = read_rows(HERE / "settling_in_other_gravities.csv")
    if len({row["share"] for row in rows}) < 3:
        return [], NOT_YET
    found = gravity_exponents(rows)
    lines = [
        line("settling: exponent of depth over gravity", 0.0, found["depth"], 0.03, "0"),
        line("settling: exponent of the time until it stops", -0.5, found["stopping_time"], 0.03, "-1/2"),
        line("settling: exponent of the time to .9 of the depth", -0.5, found["time_to_90"], 0.03, "-1/2"),
    ]
    of_gravities(rows, DIAMETER, FIGURES / "settling_in_other_gravities.png")
    table = (
        "![settling](experiments/settling_in_other_gravities.png)\n\n"
        "| gravity over Earth's | rows | depth [mm] | time until it stops, sqrt(D/g) | solid fraction |\n"
        "|---|---|---|---|---|"
    )
    for share in sorted({row["share"] for row in rows}, reverse=True):
        own = [row for row in rows if row["share"] == share]
        times = column(own, "stopping_time") / math.sqrt(DIAMETER / (9.81 * share))
        table += (
            f"\n| {share:g} | {len(own)} | {column(own, 'depth').mean() * 1e3:.2f} +- "
            f"{column(own, 'depth').std() * 1e3:.2f} | {times.mean():.2f} | "
            f"{column(own, 'bulk_density').mean() / 1000.0:.3f} |"
        )
    return lines, table


def grains_part() -> tuple[Lines, str]:
    """Return rows and a table of the grain shot at its own kind."""
    every = read_rows(HERE / "grain_on_its_own_kind.csv")
    if not every:
        return [], NOT_YET
    kinds = {name: [row for row in every if row["kind"] == name] for name in dict.fromkeys(r["kind"] for r in every)}
    base = kinds["basalt"]
    speed = mean_of(speeds(base))
    few = Estimate(float(np.mean(column(base, "risen_0.1") < 10)), math.nan, len(base))
    low = Estimate(float(np.mean(column(base, "median_rise") < 1.0)), math.nan, len(base))
    lines = [
        line("own kind: mean speed out over speed in, 0 where the grain stays", 0.2, speed, 0.05, "about .20"),
        line("own kind: the same of those that leave upwards", 0.2, mean_of(leaving(base)), 0.05, "about .20"),
        line("own kind: share of impacts with fewer than 10 grains ejected", 1.0, few, 0.5, "typical"),
        line("own kind: share of impacts whose median grain rises less than its diameter", 1.0, low, 0.5, "typical"),
    ]
    of_grains(kinds, FIGURES / "grain_on_its_own_kind.png")
    table = (
        "![grains](experiments/grain_on_its_own_kind.png)\n\n"
        "| bed | impacts | mean speed ratio | of those that leave | share that stays "
        "| rise > .1 | > .5 | > 1 grain | median rise [grains] |\n"
        "|---|---|---|---|---|---|---|---|---|"
    )
    for name, rows in kinds.items():
        stayed = 1.0 - len(leaving(rows)) / len(rows)
        table += (
            f"\n| {name} | {len(rows)} | {said(mean_of(speeds(rows)))} | {said(mean_of(leaving(rows)))} "
            f"| {stayed:.2f} | "
            + " | ".join(f"{column(rows, f'risen_{rise}').mean():.2f}" for rise in ("0.1", "0.5", "1"))
            + f" | {np.median(column(rows, 'median_rise')):.2f} |"
        )
    return lines, table


def similar() -> str:
    """Return the sentence on the drop at another gravity."""
    rows = read_rows(HERE / "similarity.csv")
    same = all(row["same_bits"] == "True" for row in rows)
    last = rows[-1]
    return (
        f"A drop under {last['gravity']:.2g} m/s2, with the modulus times L^2 and the speed times L = 1/128, ends "
        f"{'bit for bit' if same else 'within rounding'} where the same drop ends on Earth ({int(last['beads'])} "
        f"beads, {int(last['steps'])} steps; largest difference {last['largest_difference']:g} ball diameters)."
    )


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=Path, required=True, help="folder with the paths of the drops")
    beads, drops, found = beads_part(parser.parse_args().work)
    gravities, settled = gravity_part()
    grains, impacts = grains_part()
    plates, plate = plate_part()
    packings, packing = packing_part()
    balls, ball = balls_part()
    rebounds, rebound = rebounds_part()
    lines = beads + gravities + grains + plates + packings + balls + rebounds + mascot_part()
    yes = sum(agrees for _, agrees in lines)
    first = (
        f"{yes} of {len(lines)} quantities agree. Exponents of depth: {said(found['density'])} of the density (1/2), "
        f"{said(found['total'])} of the drop distance (1/3)."
    )
    page = TEXT.format(
        **{f"why_{key}": text for key, text in WHY.items()},
        first=wrapped(first), table=HEAD + "\n".join(text for text, _ in lines),
        drops=drops, settled=settled, impacts=impacts, similar=wrapped(similar()), plate=plate, packing=packing,
        ball=ball, rebound=rebound,
        **{f"from_{key}": wrapped(came_from(name)) for key, name in TABLES.items()},
    )  # fmt: skip
    PAGE.write_text(page)
    print("\n".join(text for text, _ in lines))


if __name__ == "__main__":
    main()
