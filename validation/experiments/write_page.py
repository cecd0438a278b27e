"""Write docs/validation/experiments.md and its figures from the tables of the experiments.

python validation/experiments/write_page.py
"""

import sys
import textwrap

import verdicts
from beads_part import beads_part
from fits import Line, Lines
from grains_part import grains_part, settling_part
from low_gravity_parts import balls_part, packing_part, plate_part
from page import table, write_page
from quantities import EXPERIMENT, FLIGHT, Quantity, counts, keep_quantities
from rebounds_part import rebounds_part
from result_rows import HERE
from stopping_part import stopping_part

# Behind this folder, which has files of the same names.
sys.path.append(str(HERE.parent / "mascot"))
from answers import MEASURED, answer, column, rows_of, said
from harness import read_document

QUANTITIES = {
    "contacts": "contacts from the first to rest",
    "time_s": "time from the first contact to rest [s]",
    "path_m": "distance along the ground [m]",
}
HEADS = ("quantity", "measured", "here", "simulations", "here / measured", "agrees", "cause shown by")
SUMMARY = ("experiment", "quantities", "agree", "disagree, cause shown", "disagree, cause not shown")
# Measured numbers that the page reads in two ways count once in the table of all cases, by the worse reading.
BETTER_READINGS = {
    "exponent of density, depth below the first touch",
    "exponent of the total drop distance, depth below the first touch",
    "exponent of diameter, depth below the first touch",
    "prefactor, depth below the mean surface",
    "rebound speed / impact speed, mean of the grains that leave the bed",
    "speed 6 s after contact, packing fraction 0.58, no cohesion [m/s]",
    "below 1e-4 g, 1-10 cm/s, 4 mm grains as cohesive as lunar soil",
}
# Sections by their keys in the text: name in the summary, and the table of simulations behind them.
SECTIONS = {
    "beads": ("ball dropped into beads", "ball_into_beads"),
    "stopping": ("force that stops a ball in beads", "stopping_force"),
    "gravity": ("sphere settling under other gravities", "settling_in_other_gravities"),
    "grains": ("grain impact on a bed of its own kind", "grain_on_its_own_kind"),
    "plate": ("spacecraft plate on loose grains", "plate_into_loose_grains"),
    "packing": ("packing under low gravity", "packing_and_cohesion"),
    "balls": ("ball on beads under several gravities", "ball_under_gravities"),
    "rebounds": ("rebound or embedding of a ball", "who_rebounds"),
    "mascot": ("MASCOT on Ryugu", "../mascot/mascot"),
}


def wrapped(text: str) -> str:
    parts = text.split("\n\n")
    return "\n\n".join(part if part.startswith("|") else "\n".join(textwrap.wrap(part, 98)) for part in parts)


def came_from(name: str) -> str:
    kept = read_document(HERE / f"{name}.json")
    cost = f", {kept['cpu_s_of_rows']:.0f} s of CPU time" if "cpu_s_of_rows" in kept else ""
    return f"Simulations: `{kept['command']}`, {kept['date']}, {kept['machine']}{cost}."


def summary(lines: dict[str, Lines]) -> str:
    rows = [(SECTIONS[key][0], own) for key, own in lines.items()]
    rows.append(("**all**", [one for own in lines.values() for one in own]))
    return table(SUMMARY, ((name, *map(str, counts(own))) for name, own in rows))


def quantities(key: str, lines: Lines) -> list[Quantity]:
    """What the lines of a section add to the table of all cases."""
    made_by = SECTIONS[key][1]
    kind = FLIGHT if key in ("plate", "mascot") else EXPERIMENT
    kept = [one for one in lines if one.quantity not in BETTER_READINGS]
    return [
        Quantity(kind, one.quantity, one.measured, one.ours, one.ratio, one.tolerance, one.agrees,
                 made_by.rpartition("/")[2], one.cause) for one in kept
    ]  # fmt: skip


def mascot_part() -> Lines:
    """Return a row for each quantity: it agrees where it lies in the central 80 % of the landers."""
    rows = rows_of("at the surface")
    lines = []
    for name, words in QUANTITIES.items():
        one, measured = answer(column(rows, name), MEASURED[name]), MEASURED[name]
        told = f"{said(one.middle)} (80 % of landers: {said(one.low)} to {said(one.high)})"
        lines.append(Line(words, f"{measured:g}, once", told, len(rows), f"{one.middle / measured:.2f}", one.agrees,
                          tolerance="in the central 80 %"))  # fmt: skip
    return lines


def main() -> None:
    lines: dict[str, Lines] = {}
    lines["beads"], drops = beads_part()
    lines["stopping"], stopping = stopping_part()
    lines["gravity"], settled = settling_part()
    lines["grains"], impacts = grains_part()
    lines["plate"], plate = plate_part()
    lines["packing"], packing = packing_part()
    lines["balls"], ball = balls_part()
    lines["rebounds"], rebound = rebounds_part()
    lines["mascot"] = mascot_part()
    every, agree, *_ = counts([one for own in lines.values() for one in own])
    write_page(
        "experiments", filled=False, first=f"{agree} of {every} quantities agree.", summary=summary(lines),
        **{f"lines_{key}": table(HEADS, (one.cells() for one in own)) for key, own in lines.items()},
        **{f"verdict_{key}": wrapped(text) for key, text in verdicts.every().items()},
        drops=drops, stopping=stopping, settled=settled, impacts=impacts, plate=plate, packing=packing, ball=ball,
        rebound=rebound,
        **{f"from_{key}": wrapped(came_from(name)) for key, (_, name) in SECTIONS.items()},
    )  # fmt: skip
    keep_quantities("experiments", {SECTIONS[key][0]: quantities(key, own) for key, own in lines.items()})
    print(summary(lines))


if __name__ == "__main__":
    main()
