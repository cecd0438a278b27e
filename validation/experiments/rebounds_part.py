"""What the table of the ball on coarse grains says: rows of the page's table, and a table of its own."""

import math
from pathlib import Path

import numpy as np
from draw import INK, MEASURED
from drawing import figure
from fits import Line, Lines, column, line, mean_of
from page import table, two_digits
from quantities import NOT_SHOWN
from result_rows import FIGURES, HERE, Row, read_rows

from lithobrake.analysis import wilson_interval

EARTH, DIAMETER = 9.81, 0.02  # m/s2, m
RISEN = 5e-4  # m above its deepest place, from which a ball counts as rebounding
LOWEST = "below 1e-4 g, lowest energies, here 1-10 cm/s (PRIME-3)"
# What the sources say: gravity over Earth's, speeds [m/s] from and to, and whether the ball rebounds. The lowest
# energies below 1e-4 of Earth's gravity have no number; up to 0.1 m/s is our reading, where ejecta begin.
SAID = {
    "1e-3 g, 1-20 cm/s (COLLIDE-2)": (1e-3, 0.01, 0.2, 0.0),
    "1e-3 g, 25-100 cm/s (COLLIDE-2)": (1e-3, 0.25, 1.0, 1.0),
    "1e-2 g, 4-230 cm/s (PRIME)": (1e-2, 0.04, 2.3, 0.0),
    LOWEST: (1e-4, 0.01, 0.1, 1.0),
}
FINEST = "4 mm"  # of the beds with all speeds
PULLING = "lunar, 4 mm, 1e-4 g"
JSC = "lunar, 1e-3 g, teflon"  # what COLLIDE-1 had
HARDER = "pebbles, restitution 0.83"
SHOWN = ("4 mm", "6 mm", "lunar, 1e-4 g", "lunar, 4 mm, 1e-4 g", "pebbles", "pebbles, restitution 0.83")


def froude(share: float, speed: float) -> float:
    """Return the Froude number of the ball at a speed [m/s] under a share of Earth's gravity."""
    return speed / math.sqrt(EARTH * share * DIAMETER)


def rebounds(rows: list[Row]) -> int:
    """Return how many balls rebound."""
    return int((column(rows, "rise") >= RISEN).sum())


def share_line(quantity: str, measured: str, expected: float, rows: list[Row], cause: str = NOT_SHOWN) -> Line:
    """Return a row of the table for a share: it agrees where most of ours do what was seen."""
    count, total = rebounds(rows), len(rows)
    low, high = wilson_interval(count, total)
    ours = f"{count / total:.2f} ({low:.2f} to {high:.2f})"
    return Line(quantity, measured, ours, total, "-", abs(count / total - expected) < 0.5, cause, "more than half")


def between(rows: list[Row], kind: str, share: float, slow: float, fast: float) -> list[Row]:
    """Return the drops on a kind of grains at Froude numbers of two speeds [m/s] under a share of Earth's gravity."""
    low, high = froude(share, slow), froude(share, fast)
    return [row for row in rows if row["kind"] == kind and low <= row["froude"] <= high]


def shown_by(expected: float, drops: dict[str, list[Row]]) -> str:
    """Return the kinds, with their drops, of which most do what was seen."""
    kinds = [kind for kind, rows in drops.items() if rows and abs(rebounds(rows) / len(rows) - expected) < 0.5]
    return "; ".join(kinds) or NOT_SHOWN


def rebounds_part() -> tuple[Lines, str]:
    every = read_rows(HERE / "who_rebounds.csv")
    tried = {
        "1e-3 g, 25-100 cm/s (COLLIDE-2)": ("6 mm", "lunar, 4 mm, 1e-3 g"), LOWEST: (PULLING,),
        "1e-2 g, 4-230 cm/s (PRIME)": ("6 mm",),
    }  # fmt: skip
    lines = [
        share_line(text, "rebounds" if expected else "stays", expected, between(every, FINEST, share, slow, fast),
                   shown_by(expected, {one: between(every, one, share, slow, fast) for one in tried.get(text, ())}))
        for text, (share, slow, fast, expected) in SAID.items()
    ]  # fmt: skip
    share, slow, fast, expected = SAID[LOWEST]
    pulling = between(every, PULLING, share, slow, fast)
    lines.append(
        share_line("below 1e-4 g, 1-10 cm/s, 4 mm grains as cohesive as lunar soil", "rebounds", expected, pulling)
    )
    out = between(every, JSC, 1e-3, 0.01, 0.2)
    lines.append(line("rebound speed / impact speed, Teflon on lunar grains, 1e-3 g, 1-20 cm/s (COLLIDE-1)", 0.05,
                      mean_of(list(column(out, "upward_out"))), 0.025, "order of 0.05",
                      "4 mm; 6 mm"))  # fmt: skip
    thrown = [row for row in every if row["kind"] == FINEST and row["froude"] == 30.0 and row["ejecta"] > 0]
    lines.append(line("mean ejecta speed / impact speed, Froude number 30 (COLLIDE-2)", 0.0,
                      mean_of(list(column(thrown, "ejecta_speed"))), 0.10, "below 0.10"))  # fmt: skip
    pebbles, other = ([row for row in every if row["kind"] == kind] for kind in ("pebbles", HARDER))
    lines.append(share_line("rebounds from irregular grains: pebbles", "often", 1.0, pebbles,
                            shown_by(1.0, {HARDER: other})))  # fmt: skip
    of_rebounds(every, FIGURES / "who_rebounds.png")
    return lines, cells(every)


