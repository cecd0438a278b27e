"""What a user should know of a study before it runs: nothing here is an error, and all of it may be meant."""

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.analysis.confidence import t_quantile
from lithobrake.chaos import smolyak_count, term_count
from lithobrake.pipeline.design.arrivals import smallest_width
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil
from lithobrake.study import Study
from lithobrake.study.quantity import Scalar, Uncertain, uncertain
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_INTERVAL
from lithobrake.vocabulary.material_properties import SHARED_PROPERTIES
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.quantities import PLACE

if TYPE_CHECKING:
    from lithobrake.touchdown import Lander, Landing

# Pull of one contact over the weight of the lander: clean lunar soil pulls a CubeSat on Dimorphos with some 16 weights.
STICKY = 1000.0
# A share of touchdowns that may be cut off without a word [-].
CUT_OFF = 0.05
# A smaller share of delivered landers that reach the ground is hardly meant [-].
FEW_REACH = 0.5
# A uniform distribution over more than this, largest over smallest value, hardly ever draws what is small.
WIDE = 100.0
# Fewer runs a term than this, and a least-squares fit follows single runs.
RUNS_A_TERM = 1.5


def study_warnings(design: DrawnDesign, soil: ExpectedSoil | None) -> list[str]:
    study, site = design.study, design.site
    ground = [*site.cautions, *filter(None, (site.warning, site.gravity_warning))]
    touchdown = (
        []
        if soil is None
        else [*_bed(soil), *_cohesion(soil), *_sides(design, soil), *_time_limit(study, soil), *_never_count(study)]
    )
    return [
        *_missed(design),
        *ground,
        *touchdown,
        *_wide(study),
        *_terms(design),
        *_few_beds(study),
        *_one_place(design),
    ]


def _missed(design: DrawnDesign) -> Iterator[str]:
    """Landers that are delivered as states, of which many never reach the ground."""
    if design.descents is None:
        return
    down = design.descents.touches_down
    if down.mean() < FEW_REACH:
        yield (
            f"Only {int(down.sum())} of {len(down)} landers reach the ground, and only these have touchdowns: times, "
            "places and sides at rest will come from them alone; change the states or [delivery.release], or raise "
            "journey.duration where they still fly."
        )


def _bed(soil: ExpectedSoil) -> Iterator[str]:
    """A bed whose walls or images, or whose floor answers."""
    from lithobrake.touchdown import smallest_bed

    body, landing = soil.landings[0]
    width, depth = smallest_bed(body, landing.grain, soil.diameter, landing.speed)
    here = min(soil.recipe.width)
    # A wider bed of as many grains is shallower.
    wide, deep = max(here, width), max(soil.depth, depth)
    count = math.ceil(soil.recipe.grain_count * deep / soil.depth * (wide / here) ** 2)
    if here < width or soil.depth < depth:
        yield (
            f"The bed will be about {soil.depth:.2g} m deep and is {here:g} m wide; it must be at least {depth:.2g} m "
            f"deep and {width:.2g} m wide to avoid {_echo(soil)} during the first impact: set bed.grain_count = {count}"
            f"{f', and bed.width = {wide:.2g} m' if wide > here else ''}."
        )


def _cohesion(soil: ExpectedSoil) -> Iterator[str]:
    """Contacts that pull far more than the lander weighs."""
    from lithobrake.dem.law.restitution import pair_law

    radius, most = 0.5 * soil.diameter, (0.0, 0.0)
    for body, landing in soil.landings:
        law = pair_law(landing.grain, body.own_material, landing.contact.shear_modulus_rule, landing.contact.pair_rule)
        pull, weight = law.cohesion_force + law.cohesion_line * radius, body.mass * math.hypot(*landing.gravity)
        most = max(most, (pull / weight, pull)) if weight > 0.0 else most
    if most[0] > STICKY:
        yield (
            f"One contact of the lander with a grain pulls with up to {most[1]:.2g} N, {most[0]:.2g} times the weight "
            "of the lander, which may then never leave the ground: check surface_energy (J/m2; is it in mJ/m2?) and "
            "cohesion_force (N)."
        )


