"""What the rows of each experiment say of its causes: the sentences under its tables, with their numbers."""

from collections.abc import Callable

import numpy as np
from ball_into_beads import FINE, LOOSE, OURS
from beads_part import SURFACES, causes_of, mean_prefactor, steps_of_diameter
from fits import (
    column,
    density_exponent,
    gravity_exponents,
    leaving,
    mean_of,
    powers,
    speeds,
)
from plate_into_loose_grains import SPEED
from plate_part import COHESION, RESISTS, force_exponent
from rebounds_part import FINEST, JSC, PULLING, rebounds
from result_rows import Row, read_rows
from settling_in_other_gravities import DIAMETER, EARTH, GRAINS, SHARES, STIFF
from settling_part import BAR
from table_lines import HERE, said


def rows_of(name: str) -> list[Row]:
    """Return the rows of a table."""
    return read_rows(HERE / f"{name}.csv")


def of_kind(rows: list[Row], kind: str) -> list[Row]:
    """Return the rows of a kind."""
    return [row for row in rows if row["kind"] == kind]


def beads() -> str:
    """Ball into beads: what walls, packing and the size of beads do to the exponent of density."""
    every = rows_of("ball_into_beads")
    beds = causes_of(every)
    steep = {
        name: [density_exponent(light, heavy, depth_of) for depth_of in SURFACES.values()]
        for name, (light, heavy) in beds.items()
    }  # fmt: skip

    def step(before: str, after: str) -> str:
        (a, b), (c, d) = steep[before], steep[after]
        return f"{a:.2f} to {c:.2f} ({b:.2f} to {d:.2f})"

    causes = (
        f"finer beads, 8 to 5 mm, {step('8 mm, walls, dense', '5 mm, walls, dense')}, and 5 to 3 mm "
        f"{step('5 mm, walls, dense', OURS)}; no walls "
        f"{step('5 mm, walls, dense', '5 mm, periodic as wide as the box')}; ground 6 in place of 3 balls wide "
        f"{step('5 mm, periodic as wide as the box', '5 mm, periodic, 6 ball diameters')}; a loose bed "
        f"{step('5 mm, periodic', '5 mm, periodic, loose')}; a deeper one {step('5 mm, periodic, loose', LOOSE)}; "
        f"there, 3 in place of 5 mm {step(LOOSE, FINE)}"
    )
    law = step(LOOSE, "5 mm, as the one before, friction 0.6")
    larger = [", ".join(f"{one:.2f}" for one in steps_of_diameter(every, depth_of)) for depth_of in SURFACES.values()]
    return (
        "The exponent of density that a light and a heavy ball give, from the mean surface (from the first touch): "
        f"{causes}; and there, friction of 0.6 in place of 0.3 {law}. So a loose bed brings it nearer to 1/2, from "
        "the first touch to within the bar in beads of 5 mm, but not in 3 mm. Walls, width, depth and friction do not "
        "make the rest, and no row here shows what does. On the loose bed of 3 mm the prefactor of "
        f"the two is {mean_prefactor(list(beds[FINE])):.2f}, on the dense one {mean_prefactor(list(beds[OURS])):.2f}."
        "\n\nThe exponent of the diameter falls from ball to ball of 12.7, 18, 25.4 and 36 mm: "
        f"{larger[0]} (from the first touch {larger[1]}). The more beads across the ball, the nearer to 2/3. That "
        "walls hold a ball up was measured, too [Nelson-2008]."
    )


def gravity() -> str:
    """Sphere that settles: softness under Earth's gravity."""
    every = rows_of("settling_in_other_gravities")
    rows = [row for row in every if row["young_modulus"] == GRAINS.young_modulus]
    stiff = [row for row in every if row["young_modulus"] == STIFF]

    def deep(rows: list[Row]) -> str:
        return f"{np.mean(column(rows, 'depth')) / DIAMETER:.2f}"

    ends = {share: [row for row in rows if row["share"] == share] for share in (SHARES[0], SHARES[-1])}
    text = (
        f"The sphere sinks by {deep(ends[1.0])} diameters under Earth's gravity and by {deep(ends[SHARES[-1]])} under "
        "a tenth of it. Only the modulus over density, gravity and diameter tells the two apart: "
        f"{GRAINS.young_modulus / (GRAINS.density * EARTH * DIAMETER):.0f} under Earth's, and ten times as much."
    )
    alike = gravity_exponents(stiff + ends[SHARES[-1]])
    text += (
        f" On ten times stiffer grains under Earth's gravity, the same number, it sinks by {deep(stiff)} diameters. "
        f"Between these and a tenth of Earth's gravity the exponent of the depth is {said(alike['depth'])}, that of "
        f"the time until it stops {said(alike['stopping_time'])}; the bar is {BAR:g}."
    )
    return text


