"""What the rows of each experiment say of its causes: the sentences under its tables, with their numbers."""

from collections.abc import Callable

import numpy as np
from ball_into_beads import BALL, FINE, FINER, LOOSE, OURS, ROLLING_STIFF
from beads_part import SURFACES, cause_of_diameter, steps_of_diameter
from bed_steps import BAR as STEP
from bed_steps import agrees, bed_table, diameter_table, mean_prefactor, pairs, pours, step_table, steps
from fits import (
    Estimate,
    below_mean_surface,
    column,
    density_exponent,
    gravity_exponents,
    leaving,
    mean_of,
    powers,
    speeds,
    stopping,
)
from low_gravity_parts import compared
from plate_into_loose_grains import SPEED
from plate_part import COHESION, RESISTS, force_exponent
from rebounds_part import FINEST, JSC, PULLING, rebounds
from result_rows import Row, read_rows
from settling_in_other_gravities import DIAMETER, EARTH, GRAINS, SHARES, SOFT
from stopping_force import FALLS
from stopping_part import measured_prefactor, stopping_words
from table_lines import HERE, NOT_SHOWN, said


def rows_of(name: str) -> list[Row]:
    """Return the rows of a table."""
    return read_rows(HERE / f"{name}.csv")


def of_kind(rows: list[Row], kind: str) -> list[Row]:
    """Return the rows of a kind."""
    return [row for row in rows if row["kind"] == kind]


def beads() -> str:
    """Ball into beads: what walls, packing and the size of beads do to the exponents."""
    every = rows_of("ball_into_beads")
    beds = pairs(every)
    found = {name: density_exponent(*two, below_mean_surface) for name, two in beds.items()}
    moved = {words: found[after] - found[before] for words, before, after in steps(beds)}
    large = [f"{words} ({moved[words]:+.2f})" for words in moved if abs(moved[words]) > STEP]
    small = [f"{words} ({moved[words]:+.2f})" for words in moved if abs(moved[words]) <= STEP]
    inside = {text: [name for name, two in beds.items() if agrees(two, of)] for text, of in SURFACES.items()}
    held = "; ".join(f"from {text} in {len(names)} of {len(beds)} beds" for text, names in inside.items())
    larger = [", ".join(f"{one:.2f}" for one in steps_of_diameter(every, depth_of)) for depth_of in SURFACES.values()]
    nearer = all(cause_of_diameter(every, depth_of) != NOT_SHOWN for depth_of in SURFACES.values())
    size = "It approaches the measured 2/3 as the ball spans more beads." if nearer else "No trend to 2/3 is seen."
    stops = stopping([row for row in every if (row["bed"], row["diameter"]) == (FINE, BALL)])
    return "\n\n".join((
        "### Why the exponent of density disagrees",
        "A light (2200 kg/m3) and a heavy ball (15000 kg/m3) were dropped from 0.1 m into beds that differ in one "
        'respect at a time. "Walls" is a box three balls wide and 85 mm deep. "Periodic" beds have no walls. They are '
        "four balls wide, those of 3 mm and smaller beads three, unless named otherwise. "
        '"Dense" beds were poured at up to $3\\sqrt{gd}$, "loose" ones at up to $0.6\\sqrt{gd}$. "Deeper" is 110 mm.',
        step_table(every),
        bed_table(every),
        f"Measured from the mean surface, these changes move the exponent by more than {STEP:g}: "
        f"{'; '.join(large) or 'none'}. The others move it by less: {'; '.join(small) or 'none'}. The exponent is "
        f"within the tolerance {held}. The last column of the first table names the changes to the bed compared (3 mm, "
        "periodic, loose, deeper), or to the same bed of 5 mm beads, that bring the exponent within the tolerance. "
        "Packing matters in other simulations too: [Carvalho-2023] attributes the variety of published scaling laws to "
        "it.",
        pour_words(beds),
        size_words(beds),
        prefactor_words(),
        f"On the loose bed of 3 mm the mean prefactor of the two balls is {mean_prefactor(beds[FINE]):.2f}, on the "
        f"dense one {mean_prefactor(beds[OURS]):.2f}. The stopping time agrees in the mean only: single drops take "
        f"from {min(stops):.1f} to {max(stops):.1f} d/v.",
        "### Why the exponent of diameter disagrees",
        diameter_table(every),
        f"From one ball to the next larger (12.7, 18, 25.4 and 36 mm) the exponent is {larger[0]} from the mean "
        f"surface and {larger[1]} from the first touch. {size} [Nelson-2008] measured that walls hold a ball up as "
        "well.",
    ))  # fmt: skip


