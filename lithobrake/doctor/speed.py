"""How fast this machine is in landings and flights, on one core, beside the reference machine.

Each piece of work has a fixed seed, so that it is the same wherever it is timed. The figures of the reference machine,
the one of pipeline/planning, were measured by benchmarks/doctor_speed.py and stand in benchmarks/doctor_speed.json.
"""

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from lithobrake.dem import Material, Sphere
from lithobrake.pipeline.planning.expected_time import EDGE, REFERENCE, STEPS, probe
from lithobrake.smallbody import dimorphos, fly
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, land, pour_bed

LANDINGS, FLIGHTS = 20, 2000
# A CPU second of the reference machine.
REFERENCE_LANDINGS, REFERENCE_FLIGHTS = 43.0, 610.0
GRAVITY = (0.0, 0.0, -5e-4)


@dataclass(frozen=True)
class MeasuredSpeed:
    """How much of a work a CPU second does here, and on the reference machine."""

    what: str
    here: float
    reference: float


def measured_speeds() -> Iterator[MeasuredSpeed]:
    """Measure steps of grains, landings and flights, one after the other, which takes some ten CPU seconds."""
    steps = EDGE**3 * STEPS
    yield MeasuredSpeed(f"steps of one grain among {EDGE**3}", steps / probe(), steps / REFERENCE)
    bed = small_bed()
    yield MeasuredSpeed(
        f"landings of a ball on {len(bed.grains)} grains", _rate(LANDINGS, lambda: _land(bed)), REFERENCE_LANDINGS
    )
    yield MeasuredSpeed("flights from Dimorphos, by the sum over its facets", _flights_rate(), REFERENCE_FLIGHTS)


def small_bed() -> Bed:
    """A bed of 24 grains, poured."""
    recipe = BedRecipe(
        grain_count=24, sizes=GrainSizes(distribution="uniform", lower=0.09, upper=0.11), cloud_point_count=14,
        width=(0.36, 0.36), material=_rock(), gravity=GRAVITY, pour_gravity=0.5, seed=3,
        contact=ContactModel(steps_per_contact=25.0),
    )  # fmt: skip
    return pour_bed(recipe)


def _land(bed: Bed) -> None:
    """Land from as many directions as there are landings."""
    ball = Lander(shape=Sphere(0.06), mass=0.3, material=_rock())
    for number in range(LANDINGS):
        arrival = Landing(
            grain=_rock(), speed=0.3, incidence=0.2, azimuth=2.0 * math.pi * number / LANDINGS, place=(0.0, 0.0),
            orientation=(1.0, 0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0), gravity=GRAVITY, time_limit=20.0,
            contact=ContactModel(steps_per_contact=25.0),
        )  # fmt: skip
        land(bed, ball, arrival)


def _flights_rate() -> float:
    body, random = dimorphos(partner=False), np.random.default_rng(0)
    outward = random.normal(size=(FLIGHTS, 3))
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    speed = random.uniform(0.01, 0.03, FLIGHTS)

    def all_of_them(count: int) -> None:
        # One lane of work: CPU time of a core.
        fly(body, 120.0 * outward[:count], (speed[:, None] * outward)[:count], 4.0 * 3600.0, threads=1)

    # What is compiled is read with the first.
    all_of_them(1)
    return _rate(FLIGHTS, lambda: all_of_them(FLIGHTS))


def _rate(count: int, work: Callable[[], None]) -> float:
    """How many a CPU second."""
    start = time.process_time()
    work()
    return count / (time.process_time() - start)


def _rock() -> Material:
    return Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)
