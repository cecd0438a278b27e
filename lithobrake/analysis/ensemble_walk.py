"""Walkers over a law of which too few weighted points could be found: narrow, bent, or with several peaks.

Source: [Goodman-2010] (stretch moves); [ForemanMackey-2013] (emcee, and how long to walk).
"""

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from lithobrake.vocabulary.arrays import Array

INSTALL = 'install emcee, whose walkers reach what points do not: pip install "lithobrake[infer]"'
ENDLESS = "emcee's walkers did not come to an end either; leave some bounces out, or give them larger errors"
WALKER_COUNT = 64
# Walkers go on in blocks until their way is so many autocorrelation times long; so many are left out at its beginning.
LENGTH, BEGINNING = 50.0, 5.0
BLOCK, MOST_STEPS = 200, 4000


def can_walk() -> bool:
    """Whether emcee is installed."""
    return find_spec("emcee") is not None


def walk(logarithm: Callable[[Array], Array], start: Array, seed: int) -> tuple[Array, float] | None:
    """Points [point_count, dimension] of a law, of equal weight, and how many independent ones they are worth.

    logarithm: of the density at points [count, dimension], without its constant, -inf where it is 0; also an estimate
    that is right in the mean and drawn anew at each call. start [WALKER_COUNT, dimension]: where walkers begin.
    None where their way has not become long enough for its own autocorrelation time. Raises ImportError without emcee.
    """
    emcee: Any = import_module("emcee")
    dimension = start.shape[1]
    moves = [(emcee.moves.StretchMove(), 0.5), (emcee.moves.DEMove(), 0.5)]
    sampler = emcee.EnsembleSampler(len(start), dimension, logarithm, moves=moves, vectorize=True)
    state = emcee.State(start, random_state=np.random.RandomState(seed).get_state())
    for _ in range(MOST_STEPS // BLOCK):
        state = sampler.run_mcmc(state, BLOCK)
        time = float(np.max(sampler.get_autocorr_time(tol=0)))
        if np.isfinite(time) and sampler.iteration > LENGTH * time:
            every = max(round(0.5 * time), 1)
            points: Array = sampler.get_chain(discard=round(BEGINNING * time), thin=every, flat=True)
            return points, len(points) * every / max(time, 1.0)
    return None