def pour_words(beds: dict[str, tuple[Row, Row]]) -> str:
    """Say how far the exponents of several pours of one bed are apart."""
    spreads = []
    for bed, size in ((LOOSE, "5 mm"), (FINE, "3 mm")):
        own = pours(beds, bed)
        if len(own) > 1:
            found = {text: [density_exponent(*beds[name], of) for name in own] for text, of in SURFACES.items()}
            spread = " and ".join(f"{min(ones):.2f} to {max(ones):.2f} from {text}" for text, ones in found.items())
            spreads.append(f"The exponents of {len(own)} pours of the loose bed of {size} are {spread}.")
    return (
        f"{' '.join(spreads)} One bed therefore determines the exponent less well than the intervals of the first "
        "table say, which hold for drops into one bed; a change that moves it by less than the pours differ is not "
        "detected by two drops."
    )


def size_words(beds: dict[str, tuple[Row, Row]]) -> str:
    """Say that depths have not converged with the size of the beads, and what holds a ball up."""
    depths = [
        ", ".join(f"{100.0 * beds[name][k]['deepest']:.2f}" for name in (LOOSE, FINE, FINER)) for k in (0, 1)
    ]  # fmt: skip
    less = [100.0 * (1.0 - after["deepest"] / before["deepest"])
            for before, after in zip(beds[LOOSE], beds[f"{LOOSE}, {ROLLING_STIFF}"], strict=True)]  # fmt: skip
    return (
        "Depths have not converged with the size of the beads: in beads of 5, 3 and 2 mm the light ball sinks by "
        f"{depths[0]} cm and the heavy one by {depths[1]} cm. Rolling friction and stiffer beads together take "
        f"{less[0]:.0f} and {less[1]:.0f} % off these depths in beads of 5 mm. The slope of a heap of such beads was "
        "not measured; a steeper one makes the measured law smaller too."
    )


def prefactor_words() -> str:
    """Set the prefactor beside that of the measured force."""
    heights = ", ".join(f"{fall:g}" for fall in FALLS)
    return (
        "The prefactor is that of a secondary source. By the force that the same laboratory measured later, steel "
        f"balls from {heights} m stop at depths with a mean prefactor of {measured_prefactor().value:.2f} (next "
        "section), nearer to the one here."
    )


def gravity() -> str:
    """Sphere that settles: what the modulus does."""
    every = rows_of("settling_in_other_gravities")
    rows = [row for row in every if row["young_modulus"] == GRAINS.young_modulus]
    soft = [row for row in every if row["young_modulus"] == SOFT]

    def deep(rows: list[Row], share: float) -> str:
        return f"{np.mean(column([row for row in rows if row['share'] == share], 'depth')) / DIAMETER:.2f}"

    hard, least = gravity_exponents(rows), GRAINS.young_modulus / (GRAINS.density * EARTH * DIAMETER)
    found = gravity_exponents(soft)
    return (
        "The modulus must be large enough under every gravity. Here it is at least "
        f"{1e3 * round(1e-3 * least):.0f} times density x gravity x diameter of the "
        "sphere. On grains ten times softer the sphere sinks by "
        f"{deep(soft, 1.0)} diameters under Earth's gravity, and the exponents are {said(found['depth'])} for the "
        f"depth and {said(found['stopping_time'])} for the time until it stops, instead of {said(hard['depth'])} and "
        f"{said(hard['stopping_time'])}. Soft grains under a tenth of Earth's gravity are as stiff, by that ratio, as "
        f"stiff ones under Earth's: the sphere sinks by {deep(soft, SHARES[-1])} and {deep(rows, 1.0)} diameters. That "
        "difference is the scatter of beds."
    )


