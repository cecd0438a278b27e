"""Draw the impact of [Dosta-2024] in the codes that were run here, and write docs/validation/nine_codes.md.

    python validation/nine_codes/write_page.py

Reads the tables beside it, those of runs that were stopped as well; writes nine_codes.png and nine_codes.md to
docs/validation.
"""

import json
import statistics
import sys
import textwrap
from pathlib import Path

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from impact import MEETS, RUNS
from impact_bed import BALL_RADIUS, FLOOR, GRAVITY, in_free_fall
from lammps_impact import TIMED_AT
from page_words import CONDITIONS, FREE_FALL, HEAD, MISSING

from lithobrake.report.figures.style import INPUT_COLOURS, QUIET, SITE, STYLE, TRAINING

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import read_rows

HERE = Path(__file__).parent
PAGES = HERE.parents[1] / "docs" / "validation"
CRITERION = 0.001  # m
ASKED, ADDED = (0.01, 0.02, 0.05, 0.1), (0.022, 0.025, 0.0275, 0.029, 0.03, 0.032)  # s
BOTTOM = 0.02925  # s: just before the ball meets the layer on the floor
# m/s2, by which an acceleration may differ from that of gravity in free flight; it is looked at over so many rows.
FREE, LAST = 0.1, 4
IMPACTS = ("published", "east", "north", "west", "south", "nudged")
WORDS = {"restitution": "restitution", "v_x": "speed [m/s]", "omega_y": "spin [rad/s]", "x": "path [m]"}
Curve = tuple[np.ndarray, np.ndarray, np.ndarray]


def curves() -> dict[str, Curve]:
    """Return times [s], heights [m] and velocities upwards [m/s] of each run that was begun."""
    found = {}
    for name in (*(one.run for one in RUNS), "mercury", "lammps_no_dashpot", "lammps_dashpot"):
        rows = read_rows(HERE / f"impact_{name}.csv", {})
        if rows:
            time, z, speed = (np.array([row[column] for row in rows]) for column in ("time", "z", "v_z"))
            found[name] = time, z, speed
    return found


def flies_at_its_end(curve: Curve) -> bool:
    """Return whether the ball moves under gravity alone in the last rows."""
    time, _, speed = curve
    acceleration = np.diff(speed[-LAST:]) / np.diff(time[-LAST:])
    return bool(np.abs(acceleration + GRAVITY).max() < FREE)


def height(curve: Curve, time: float) -> float | None:
    """Return the height [m] at a time [s], none after the end of a curve in which the ball does not fly freely then.

    Before a curve begins, and after it ends, the height is that of free flight.
    """
    times, z, speed = curve
    if time < times[0]:
        return in_free_fall(time)[0]
    if time <= times[-1] + 1e-5:
        return float(np.interp(time, times, z))
    if not flies_at_its_end(curve):
        return None
    left = time - times[-1]
    return float(z[-1] + speed[-1] * left - 0.5 * GRAVITY * left**2)


def mm(value: float | None, digits: int = 2) -> str:
    """Return a length [m] in mm."""
    return "not run" if value is None else f"{1000.0 * value:.{digits}f}"


def cell(curve: Curve, time: float) -> str:
    """Return the height at a time, marked where it is carried on in free flight."""
    mark = "*" if time > curve[0][-1] + 1e-5 and height(curve, time) is not None else ""
    return mm(height(curve, time)) + mark


def at_a_time(found: dict[str, Curve], time: float) -> str:
    """Return the line of a time [s]: both codes, their difference, the range of impacts, and whether they agree."""
    ours, theirs = (height(found[name], time) for name in ("published", "mercury"))
    verdict, difference = "not run", None if ours is None or theirs is None else ours - theirs
    if difference is not None:
        verdict = "yes" if abs(difference) <= CRITERION else "**no**"
    places = [z for name in IMPACTS if name in found and (z := height(found[name], time)) is not None]
    spread = inside = "not run"
    if len(places) > 1:
        spread = f"{mm(min(places))} to {mm(max(places))} ({len(places)})"
        if theirs is not None:
            inside = "yes" if min(places) - 1e-6 <= theirs <= max(places) + 1e-6 else "**no**"
    cells = (cell(found["published"], time), cell(found["mercury"], time), mm(difference), verdict, spread, inside)
    return f"| {1000.0 * time:g} | " + " | ".join(cells) + " |"


