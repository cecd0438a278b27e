"""How long a study will take and how much room, from its steps and the speed of this machine."""

import math
import os
import statistics
import time
from collections.abc import Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.campaign import Record, available_cores
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil, PlannedRuns
from lithobrake.pipeline.runs.landings import landing_files, telling_files
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.vocabulary.quantities import OUTPUTS

if TYPE_CHECKING:
    from lithobrake.touchdown import Lander, Landing

NUMBER = 8
# A bed: hulls, poses and frames of a grain, and the history, a row in every eight steps.
BED_GRAIN, BED_STEP = 1400, 4
LANDING_BODY = 11_800  # poses of a body and forces on it in all frames of a landing
LEDGER_RUN = 5_000
FLIGHT_ROW, JOURNEY_ROW = 270, 120
SHAPE_FACET = 45
TOUCHDOWNS = 4  # of a journey
REPORT_BYTES = 7_500_000  # page and figures, with expansions, scores and summary
# CPU time [s] of the piece of work where the times of expected_time.py were measured (benchmarks/plan_estimate.json).
REFERENCE = 0.22
EDGE, STEPS, TIME_STEP = 4, 10_000, 1e-4
Span = tuple[float, float]
# A common step of a landing: of the bed, of each grain [s]; and of each grain of a bed that settles, which is looked at
# more often.
LANDING_STEP, LANDING_GRAIN = 3.5e-5, 5.0e-7
SETTLING_GRAIN = 8.0e-7
# Contacts at steps of their own: for each grain that moves and each duration of the shortest contact, at no steps a
# contact and for each [s]. Where what is slower than a share of the lander is held, so many move for each grain that
# is too near to be held, over the share.
LOCAL_GRAIN, LOCAL_LOOK, MOVING = 2.7e-6, 7.2e-8, 0.5
# Of that, where slow collisions take fewer steps.
SLOW_PART = 0.42
# A grain at rest in a journey's touchdown, each period [s].
RESTING_GRAIN = 3.0e-5
COMPILING = 60.0  # s
# Flights and journeys over a body of FACETS facets [s]: by the table, once it is built, and by the facets' sum.
FACETS, TABLE, FLIGHT, EXACT_FLIGHT, JOURNEY, EXACT_JOURNEY = 1920, 10.0, 2.0e-4, 3.5e-3, 1.1e-3, 2.0e-2
REPORT_SECONDS = 15.0  # s: fits, scores, samples, summary and page
# An estimate and the time that it then took differ by these factors, either way; that of touchdowns by the second, and
# of those of journeys, over the beds of a study, by the third.
SPREAD, SPREAD_OF_TOUCHDOWNS, SPREAD_OF_JOURNEYS = 2.0, 3.0, 2.0
# So many runs of a study tell how long the others take, to this factor at best.
RUNS_THAT_TELL, SPREAD_OF_RUNS = 5, 1.15
BUSY = 0.7  # of the cores: a load above this is other work


def expected_bytes(design: DrawnDesign, runs: PlannedRuns, soil: ExpectedSoil | None) -> dict[str, int]:
    """Bytes at most of the files of a finished study, by what they hold; what a program of one's own leaves apart."""
    study = design.study
    flights, journeys = flight_count(study), followed_count(study)
    # The outcome takes one byte.
    row = NUMBER * (len(design.inputs) + len(OUTPUTS) * (1 + study.monte_carlo.scatter)) + 1
    found = {
        "runs": LEDGER_RUN * runs.total * (1 if study.journey.touchdowns == 1 else TOUCHDOWNS),
        "samples": study.sample_count * row,
        "flights": FLIGHT_ROW * flights + JOURNEY_ROW * journeys + SHAPE_FACET * len(design.site.body.shape.faces),
        "report": REPORT_BYTES,
    }
    if soil is not None:
        grains = soil.recipe.grain_count
        one = BED_GRAIN * grains + BED_STEP * round(soil.pour_steps())
        shown = len(landing_files(study) + telling_files(study))
        found["beds"] = study.bed_count * one + shown * LANDING_BODY * (grains + 1)
    return found


def flight_count(study: Study) -> int:
    """Flights at most, with those of the expansion alone beside those with scatter."""
    count = min(study.flight.flight_count or study.sample_count, study.sample_count)
    return count * (1 + study.monte_carlo.scatter)


def followed_count(study: Study) -> int:
    """Landers that a model follows to rest: the emulator, and hard ground with its equivalent of the soil."""
    drawn = study.design.run_count > 0
    return (study.journey.emulated_count or 0) * drawn + study.hard_ground.count * (1 + drawn)


