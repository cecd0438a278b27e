"""What is wrong with the aims and the sky that a study asks about, found before anything runs."""

import importlib.util
import os
from collections.abc import Iterator, Sequence
from itertools import pairwise

from lithobrake.study.delivery_sections import ERROR_KEYS, FAR, FAST, OFFSETS, VELOCITY_OFFSETS
from lithobrake.study.design_sections import AIM_RESULTS, AimLimit
from lithobrake.study.lander_section import directions_of_sides
from lithobrake.study.limit_state_checks import option_states
from lithobrake.study.quantity import Uncertain, reach, uncertain
from lithobrake.study.study import Study
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.journey_names import JOURNEY_WORDS
from lithobrake.vocabulary.plain_text import closest, show
from lithobrake.vocabulary.quantities import ERRORS, REST_NUMBERS

# A figure has two axes and a row of pictures; more aims than this nobody looks at.
MOST_AXES, MOST_AIMS = 3, 500
# Errors so many times those of the study have nothing to do with them.
MOST_ERRORS = 100.0
PLACES = {"site.latitude_deg": 90.0, "site.longitude_deg": 360.0, "site.heading_deg": 360.0}
POLE = ("pole_right_ascension_deg", "pole_declination_deg")
# What tells where Sun and Earth are, by the module that each is imported by.
SKY_KEYS = {"spiceypy": "spiceypy", "erfa": "pyerfa"}


