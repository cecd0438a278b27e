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
from page_words import CONDITIONS, FREE_FALL, HEAD, MISSING, PAIRS, PAIRS_AFTER, RUNS_WORDS, SOURCE

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
PLACES = ("east", "north", "west", "south")  # impacts to a side
IMPACTS = ("published", *PLACES, "nudged")
UNDAMPED = ("mercury", "lammps_no_dashpot")  # runs without a dashpot across the normal
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
        "| time [ms] | z here [mm] | z MercuryDPM [mm] | difference [mm] | within 1 mm | range of impacts here [mm] "
        "(number) | MercuryDPM in this range |"
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


def largest_gap(found: dict[str, Curve]) -> float:
    """Return the largest difference [m] of height between both codes before the ball reaches the bottom."""
    mercury, ours = found["mercury"], found["published"]
    down = ours[0] <= BOTTOM
    return float(np.abs(np.interp(ours[0][down], *ours[:2]) - np.interp(ours[0][down], *mercury[:2])).max())


def answer(found: dict[str, Curve]) -> str:
    """Return the answer of the page: how far the codes are apart in the bed and after it, and what rounding does."""
    gaps = {time: None if (a := height(found["published"], time)) is None or (b := height(found["mercury"], time))
            is None else abs(a - b) for time in ASKED}  # fmt: skip
    held = [time for time, gap in gaps.items() if gap is not None and gap <= CRITERION]
    failed = [f"{mm(gap)} mm at {1000.0 * time:g} ms" for time, gap in gaps.items() if gap and gap > CRITERION]
    largest = largest_gap(found)
    words = (
        f"**{'Yes' if largest <= CRITERION else 'No'}, while the ball moves through the bed:** its height differs from "
        f"MercuryDPM's by at most {mm(largest)} mm from {1000.0 * MEETS:g} to {1000.0 * BOTTOM:g} ms; the criterion is "
        f"{mm(CRITERION, 0)} mm. The criterion holds at {len(held)} of the {len(ASKED)} times set before the runs"
    )
    words += f" and fails after the ball turns ({' and '.join(failed)})." if failed else "."
    shift = [mm(moved(found, "nudged", time)) for time in ASKED[2:]]
    if "nudged" in found:
        words += (
            " After the turn, a shift of the impact point by a billionth of a metre alone changes the height by "
            f"{shift[0]} mm at {1000.0 * ASKED[2]:g} ms and by {shift[1]} mm at {1000.0 * ASKED[3]:g} ms."
        )
    return "\n" + paragraph(words)


def moved(found: dict[str, Curve], name: str, time: float) -> float | None:
    """Return how far [m] the height of a run at a time [s] is from that of the published impact."""
    if name not in found:
        return None
    one, other = height(found[name], time), height(found["published"], time)
    return None if one is None or other is None else abs(one - other)


def between_codes(found: dict[str, Curve]) -> str:
    """Return how far both codes are apart before the ball reaches the bottom."""
    ours = found["published"]
    lowest = {name: float(found[name][1].min()) - FLOOR - BALL_RADIUS for name in ("published", "mercury")}
    way = mm(in_free_fall(MEETS)[0] - float(ours[1][ours[0] <= BOTTOM][-1]), 0)
    return paragraph(
        f"In the bed, from {1000.0 * MEETS:g} to {1000.0 * BOTTOM:g} ms in steps of 0.25 ms, the two heights differ by "
        f"at most {mm(largest_gap(found))} mm, while the ball moves by {way} mm. The ball then meets the last grains "
        f"above the floor. Its lowest point is {mm(lowest['published'])} mm above the floor here and "
        f"{mm(lowest['mercury'])} mm in MercuryDPM, less than a grain. It leaves upwards in free flight."
    )


def lost_speed(curve: Curve) -> float | None:
    """Return the speed [m/s] that the ball loses in the half millisecond before it turns, none without rows there."""
    if curve[0][-1] <= BOTTOM + 0.0005:
        return None
    return float(np.diff(np.interp([BOTTOM, BOTTOM + 0.0005], curve[0], curve[2]))[0])