@cache
def machine_pace() -> float | None:
    """CPU time here over that of the reference machine; None where the engine has yet to be compiled."""
    return probe() / REFERENCE if engine_is_compiled() else None


def engine_is_compiled() -> bool:
    from lithobrake.compilation.compiled import lies_on_disk
    from lithobrake.dem.stepping.time_loop import advance

    return lies_on_disk(advance)


def probe() -> float:
    """CPU time [s] of a heap of hulls that falls into a box and comes to lie."""
    from lithobrake.dem import Material, World
    from lithobrake.touchdown.grains import make_grain

    generator = np.random.default_rng(0)
    grains = [make_grain(generator, 14, 0.1) for _ in range(8)]
    rock = Material(young_modulus=2e7, poisson_ratio=0.25, restitution=0.3, friction=0.5, density=2500.0)
    world, room = World((0.0, 0.0, -1.0), TIME_STEP), 2.0 * max(grain.bounding_radius for grain in grains)
    for number, place in enumerate(np.ndindex(EDGE, EDGE, EDGE)):
        world.add_body(grains[number % len(grains)], rock, tuple(room * (np.array(place) + 0.5)))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rock)
    for axis in (0, 1):
        inward = np.eye(3)[axis]
        world.add_plane((0.0, 0.0, 0.0), tuple(inward), rock)
        world.add_plane(tuple(EDGE * room * inward), tuple(-inward), rock)
    # The first step also reads what is compiled.
    world.run(steps=1)
    start = time.process_time()
    world.run(steps=STEPS)
    return time.process_time() - start


