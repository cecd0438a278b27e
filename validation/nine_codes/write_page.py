"""Draw the impact of [Dosta-2024] in the codes that were run here, and write docs/validation/nine_codes.md.

    python validation/nine_codes/write_page.py

Reads the tables beside it, those of runs that were stopped as well; writes nine_codes.png and nine_codes.md to
docs/validation.
"""

import itertools
import math
import statistics
import sys
from pathlib import Path

import numpy as np
from heights import (
    ADDED,
    ASKED,
    BOTTOM,
    CRITERION,
    HERE,
    IMPACTS,
    OURS,
    Curve,
    after_the_turn,
    answer,
    between_codes,
    curves,
    height,
    largest_gap,
    mm,
    moved,
    named,
    paragraph,
    within_impacts,
)
from impact import LATER, MEETS, RUNS
from impact_bed import BALL_RADIUS, FLOOR
from lammps_impact import TIMED_AT
from turn_tests import DEEP, SPEED

from lithobrake.report.figures.style import INPUT_COLOURS, QUIET, SITE, TRAINING

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document, read_rows
from page import table, write_page
from quantities import CODE, NOT_SHOWN, Quantity, keep_quantities

PAIR_BAR = 1e-3  # relative, set before the runs
TURNED = 0.03  # s
# Spheres and steps: 5 s at the step of the drum.
DRUM, SILO = (38_000, 6.25e6), (100_000, 6.25e6)
WORDS = {"restitution": "restitution", "v_x": "speed [m/s]", "omega_y": "spin [rad/s]", "x": "path [m]"}


def cell(curve: Curve, time: float) -> str:
    """Return the height at a time, marked where it is carried on in free flight."""
    mark = "*" if time > curve[0][-1] + 1e-5 and height(curve, time) is not None else ""
    return mm(height(curve, time)) + mark


def at_a_time(found: dict[str, Curve], time: float) -> list[str]:
    """Return the line of a time [s]: both codes, their difference, the range of impacts, and whether they agree."""
    ours, theirs = (height(found[name], time) for name in (OURS, "mercury"))
    verdict, difference = "not run", None if ours is None or theirs is None else ours - theirs
    if difference is not None:
        verdict = "yes" if abs(difference) <= CRITERION else "**no**"
    places = [z for name in IMPACTS if name in found and (z := height(found[name], time)) is not None]
    spread = inside = "not run"
    if len(places) > 1:
        spread = f"{mm(min(places))} to {mm(max(places))} ({len(places)})"
        if theirs is not None:
            inside = "yes" if within_impacts(found, time) else "**no**"
    cells = (*(cell(found[name], time) for name in (OURS, "mercury")), mm(difference), verdict,
             *(cell(found[name], time) for name in (LATER, "published")), spread, inside)  # fmt: skip
    return [f"{1000.0 * time:g}", *cells]


def comparison(found: dict[str, Curve]) -> str:
    heads = ("time [ms]", "z here [mm]", "z MercuryDPM [mm]", "difference [mm]", "within 1 mm",
             "z here, dashpot until 20.5 ms [mm]", "z here, with dashpot [mm]",
             "range of impacts here with it [mm] (number)", "MercuryDPM in this range")  # fmt: skip
    return table(heads, (at_a_time(found, time) for time in sorted(ASKED + ADDED)))


def draw(found: dict[str, Curve]) -> None:
    """Height of the ball against time, and what the other runs differ from the compared one."""
    with figure(PAGES / "nine_codes.png", 1, 2, (9.2, 3.9), dpi=150) as (drawn, (left, right)):
        drawn = {OURS: ("here", TRAINING, "-"), "mercury": ("MercuryDPM", SITE, "--")}
        for name, (label, colour, line) in drawn.items():
            time, z, _ = found[name]
            left.plot(1000.0 * time, 1000.0 * z, line, color=colour, lw=1.8, label=label)
        left.axhline(1000.0 * (FLOOR + BALL_RADIUS), color=QUIET, lw=1.0, ls=":", label="ball on the floor")
        left.set(xlabel="time [ms]", ylabel="height of the ball's centre [mm]", xlim=(15.0, None), ylim=(-82.0, -10.0))
        left.set_title("Height")
        left.legend(fontsize=8)
        reference = found[OURS]
        others = [name for name in found if name not in (OURS, "mercury")]
        inks = itertools.cycle((*INPUT_COLOURS[1:3], *INPUT_COLOURS[4:]))
        colours = {name: next(inks) for name in others} | {"mercury": SITE}
        for name in ("mercury", *others):
            time = reference[0][reference[0] <= found[name][0][-1] + 1e-6]
            gap = np.interp(time, *found[name][:2]) - np.interp(time, *reference[:2])
            style = "--" if name == "mercury" else ":" if "lammps" in name else "-"
            right.plot(1000.0 * time, 1000.0 * gap, style, color=colours[name], lw=1.6,
                       label="MercuryDPM" if name == "mercury" else named(name))  # fmt: skip
        right.axhspan(-1.0, 1.0, color=QUIET, alpha=0.15, lw=0, label="criterion")
        right.set(xlabel="time [ms]", ylabel="height minus that of the compared run [mm]")
        right.set_title("Differences of height")
        right.legend(fontsize=8)


