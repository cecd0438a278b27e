"""Write docs/validation/experiments.md and its figures from the tables of the experiments.

python validation/experiments/write_page.py
"""

import json
import textwrap

import verdicts
from beads_part import beads_part
from grains_part import grains_part
from low_gravity_parts import balls_part, packing_part
from mascot_part import mascot_part
from page_text import TEXT, WHY
from plate_part import plate_part
from rebounds_part import rebounds_part
from settling_part import settling_part
from table_lines import HERE, PAGES, table

PAGE = PAGES / "experiments.md"
HEADS = ("quantity", "measured", "ours, 95 %", "rows", "ours over measured", "agrees", "cause shown by")
# Keys of the page's text, and the tables that its sections stand on.
TABLES = {
    "beads": "ball_into_beads", "gravity": "settling_in_other_gravities", "grains": "grain_on_its_own_kind",
    "plate": "plate_into_loose_grains", "packing": "packing_and_cohesion", "balls": "ball_under_gravities",
    "rebounds": "who_rebounds", "mascot": "../mascot/mascot",
}  # fmt: skip


def wrapped(text: str) -> str:
    """Return paragraphs in lines."""
    return "\n\n".join("\n".join(textwrap.wrap(part, 98)) for part in text.split("\n\n"))


def came_from(name: str) -> str:
    """Return command, date, machine and cost of a table."""
    told = json.loads((HERE / f"{name}.json").read_text())
    cost = f", {told['cpu_s_of_rows']:g} s of CPU time in its rows" if "cpu_s_of_rows" in told else ""
    return f"`{told['command']}`, {told['date']}, {told['machine']}{cost}."


def main() -> None:
    """Write the page."""
    beads, drops = beads_part()
    gravities, settled = settling_part()
    grains, impacts = grains_part()
    plates, plate = plate_part()
    packings, packing = packing_part()
    balls, ball = balls_part()
    rebounds, rebound = rebounds_part()
    lines = [*beads, *gravities, *grains, *plates, *packings, *balls, *rebounds, *mascot_part()]
    page = TEXT.format(
        **{f"why_{key}": text for key, text in WHY.items()},
        **{f"verdict_{key}": wrapped(text) for key, text in verdicts.every().items()},
        first=f"{sum(one.agrees for one in lines)} of {len(lines)} quantities agree.",
        table=table(HEADS, (one.cells() for one in lines)), drops=drops, settled=settled, impacts=impacts,
        plate=plate, packing=packing, ball=ball, rebound=rebound,
        **{f"from_{key}": wrapped(came_from(name)) for key, name in TABLES.items()},
    )  # fmt: skip
    PAGE.write_text(page)
    print("\n".join(" | ".join(one.cells()) for one in lines))


if __name__ == "__main__":
    main()