def aim_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing wrong with the table [aim]; none where the study has no grid."""
    grid = study.aim.grid
    yield from _side_problems(study)
    if not study.aim.names:
        for key in ("within", "best"):
            if getattr(study.aim, key):
                yield f"aim.{key} is given without aim.grid; say there between which values there is to choose"
        return
    is_flown = study.delivery is not None and study.delivery.is_flown
    if is_flown and study.aim.sides:
        yield (
            "aim.sides chooses the side down at the first touchdown, and [delivery] flies landers there from states; "
            "leave one of the two out"
        )
    if study.site.roughness_deg and "delivery.incidence_deg" in grid:
        yield (
            'aim.grid has "delivery.incidence_deg", and site.roughness_deg draws the ground under each lander by its '
            "own incidence; leave one of the two out"
        )
    axes, count = len(study.aim.names), study.aim.count
    if axes > MOST_AXES or count > MOST_AIMS:
        yield (
            f"aim.grid has {axes} names, with aim.sides, and {count} aims; allowed: at most {MOST_AXES} and "
            f"{MOST_AIMS}; leave some values out"
        )
    found = (option_problem(study, name, values, f'aim.grid."{name}"') for name, values in grid.items())
    yield from filter(None, found)
    yield from _limit_problems(study)


def option_ranges(study: Study) -> dict[str, tuple[float, float]]:
    """The dotted keys of [delivery] that a study can choose among, each from where to where its runs reach."""
    delivery = study.delivery
    if delivery is not None and delivery.is_flown:
        # What is told by the flights cannot be chosen, but where these begin.
        farthest = dict.fromkeys(OFFSETS, FAR) | dict.fromkeys(VELOCITY_OFFSETS, FAST)
        found = {f"delivery.{name}": (-most, most) for name, most in farthest.items()}
        return found | ({ERRORS: (0.0, MOST_ERRORS)} if delivery.release and delivery.release.has_errors else {})
    inputs = uncertain(study.touchdown_values())
    arrival = {name: reach(value) for name, value in inputs.items() if name.startswith("impact.")}
    arrival |= {name: (-most, most) for name, most in PLACES.items()}
    found = {f"delivery.{name.partition('.')[2]}": ends for name, ends in arrival.items()}
    has_errors = any(isinstance(getattr(study.site, key), Uncertain) for key in ERROR_KEYS)
    return found | ({ERRORS: (0.0, MOST_ERRORS)} if has_errors else {})


def option_problem(study: Study, option: str, values: Sequence[float], where: str) -> str | None:
    """What is wrong with the values of an option, in a sentence that begins with where they stand; None for nothing."""
    known = option_ranges(study)
    if option not in known:
        return f"{where} is no aim; allowed: {', '.join(known)}{closest(option, tuple(known))}"
    lower, upper = known[option]
    inside = all(lower <= value <= upper for value in values)
    if not values or not inside or any(later <= earlier for earlier, later in pairwise(values)):
        return (
            f"{where} is {show(values)}; allowed: ascending values from {lower:g} to {upper:g}, which the runs reach "
            "over; leave others out, or widen its distribution"
        )
    return None


def _side_problems(study: Study) -> Iterator[str]:
    """Sides that the lander does not have, or cannot be aimed with."""
    sides, known = study.aim.sides, tuple(directions_of_sides(study.lander))
    if not sides:
        return
    if len(known) < 2:
        yield f"aim.sides is {show(sides)}, and all sides of the lander are alike; leave it out"
    elif not set(sides) <= set(known) or len(set(sides)) < len(sides):
        named = ", ".join(f'"{name}"' for name in known)
        yield f"aim.sides is {show(sides)}; allowed: some of {named}, each once; write them so"


def _limit_problems(study: Study) -> Iterator[str]:
    """Limits of the best aim that cannot be read, or name nothing."""
    of_grid = (name.partition(".")[2] for name in study.aim.grid)
    states = option_states(study)
    names = [*of_grid, *AIM_RESULTS, *states]
    if study.aim.best is not None and study.aim.best not in states:
        known = ", ".join(states) or "none"
        told = ", ".join((*REST_NUMBERS, *JOURNEY_WORDS))
        yield (
            f'aim.best is "{study.aim.best}"; allowed: a limit state of journeys that uses no other names than {told} '
            f"(here: {known}); add it to [limit_states]"
        )
    for text in study.aim.within:
        limit = AimLimit.of(text)
        if limit is None or limit.name not in names:
            yield (
                f'aim.within has "{text}"; allowed: one of {", ".join(names)}, compared by <, <=, > or >= with a '
                'finite number, as in "incidence_deg < 45"; write it so'
            )


def sky_problems(study: Study) -> Iterator[str]:
    sky = study.sky
    far = [name for name in sky.bodies if name != "sun"]
    for key, default in (("mask_deg", 0.0), ("beam_deg", 90.0)):
        if getattr(sky, key) != default and not far:
            yield f"sky.{key} is of Earth and the orbiter, and neither is asked for; leave it out, or ask for one"
    yield from _date_problems(study)
    yield from _orbiter_problems(study)


def _date_problems(study: Study) -> Iterator[str]:
    """Dates that are none, and a date without what it needs."""
    sky, site = study.sky, study.site
    times: dict[str, Epoch] = {}
    epoch = None if sky.orbit is None else sky.orbit.epoch
    for name, text in (("date", sky.date), ("until", sky.until), ("orbit.epoch", epoch)):
        try:
            times |= {} if text is None else {name: Epoch.of(text)}
        except ValueError as error:
            yield f"sky.{name} {error}"
            return
    if sky.date is None:
        for key in ("until", "orbit"):
            if getattr(sky, key) is not None:
                yield f"sky.{key} goes with sky.date, which is absent; write it, or leave {key} out"
        return
    if sky.latitudes:
        name = next(iter(sky.latitudes))
        yield f"sky.{name}_latitude_deg is given, and sky.date tells it; leave one of the two out"
    if "until" in times and not times["date"] < times["until"]:
        yield f"sky.until is {sky.until}; allowed: later than sky.date, {sky.date}; change one of them"
    if site.kernels:
        if sky.orbit is not None:
            yield "sky.orbit is given, and site.kernels tell where the body is; leave one of the two out"
        yield from _kernel_problems(study, [text for text in (sky.date, sky.until) if text is not None])
        return
    lacking = [key for key in POLE if getattr(site, key) is None]
    if lacking:
        yield f"site.{lacking[0]} is missing; sky.date tells latitudes through the pole of the body; write it"
    if sky.orbit is None:
        yield "sky.orbit is missing; sky.date tells latitudes through the orbit of the body; write it, or site.kernels"
    absent = [package for module, package in SKY_KEYS.items() if importlib.util.find_spec(module) is None]
    if absent:
        yield f'sky.date needs {absent[0]}, which is not installed: pip install "lithobrake[spice]"'


def _kernel_problems(study: Study, dates: Sequence[str]) -> Iterator[str]:
    """Kernels that do not tell where Sun, Earth and orbiter are at both ends of the span; absent files are told of."""
    site, sky = study.site, study.sky
    if not all(os.path.isfile(path) for path in site.kernels):
        return
    from lithobrake.smallbody import read_places

    name = None if sky.orbiter is None else sky.orbiter.kernel_name
    for target in ("sun", "earth", *([] if name is None else [name])):
        try:
            read_places(site.kernels, site.kernel_body or site.body, target, dates)
        except (ValueError, ImportError) as error:
            yield f"sky.date: {error}"
            return


def _orbiter_problems(study: Study) -> Iterator[str]:
    """An orbiter that is given in no way, or in two, or whose file cannot be read."""
    sky, orbiter = study.sky, study.sky.orbiter
    if orbiter is None:
        return
    ways = orbiter.ways
    if len(ways) != 1:
        given = " and ".join(f"sky.orbiter.{way}" for way in ways) or "nothing"
        yield f"[sky.orbiter] has {given}; allowed: one of altitude, states, kernel_name; keep one"
        return
    if orbiter.inclination_deg is not None and ways != ["altitude"]:
        yield f"sky.orbiter.inclination_deg is that of a circle, and sky.orbiter has {ways[0]}; leave one of them out"
    if ways == ["kernel_name"]:
        needed = {"site.kernels": study.site.kernels, "sky.until": sky.until}
        lacking = [name for name, value in needed.items() if not value]
        if lacking:
            yield f"{lacking[0]} is missing; sky.orbiter.kernel_name is read from kernels, from sky.date to sky.until"
    if ways == ["states"]:
        from lithobrake.study.delivered_states import orbiter_states

        try:
            orbiter_states(study)
        except ValueError as error:
            yield f"sky.orbiter.states: {error}"