def pair_table() -> str:
    lines = []
    for row in read_rows(HERE / "pair_tests.csv", {"quantity": str, "mercury": str}):
        off = row["lithobrake"] / row["closed_form"] - 1.0
        theirs = f"{float(row['mercury']):.7g}" if row["mercury"] else ""
        cells = (f"{row['closed_form']:.7g}", theirs, f"{row['lithobrake']:.7g}", f"{off:.1e}" if off else "0")
        lines.append((WORDS[row["quantity"]], f"{row['step_s']:g}", *cells))
    return table(("quantity", "step [s]", "closed form", "MercuryDPM", "here", "relative error here"), lines)


def impact_quantities(found: dict[str, Curve]) -> list[Quantity]:
    """Heights in the bed, and at the times set before the runs at which the ball does not fall freely.

    Where they differ, the cause is shown if a shift of the impact point by a billionth of a metre moves the ball by
    more than the criterion.
    """
    gaps: list[tuple[str, float, str]] = [
        (f"in the bed, {1000.0 * MEETS:g} to {1000.0 * BOTTOM:g} ms, largest", largest_gap(found), NOT_SHOWN),
    ]
    for time in (time for time in ASKED if time > MEETS):
        shift, ours, theirs = moved(found, "nudged", time), *(height(found[name], time) for name in (OURS, "mercury"))
        gap = math.inf if ours is None or theirs is None else abs(ours - theirs)
        cause = f"an impact point moved by 1e-9 m changes it by {mm(shift)} mm" if shift else NOT_SHOWN
        words = f"at {1000.0 * time:g} ms, after the turn"
        gaps.append((words, gap, cause if shift and shift > CRITERION else NOT_SHOWN))
    return [
        Quantity(CODE, f"height of the ball, difference from MercuryDPM {words} [mm]", "0", mm(gap), "",
                 mm(CRITERION, 0), gap <= CRITERION, "impact", cause) for words, gap, cause in gaps
    ]  # fmt: skip


def pair_quantities() -> list[Quantity]:
    """The pair tests at the published step beside MercuryDPM, and whether smaller steps show why one disagrees."""
    rows, found = read_rows(HERE / "pair_tests.csv", {"quantity": str, "mercury": str}), []
    for row in (row for row in rows if row["mercury"] and row["step_s"] == rows[0]["step_s"]):
        theirs, finest = float(row["mercury"]), min(one["step_s"] for one in rows if one["quantity"] == row["quantity"])
        fine = next(one for one in rows if (one["quantity"], one["step_s"]) == (row["quantity"], finest))
        off, left = row["lithobrake"] / theirs - 1.0, abs(fine["lithobrake"] / fine["closed_form"] - 1.0)
        cause = f"steps of {finest:g} s: {left:.0e} from the closed form" if left <= PAIR_BAR else NOT_SHOWN
        found.append(Quantity(
            CODE, f"pair test: {WORDS[row['quantity']]}", f"{theirs:.7g}", f"{row['lithobrake']:.7g}", f"{off:+.1e}",
            f"{PAIR_BAR:g}", abs(off) <= PAIR_BAR, "pair_tests", cause,
        ))  # fmt: skip
    return found


def time_words() -> str:
    """Return the sentence of CPU times beside LAMMPS."""
    rows = read_rows(HERE / "lammps_times.csv", {})
    if not rows:
        return "Not measured against LAMMPS."
    theirs, ours = (statistics.median(row[name] for row in rows) for name in ("lammps", "lithobrake"))
    ratios = sorted(row["lithobrake"] / row["lammps"] for row in rows)
    count, load = int(rows[0]["spheres"]), read_document(HERE / "lammps.json")["load"]
    return paragraph(
        f"A step takes {statistics.median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f}) times the CPU time of "
        f"LAMMPS: in the median {1000.0 * ours:.1f} ms here and {1000.0 * theirs:.1f} ms in LAMMPS, or "
        f"{count / ours / 1e6:.1f} and {count / theirs / 1e6:.1f} million sphere-steps per CPU second. Both codes "
        f"started from the state at {1000.0 * TIMED_AT:g} ms, with the ball in the bed, and took "
        f"{rows[0]['steps']:.0f} steps of 5e-7 s in turn, {len(rows)} times, with one thread each (LAMMPS: pair style "
        f"granular, hertz/material, mindlin, coeff_restitution). The load was {load:.0f} on two cores, so both are "
        "slower than alone."
    )


