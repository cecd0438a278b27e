"""What is wrong with beds, boulders, soils and contacts, found before anything runs."""

import math
import re
from collections.abc import Iterator
from pathlib import Path

from lithobrake.geometry.bed_limits import BOULDER_REACH, longest_reach
from lithobrake.study.ground_sections import BoulderSection, Constant, SoilSection, facet_numbers
from lithobrake.study.lander_checks import NAME
from lithobrake.study.quantity import Scalar, median, usual_reach
from lithobrake.study.study import Study
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.plain_text import closest, show
from lithobrake.vocabulary.quantities import ELSEWHERE

# A lander heavier than so many of the largest grains outweighs every bed that a study may have; one lighter than the
# same part of the smallest grain bounces off as from a rock. Neither says anything about a soil.
GRAINS_PER_LANDER = 1e6
# Mass that is nearer to one point or farther out than so many times mass x radius^2 is a slip, and no equation of
# motion can be solved for it. Booms and panels that the shape leaves out may reach far.
INERTIAS = (1e-6, 1e2)
# Of a point of the lander [m/s], as of the impact speed.
FASTEST = 1000.0
# Of what two grains at rest overlap by cohesion, over the radius of the smaller: Hertz' law is one of small overlaps.
DEEPEST_PULL = 0.1
# Young's modulus of a region over that of the bed, which is poured once for all regions.
STIFFER = 1e5
# A lander that is smaller than so much of a grain is a slip, too.
SMALLEST_LANDER = 1e-4
TWO_IMAGES = 'as with bed.sides = "periodic" nothing may meet another through two images'
# What the skins of lists of neighbours add to that (dem/bodies/vectors.py): of two grains, and of one and the lander.
SKINS, SKINS_AT_LANDER = 0.5, 0.7
# Share of the volume that the loosest bed fills.
LEAST_SOLID = 0.4
# Friction over the tangent of a slope with which beds of hulls were seen to hold, two to three grains deep.
LEAST_FRICTION = 0.4
# The stiffest grains [Pa].
STIFFEST = 1e13
# Part of the ground on which grains lie one beside the other, at least.
LEAST_COVER = 0.01


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


def material_problems(study: Study, region: str | None = None) -> Iterator[str]:
    """What this program's own soil cannot carry, with the grains of [grain] or of a region."""
    there = study if region is None else study.on_soil(region)
    yield from contact_problems(there)
    yield from cohesion_problems(there)
    yield from stiffness_problems(there, study.grain.young_modulus)


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
    # Masses first: the overlap below is meaningless for one out of range.
    if low < least or high > most:
        masses = f"is {low:.4g} kg" if low == high else f"reaches from {low:.4g} to {high:.4g} kg"
        yield (
            f"lander.mass {masses}; allowed: {least:.3g} to {most:.3g} kg, a millionth of the lightest grain to a "
            "million of the heaviest, as no soil answers to another lander; change it or the grains"
        )
        return
    speed = _impact_speed(study)
    if wrong := deep_contact(study, speed):
        yield f"impact.speed reaches {speed:.4g} m/s {wrong}; lower the speed or raise Young's modulus"


def cohesion_problems(study: Study) -> Iterator[str]:
    """Grains that pull each other deeper than the contact law describes; for this program's own soil."""
    grain, radius = study.grain, 0.5 * _grain_sizes(study)[0]
    line, softest = usual_reach(grain.surface_energy)[1], usual_reach(grain.young_modulus)[0]
    # Of two equal grains: half the radius of one, half the modulus of one.
    pull = usual_reach(grain.cohesion_force)[1] + 4.0 * math.pi * line * 0.5 * radius
    modulus = 0.5 * softest / (1.0 - usual_reach(grain.poisson_ratio)[0] ** 2)
    depth = (0.75 * pull / modulus / math.sqrt(0.5 * radius)) ** (2.0 / 3.0)
    if depth > DEEPEST_PULL * radius:
        yield (
            f"grain.surface_energy reaches {line:.4g} J/m2 and grain.cohesion_force "
            f"{usual_reach(grain.cohesion_force)[1]:.4g} N with grain.young_modulus down to {softest:.3g} Pa, so that "
            f"two grains pull each other {depth:.3g} m deep; allowed: at most {DEEPEST_PULL * radius:.3g} m, a tenth "
            "of the radius of the smallest grain; lower the cohesion (surface_energy is in J/m2), or raise Young's "
            "modulus"
        )


def stiffness_problems(study: Study, modulus: Scalar) -> Iterator[str]:
    """Grains so much stiffer than those that a bed is poured with, at the median of a Young's modulus [Pa], that it
    cannot take them on.
    """
    highest = usual_reach(study.grain.young_modulus)[1]
    if highest > STIFFEST:
        yield (
            f"grain.young_modulus reaches {highest:.3g} Pa; allowed: at most {STIFFEST:g} Pa, ten times that of "
            "diamond, as time steps shorten with it; lower it"
        )
        return
    # The median of some distributions takes SciPy, and hardly any study is near.
    if highest > STIFFER * usual_reach(modulus)[0] and highest > STIFFER * (poured := median(modulus)):
        yield (
            f"grain.young_modulus reaches {highest:.3g} Pa, and beds are poured with the median of [grain], "
            f"{poured:.3g} Pa; allowed: at most {STIFFER * poured:.3g} Pa, {STIFFER:g} times as much, as contacts of "
            "the bed are then too deep for the stiffer law; lower it, or raise that of [grain]"
        )