def comparison(found: dict[str, Curve]) -> list[str]:
    """Return the table of heights against time."""
    head = (
        "| time [ms] | z here [mm] | z MercuryDPM [mm] | difference [mm] | within 1 mm | range of impacts [mm] "
        "(number) | MercuryDPM in it |"
    )
    return [head, "|---" * 7 + "|", *(at_a_time(found, time) for time in sorted(ASKED + ADDED))]


def paragraph(words: str) -> str:
    """Return words as lines of a page."""
    return "\n".join(textwrap.wrap(words, 100, break_long_words=False, break_on_hyphens=False))


def named(run: str) -> str:
    """Return the name of a run in words."""
    return run.replace("lammps", "LAMMPS").replace("_", " ")


def rebound(curve: Curve) -> float | None:
    """Return the speed [m/s] at which the ball leaves the bottom, none where it has not left."""
    return float(curve[2].max()) if curve[2].max() > 0.0 else None


def between_codes(found: dict[str, Curve]) -> str:
    """Return how far both codes are apart before the ball reaches the bottom, and how it leaves it."""
    mercury, ours = found["mercury"], found["published"]
    down = ours[0] <= BOTTOM
    gap = np.abs(np.interp(ours[0][down], *ours[:2]) - np.interp(ours[0][down], *mercury[:2]))
    lowest = {name: float(found[name][1].min()) - FLOOR - BALL_RADIUS for name in ("published", "mercury")}
    speeds = {name: rebound(curve) for name, curve in found.items()}
    names = {"published": "here", "mercury": "MercuryDPM"}
    left = ", ".join(
        f"{names.get(name, named(name))} {speed:.2f}" for name, speed in speeds.items() if speed is not None
    )
    way = mm(in_free_fall(MEETS)[0] - float(ours[1][down][-1]), 0)
    return paragraph(
        f"**In the bed the codes agree.** From {1000.0 * MEETS:g} to {1000.0 * BOTTOM:g} ms, every 0.25 ms, the two "
        f"heights differ by {mm(float(gap.max()))} mm at the most, over a way of {way} mm. Then the ball meets what is "
        f"left between it and the floor: its lowest point comes to {mm(lowest['published'])} mm above the floor here "
        f"and to {mm(lowest['mercury'])} mm in MercuryDPM, less than a grain, and it leaves upwards, in free flight. "
        f"The speed at which it leaves [m/s]: {left}."
    )


def what_rounding_does(found: dict[str, Curve]) -> list[str]:
    """Return what a billionth of a metre changes, as lines of the page."""
    if not {"nudged", "east"} <= set(found):
        return []
    apart = {time: abs(nudged - published) if (nudged := height(found["nudged"], time)) is not None
             and (published := height(found["published"], time)) is not None else None
             for time in (0.029, *ASKED[2:])}  # fmt: skip
    before, at_50, at_100 = (mm(value) for value in apart.values())
    lost = {name: float(np.diff(np.interp([BOTTOM, BOTTOM + 0.0005], found[name][0], found[name][2]))[0])
            for name in found if found[name][0][-1] > BOTTOM + 0.0005}  # fmt: skip
    others = "".join(
        f" LAMMPS {words} dashpot across the normal, at 5e-7 s from the bed relaxed here, loses {lost[name]:.2f} m/s."
        for name, words in (("lammps_no_dashpot", "without the"), ("lammps_dashpot", "with a"))
        if name in lost
    )
    return ["", paragraph(
        "**After it no two runs do.** The ball leaves nearly as fast as it came down on the last grains, which are "
        "2880 times lighter, so that what it keeps follows from how few grains lie between it and the floor. An impact "
        f"here that is a billionth of a metre to the side is {before} mm off at 29 ms, {at_50} mm at 50 ms and "
        f"{at_100} mm at 100 ms: rounding alone moves the ball by more than the criterion at both times. The larger "
        "difference from MercuryDPM begins before it turns: in the 0.5 ms after "
        f"{1000.0 * BOTTOM:g} ms the ball loses {lost['published']:.2f} m/s here, {lost['nudged']:.2f} in the nudged "
        f"run and {lost['mercury']:.2f} there, to grains that it meets.{others} At the same place the "
        "runs with that dashpot, of both engines, are alike, and so are those without it, of both other codes: the law "
        "across the normal makes the difference, as far as five runs can show it. An impact to the side loses "
        f"{lost['east']:.2f} m/s here."
    )]  # fmt: skip