def turn_table(found: dict[str, Curve]) -> list[str]:
    """Return the table of what each run does where the ball turns."""
    head = (
        f"| run | tangential dashpot | speed lost from {1000.0 * BOTTOM:g} to {1000.0 * BOTTOM + 0.5:g} ms [m/s] "
        "| rebound speed [m/s] |"
    )
    lines = [head, "|---" * 4 + "|"]
    for name, curve in found.items():
        lost, speed = lost_speed(curve), rebound(curve)
        cells = ("-" if value is None else f"{value:.2f}" for value in (lost, speed))
        lines.append(f"| {shown(name)} | {'no' if name in UNDAMPED else 'yes'} | {' | '.join(cells)} |")
    return lines


def shown(name: str) -> str:
    """Return the name of a run with that of its code."""
    return {"mercury": "MercuryDPM"}.get(name, named(name) if "lammps" in name else f"here, {named(name)}")


def span(values: list[float]) -> str:
    """Return the least and the most of some values."""
    return f"{min(values):.2f} to {max(values):.2f}"


def after_the_turn(found: dict[str, Curve]) -> list[str]:
    """Return why the codes differ after the ball turns, as parts of the page."""
    lost = {name: one for name, curve in found.items() if (one := lost_speed(curve)) is not None}
    middle = {name: one for name, one in lost.items() if name not in PLACES}
    damped = [one for name, one in middle.items() if name not in UNDAMPED]
    free = [one for name, one in middle.items() if name in UNDAMPED]
    words = (
        "The ball rebounds nearly as fast as it came down on the last grains, which are 2880 times lighter. Its "
        "rebound speed therefore depends on how few grains lie between it and the floor."
    )
    nudged = [moved(found, "nudged", time) for time in (0.029, *ASKED[2:])]
    if "nudged" in found:
        words += (
            f" Rounding alone matters: the run nudged by a billionth of a metre is {mm(nudged[0])} mm off at 29 ms, "
            f"{mm(nudged[1])} mm at 50 ms and {mm(nudged[2])} mm at 100 ms."
        )
    parts = ["\n## Why the codes differ after the turn\n", paragraph(words), "", *turn_table(found)]
    if damped and free:
        apart = min(damped) > max(free)
        parts += ["", paragraph(
            f"At the published impact point, the {len(damped)} runs with a tangential dashpot lose {span(damped)} m/s "
            f"in that half millisecond, the {len(free)} without one {span(free)} m/s. "
            + ("The tangential law thus separates the runs of all codes" if apart
               else "The tangential law does not separate the runs")
            + f", as far as {len(middle)} runs can show it. "
            + "".join(f"At another impact point ({named(name)}) {lost[name]:.2f} m/s are lost here. "
                      for name in PLACES if name in lost)
        )]  # fmt: skip
    return parts


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
        "| quantity | step [s] | closed form | MercuryDPM | here | relative error here |",
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


def time_table() -> list[str]:
    """Return the sentence of CPU times beside LAMMPS."""
    rows = read_rows(HERE / "lammps_times.csv", {})
    lines = ["\n## CPU time\n"]
    if not rows:
        return [*lines, "Not measured against LAMMPS."]
    theirs, ours = (statistics.median(row[name] for row in rows) for name in ("lammps", "lithobrake"))
    ratios = sorted(row["lithobrake"] / row["lammps"] for row in rows)
    count, load = int(rows[0]["spheres"]), json.loads((HERE / "lammps.json").read_text())["load"]
    return [*lines, paragraph(
        f"A step takes {statistics.median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f}) times the CPU time of "
        f"LAMMPS: in the median {1000.0 * ours:.1f} ms here and {1000.0 * theirs:.1f} ms in LAMMPS, or "
        f"{count / ours / 1e6:.1f} and {count / theirs / 1e6:.1f} million sphere-steps per CPU second. Both codes "
        f"started from the state at {1000.0 * TIMED_AT:g} ms, with the ball in the bed, and took "
        f"{rows[0]['steps']:.0f} steps of 5e-7 s in turn, {len(rows)} times, with one thread each (LAMMPS: pair style "
        f"granular, hertz/material, mindlin, coeff_restitution). The load was {load:.0f} on two cores, so both are "
        "slower than alone."
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


def main() -> None:
    """Draw and write."""
    found = curves()
    draw(found)
    parts = [
        HEAD.rstrip(), answer(found), SOURCE, *comparison(found), FREE_FALL, between_codes(found),
        *after_the_turn(found), CONDITIONS.rstrip(), RUNS_WORDS, *runs_table(found), PAIRS, *pair_table(),
        PAIRS_AFTER.rstrip(), *time_table(), MISSING.rstrip(),
    ]  # fmt: skip
    (PAGES / "nine_codes.md").write_text("\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