def grains() -> str:
    """Grain on its own kind: what stays."""
    every = rows_of("grain_on_its_own_kind")
    base = of_kind(every, "basalt")
    kinds = [name for name in dict.fromkeys(row["kind"] for row in every) if name != "basalt"]
    others = [mean_of(speeds(of_kind(every, name))).value for name in kinds]
    left = [mean_of(leaving(of_kind(every, name))).value for name in kinds]
    return (
        f"Of the grains {1.0 - len(leaving(base)) / len(base):.2f} stay, in a pocket between others; those that leave "
        f"keep {mean_of(leaving(base)).value:.2f} of their speed. On the other beds, one respect changed in each, all "
        f"together keep {min(others):.2f} to {max(others):.2f}, and those that leave {min(left):.2f} to "
        f"{max(left):.2f}. How many are ejected depends on how little a rise is seen, and on the restitution: "
        f"{np.mean(column(base, 'risen_0.1')):.1f} grains rise by more than 0.1 grain, "
        f"{np.mean(column(base, 'risen_0.5')):.1f} by more than 0.5; at a restitution of 0.5 "
        f"{np.mean(column(of_kind(every, 'restitution 0.5'), 'risen_0.1')):.1f} and "
        f"{np.mean(column(of_kind(every, 'restitution 0.5'), 'risen_0.5')):.1f}."
    )


def plate() -> str:
    """Plate: the flight, the corners and the exponent."""
    every = rows_of("plate_into_loose_grains")
    by_name = {row["name"]: row for row in every}
    light = [by_name[f"half density {share}"]["speed_6"] for share in ("0.58", "0.6")]
    speed = [row for row in every if row["series"] == "speeds"]
    free, pulled = ([row for row in speed if row["cohesion"] == pull] for pull in (0.0, 10.0))
    text = (
        f"At half of Bennu's bulk density a plate keeps {by_name['filled 0.3']['speed_6']:.3f} m/s where dense grains "
        f"fill 0.3, and {light[0]:.3f} and {light[1]:.3f} m/s where light ones fill 0.58 and 0.6: packing decides, not "
        "bulk density."
    )
    corners = [row for row in every if row["series"] == "corners"]
    right = [row["speed_6"] < RESISTS * SPEED for row in corners if row["filled"] >= 0.6]
    expected = [row["cohesion"] >= COHESION or "rough" in row["name"] for row in corners if row["filled"] >= 0.6]
    text += (
        f"\n\nOf the four corners at 0.6 filled, {sum(a == b for a, b in zip(right, expected, strict=True))} are as "
        "[Ballouz-2021] has them. Rough grains without cohesion slow the plate to "
        f"{by_name['corner 0.6 rough 0 Pa']['speed_6']:.3f} m/s in 6 s but do not stop it: their heaps are hardly "
        "steeper than 28 degrees, and packing is critical: at 0.58 filled "
        f"{by_name['filled 0.58']['speed_6']:.3f} m/s are left, at 0.55 {by_name['filled 0.55']['speed_6']:.3f}. At "
        "0.5 filled rough grains stop it where they pull by 50 Pa; those that pull by 10 Pa leave it "
        f"{by_name['speed 10 Pa 0.1']['speed_6']:.3f} m/s. What a cohesion in Pa is of a contact, the abstract does "
        "not say. The mean force on the plate, over the first half of its diameter, goes as its speed to the "
        f"{said(force_exponent(free))} where grains do not pull: nothing else there has a speed, so the exponent must "
        f"be 2. A cohesion of 10 Pa, which no speed changes, makes it {said(force_exponent(pulled))}."
    )
    return text


