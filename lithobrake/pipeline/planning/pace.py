"""How fast this machine is: a short piece of work of the soft-surface engine, beside what it took elsewhere."""

import time
from functools import cache

import numpy as np

# CPU time [s] of the piece of work where the times of expected_time.py were measured (benchmarks/plan_estimate.json).
REFERENCE = 0.22
EDGE, STEPS, TIME_STEP = 4, 10_000, 1e-4


@cache
def machine_pace() -> float | None:
    """CPU time here over that of the reference machine; None where the engine has yet to be compiled."""
    return probe() / REFERENCE if engine_is_compiled() else None


def engine_is_compiled() -> bool:
    """Whether the compiled engine lies on the disk."""
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
