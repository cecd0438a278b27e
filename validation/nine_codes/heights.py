"""Heights of the ball in the runs of the benchmark's impact, and how far codes are apart, before and after it turns."""

import sys
import textwrap
from pathlib import Path

import numpy as np
from impact import FROM_START, LATER, MEETS, RUNS
from impact_bed import BALL_RADIUS, FLOOR, GRAVITY, in_free_fall

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import read_rows
from page import table

HERE = Path(__file__).parent
CRITERION = 0.001  # m
ASKED, ADDED = (0.01, 0.02, 0.05, 0.1), (0.022, 0.025, 0.0275, 0.029, 0.03, 0.032)  # s
BOTTOM = 0.02925  # s: just before the ball meets the layer on the floor
# m/s2, by which an acceleration may differ from that of gravity in free flight; it is looked at over so many rows.
FREE, LAST = 0.1, 4
ROUNDING = 1e-6  # m, of heights in free fall, which are alike
PLACES = ("east", "north", "west", "south")  # impacts to a side
OURS = FROM_START  # the run of the benchmark's law, which is compared
IMPACTS = ("published", *PLACES, "nudged")
# Runs without a dashpot across the normal.
UNDAMPED = ("mercury", "lammps_no_dashpot", FROM_START, LATER)
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


def paragraph(words: str) -> str:
    return "\n".join(textwrap.wrap(words, 100, break_long_words=False, break_on_hyphens=False))


def named(run: str) -> str:
    return run.replace("lammps", "LAMMPS").replace("_", " ")


def rebound(curve: Curve) -> float | None:
    """Return the speed [m/s] at which the ball leaves the bottom, none where it has not left."""
    return float(curve[2].max()) if curve[2].max() > 0.0 else None


def largest_gap(found: dict[str, Curve]) -> float:
    """Return the largest difference [m] of height between both codes before the ball reaches the bottom."""
    mercury, ours = found["mercury"], found[OURS]
    down = ours[0] <= BOTTOM
    return float(np.abs(np.interp(ours[0][down], *ours[:2]) - np.interp(ours[0][down], *mercury[:2])).max())


def within_until(found: dict[str, Curve]) -> float:
    """Return until when [s] the two heights stay within the criterion, MercuryDPM's as carried on in free flight."""
    times, ours = found[OURS][:2]
    # None, where it is not known, becomes NaN, which is not within anything.
    theirs = np.array([height(found["mercury"], float(time)) for time in times], dtype=np.float64)
    outside = ~(np.abs(theirs - ours) <= CRITERION)
    return float(times[np.argmax(outside) - 1] if outside.any() else times[-1])