def packing() -> str:
    """Packing: cohesion is the cause."""
    rows = rows_of("packing_and_cohesion")
    none = column([row for row in rows if row["pull"] <= 0.3], "solid_fraction")
    return (
        "Without a pull no gravity changes the volume, by similarity; chance from bed to bed is "
        f"{none.max() - none.min():.4f} in three pours. So what was measured is cohesion. Coarse basalt has not run: "
        "its first bed, 1256 hulls, was not at rest after 228 s of CPU time."
    )


def balls() -> str:
    """Ball under several gravities: stiffness, and a contradiction."""
    every = rows_of("ball_under_gravities")
    rows, stiff = of_kind(every, "plain"), of_kind(every, "stiffer")
    slow = [row for row in rows if row["froude"] < 3.0]
    reach = column(slow, "depth") + column(slow, "touch_height")
    by_speed, by_gravity = powers(reach, column(slow, "speed"), column(slow, "share"))
    text = (
        "Depth follows the Froude number, as Sunday found; so at one speed a ball comes the deeper the less the "
        f"gravity. Murdoch's Froude numbers are 0.06 to 2.8; ours below 3 alone give {said(by_gravity)} for gravity "
        f"and {said(by_speed)} for speed. Both rules cannot hold for one material that does not pull. {pulling(every)}"
    )
    swapped = [
        next((other for other in stiff if (other["share"], other["froude"]) == (row["share"], row["froude"])), row)
        for row in rows
    ]  # fmt: skip
    found = powers(column(swapped, "duration_in_units"), column(swapped, "share"))[0]
    return text + (
        " Under Earth's gravity the beads are too soft for the fast balls, which bounce. With the two drops on ten "
        f"times stiffer beads in their place, the exponent of duration is {said(found)}."
    )


def pulling(every: list[Row]) -> str:
    """Balls on beads that pull: exponents, and depths of the fast balls."""
    rows = of_kind(every, "pulling")
    reach = column(rows, "depth") + column(rows, "touch_height")
    by_speed, by_gravity = powers(reach, column(rows, "speed"), column(rows, "share"))
    fast = reach[column(rows, "speed") > column(rows, "speed").mean()]
    return (
        f"On beads that pull ({len(rows)} drops) they are {by_gravity.value:.3f} and {by_speed.value:.3f}: less "
        "gravity does not make the ball come deeper any more, and speed counts more. The fast balls come "
        f"{100.0 * fast.min():.2f} and {100.0 * fast.max():.2f} cm deep under the two gravities; what the slow ones "
        "come is the size of a bead, and chance."
    )


def rebound() -> str:
    """Balls on grains: size of the grains, pull, restitution."""
    every = rows_of("who_rebounds")

    def share(kind: str) -> str:
        rows = of_kind(every, kind)
        return f"{rebounds(rows)} of {len(rows)}"

    fast = {kind: [row for row in of_kind(every, kind) if row["froude"] == 30.0] for kind in ("6 mm", FINEST, "3 mm")}
    told = ", ".join(f"{rebounds(rows)} of {len(rows)} in {kind}" for kind, rows in fast.items())
    slow = {
        kind: np.mean([row["upward_out"] for row in of_kind(every, kind) if row["froude"] <= 10.0])
        for kind in (FINEST, "6 mm", JSC)
    }
    return (
        f"Without a pull the size of the grains decides: at a Froude number of 30 rebound {told}. Grains that pull as "
        f"lunar soil throw balls back: {share(PULLING)} from 4 mm at 1e-4 g, and {share('lunar, 4 mm, 1e-3 g')} at "
        f"1e-3 g and a Froude number of 30. Up to a Froude number of 10 a ball leaves with {slow[FINEST]:.3f} of its "
        f"speed from 4 mm, {slow['6 mm']:.3f} from 6 mm, and {slow[JSC]:.3f} (Teflon, 1e-3 g) from 6 mm that pull: the "
        f"size of the grains and the pull decide, and 0.05 lies between. From pebbles rebound {share('pebbles')} at a "
        f"restitution of 0.6, {share('pebbles, restitution 0.83')} at 0.83, that of rock on rock [Durda-2011]."
    )


EVERY: dict[str, Callable[[], str]] = {
    "beads": beads, "gravity": gravity, "grains": grains, "plate": plate, "packing": packing, "balls": balls,
    "rebounds": rebound,
}  # fmt: skip


def every() -> dict[str, str]:
    """Return all sentences by the key of their section."""
    return {key: tell() for key, tell in EVERY.items()}
