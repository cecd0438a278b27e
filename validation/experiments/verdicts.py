"""What the rows of each experiment say of its causes: the numbers of the sentences of experiments_causes.md."""

from collections.abc import Callable
from typing import Any

import numpy as np
from ball_into_beads import BALL, FINE, FINER, LOOSE, OURS, ROLLING_STIFF
from beads_part import (
    STEP,
    SURFACES,
    agrees,
    bed_table,
    cause_of_diameter,
    diameter_table,
    mean_prefactor,
    pairs,
    pours,
    step_table,
    steps,
    steps_of_diameter,
)
from fits import (
    NOT_SHOWN,
    Estimate,
    below_mean_surface,
    column,
    density_exponent,
    gravity_exponents,
    leaving,
    mean_of,
    powers,
    said,
    speeds,
    stopping,
)
from low_gravity_parts import COHESION, RESISTS, compared, force_exponent
from page import parts_of
from plate_into_loose_grains import SPEED
from rebounds_part import FINEST, JSC, PULLING, rebounds
from result_rows import HERE, Row, read_rows
from settling_in_other_gravities import DIAMETER, EARTH, GRAINS, SHARES, SOFT
from stopping_force import FALLS
from stopping_part import measured_prefactor, stopping_numbers

Numbers = dict[str, Any]


def rows_of(name: str) -> list[Row]:
    return read_rows(HERE / f"{name}.csv")


def of_kind(rows: list[Row], kind: str) -> list[Row]:
    return [row for row in rows if row["kind"] == kind]


def beads() -> Numbers:
    """What walls, packing and the size of beads do to the exponents."""
    every = rows_of("ball_into_beads")
    beds = pairs(every)
    found = {name: density_exponent(*two, below_mean_surface) for name, two in beds.items()}
    moved = {words: found[after] - found[before] for words, before, after in steps(beds)}
    large = [f"{words} ({moved[words]:+.2f})" for words in moved if abs(moved[words]) > STEP]
    small = [f"{words} ({moved[words]:+.2f})" for words in moved if abs(moved[words]) <= STEP]
    inside = {text: [name for name, two in beds.items() if agrees(two, of)] for text, of in SURFACES.items()}
    nearer = all(cause_of_diameter(every, depth_of) != NOT_SHOWN for depth_of in SURFACES.values())
    stops = stopping([row for row in every if (row["bed"], row["diameter"]) == (FINE, BALL)])
    firmer = zip(beds[LOOSE], beds[f"{LOOSE}, {ROLLING_STIFF}"], strict=True)
    return {
        "steps": step_table(every), "beds": bed_table(every), "diameters": diameter_table(every), "step": STEP,
        "large": "; ".join(large) or "none", "small": "; ".join(small) or "none", "pours": pour_words(beds),
        "held": "; ".join(f"from {text} in {len(names)} of {len(beds)} beds" for text, names in inside.items()),
        "depths": [
            ", ".join(f"{100.0 * beds[name][k]['deepest']:.2f}" for name in (LOOSE, FINE, FINER)) for k in (0, 1)
        ],
        "less": [100.0 * (1.0 - after["deepest"] / before["deepest"]) for before, after in firmer],
        "heights": ", ".join(f"{fall:g}" for fall in FALLS), "prefactor": measured_prefactor().value,
        "loose": mean_prefactor(beds[FINE]), "dense": mean_prefactor(beds[OURS]), "least": min(stops),
        "most": max(stops),
        "larger": [", ".join(f"{one:.2f}" for one in steps_of_diameter(every, of)) for of in SURFACES.values()],
        "size": "It approaches the measured 2/3 as the ball spans more beads." if nearer
                else "No trend to 2/3 is seen.",
    }  # fmt: skip


def pour_words(beds: dict[str, tuple[Row, Row]]) -> str:
    """Say how far the exponents of several pours of one bed are apart."""
    spreads = []
    for bed, size in ((LOOSE, "5 mm"), (FINE, "3 mm")):
        own = pours(beds, bed)
        if len(own) > 1:
            found = {text: [density_exponent(*beds[name], of) for name in own] for text, of in SURFACES.items()}
            spread = " and ".join(f"{min(ones):.2f} to {max(ones):.2f} from {text}" for text, ones in found.items())
            spreads.append(f"The exponents of {len(own)} pours of the loose bed of {size} are {spread}.")
    return " ".join(spreads)


def gravity() -> Numbers:
    """What the modulus does to a sphere that settles."""
    every = rows_of("settling_in_other_gravities")
    rows, soft = ([row for row in every if row["young_modulus"] == one] for one in (GRAINS.young_modulus, SOFT))

    def deep(rows: list[Row], share: float) -> str:
        return f"{np.mean(column([row for row in rows if row['share'] == share], 'depth')) / DIAMETER:.2f}"

    hard, found = gravity_exponents(rows), gravity_exponents(soft)
    least = GRAINS.young_modulus / (GRAINS.density * EARTH * DIAMETER)
    return {
        "least": 1e3 * round(1e-3 * least), "soft": deep(soft, 1.0), "soft_depth": said(found["depth"]),
        "soft_time": said(found["stopping_time"]), "depth": said(hard["depth"]), "time": said(hard["stopping_time"]),
        "light": deep(soft, SHARES[-1]), "hard": deep(rows, 1.0),
    }  # fmt: skip