def draw(found: dict[str, Curve]) -> None:
    """Height of the ball against time, and what the other runs differ from the published impact."""
    with plt.rc_context(STYLE):
        figure, (left, right) = plt.subplots(1, 2, figsize=(9.2, 3.9), constrained_layout=True)
        drawn = {"published": ("here", TRAINING, "-"), "mercury": ("MercuryDPM", SITE, "--")}
        for name, (label, colour, line) in drawn.items():
            time, z, _ = found[name]
            left.plot(1000.0 * time, 1000.0 * z, line, color=colour, lw=1.8, label=label)
        left.axhline(1000.0 * (FLOOR + BALL_RADIUS), color=QUIET, lw=1.0, ls=":", label="ball on the floor")
        left.set(xlabel="time [ms]", ylabel="height of the ball's centre [mm]", xlim=(15.0, None), ylim=(-82.0, -10.0))
        left.set_title("Height")
        left.legend(fontsize=8)
        reference = found["published"]
        others = [name for name in found if name not in ("published", "mercury")]
        colours = dict(zip(others, (*INPUT_COLOURS[1:3], *INPUT_COLOURS[4:]), strict=False)) | {"mercury": SITE}
        for name in ("mercury", *others):
            time = reference[0][reference[0] <= found[name][0][-1] + 1e-6]
            gap = np.interp(time, *found[name][:2]) - np.interp(time, *reference[:2])
            right.plot(1000.0 * time, 1000.0 * gap, "--" if name == "mercury" else "-", color=colours[name], lw=1.6,
                       label="MercuryDPM" if name == "mercury" else named(name))  # fmt: skip
        right.axhspan(-1.0, 1.0, color=QUIET, alpha=0.15, lw=0, label="criterion")
        right.set(xlabel="time [ms]", ylabel="less that of the published impact here [mm]")
        right.set_title("Differences of height")
        right.legend(fontsize=8)
        figure.savefig(PAGES / "nine_codes.png", dpi=150)


def pair_table() -> list[str]:
    """Return the table of the pair tests, and what it shows."""
    rows = read_rows(HERE / "pair_tests.csv", {"quantity": str, "mercury": str})
    lines = [
        "| test | step [s] | closed form | MercuryDPM | here | here less closed form, relative |",
        "|---" * 6 + "|",
    ]
    for row in rows:
        off = row["lithobrake"] / row["closed_form"] - 1.0
        theirs = f"{float(row['mercury']):.7g}" if row["mercury"] else ""
        lines.append(
            f"| {WORDS[row['quantity']]} | {row['step_s']:g} | {row['closed_form']:.7g} | {theirs} | "
            f"{row['lithobrake']:.7g} | {off:.1e} |"
        )
    return lines


PAIRS = """
## Two pair tests

A sphere M1 (radius 1 mm) falls from z = 1.01 mm at 1 m/s on steel, without gravity; a sphere of
steel, at rest on M1, is pushed by (5, 0, -5) m/s2 for 5 ms. Closed forms: restitution as entered;
sliding by Coulomb's law from the start, a = g (1 - μ), 5 μ g / 2R of spin. Criterion: 1e-3.
"""
PAIRS_AFTER = """
Sliding agrees with both to 1e-3. The rebound does so from a fifth of the published step on: contact
begins and ends within a step, a fortieth of it, and the error is in proportion to the step. So it
is in MercuryDPM, whose 0.40108 is that of its step, too: its driver gives 0.39995 at a tenth of it.
Its damping force is not clipped: it pulls when the contact ends.
"""


