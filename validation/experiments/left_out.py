"""Sizes of what the model of a landing leaves out: the numbers of docs/what_the_model_leaves_out.md.

    python validation/experiments/left_out.py

Prints the tables of that page. The landing is that of scenarios/first_bounce.toml: a box of 2 kg on grains of 9 cm;
durations are those of the touchdowns of showcase/mission.
"""

import csv
import math
import statistics
from pathlib import Path

from lithobrake.dem import contact_duration
from lithobrake.smallbody import dimorphos
from lithobrake.vocabulary.number_words import duration

TOUCHDOWNS = Path(__file__).parents[2] / "showcase" / "mission" / "runs" / "touchdowns.csv"

GRAVITY, SPEEDS = 5e-5, (0.4, 0.05)  # m/s2, m/s
DENSITY, POISSON, GRAIN = 2500.0, 0.25, 0.09  # kg/m3, -, m across
LANDER_MASS, EDGES = 2.0, (0.1, 0.1, 0.227)  # kg, m
# Young's moduli [Pa]: the middle of the scenario's range, and two that stand for weak and for sound rock.
MODULI = {"soft, as in the scenario": 1.6e6, "weak rock": 1e9, "sound rock": 5e10}
# Strengths [Pa] and what modulus goes with them.
STRENGTHS = {
    "weak carbonaceous simulant": (1.8e6, 1e9), "weakest ordinary chondrite": (6e6, 1e9),
    "strongest ordinary chondrite": (260e6, 5e10),
}  # fmt: skip
PERMITTIVITY, SUNLIGHT = 8.854e-12, 4.54e-6  # F/m; Pa, pressure of absorbed sunlight at 1 au
LUNAR_PULL = 0.036  # N/m, pull over contact radius between clean grains of lunar soil


def grain_mass(diameter: float) -> float:
    """Return the mass [kg] of a grain of a diameter [m]."""
    return DENSITY * math.pi / 6.0 * diameter**3


def pair() -> tuple[float, float]:
    """Return effective mass [kg] and radius [m] of lander and grain, as the contact law has them."""
    radius = (3.0 * math.prod(EDGES) / (4.0 * math.pi)) ** (1.0 / 3.0)
    grain = grain_mass(GRAIN)
    return LANDER_MASS * grain / (LANDER_MASS + grain), 1.0 / (1.0 / radius + 2.0 / GRAIN)


def effective_modulus(young: float) -> float:
    """Return E* [Pa] of two bodies of one Young's modulus [Pa]."""
    return 0.5 * young / (1.0 - POISSON**2)


def peak(young: float, speed: float) -> tuple[float, float, float]:
    """Return largest overlap [m], force [N] and pressure [Pa] of an elastic Hertz impact at a speed [m/s]."""
    mass, radius = pair()
    modulus = effective_modulus(young)
    stiffness = 4.0 / 3.0 * modulus * math.sqrt(radius)
    overlap = (1.25 * mass * speed**2 / stiffness) ** 0.4
    force = stiffness * overlap**1.5
    return overlap, force, (6.0 * force * modulus**2 / (math.pi**3 * radius**2)) ** (1.0 / 3.0)


def yield_speed(strength: float, young: float) -> float:
    """Return the speed [m/s] from which on a Hertz impact yields: peak pressure 1.6 times the strength [Pa]."""
    mass, radius = pair()
    modulus = effective_modulus(young)
    overlap = radius * (math.pi * 1.6 * strength / (2.0 * modulus)) ** 2
    return math.sqrt(0.8 * 4.0 / 3.0 * modulus * math.sqrt(radius) * overlap**2.5 / mass)


def bond(diameter: float, cleanliness: float) -> float:
    """Return the pull between two grains of a diameter [m] over the weight of one."""
    return LUNAR_PULL * cleanliness**2 * diameter / 4.0 / (grain_mass(diameter) * GRAVITY)