def _echo(soil: ExpectedSoil) -> str:
    """What comes back to the lander in a bed that is too small."""
    return "boundary reflections" if soil.recipe.period is None else "reflections and waves of the lander's own images"


def _sides(design: DrawnDesign, soil: ExpectedSoil) -> Iterator[str]:
    """What the walls of a bed do to the landings; ground that repeats has none."""
    if soil.recipe.period is None:
        yield from _rim(design, soil)
        yield from _lost(soil)


def _rim(design: DrawnDesign, soil: ExpectedSoil) -> Iterator[str]:
    """A lander that comes down over the edge of the bed."""
    reach, region = soil.landings[0][0].reach, design.region
    for number, (axis, name, width) in enumerate(zip("xy", PLACE, soil.recipe.width, strict=True)):
        low, high = region[number] if region else _reach(design.study.touchdown_values()[name])
        room = 0.5 * width - reach
        if max(-low, high) > room:
            yield (
                f"The lander reaches {reach:.2g} m to each side, so along {axis} it may land across the edge of the "
                f"bed: keep impact.{'region' if region else 'place'}.{axis} within {room:.2g} m of the middle, or "
                "widen the bed."
            )


def _lost(soil: ExpectedSoil) -> Iterator[str]:
    """Landings that will leave the bed laterally after they have come down on it."""
    share = expected_loss(soil.landings[1:], min(soil.recipe.width))
    if share > CUT_OFF:
        yield (
            f"About {percent(share)} of the landings may leave the bed laterally at these impact angles and have no "
            "outcome: medians, parts of the variance and the emulator will describe only the others, and every "
            "fraction will be uncertain by as much; widen the bed (bed.width, with bed.grain_count), or "
            "keep impact.incidence_deg steeper."
        )


def _time_limit(study: Study, soil: ExpectedSoil) -> Iterator[str]:
    """Touchdowns that may be cut off; those of a journey go on for as long as that."""
    limit = study.landing.time_limit
    if limit is None:
        return
    times = [soil.touchdown_time(*landing) for landing in soil.landings[1:]]
    share = sum(time > limit for time in times) / len(times)
    if share > CUT_OFF:
        yield (
            f"About {percent(share)} of the touchdowns may last longer than landing.time_limit, "
            f"{limit:g} s, and then have no outcome (longest: about {max(times):.2g} s): raise it."
        )


def _never_count(study: Study) -> Iterator[str]:
    """Properties of the lander and its parts that no contact takes."""
    values = study.touchdown_values() if study.contact.pair_rule == "smaller" else {}
    tables = ("lander", *(f"lander.part.{part}" for part in study.lander.part))
    for table, name in product(tables, SHARED_PROPERTIES):
        own, rock = values.get(f"{table}.{name}"), values.get(f"grain.{name}")
        if own is not None and rock is not None and own != rock and _reach(own)[0] >= _reach(rock)[1]:
            yield (
                f'{table}.{name} has no effect: contact.pair_rule = "smaller" takes grain.{name}, which is smaller; '
                'use "mean" or "geometric", or leave it out.'
            )


def _wide(study: Study) -> Iterator[str]:
    """Uniform distributions over decades."""
    for name, value in uncertain(study.touchdown_values() | study.site_values()).items():
        lower, upper = _reach(value)
        if value.distribution == "uniform" and lower > 0.0 and upper > WIDE * lower:
            yield (
                f"{name} is uniform from {lower:g} to {upper:g}: {percent(0.9)} of its values are above "
                f"{upper / 10:.2g}; use log_uniform for equal weight on each decade."
            )