def grains() -> Numbers:
    every = rows_of("grain_on_its_own_kind")
    base, half = of_kind(every, "basalt"), of_kind(every, "restitution 0.5")
    kinds = [name for name in dict.fromkeys(row["kind"] for row in every) if name != "basalt"]
    others = [mean_of(speeds(of_kind(every, name))).value for name in kinds]
    left = [mean_of(leaving(of_kind(every, name))).value for name in kinds]
    risen, risen_half = ([np.mean(column(of, f"risen_{rise}")) for rise in ("0.1", "0.5")] for of in (base, half))
    return {
        "stay": 100.0 * (1.0 - len(leaving(base)) / len(base)), "kept": mean_of(leaving(base)).value,
        "least": min(others), "most": max(others), "least_left": min(left), "most_left": max(left), "risen": risen,
        "half": risen_half,
    }  # fmt: skip


def plate() -> Numbers:
    """The flight, the corners and the exponent."""
    every = rows_of("plate_into_loose_grains")
    ran = [row for row in every if row["series"] == "speeds"]
    free, pulled = ([row for row in ran if row["cohesion"] == pull] for pull in (0.0, 10.0))
    dense = [row for row in every if row["series"] == "corners" and row["filled"] >= 0.6]
    right = [row["speed_6"] < RESISTS * SPEED for row in dense]
    expected = [row["cohesion"] >= COHESION or "rough" in row["name"] for row in dense]
    return {
        "speed": {row["name"]: f"{row['speed_6']:.3f}" for row in every},
        "alike": sum(a == b for a, b in zip(right, expected, strict=True)),
        "free": said(force_exponent(free)), "pulled": said(force_exponent(pulled)),
    }  # fmt: skip


def packing() -> Numbers:
    """Cohesion is the cause."""
    rows, spreads = rows_of("packing_and_cohesion"), []
    for kind in dict.fromkeys(row["kind"] for row in rows):
        none = column([row for row in of_kind(rows, kind) if row["pull"] <= 0.3], "solid_fraction")
        spreads.append(f"{none.max() - none.min():.4f} ({kind})")
    return {"spreads": ", ".join(spreads)}


def balls() -> Numbers:
    """Stiffness, and a contradiction between two sources; depths and exponents on beads that pull."""
    every = rows_of("ball_under_gravities")
    rows, soft, pulled = compared(every), of_kind(every, "plain"), of_kind(every, "pulling")
    by_speed, by_gravity = reach_powers([row for row in rows if row["froude"] < 3.0])
    pulled_by_speed, pulled_by_gravity = reach_powers(pulled)
    found, before = (powers(column(own, "duration_in_units"), column(own, "share"))[0] for own in (rows, soft))
    mean = column(pulled, "speed").mean()
    fast = sorted((row for row in pulled if row["speed"] > mean), key=lambda row: row["share"], reverse=True)
    fewer = (fast[1]["share"] / fast[0]["share"]) ** reach_powers(rows)[1].value
    return {
        "gravity": said(by_gravity), "speed": said(by_speed), "fast": fast,
        "deep": [100.0 * (row["depth"] + row["touch_height"]) for row in fast], "deeper": 100.0 * (fewer - 1.0),
        "pulled": len(pulled), "pulled_gravity": said(pulled_by_gravity), "pulled_speed": said(pulled_by_speed),
        "soft": durations(soft), "stiffer": durations(rows), "before": said(before), "after": said(found),
    }  # fmt: skip


def durations(rows: list[Row]) -> str:
    """Return the durations of drops under Earth's gravity, in sqrt(D/g)."""
    return ", ".join(f"{row['duration_in_units']:.2f}" for row in rows if row["share"] == 1.0)


def reach_powers(rows: list[Row]) -> list[Estimate]:
    """Return the exponents of speed and of gravity for the depth below the first touch."""
    reach = column(rows, "depth") + column(rows, "touch_height")
    return powers(reach, column(rows, "speed"), column(rows, "share"))


def rebound() -> Numbers:
    """What size of the grains, pull and restitution do to balls on grains."""
    every = rows_of("who_rebounds")

    def share(kind: str) -> str:
        rows = of_kind(every, kind)
        return f"{rebounds(rows)} of {len(rows)}"

    fast = {kind: [row for row in of_kind(every, kind) if row["froude"] == 30.0] for kind in ("6 mm", FINEST, "3 mm")}
    return {
        "counts": ", ".join(f"{rebounds(rows)} of {len(rows)} on {kind}" for kind, rows in fast.items()),
        "lunar": [share(PULLING), share("lunar, 4 mm, 1e-3 g")],
        "pebbles": [share("pebbles"), share("pebbles, restitution 0.83")],
        "slow": [
            np.mean([row["upward_out"] for row in of_kind(every, kind) if row["froude"] <= 10.0])
            for kind in (FINEST, "6 mm", JSC)
        ],
    }  # fmt: skip


EVERY: dict[str, Callable[[], Numbers]] = {
    "beads": beads, "stopping": stopping_numbers, "gravity": gravity, "grains": grains, "plate": plate,
    "packing": packing, "balls": balls, "rebounds": rebound,
}  # fmt: skip


def every() -> dict[str, str]:
    """Return all sentences by the key of their section."""
    words = parts_of("experiments_causes")
    return {key: words[key].format(**numbers()) for key, numbers in EVERY.items()}