def spin_problems(study: Study, radius: float) -> Iterator[str]:
    """A spin that is too fast for a lander whose farthest point is at a radius [m]."""
    spin = math.hypot(*(max(map(abs, usual_reach(getattr(study.impact, f"spin_{axis}")))) for axis in "xyz"))
    if wrong := fast_spin(study, spin, radius):
        yield f"impact.spin_x, impact.spin_y and impact.spin_z reach {wrong}"


def fast_spin(study: Study, spin: float, radius: float) -> str | None:
    """A spin [rad/s] in words where the tip of the lander, at a radius [m], is too fast, or its contact means nothing.

    None where it is not.
    """
    tip, speed = spin * radius, _impact_speed(study)
    said = f"{spin:.4g} rad/s, at which the tip of the lander moves at {tip:.4g} m/s"
    if tip > FASTEST:
        return f"{said}; allowed: at most {FASTEST:g} m/s, as of impact.speed; lower the spin, and write it in rad/s"
    for one in (study, *map(study.on_soil, study.soil)) if study.has_soil else ():
        # What the speed alone makes too deep is refused by itself.
        if not deep_contact(one, speed) and (wrong := deep_contact(one, speed + tip)):
            return f"{said} {wrong}; lower the spin, and write it in rad/s, or raise Young's modulus"
    return None


def _impact_speed(study: Study) -> float:
    """The largest [m/s]; 0 of a lander that is flown to the ground, as it is not known before its flight."""
    return 0.0 if study.impact.speed is None else usual_reach(study.impact.speed)[1]