def grains() -> str:
    """Grain on its own kind: what stays."""
    every = rows_of("grain_on_its_own_kind")
    base, half = of_kind(every, "basalt"), of_kind(every, "restitution 0.5")
    kinds = [name for name in dict.fromkeys(row["kind"] for row in every) if name != "basalt"]
    others = [mean_of(speeds(of_kind(every, name))).value for name in kinds]
    left = [mean_of(leaving(of_kind(every, name))).value for name in kinds]
    return (
        f"Why the mean of all grains disagrees: {100.0 * (1.0 - len(leaving(base)) / len(base)):.0f} % of the grains "
        f"stay, in a pocket between others. Those that leave keep {mean_of(leaving(base)).value:.2f} of their speed, "
        "as measured. On the other beds, each changed in one respect, the mean is "
        f"{min(others):.2f} to {max(others):.2f} of all grains and {min(left):.2f} to {max(left):.2f} of those that "
        "leave.\n\n"
        "Why more grains are ejected: the number depends on the smallest rise that counts and on the restitution. "
        f"On average {np.mean(column(base, 'risen_0.1')):.1f} grains rise by more than 0.1 diameters and "
        f"{np.mean(column(base, 'risen_0.5')):.1f} by more than 0.5. At a restitution of 0.5 it is "
        f"{np.mean(column(half, 'risen_0.1')):.1f} and {np.mean(column(half, 'risen_0.5')):.1f}."
    )


def plate() -> str:
    """Plate: the flight, the corners and the exponent."""
    every = rows_of("plate_into_loose_grains")
    speed = {row["name"]: f"{row['speed_6']:.3f}" for row in every}
    ran = [row for row in every if row["series"] == "speeds"]
    free, pulled = ([row for row in ran if row["cohesion"] == pull] for pull in (0.0, 10.0))
    dense = [row for row in every if row["series"] == "corners" and row["filled"] >= 0.6]
    right = [row["speed_6"] < RESISTS * SPEED for row in dense]
    expected = [row["cohesion"] >= COHESION or "rough" in row["name"] for row in dense]
    alike = sum(a == b for a, b in zip(right, expected, strict=True))
    return (
        "Why the flight disagrees: the packing fraction matters, not the bulk density alone. At half of Bennu's bulk "
        f"density the plate keeps {speed['filled 0.3']} m/s on dense grains at a packing fraction of 0.3, but "
        f"{speed['half density 0.58']} and {speed['half density 0.6']} m/s on grains of half the density at 0.58 and "
        f"0.6. The result is sensitive near 0.6: {speed['filled 0.6']} m/s are left at 0.6, {speed['filled 0.58']} at "
        f"0.58 and {speed['filled 0.55']} at 0.55.\n\n"
        f"Of the four combinations at 0.6, {alike} behave as in [Ballouz-2021]. Rough grains without cohesion slow "
        f"the plate to {speed['corner 0.6 rough 0 Pa']} m/s in 6 s but do not stop it. Their heaps are hardly steeper "
        "than the 28 degrees of the source. At a packing fraction of 0.5, rough grains stop the plate with a cohesion "
        f"of 50 Pa; with 10 Pa, {speed['speed 10 Pa 0.1']} m/s are left. The abstract does not define how a cohesion "
        "in Pa relates to the force of a contact.\n\n"
        "The mean force on the plate, over the first half of its diameter, is proportional to the speed to the power "
        f"{said(force_exponent(free))} without cohesion. The exponent must be 2, because no other quantity of that "
        "set-up contains a speed. A cohesion of 10 Pa adds a force independent of the speed; the exponent becomes "
        f"{said(force_exponent(pulled))}."
    )


def packing() -> str:
    """Packing: cohesion is the cause."""
    rows = rows_of("packing_and_cohesion")
    spreads = []
    for kind in dict.fromkeys(row["kind"] for row in rows):
        none = column([row for row in of_kind(rows, kind) if row["pull"] <= 0.3], "solid_fraction")
        spreads.append(f"{none.max() - none.min():.4f} ({kind})")
    return (
        "Why grains without cohesion disagree: by similarity, stiff grains without cohesion pack equally under every "
        f"gravity. In the beds of the weakest cohesion, up to 0.3, the solid fraction varies by {', '.join(spreads)}. "
        "In this model, cohesion is therefore what makes the beds looser."
    )


def balls() -> str:
    """Ball under several gravities: stiffness, and a contradiction."""
    every = rows_of("ball_under_gravities")
    rows, soft = compared(every), of_kind(every, "plain")
    by_speed, by_gravity = reach_powers([row for row in rows if row["froude"] < 3.0])
    found, before = (powers(column(own, "duration_in_units"), column(own, "share"))[0] for own in (rows, soft))
    stiffer = [row for row in rows if row["share"] == 1.0]
    return (
        "Depth follows the Froude number, as [Sunday-2022] found. At one speed the ball therefore goes deeper under "
        "less gravity, against [Murdoch-2017]. For one material without cohesion the two rules exclude each other. "
        "The range of speeds is not the reason: Murdoch's Froude numbers are 0.06 to 2.8, and the drops here below 3 "
        f"give an exponent of {said(by_gravity)} for gravity and {said(by_speed)} for speed.\n\n{pulling(every)}\n\n"
        "Plain beads are too soft under Earth's gravity: the durations there are "
        f"{durations(soft)} sqrt(D/g), on those ten times stiffer {durations(stiffer)}, for the four Froude numbers. "
        f"The exponent of duration is {said(before)} with the former and {said(found)} with the latter."
    )


