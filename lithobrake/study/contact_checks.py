"""What no contact law can answer, found before anything runs: how deep, how heavy, how light."""

import math
from collections.abc import Iterator

from lithobrake.study.bed_section import Constant
from lithobrake.study.quantity import usual_reach
from lithobrake.study.study import Study

# A lander heavier than so many of the largest grains outweighs every bed that a study may have; one lighter than the
# same part of the smallest grain bounces off as from a rock. Neither says anything about a soil.
GRAINS_PER_LANDER = 1e6
# Mass that is nearer to one point or farther out than so many times mass x radius^2 is a slip, and no equation of
# motion can be solved for it. Booms and panels that the shape leaves out may reach far.
INERTIAS = (1e-6, 1e2)
# A lander that is smaller than so much of a grain is a slip, too.
SMALLEST_LANDER = 1e-4


def size_problems(study: Study, radius: float) -> Iterator[str]:
    """A lander too small, or with inertia that its mass cannot have; radius [m]: of its farthest point."""
    lander = study.lander
    smallest = _grain_sizes(study)[0]
    if study.has_soil and radius < SMALLEST_LANDER * smallest:
        yield (
            f"the lander reaches {radius:.3g} m from its centre; allowed: at least {SMALLEST_LANDER * smallest:.3g} m, "
            f"{SMALLEST_LANDER:g} of the smallest grain; mend lander.edges, lander.diameter or lander.unit"
        )
    if lander.inertia is not None:
        low, high = (factor * mass * radius**2 for factor, mass in zip(INERTIAS, usual_reach(lander.mass), strict=True))
        if min(lander.inertia[:3]) < low or max(lander.inertia[:3]) > high:
            shown = ", ".join(f"{moment:g}" for moment in lander.inertia)
            yield (
                f"lander.inertia is [{shown}] kg m2; allowed: {low:.3g} to {high:.3g} kg m2, a millionth to a hundred "
                "times mass x radius^2; mend it, or leave it out for a homogeneous lander"
            )


def contact_problems(study: Study) -> Iterator[str]:
    """Landers and speeds at which the contact of the lander with a grain means nothing; for this program's own soil."""
    if study.contact.held_speed > 0.0 and study.contact.stepping != "local":
        yield (
            f'contact.held_speed is {study.contact.held_speed:g} with contact.stepping = "{study.contact.stepping}"; '
            'allowed above 0: "local" only; change either'
        )
    smallest, largest = _grain_sizes(study)
    thin, dense = usual_reach(study.grain.density)
    grain = _ball_mass(dense, largest)
    least, most = _ball_mass(thin, smallest) / GRAINS_PER_LANDER, grain * GRAINS_PER_LANDER
    low, high = usual_reach(study.lander.mass)
    if low < least or high > most:
        masses = f"is {low:.4g} kg" if low == high else f"reaches from {low:.4g} to {high:.4g} kg"
        yield (
            f"lander.mass {masses}; allowed: {least:.3g} to {most:.3g} kg, a millionth of the lightest grain to a "
            "million of the heaviest, as no soil answers to another lander; change it or the grains"
        )
        return
    radius = 0.5 * largest
    # That of a lander that is flown to the ground is not known before its flight.
    speed = 0.0 if study.impact.speed is None else usual_reach(study.impact.speed)[1]
    depth = _first_overlap(study, min(high, grain), radius, speed)
    if depth > radius:
        modulus = usual_reach(study.grain.young_modulus)[0]
        yield (
            f"impact.speed reaches {speed:.4g} m/s with grain.young_modulus down to {modulus:.3g} Pa, so the first "
            f"contact with a grain is {depth:.3g} m deep; allowed: at most the radius of a grain, {radius:.3g} m; "
            "lower the speed or raise Young's modulus"
        )


def _grain_sizes(study: Study) -> tuple[float, float]:
    """Diameters of the smallest and the largest grain [m]."""
    sizes = study.bed.diameter
    return (sizes.value,) * 2 if isinstance(sizes, Constant) else (sizes.lower, sizes.upper)


def _first_overlap(study: Study, mass: float, radius: float, speed: float) -> float:
    """Largest overlap [m] of a flat lander and a grain of a radius [m] at a speed [m/s].

    mass [kg]: of the lighter of the two, which for unlike bodies is that of the collision. Source: [Johnson-1985],
    Eq 11.23: (15 m v^2 / (16 E sqrt(R)))^(2/5) of a Hertz collision.
    """
    grain, lander, give = study.grain, study.lander, 0.0
    own = grain.young_modulus if lander.young_modulus is None else lander.young_modulus
    of_parts = [part.young_modulus for part in lander.part.values() if part.young_modulus is not None]
    ratio_of_lander = grain.poisson_ratio if lander.poisson_ratio is None else lander.poisson_ratio
    for softest, ratio in (
        (usual_reach(grain.young_modulus)[0], grain.poisson_ratio),
        (min([usual_reach(own)[0], *of_parts]), ratio_of_lander),
    ):
        give += (1.0 - usual_reach(ratio)[0] ** 2) / softest
    return float((15.0 * mass * speed**2 * give / (16.0 * math.sqrt(radius))) ** 0.4)


def _ball_mass(density: float, diameter: float) -> float:
    """Mass [kg] of a ball of a density [kg/m3] and a diameter [m]; infinite for absurd ones."""
    return density * math.pi / 6.0 * diameter * diameter * diameter