def cells(rows: list[Row]) -> str:
    heads = ("grains", "Froude number", "speed at 1e-4, 1e-3, 1e-2 g [cm/s]", "drops", "fraction that rebounds (95 %)",
             "speed ratio, mean +- standard deviation", "depth [mm]", "drops with ejecta",
             "ejecta speed / impact speed")  # fmt: skip
    found = []
    for kind in dict.fromkeys(row["kind"] for row in rows):
        for number in sorted({row["froude"] for row in rows if row["kind"] == kind}):
            own = [row for row in rows if row["kind"] == kind and row["froude"] == number]
            low, high = wilson_interval(rebounds(own), len(own))
            out, speeds = column(own, "upward_out"), [row["ejecta_speed"] for row in own if row["ejecta"] > 0]
            at = ", ".join(two_digits(100 * number * math.sqrt(EARTH * g * DIAMETER)) for g in (1e-4, 1e-3, 1e-2))
            found.append((
                str(kind), f"{number:g}", at, str(len(own)),
                f"{rebounds(own) / len(own):.2f} ({low:.2f} to {high:.2f})", f"{out.mean():.3f} +- {out.std():.3f}",
                f"{1e3 * column(own, 'depth').mean():.1f}", str(len(speeds)),
                f"{np.mean(speeds):.3f}" if speeds else "-",
            ))  # fmt: skip
    return table(heads, found)


def of_rebounds(rows: list[Row], to: Path) -> None:
    """Share that rebounds and speed out over in, over the Froude number."""
    with figure(to, 1, 2, (8.6, 4.8)) as (drawn, axes):
        beyond = {0.0: -0.07, 1.0: 1.07}
        for text, (share, slow, fast, expected) in SAID.items():
            level = beyond[expected]
            beyond[expected] += 0.1 * (1.0 if expected else -1.0)
            ends = [froude(share, slow), froude(share, fast)]
            axes[0].plot(ends, [level, level], "|-", color=MEASURED, lw=2)
            axes[0].text(
                ends[0], level + (0.025 if expected else -0.06), text.split(" (")[0], fontsize=7.5, color=MEASURED
            )
        marks = dict(zip(SHOWN, ("o", "s", "^", "D", "v", "P"), strict=True))
        for k, kind in enumerate(name for name in SHOWN if any(row["kind"] == name for row in rows)):
            numbers = sorted({row["froude"] for row in rows if row["kind"] == kind})
            parts = [[row for row in rows if row["kind"] == kind and row["froude"] == number] for number in numbers]
            share = np.array([rebounds(part) / len(part) for part in parts])
            ends = np.array([wilson_interval(rebounds(part), len(part)) for part in parts]).T
            at, ink = np.array(numbers) * 1.06 ** (k - 2), (*INK, "0.2", "#c98a1b")[k]
            axes[0].errorbar(at, share, np.abs(ends - share), fmt=marks[kind] + "-", color=ink, lw=1, capsize=2,
                             label=kind)  # fmt: skip
            out = [column(part, "upward_out") for part in parts]
            axes[1].errorbar(at, [o.mean() for o in out], [o.std() for o in out], fmt=marks[kind], color=ink, capsize=2)
        needed = np.geomspace(0.8, 400.0, 50)
        axes[1].plot(needed, math.sqrt(2.0 * RISEN / DIAMETER) / needed, ":", color=MEASURED)
        axes[1].text(12.0, 0.2, "above the dotted line\nit rises by 0.5 mm", fontsize=7.5, color=MEASURED)
        axes[1].axhline(0.05, color=MEASURED, lw=2)
        axes[1].text(480.0, 0.053, "COLLIDE-1", fontsize=7.5, color=MEASURED, ha="right")
        for axis in axes:
            axis.set(xscale="log", xlabel=r"Froude number $v / \sqrt{g D}$")
        axes[0].set(ylabel="fraction that rebounds", ylim=(-0.3, 1.3))
        axes[1].set(ylabel="rebound speed / impact speed", ylim=(-0.01, 0.4))
        drawn.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