def durations(rows: list[Row]) -> str:
    """Return the durations of drops under Earth's gravity, in sqrt(D/g)."""
    return ", ".join(f"{row['duration_in_units']:.2f}" for row in rows if row["share"] == 1.0)


def reach_powers(rows: list[Row]) -> list[Estimate]:
    """Return the exponents of speed and of gravity for the depth below the first touch."""
    reach = column(rows, "depth") + column(rows, "touch_height")
    return powers(reach, column(rows, "speed"), column(rows, "share"))


def pulling(every: list[Row]) -> str:
    """Balls on beads that pull: exponents, and depths of the fast balls."""
    rows = of_kind(every, "pulling")
    by_speed, by_gravity = reach_powers(rows)
    fast = sorted(
        (row for row in rows if row["speed"] > column(rows, "speed").mean()), key=lambda row: row["share"], reverse=True
    )
    deep = [100.0 * (row["depth"] + row["touch_height"]) for row in fast]
    plain = reach_powers(compared(every))[1].value
    deeper = 100.0 * ((fast[1]["share"] / fast[0]["share"]) ** plain - 1.0)
    return (
        f"Cohesive beads come nearer to Murdoch's rule. At {fast[0]['speed']:.2f} m/s the ball goes {deep[0]:.2f} cm "
        f"deep at {fast[0]['share']:g} of Earth's gravity and {deep[1]:.2f} cm at {fast[1]['share']:g}; on the beads "
        f"without cohesion the fitted exponent would make it {deeper:.0f} % deeper. The depth of the slow balls "
        f"is only that of one bead. {len(rows)} drops are too few for the exponents: {said(by_gravity)} for gravity "
        f"and {said(by_speed)} for speed."
    )


def rebound() -> str:
    """Balls on grains: size of the grains, pull, restitution."""
    every = rows_of("who_rebounds")

    def share(kind: str) -> str:
        rows = of_kind(every, kind)
        return f"{rebounds(rows)} of {len(rows)}"

    fast = {kind: [row for row in of_kind(every, kind) if row["froude"] == 30.0] for kind in ("6 mm", FINEST, "3 mm")}
    counts = ", ".join(f"{rebounds(rows)} of {len(rows)} on {kind}" for kind, rows in fast.items())
    slow = {
        kind: np.mean([row["upward_out"] for row in of_kind(every, kind) if row["froude"] <= 10.0])
        for kind in (FINEST, "6 mm", JSC)
    }
    return (
        "Why the outcomes disagree: the size of the grains, cohesion and restitution change them. Each row has few "
        "drops, so the fractions are coarse.\n\n"
        f"Without cohesion the outcome depends on the grains: at a Froude number of 30, {counts} grains rebound. "
        f"Grains as cohesive as lunar soil make balls rebound: {share(PULLING)} from 4 mm at 1e-4 g, and "
        f"{share('lunar, 4 mm, 1e-3 g')} at 1e-3 g and a Froude number of 30. Up to a Froude number of 10 the mean "
        f"speed ratio is {slow[FINEST]:.3f} on 4 mm grains, {slow['6 mm']:.3f} on 6 mm, and {slow[JSC]:.3f} on 6 mm "
        "lunar grains (Teflon, 1e-3 g). The measured 0.05 lies between these. From pebbles, "
        f"{share('pebbles')} rebound at a restitution of 0.6 and {share('pebbles, restitution 0.83')} at 0.83, the "
        "measured restitution of rock on rock [Durda-2011]."
    )


EVERY: dict[str, Callable[[], str]] = {
    "beads": beads, "stopping": stopping_words, "gravity": gravity, "grains": grains, "plate": plate,
    "packing": packing, "balls": balls, "rebounds": rebound,
}  # fmt: skip


def every() -> dict[str, str]:
    """Return all sentences by the key of their section."""
    return {key: text() for key, text in EVERY.items()}