def deep_contact(study: Study, speed: float) -> str | None:
    """What a speed [m/s] of the first contact does to it, where that is deeper than a grain; None where it is not."""
    largest = _grain_sizes(study)[1]
    radius, mass = 0.5 * largest, usual_reach(study.lander.mass)[1]
    depth = _first_overlap(study, min(mass, _ball_mass(usual_reach(study.grain.density)[1], largest)), radius, speed)
    if depth <= radius:
        return None
    return (
        f"with grain.young_modulus down to {usual_reach(study.grain.young_modulus)[0]:.3g} Pa, so the first contact "
        f"with a grain is {depth:.3g} m deep; allowed: at most the radius of a grain, {radius:.3g} m"
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


def widths_in_grains(study: Study) -> tuple[float, float]:
    """Least width of ground that repeats over the largest diameter of a grain, and how much wider than the lander.

    The fewer its points, the longer a grain may be.
    """
    # Two bodies meet through two images where the period is no longer than twice the sum of their reaches and a skin.
    longest = longest_reach(study.bed.cloud_point_count)
    return 4.0 * longest + SKINS, 2.0 * longest + SKINS_AT_LANDER


def slope_problems(study: Study) -> Iterator[str]:
    """Grains that run down a slope one over the other, where no wall holds them."""
    steepest, friction = usual_reach(study.surface.slope_deg)[1], usual_reach(study.grain.friction)[0]
    least = LEAST_FRICTION * math.tan(math.radians(steepest))
    if study.bed.sides == "periodic" and friction < least:
        yield (
            f"surface.slope_deg reaches to {steepest:g} and grain.friction down to {friction:g}; allowed with "
            f'bed.sides = "periodic" is friction of at least {least:.3g}, {LEAST_FRICTION:g} of the tangent of the '
            "slope, as such grains run down the slope otherwise; raise grain.friction, lower the slope, or set "
            'bed.sides = "walls"'
        )


def cover_problems(study: Study) -> Iterator[str]:
    """Grains that are too few for the ground of their bed; for this program's own soil."""
    largest = _grain_sizes(study)[1]
    area, here = study.bed.grain_count * 0.25 * math.pi * largest * largest, math.prod(study.bed.width)
    if area < LEAST_COVER * here:
        yield (
            f"bed.width is {study.bed.width[0]:g} x {study.bed.width[1]:g} m, of which {study.bed.grain_count} grains "
            f"cover {percent(area / here, 2)}; allowed: at most {area / LEAST_COVER:.3g} m2, a hundredth of which "
            "they cover; narrow the bed, or raise bed.grain_count"
        )


def twin_problems(study: Study) -> Iterator[str]:
    """A shift of the impact point, for runs that measure chaos, by which another grain is hit."""
    smallest = _grain_sizes(study)[0]
    if study.design.side_runs and study.design.twin_shift > smallest:
        yield (
            f"design.twin_shift is {study.design.twin_shift:g} m; allowed: at most {smallest:g} m, the smallest grain, "
            "as another place says nothing of chaos; lower it"
        )


def boulder_problems(study: Study, largest: float, lander_radius: float) -> Iterator[str]:
    """Sizes and cover of boulders, and the least width of their bed; largest: diameter of a grain, all [m]."""
    if study.bed.boulders is None:
        return
    lower, upper = boulder_diameters(study.bed.boulders)
    if lower < largest:
        yield (
            f"bed.boulders.diameter reaches from {lower:g} m, and grains to {largest:g} m (bed.diameter); allowed: "
            f"boulders of at least {largest:g} m; raise it, or lower bed.diameter"
        )
    low, high = study.bed.boulders.cover
    highest, deepest = 2.0 * BOULDER_REACH * upper, _most_depth(study, largest)
    if low > high:
        yield f"bed.boulders.cover is [{low:g}, {high:g}] m; allowed: the smaller first; swap them"
    elif low < -highest or high > deepest:
        yield (
            f"bed.boulders.cover is [{low:g}, {high:g}] m; allowed: {-highest:.3g} m, as no boulder of {upper:g} m "
            f"stands higher, to {deepest:.3g} m, as {study.bed.grain_count} grains fill the bed no deeper; mend it"
        )
    width, least = min(study.bed.width), boulder_width(study, largest, lander_radius)
    if width < least:
        why = "as they lie between the walls" if study.bed.sides == "walls" else TWO_IMAGES
        yield (
            f"bed.width is {width:g} m at its narrowest; allowed: at least {least:.3g} m for boulders of {upper:g} m, "
            f"{why}; widen the bed and add grains, or lower bed.boulders.diameter"
        )


def _most_depth(study: Study, largest: float) -> float:
    """The depth [m] to which the grains of a bed would fill it if all were as large as the largest."""
    return study.bed.grain_count * _ball_mass(1.0, largest) / (LEAST_SOLID * math.prod(study.bed.width))


def boulder_diameters(section: BoulderSection) -> tuple[float, float]:
    """Diameters of the smallest and the largest boulder [m]."""
    sizes = section.diameter
    return (sizes.value,) * 2 if isinstance(sizes, Constant) else (sizes.lower, sizes.upper)


def boulder_width(study: Study, largest: float, lander_radius: float) -> float:
    """The least width of a bed with boulders [m]; 0 without any."""
    section = study.bed.boulders
    if section is None:
        return 0.0
    lower, upper = boulder_diameters(section)
    reach = BOULDER_REACH * upper
    if study.bed.sides != "periodic":
        return 2.0 * reach
    # Of the smallest a bed has most.
    count = section.coverage * study.bed.width[0] * study.bed.width[1] / (0.25 * math.pi * lower**2)
    # A second boulder may lie next to the first; a single one has grains or the lander next to it.
    beside = reach if count > 1.0 else max(longest_reach(study.bed.cloud_point_count) * largest, lander_radius)
    return 2.0 * (reach + beside) + SKINS * largest


def soil_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong; none where the study has no [soil]."""
    if not study.soil:
        return
    if study.design.side_runs:
        yield (
            "design.side_runs is true and makes first touchdowns again on a second soil, and [soil] gives regions "
            "their own; leave one of the two out"
        )
    kinds = () if study.ground is None else tuple(study.ground.kind)
    for name, soil in study.soil.items():
        yield from _region_problems(name, soil)
        if soil.ground is not None and soil.ground not in kinds:
            allowed = f"a kind of [ground]: {', '.join(kinds)}" if kinds else "nothing without [ground.kind.NAME]"
            yield f"soil.{name}.ground is {show(soil.ground)}; allowed: {allowed}{closest(soil.ground, kinds)}"
        if study.has_soil:
            # Problems of [grain] itself are reported already, and would be repeated for each region.
            known, found = list(material_problems(study)), material_problems(study, name)
            yield from (f"soil.{name}: {text}" for text in found if text not in known)


def _region_problems(name: str, soil: SoilSection) -> Iterator[str]:
    """A region without a name, bounds or a soil of its own, or that no ground can lie in."""
    key = f"soil.{name}"
    if not re.fullmatch(NAME, name, re.ASCII) or name == ELSEWHERE:
        yield (
            f'{key} is no name; allowed: letters, digits, _ and -, and not "{ELSEWHERE}", the ground of [grain]; '
            "rename it"
        )
    if not soil.has_bounds:
        yield f"{key} has no bounds; allowed: one at least of latitude_deg, longitude_deg, slope_deg, facets; add it"
    if not soil.grain.values() and soil.ground is None:
        yield f"{key}.grain is empty, so its soil is that of [grain]; write what differs there, or leave {key} out"
    if soil.longitude_deg is not None:
        west, east = soil.longitude_deg
        if east - west > 360.0 or (east - west) % 360.0 == 0.0:
            yield (
                f"{key}.longitude_deg is [{west:g}, {east:g}]; allowed: from one longitude eastward to another, less "
                "than once round; write [170, -170] for 20 degrees across 180, and leave it out for all longitudes"
            )
    if soil.facets is not None:
        try:
            facet_numbers(Path(soil.facets))
        except (ValueError, OSError) as error:
            said = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
            yield f"{key}.facets: {soil.facets}: {said}"