def expected_seconds(
    site: Site,
    made: Mapping[str, tuple[int, int]],
    soils: Sequence[ExpectedSoil],
    ended: Sequence[Record],
    workers: int | None,
) -> dict[str, Span | None]:
    """From and to [s], by what takes it; None where nobody knows.

    made: how many of each are to be made, at least and at most. soils: beds as those of the study, each standing for as
    many; none with a program of one's own. ended: runs of this study that have. workers: None for
    a cluster, of which nobody knows the pace.
    """
    cores, pace = min(workers or 1, available_cores()), _pace(made, soils) or 1.0
    found: dict[str, Span | None] = {}
    if soils and _engine_works(made) and not engine_is_compiled():
        found["compiling the engine, once"] = spread(COMPILING)
    if soils and made["beds"][1]:
        pour = pace * statistics.fmean(map(pour_time, soils))
        found["beds"] = _beds_time(pour, made["beds"], None if workers is None else cores)
    if soils and made["landings"][1]:
        middle = soils[len(soils) // 2]
        found["preview landing"] = spread(pace * landing_time(middle, *middle.landings[0]))
    if made["touchdowns"][1]:
        one, (fewest, most) = run_time(soils, ended, pace), made["touchdowns"]
        found["touchdowns"] = (fewest * one[0] / cores, most * one[1] / cores) if one and workers else None
    if made["journeys to rest"][1]:
        one, (fewest, most) = journey_time(soils, pace), made["journeys to rest"]
        found["journeys"] = (fewest * one[0] / cores, most * one[1] / cores) if one and workers else None
    flying = flights_time(site) if made["flights"][1] else 0.0
    flying += journeys_time(site) if made["journeys"][1] else 0.0
    if flying:
        found["flights and bounces"] = spread(pace * flying / cores)
    found["fits, samples and report"] = spread(pace * REPORT_SECONDS)
    # The upper ends alone: the other work may end before this study does.
    slower = busy_factor()
    return {what: span and (span[0], span[1] * slower) for what, span in found.items()}


def basis(made: Mapping[str, tuple[int, int]], soils: Sequence[ExpectedSoil], ended: Sequence[Record]) -> str:
    if made["touchdowns"][1] and len(walls_of(ended)) >= RUNS_THAT_TELL:
        said = f"Touchdowns by the times of the {len(walls_of(ended))} finished ones, all else estimated"
    elif _engine_works(made) and soils:
        said = "Estimated from the number of time steps for contacts of this stiffness and speed"
    elif made["touchdowns"][1]:
        said = "The time of your program is unknown until some touchdowns are finished; all else is estimated"
    else:
        said = "Estimated"
    pace = _pace(made, soils)
    if pace is None:
        said += ", at the pace of the reference machine"
    else:
        said += f"; a step takes {pace:.2g} times as long here as on the reference machine"
    slower = busy_factor()
    if slower > 1.0:
        said += (
            f". Other work is on these cores (load {_load():.1f} on {available_cores()}): while it lasts, everything "
            f"takes up to {slower:.1f} times as long, which the upper ends include"
        )
    return f"{said}."


def busy_factor() -> float:
    """How many times as long work takes here as on idle cores, where other work is on them; else 1.

    As many processes as cores share these with `load` others, each of which has the same right to them.
    """
    cores, load = available_cores(), _load()
    return 1.0 + load / cores if load > BUSY * cores else 1.0


def _load() -> float:
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0


def _pace(made: Mapping[str, tuple[int, int]], soils: Sequence[ExpectedSoil]) -> float | None:
    """Time of this machine over that of the reference machine, where it is worth a look and can be had at once."""
    return machine_pace() if soils and _engine_works(made) else None


def _engine_works(made: Mapping[str, tuple[int, int]]) -> bool:
    return any(made[what][1] for what in ("beds", "landings", "touchdowns", "journeys to rest"))


def walls_of(ended: Sequence[Record]) -> list[float]:
    """Times by the clock [s] of runs that have ended."""
    return [record.wall_s for record in ended if record.wall_s]


def pour_time(soil: ExpectedSoil) -> float:
    """Time [s] to pour a bed."""
    return soil.pour_steps() * SETTLING_GRAIN * soil.recipe.grain_count


def _beds_time(one: float, beds: tuple[int, int], cores: int | None) -> Span | None:
    """Time [s] of beds that are poured at once, at least and at most so many, of which one takes so long.

    cores: None for a cluster, on which a single bed alone is poured here.
    """
    if cores is None and beds[1] > 1:
        return None
    rounds = [math.ceil(count / (cores or 1)) for count in beds]
    return spread(one * rounds[0])[0], spread(one * rounds[1])[1]


def run_time(soils: Sequence[ExpectedSoil], ended: Sequence[Record], pace: float) -> Span | None:
    """Time [s] of one touchdown in the mean, by the clock: as those that have ended took, else as expected of the soil.

    None where nobody knows: a program of one's own that has not yet run.
    """
    walls = walls_of(ended)
    if len(walls) >= RUNS_THAT_TELL:
        mean = statistics.fmean(walls)
        factor = max(SPREAD_OF_RUNS, 1.0 + 2.0 * statistics.stdev(walls) / (mean * math.sqrt(len(walls))))
        return mean / factor, mean * factor
    if not soils:
        return None
    mean = pace * statistics.fmean(landing_time(soil, *landing) for soil in soils for landing in soil.landings[1:])
    return mean / SPREAD_OF_TOUCHDOWNS, mean * SPREAD_OF_TOUCHDOWNS


def journey_time(soils: Sequence[ExpectedSoil], pace: float) -> Span | None:
    """Time [s] of the touchdowns of one journey in the mean; None with a program of one's own."""
    if not soils:
        return None
    mean = pace * statistics.fmean(map(mean_journey_time, soils))
    return mean / SPREAD_OF_JOURNEYS, mean * SPREAD_OF_JOURNEYS


def mean_journey_time(soil: ExpectedSoil) -> float:
    """Time [s] of the touchdowns of one journey in the mean, on the reference machine."""
    return RESTING_GRAIN * statistics.fmean(soil.journey_steps(*landing) for landing in soil.landings[1:])


def landing_time(soil: ExpectedSoil, lander: "Lander", landing: "Landing") -> float:
    """Time [s] of one landing."""
    contact, grains = landing.contact, soil.recipe.grain_count
    steps = soil.landing_steps(lander, landing)
    if contact.stepping == "global":
        return steps * (LANDING_STEP + LANDING_GRAIN * grains)
    moving = float(grains)
    if contact.held_speed > 0.0:
        moving = min(moving, MOVING * soil.near_grains(lander, landing) / contact.held_speed)
    part = SLOW_PART if contact.resolved_speed > 0.0 else 1.0
    return part * steps / contact.steps_per_contact * moving * (LOCAL_GRAIN + LOCAL_LOOK * contact.steps_per_contact)


def flights_time(site: Site) -> float:
    """Time [s] of all flights, with the table of gravity where it has to be built."""
    study, facets = site.study, len(site.body.shape.faces) / FACETS
    if study.flight.gravity == "exact":
        return facets * EXACT_FLIGHT * flight_count(study)
    return facets * TABLE + FLIGHT * flight_count(study)


def journeys_time(site: Site) -> float:
    """Time [s] of all landers that a model follows."""
    study = site.study
    if study.flight.gravity == "exact":
        return len(site.body.shape.faces) / FACETS * EXACT_JOURNEY * followed_count(study)
    return JOURNEY * followed_count(study)


def spread(seconds: float) -> Span:
    return seconds / SPREAD, seconds * SPREAD