def time_table() -> list[str]:
    """Return the sentence of CPU times beside LAMMPS."""
    rows = read_rows(HERE / "lammps_times.csv", {})
    lines = ["\n## CPU time\n"]
    if not rows:
        return [*lines, "Not measured next to LAMMPS."]
    theirs, ours = (statistics.median(row[name] for row in rows) for name in ("lammps", "lithobrake"))
    ratios = sorted(row["lithobrake"] / row["lammps"] for row in rows)
    count, load = int(rows[0]["spheres"]), json.loads((HERE / "lammps.json").read_text())["load"]
    return [*lines, paragraph(
        f"From the state at {1000.0 * TIMED_AT:g} ms, with the ball in the bed, both took {rows[0]['steps']:.0f} "
        f"steps of 5e-7 s in turn, {len(rows)} times, with one thread each (LAMMPS: pair style granular, "
        f"hertz/material, mindlin, coeff_restitution): median {1000.0 * ours:.1f} ms of CPU time a step "
        f"here, {1000.0 * theirs:.1f} ms in LAMMPS, ratio {statistics.median(ratios):.2f} ({ratios[0]:.2f} to "
        f"{ratios[-1]:.2f}); that is {count / ours / 1e6:.1f} and {count / theirs / 1e6:.1f} million sphere-steps a "
        f"CPU second. The load was {load:.0f} on two cores, so that both are slower than alone."
    )]  # fmt: skip


def runs_table(found: dict[str, Curve]) -> list[str]:
    """Return what was run, how far, and at what cost."""
    lines = ["| run | ball at x, y [mm] | longest step until 32 ms [s] | followed to [ms] | CPU time [s] |"]
    lines.append("|---" * 5 + "|")
    done = {row["run"]: row for row in read_rows(HERE / "impact.csv", {"run": str})}
    for one in RUNS:
        ends = f"{1000.0 * found[one.run][0][-1]:.2f}" if one.run in found else "not run"
        cost = f"{done[one.run]['cpu_s']:.0f}" if one.run in done else ""
        place = f"{1000.0 * one.x:g}, {1000.0 * one.y:g}"
        lines.append(f"| {one.run.replace('_', ' ')} | {place} | {one.step:g} | {ends} | {cost} |")
    for row in read_rows(HERE / "lammps.csv", {"run": str}):
        name = f"LAMMPS {row['run'].replace('_', ' ')}"
        lines.append(f"| {name} | 0, 0 | {row['step']:g} | {1000.0 * row['until']:.2f} | {row['cpu_s']:.0f} |")
    mercury = read_rows(HERE / "mercury.csv", {"run": str})
    if mercury:
        lines.append(f"| MercuryDPM | 0, 0 | 1e-06 | {1000.0 * mercury[0]['until']:.2f} | {mercury[0]['cpu_s']:.0f} |")
    return lines


RUNS_WORDS = """
## Runs

Here the bed relaxes at 1e-6 s while the ball falls freely, to 20.5 ms; then the step is the
published 5e-7 s until 32 ms and 1e-6 s after it, or 0.9 of the largest that the engine allows.
MercuryDPM takes 4e-6 s in free fall, 1e-6 s until 30 ms, 3e-6 s until 50 ms and 4e-6 s after it;
its contact search has cells that fit both sizes of spheres. At the published step it would take
some ten thousand CPU seconds and was not run so. Runs that were not finished were stopped for want
of time. CPU times were measured beside other work.
"""


def main() -> None:
    """Draw and write."""
    found = curves()
    draw(found)
    parts = [
        HEAD, *comparison(found), FREE_FALL, between_codes(found), *what_rounding_does(found),
        "\n![Height of the ball](nine_codes.png)",
        CONDITIONS.rstrip(), RUNS_WORDS, *runs_table(found), PAIRS, *pair_table(), PAIRS_AFTER.rstrip(), *time_table(),
        MISSING.rstrip(),
    ]  # fmt: skip
    (PAGES / "nine_codes.md").write_text("\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