def answer(found: dict[str, Curve]) -> str:
    """Return the answer of the page: how far the codes are apart in the bed and after it, and what rounding does."""
    gaps = {time: None if (a := height(found[OURS], time)) is None or (b := height(found["mercury"], time))
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
    words += f" The heights stay within it until {1000.0 * within_until(found):.0f} ms."
    shift = [mm(moved(found, "nudged", time)) for time in ASKED[2:]]
    if "nudged" in found:
        words += (
            " After the turn, a shift of the impact point by a billionth of a metre changes the height by "
            f"{shift[0]} mm at {1000.0 * ASKED[2]:g} ms and by {shift[1]} mm at {1000.0 * ASKED[3]:g} ms."
        )
    inside = [within_impacts(found, time) for time in ASKED]
    words += (
        f" At {sum(inside)} of the {len(ASKED)} times MercuryDPM lies within the range of the impacts here with a "
        "tangential dashpot, in the middle and to the sides."
    )
    return paragraph(words)


def within_impacts(found: dict[str, Curve], time: float) -> bool:
    """Return whether MercuryDPM's height at a time [s] lies between those of the impacts here."""
    theirs = height(found["mercury"], time)
    ours = [z for name in IMPACTS if name in found and (z := height(found[name], time)) is not None]
    return theirs is not None and len(ours) > 1 and min(ours) - ROUNDING <= theirs <= max(ours) + ROUNDING


def moved(found: dict[str, Curve], name: str, time: float) -> float | None:
    """Return how far [m] the height of a run at a time [s] is from that of the published impact."""
    if name not in found:
        return None
    one, other = height(found[name], time), height(found["published"], time)
    return None if one is None or other is None else abs(one - other)


def between_codes(found: dict[str, Curve]) -> str:
    """Return how far both codes are apart before the ball reaches the bottom."""
    ours = found[OURS]
    lowest = {name: float(found[name][1].min()) - FLOOR - BALL_RADIUS for name in (OURS, "mercury")}
    way = mm(in_free_fall(MEETS)[0] - float(ours[1][ours[0] <= BOTTOM][-1]), 0)
    return paragraph(
        f"In the bed, from {1000.0 * MEETS:g} to {1000.0 * BOTTOM:g} ms in steps of 0.25 ms, the two heights differ by "
        f"at most {mm(largest_gap(found))} mm, while the ball moves by {way} mm. The ball then meets the last grains "
        f"above the floor. Its lowest point is {mm(lowest[OURS])} mm above the floor here and "
        f"{mm(lowest['mercury'])} mm in MercuryDPM, less than a grain. It leaves upwards in free flight."
    )


def lost_speed(curve: Curve) -> float | None:
    """Return the speed [m/s] that the ball loses in the half millisecond before it turns, none without rows there."""
    if curve[0][-1] <= BOTTOM + 0.0005:
        return None
    return float(np.diff(np.interp([BOTTOM, BOTTOM + 0.0005], curve[0], curve[2]))[0])


def turn_table(found: dict[str, Curve]) -> str:
    """Return the table of what each run does where the ball turns."""
    lines = []
    for name, curve in found.items():
        cells = ("-" if value is None else f"{value:.2f}" for value in (lost_speed(curve), rebound(curve)))
        lines.append((shown(name), "no" if name in UNDAMPED else "yes", *cells))
    lost = f"speed lost from {1000.0 * BOTTOM:g} to {1000.0 * BOTTOM + 0.5:g} ms [m/s]"
    return table(("run", "tangential dashpot", lost, "rebound speed [m/s]"), lines)


def shown(name: str) -> str:
    """Return the name of a run with that of its code."""
    return {"mercury": "MercuryDPM"}.get(name, named(name) if "lammps" in name else f"here, {named(name)}")


def span(values: list[float]) -> str:
    """Return the least and the most of some values."""
    return f"{min(values):.2f} to {max(values):.2f}"


def beside_words(lost: dict[str, float]) -> str:
    """Return what impacts to a side lose here, by which one can tell how much the impact point does."""
    beside = [lost[name] for name in PLACES if name in lost]
    if len(beside) < 2:
        return ""
    return (
        f"At {len(beside)} other impact points, with that dashpot, {span(beside)} m/s are lost here: the impact point "
        "changes the loss as much as the law does."
    )


def after_the_turn(found: dict[str, Curve]) -> str:
    """Return why the codes differ after the ball turns, as parts of the page."""
    lost = {name: one for name, curve in found.items() if (one := lost_speed(curve)) is not None}
    middle = {name: one for name, one in lost.items() if name not in PLACES}
    damped = [one for name, one in middle.items() if name not in UNDAMPED]
    free = [one for name, one in middle.items() if name in UNDAMPED]
    words = (
        "The ball rebounds from the last grains nearly as fast as it hits them, although they are 2880 times lighter. "
        "Its rebound speed therefore depends on how few grains lie between it and the floor."
    )
    nudged = [moved(found, "nudged", time) for time in (0.029, *ASKED[2:])]
    if "nudged" in found:
        words += (
            f" Rounding alone matters: the run nudged by a billionth of a metre is {mm(nudged[0])} mm off at 29 ms, "
            f"{mm(nudged[1])} mm at 50 ms and {mm(nudged[2])} mm at 100 ms."
        )
    parts = [paragraph(words), turn_table(found)]
    if damped and free:
        apart = min(damped) > max(free)
        parts.append(paragraph(
            f"At the published impact point, the {len(damped)} runs with a tangential dashpot lose {span(damped)} m/s "
            f"in that half millisecond, the {len(free)} without one {span(free)} m/s. "
            + ("The tangential law thus separates the runs of all codes" if apart
               else "The tangential law does not separate the runs")
            + f", as far as {len(middle)} runs can show it. "
            + beside_words(lost)
        ))  # fmt: skip
    return "\n\n".join(parts)