def _terms(drawn: DrawnDesign) -> Iterator[str]:
    """Fits with hardly more runs than terms."""
    design, count = drawn.study.expansion, len(drawn.inputs)
    if design is None or design.fit != "ols":
        return
    runs = design.screening_count or smolyak_count(count, design.screening_level)
    terms = term_count(count, design.screening_degree)
    if runs < RUNS_A_TERM * terms:
        yield (
            f"The screening fits {terms} terms to {runs} runs, and runs that do not rebound do not count: a fit "
            f"with less than {RUNS_A_TERM:g} runs per term overfits; lower expansion.screening_degree, or add "
            "runs."
        )


def _few_beds(study: Study) -> Iterator[str]:
    """Beds that give no interval, or a wide one."""
    if not study.design.run_count or study.bed_count >= FEWEST_BEDS_OF_INTERVAL:
        return
    enough = FEWEST_BEDS_OF_INTERVAL
    if study.bed_count == 1:
        yield (
            "All runs land on one bed, and another bed would change the result: no number of this study will have an "
            f"interval; set bed.bed_count to {enough} or more, or leave it out."
        )
        return
    wider = t_quantile(study.bed_count - 1) / t_quantile(FEWEST_BEDS_OF_INTERVAL - 1) - 1.0
    remedy = "set bed.bed_count" if study.bed.bed_count is not None else study.as_written("raise design.run_count")
    yield (
        f"The runs land on {study.bed_count} beds, and the bed is the unit of an interval: so few make it "
        f"{percent(wider)} wider than {enough} would, by Student's t alone; {remedy} to {enough} or more."
    )


def _one_place(design: DrawnDesign) -> Iterator[str]:
    """An answer that holds for one place of one bed."""
    study = design.study
    if not design.one_place:
        return
    if study.design.run_count:
        yield (
            "All runs land at the same point of their beds: give impact.region, or a bed wider than "
            f"{smallest_width(study):.2g} m, in whose middle impact points are sampled."
        )
    elif study.bed_count == 1 and study.has_soil:
        yield (
            "All runs land at the same point of the same bed, so the result holds for these boulders only: raise "
            "bed.bed_count, or sample impact points in impact.region."
        )


def _reach(value: Scalar) -> tuple[float, float]:
    return value.support() if isinstance(value, Uncertain) else (value, value)


# Incidence from the normal [deg], and share of the landings that left the bed laterally: 1 of 64 and 57 of 112 with the
# recipe of scenarios/first_bounce.toml (0.7 m wide, a box with a bounding radius of 0.13 m) at 15 and 75 deg,
# two thirds of its impacts above 80 deg; 23 of 870 of drawn_700.toml and drawn_170.toml in validation/studies (2.4 m,
# 0.22 m) at 30 deg. First touchdowns over 0 to 88 deg lost 66 of 300; this table gives 24 %.
MEASURED = ((15.0, 1 / 64), (30.0, 23 / 870), (75.0, 57 / 112), (85.0, 2 / 3))
# Half the width of the bed over the bounding radius of the lander, in those at 75 deg and above.
MEASURED_ROOM = 2.6
# Below this angle [deg] landings are lost near where they come down, whatever the width of the bed.
STEEP = 30.0


def expected_loss(landings: "Sequence[tuple[Lander, Landing]]", width: float) -> float:
    """Share of these landings that will leave a bed of this width [m] laterally, interpolated between MEASURED.

    What is lost beyond the share of steep landings falls with the width of the bed over the size of the lander.
    """
    angles, lost = np.array(MEASURED).T
    incidence = np.array([np.degrees(one.incidence) for _, one in landings])
    room = np.array([0.5 * width / lander.reach for lander, _ in landings])
    shares = np.interp(incidence, angles, lost)
    steep = np.minimum(shares, np.interp(STEEP, angles, lost))
    return float(np.mean(steep + (shares - steep) * np.minimum(1.0, MEASURED_ROOM / room)))
