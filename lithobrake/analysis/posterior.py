"""Points of a posterior, and which observed bounces share a bed."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri

from lithobrake.chaos.design import sample_inputs, sobol_sequence
from lithobrake.chaos.distributions import Distribution, Uniform
from lithobrake.emulator.model import Emulator
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import LEAST_PROBABILITY
from lithobrake.vocabulary.number_words import percent

# Of the points drawn near others a part is drawn from the prior still, and the rest wider than what is known so far, so
# that nothing is lost.
OF_PRIOR, WIDER = 0.2, 1.5
INSTALL = 'install emcee, whose walkers reach what points do not: pip install "lithobrake[infer]"'
ENDLESS = "emcee's walkers did not come to an end either; leave some bounces out, or give them larger errors"
WALKER_COUNT = 64
# Walkers go on in blocks until their way is so many autocorrelation times long; so many are left out at its beginning.
LENGTH, BEGINNING = 50.0, 5.0
BLOCK, MOST_STEPS = 200, 4000


@dataclass(frozen=True)
class Proposal:
    """Where points are drawn, in normal scores, in which the prior is standard normal: near a mean, or the prior.

    near: mean [input_count] and root of the covariance [input_count, input_count] of a normal law; None: prior alone.
    Source: [Owen-2000] (defensive mixtures).
    """

    normal: tuple[Array, Array] | None

    @classmethod
    def near(cls, scores: Array, weights: Array) -> "Proposal":
        """Of the weighted points so far; an input of which one point knows all keeps some width."""
        mean = weights @ scores
        covariance = (scores - mean).T @ ((scores - mean) * weights[:, None]) + 1e-4 * np.eye(len(mean))
        root: Array = np.asarray(WIDER * np.linalg.cholesky(covariance), dtype=np.float64)
        return cls((mean, root))

    def draw(self, dimension: int, count: int, seed: int) -> tuple[Array, Array]:
        """Normal scores [count, dimension], and the logarithm of the prior's density over that of the draws [count]."""
        unit = {str(k): Uniform(0.0, 1.0) for k in range(dimension + 1)}
        uniforms = np.clip(sobol_sequence(unit, count, seed=seed), LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY)
        scores = ndtri(uniforms[:, 1:])
        if self.normal is None:
            return scores, np.zeros(count)
        mean, root = self.normal
        moved = mean + scores @ root.T
        scores = np.where((uniforms[:, 0] < OF_PRIOR)[:, None], scores, moved)
        prior = -0.5 * np.sum(scores**2, axis=1)
        inner = np.linalg.solve(root, (scores - mean).T).T
        other = -0.5 * np.sum(inner**2, axis=1) - float(np.log(np.diagonal(root)).sum())
        return scores, prior - np.logaddexp(np.log(OF_PRIOR) + prior, np.log1p(-OF_PRIOR) + other)


def can_walk() -> bool:
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


@dataclass(frozen=True)
class Observation:
    """One observed bounce.

    outputs: those that were observed, by name, in their units; errors: standard deviations of those that have one;
    known: inputs that are known of this bounce, by name, as its speed; outcome: how it ended, None: with outputs; bed:
    a word for the bed it was on, which bounces with the same word share; None: one of its own.
    """

    outputs: Mapping[str, float]
    errors: Mapping[str, float] = field(default_factory=dict)
    known: Mapping[str, float] = field(default_factory=dict)
    outcome: str | None = None
    bed: str | None = None


def completed_points(
    inputs: Mapping[str, Distribution], given: Mapping[str, ArrayLike], count: int, seed: int
) -> Array:
    """Points [count, input_count]: given inputs, each a number or [count], and the others drawn by their laws."""
    drawn = {name: law for name, law in inputs.items() if name not in given}
    values = {**given, **dict(zip(drawn, sample_inputs(drawn, count, seed).T, strict=True))}
    return np.column_stack([np.broadcast_to(values[name], count) for name in inputs])


def by_bed(observations: Sequence[Observation]) -> list[list[int]]:
    """Places of the observations of each bed; one without outputs shares none, as it says nothing of its bed."""
    beds: dict[tuple[bool, str | int], list[int]] = {}
    for number, one in enumerate(observations):
        shared = one.bed is not None and bool(one.outputs)
        beds.setdefault((shared, one.bed if shared and one.bed is not None else number), []).append(number)
    return list(beds.values())


def bed_shares(model: Emulator) -> dict[str, float]:
    """Fraction of the variance of each output, at one soil, that beds cause in the emulator's runs.

    Raises ValueError where no bed has two runs.
    """
    rows = model.of_rows
    effect, root = rows.bed_effect, rows.kernels.root
    whole, of_beds = np.diagonal(root @ root.T), np.diagonal(root @ effect.before @ root.T)
    names = [model.output_names[column] for column in model.runs.modelled]
    shares = np.divide(of_beds, whole, out=np.zeros(len(whole)), where=whole > 0.0)
    return dict(zip(names, shares.tolist(), strict=True))


def beds_statement(model: Emulator, observations: Sequence[Observation]) -> str | None:
    """Sentence on which bounces share a bed; None for one bounce."""
    if len(observations) < 2:
        return None
    shared = [bed for bed in by_bed(observations) if len(bed) > 1]
    if not shared:
        return (
            f"The {len(observations)} bounces count as on beds of their own; name the bed of each where some share one."
        )
    said = ", ".join(f"{name} {percent(share)}" for name, share in bed_shares(model).items())
    named = "; ".join(f"{len(bed)} share bed {observations[bed[0]].bed}" for bed in shared)
    return f"Of the {len(observations)} bounces {named}; of the scatter at one soil the bed has: {said}."