def lofted(field: float) -> float:
    """Return the diameter [m] of the grain without cohesion whose weight a field [V/m] carries."""
    return 1.5 * PERMITTIVITY * field**2 / (DENSITY * GRAVITY)


def contact_lines() -> list[str]:
    mass, radius = pair()
    lines = [
        "| grains and lander | Young's modulus [Pa] | speed [m/s] | duration [s] | overlap [mm] | force [N] | "
        "pressure [MPa] |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, young in MODULI.items():
        for speed in SPEEDS:
            overlap, force, pressure = peak(young, speed)
            time = contact_duration(mass, radius, effective_modulus(young), speed)
            lines.append(
                f"| {name} | {young:.2g} | {speed:g} | {time:.2g} | {1e3 * overlap:.2g} | {force:.2g} | "
                f"{1e-6 * pressure:.2g} |"
            )
    return lines


def yield_lines() -> list[str]:
    """Return the table of yield speeds and of what the energy of a landing can crush at most."""
    lines = [
        "| rock | strength [MPa] | Young's modulus [Pa] | yields above [mm/s] | crushed at most at 0.4 m/s [mm3] |",
        "|---|---|---|---|---|",
    ]
    energy = 0.5 * LANDER_MASS * 0.4**2
    for name, (strength, young) in STRENGTHS.items():
        lines.append(
            f"| {name} | {1e-6 * strength:.2g} | {young:.2g} | {1e3 * yield_speed(strength, young):.2g} | "
            f"{1e9 * energy / strength:.2g} |"
        )
    return lines


def cohesion_lines() -> list[str]:
    lines = ["| grains | pull / weight, S = 1 | S = 0.1 |", "|---|---|---|"]
    for diameter, name in ((0.001, "1 mm"), (0.01, "1 cm"), (0.09, "9 cm"), (0.5, "50 cm")):
        lines.append(f"| {name} | {bond(diameter, 1.0):.2g} | {bond(diameter, 0.1):.2g} |")
    return lines


def force_lines() -> list[str]:
    """Return the table of small forces on the lander, as the change of its speed in a touchdown of a second."""
    area, rows = EDGES[0] * EDGES[2], []
    rows.append(("weight", LANDER_MASS * GRAVITY))
    rows.append(("sunlight at 1 au", SUNLIGHT * area))
    rows += [(f"electric field of {name} V/m", PERMITTIVITY * f**2 * area) for name, f in (("5", 5.0), ("1e5", 1e5))]
    rows.append(("a contact that pulls like clean lunar soil", LUNAR_PULL * pair()[1]))
    lines = ["| on the lander | force [N] | changes its speed in 1 s by [m/s] |", "|---|---|---|"]
    return lines + [f"| {name} | {force:.2g} | {force / LANDER_MASS:.2g} |" for name, force in rows]


def duration_lines() -> list[str]:
    """Return the table of the time from first to last touch, and of the angle by which the body turns in it."""
    with TOUCHDOWNS.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    lines = [
        "| touchdown | count | median | longest | Dimorphos turns in it by up to [deg] |",
        "|---|---|---|---|---|",
    ]
    for outcome, words in (("clear", "the lander leaves"), ("captured", "the lander comes to rest")):
        times = [float(row["output:contact_duration [s]"]) for row in rows if row["outcome"] == outcome]
        turn = 360.0 * max(times) / dimorphos(partner=False).spin_period
        ends = f"{duration(statistics.median(times))} | {duration(max(times))}"
        lines.append(f"| {words} | {len(times)} | {ends} | {turn:.2g} |")
    return lines


if __name__ == "__main__":
    for table in (contact_lines(), yield_lines(), cohesion_lines(), force_lines(), duration_lines()):
        print("\n".join(table), "\n")
    print(f"carried by 5 V/m: {lofted(5.0):.2g} m, by 1e5 V/m: {lofted(1e5):.2g} m")