def runs_table(found: dict[str, Curve]) -> str:
    """Return what was run, how far, and at what cost."""
    lines, done = [], {row["run"]: row for row in read_rows(HERE / "impact.csv", {"run": str})}
    for one in RUNS:
        ends = f"{1000.0 * found[one.run][0][-1]:.2f}" if one.run in found else "not run"
        cost = f"{done[one.run]['cpu_s']:.0f}" if one.run in done else ""
        place = f"{1000.0 * one.x:g}, {1000.0 * one.y:g}"
        lines.append((one.run.replace("_", " "), place, f"{one.step:g}", ends, cost))
    others = [(f"LAMMPS {row['run'].replace('_', ' ')}", row) for row in read_rows(HERE / "lammps.csv", {"run": str})]
    others += [("MercuryDPM", row | {"step": 1e-6}) for row in read_rows(HERE / "mercury.csv", {"run": str})[:1]]
    for name, row in others:
        lines.append((name, "0, 0", f"{row['step']:g}", f"{1000.0 * row['until']:.2f}", f"{row['cpu_s']:.0f}"))
    heads = ("run", "ball at x, y [mm]", "longest step until 32 ms [s]", "followed to [ms]", "CPU time [s]")
    return table(heads, lines)


def stand_in() -> str:
    """Return how fast the ball leaves a shallow layer, by what is changed."""
    rows, lines = read_rows(HERE / "turn_tests.csv", {"setting": str}), []
    for name in dict.fromkeys(row["setting"] for row in rows):
        speeds = [row["rebound_speed"] for row in rows if row["setting"] == name]
        lows = [row["lowest"] for row in rows if row["setting"] == name]
        ends = f"{min(speeds):.3f} to {max(speeds):.3f}"
        lines.append((name, str(len(speeds)), f"{statistics.mean(speeds):.3f}", ends, mm(statistics.mean(lows))))
    heads = ("changed", "runs", "rebound speed, mean [m/s]", "range [m/s]", "lowest point above the floor [mm]")
    return table(heads, lines)


def stand_in_words() -> str:
    """Return how far each change moves the rebound, beside what a billionth of a metre does."""
    rows = read_rows(HERE / "turn_tests.csv", {"setting": str})
    speeds = {name: [row["rebound_speed"] for row in rows if row["setting"] == name]
              for name in dict.fromkeys(row["setting"] for row in rows)}  # fmt: skip
    first, *others = speeds
    apart = max(max(own) - min(own) for own in speeds.values())
    moves = ", ".join(
        f"{name} {statistics.mean(speeds[name]) - statistics.mean(speeds[first]):+.3f}" for name in others
    )
    steps = [abs(statistics.mean(speeds[name]) - statistics.mean(speeds[first])) for name in others if "step" in name]
    moved_by = max(steps) * (ASKED[2] - TURNED)
    return paragraph(
        f"Beside the first row the mean rebound speed moves by (m/s): {moves}. Runs of one "
        f"setting, a billionth of a metre apart, differ by up to {apart:.3f} m/s. The tangential dashpot moves the "
        "rebound most and the step next; the order of pairs, the walls' friction and the damping ratio do not move it "
        f"by more than rounding does. The step alone moves the ball by {mm(moved_by)} mm from its turn to "
        f"{1000.0 * ASKED[2]:g} ms, about the criterion: at the published step the turn has not converged, and "
        "MercuryDPM took steps twice as long. Of its run heights alone were kept, and no output of its contacts is "
        "public: they were not compared one by one, and which of them makes its ball turn otherwise is unknown."
    )


def days(spheres: float, steps: float) -> str:
    """Return the CPU time of so many steps at the cost of a sphere's step that was measured beside LAMMPS."""
    rows = read_rows(HERE / "lammps_times.csv", {})
    each = statistics.median(row["lithobrake"] for row in rows) / rows[0]["spheres"]
    return f"{spheres * steps * each / 86400.0:.1f} days"


def main() -> None:
    found = curves()
    draw(found)
    write_page(
        "nine_codes", filled=False, answer=answer(found), heights=comparison(found), between=between_codes(found),
        turn=after_the_turn(found), runs=runs_table(found), pairs=pair_table(), times=time_words(),
        stand_in=stand_in(), stand_in_words=stand_in_words(), stand_in_speed=f"{SPEED:g}",
        stand_in_depth=f"{1000.0 * DEEP:g}", drum_days=days(*DRUM), silo_days=days(*SILO),
    )  # fmt: skip
    keep_quantities("nine_codes", {
        "impact of a ball on 25 000 spheres": impact_quantities(found), "two pair tests": pair_quantities(),
    })  # fmt: skip


if __name__ == "__main__":
    main()
