"""What is wrong with the aims that a study is to choose from, found before anything runs."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from lithobrake.study.journey_sections import arrival_key
from lithobrake.study.lander_sides import directions_of_sides
from lithobrake.study.quantity import Uncertain, reach, uncertain
from lithobrake.study.question_sections import AimLimit, aim_results
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import closest, show

# A figure has two axes and a row of pictures; more aims than this nobody looks at.
MOST_AXES, MOST_AIMS = 3, 500
PLACES = {"site.latitude_deg": 90.0, "site.longitude_deg": 360.0, "site.heading_deg": 360.0}
# Landers go on from bounce to bounce, so the emulator has to know other impacts than the first.
NEEDED = ("impact.speed", "impact.incidence_deg")


def aim_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing wrong with the table [aim]; none where the study has no grid."""
    grid = study.aim.grid
    yield from _side_problems(study)
    if not study.aim.names:
        if study.aim.within:
            yield "aim.within is given without aim.grid; say there between which values there is to choose"
        return
    inputs = uncertain(study.touchdown_values())
    if study.design.method == "paper":
        yield 'aim.grid goes with design.method = "drawn", and it is "paper"; leave [aim] out, or draw the runs'
    absent = [name for name in NEEDED if name not in inputs and study.journey is None]
    if absent:
        yield (
            f"aim.grid follows landers from bounce to bounce, and {' and '.join(absent)} "
            f"{'is' if len(absent) == 1 else 'are'} no uncertain input; give a distribution that reaches over the "
            "impacts to come"
        )
    if study.delivery is not None and study.delivery.is_flown:
        yield (
            "aim.grid chooses how landers arrive at the surface, and [delivery] flies them there; leave one "
            "of the two out"
        )
    if study.site.roughness_deg and "delivery.incidence_deg" in grid:
        yield (
            'aim.grid has "delivery.incidence_deg", and site.roughness_deg draws the ground under each lander by its '
            "own incidence; leave one of the two out"
        )
    axes, count = len(study.aim.names), len(study.aim.aims())
    if axes > MOST_AXES or count > MOST_AIMS:
        yield (
            f"aim.grid has {axes} names, with aim.sides, and {count} aims; allowed: at most {MOST_AXES} and "
            f"{MOST_AIMS}; leave some values out"
        )
    yield from _value_problems(study, grid, inputs)
    yield from _limit_problems(study)


def _value_problems(
    study: Study, grid: Mapping[str, Sequence[float]], inputs: Mapping[str, Uncertain]
) -> Iterator[str]:
    """Names of a grid that nothing has, and values that its runs do not reach over."""
    known = (*(name for name in inputs if name.startswith("impact.")), *PLACES)
    if study.journey is not None:
        known = tuple(f"delivery.{name.partition('.')[2]}" for name in known)
    for option, values in grid.items():
        name = arrival_key(option)
        if option not in known:
            yield f'aim.grid."{option}" is no aim; allowed: {", ".join(known)}{closest(option, known)}'
            continue
        lower, upper = reach(inputs[name]) if name in inputs else (-PLACES[name], PLACES[name])
        inside = all(lower <= value <= upper for value in values)
        if not values or not inside or any(later <= earlier for earlier, later in pairwise(values)):
            yield (
                f'aim.grid."{option}" is {values}; allowed: ascending values from {lower:g} to {upper:g}, which the '
                "runs reach over; leave others out, or widen its distribution"
            )


def _side_problems(study: Study) -> Iterator[str]:
    """Sides that the lander does not have, or cannot be aimed with."""
    sides, known = study.aim.sides, tuple(directions_of_sides(study.lander))
    if not sides:
        return
    if study.journey is None:
        yield "aim.sides goes with [journey], which the study does not have; add it, or leave the sides out"
    if len(known) < 2:
        yield f"aim.sides is {show(sides)}, and all sides of the lander are alike; leave it out"
    elif not set(sides) <= set(known) or len(set(sides)) < len(sides):
        named = ", ".join(f'"{name}"' for name in known)
        yield f"aim.sides is {show(sides)}; allowed: some of {named}, each once; write them so"


def _limit_problems(study: Study) -> Iterator[str]:
    """Limits of the best aim that cannot be read, or name nothing."""
    of_grid = (name.partition(".")[2] for name in study.aim.grid)
    names = [*of_grid, *aim_results(is_journey=study.journey is not None)]
    for text in study.aim.within:
        limit = AimLimit.of(text)
        if limit is None or limit.name not in names:
            yield (
                f'aim.within has "{text}"; allowed: one of {", ".join(names)}, compared by <, <=, > or >= with a '
                'number, as in "incidence_deg < 45"; write it so'
            )
