"""From observed bounces to the soil: the law of the inputs of a stochastic model, given what came out of it."""

import itertools
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import logsumexp, ndtr, ndtri

from lithobrake.analysis import posterior
from lithobrake.analysis.confidence import LEVEL
from lithobrake.analysis.observed_draws import weighted_quantiles
from lithobrake.chaos.basis import checked_points
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.training_data import one_thread
from lithobrake.emulator.density import BedEffect, observed_density
from lithobrake.emulator.model import Emulator
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import LEAST_PROBABILITY
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import random_numbers, sample_count, whole_number
from lithobrake.vocabulary.number_words import at_level, percent

REFIT_COUNT = 30
POINT_COUNT = 1 << 12
# While too few points carry weight new ones are drawn near those that do, so often at most.
MOST_ROUNDS = 4
# Fewer points of weight than this are no sample of a law.
FEWEST_EFFECTIVE = 400.0
# An input of which more than this part of the prior's standard deviation is left has learnt nothing worth saying.
NOTHING_LEARNT = 0.9
# How far beside points walkers begin, as a part of their spread, which is at least so much in normal scores.
BESIDE, NARROWEST = 0.1, 0.01
# Equal steps of probability in which an input's law is compared with its prior.
STEPS = 20

Likelihood = Callable[[Array, int], Array]
Bounds = Callable[[Array], tuple[ArrayLike | None, ArrayLike | None]]


@dataclass(frozen=True)
class LearntInput:
    """An input before and after: bounds and median after, in its unit; sd_ratio: standard deviation after over before,
    on the scale of its law; information: Kullback-Leibler divergence of after from before [nats].
    """

    after: Estimate
    before: Estimate
    sd_ratio: float
    information: float


@dataclass(frozen=True)
class Posterior:
    """Posterior distribution of the inputs, as weighted points.

    points [point_count, input_count] in physical units, of the inputs that all bounces share; weights [point_count],
    which sum to 1; effective_count: of so many equal points they are worth; log_evidence: logarithm of the mean
    likelihood over the prior, by points that were drawn from it and near it; remedy: where too few carry weight.
    open_weight [point_count]: how many times its weight each point may have, at least 1, where runs of the emulator are
    missing; missing: their share of its runs.
    """

    inputs: dict[str, Distribution]
    points: Array
    weights: Array
    effective_count: float
    log_evidence: float
    remedy: str = ""
    open_weight: Array | None = None
    missing: float = 0.0

    @property
    def is_reliable(self) -> bool:
        """Whether enough points carry weight for its numbers to be those of the law."""
        return self.effective_count >= FEWEST_EFFECTIVE

    def sample(self, count: int, seed: int = 0) -> Array:
        """Draw points with replacement, [count, input_count]."""
        size = sample_count("count", count, len(self.inputs), at_least=0)
        return self.points[random_numbers(seed).choice(len(self.points), size, p=self.weights)]

    def learnt(self) -> dict[str, LearntInput]:
        """Each input before and after the observations, by name."""
        ends = [0.5 - 0.5 * LEVEL, 0.5, 0.5 + 0.5 * LEVEL]
        found = {}
        for (name, law), values in zip(self.inputs.items(), self.points.T, strict=True):
            lower, middle, upper = weighted_quantiles(values, self.weights, ends)
            if self.open_weight is not None:
                lower, upper = open_quantiles(values, self.weights, self.open_weight, (ends[0], ends[2]))
            least, median, most = (float(law.ppf(end)) for end in ends)
            germ = law.germ(values)
            # Where one point has all the weight its law has no width, and no more is known of it.
            after, before = np.sqrt(np.cov(germ, aweights=self.weights, ddof=0)), _germ_deviation(law)
            found[name] = LearntInput(
                Estimate(middle, lower, upper), Estimate(median, least, most),
                float(after / before), self._information(law.cdf(values)),
            )  # fmt: skip
        return found

    def statement(self) -> str:
        """What was learnt, and what not, in a sentence."""
        learnt = self.learnt()
        said = [
            f"{name}: {one.after.value:.3g} ({at_level(LEVEL)} {one.after.lower:.3g} to {one.after.upper:.3g}, "
            f"before {one.before.lower:.3g} to {one.before.upper:.3g})"
            for name, one in learnt.items()
            if one.sd_ratio <= NOTHING_LEARNT
        ]
        nothing = [name for name, one in learnt.items() if one.sd_ratio > NOTHING_LEARNT]
        if nothing:
            said.append(f"the data say nothing about {', '.join(nothing)}")
        if not self.is_reliable:
            few = f"only {self.effective_count:.0f} points carry weight, too few to trust any of this"
            said.append(f"{few}: {self.remedy}" if self.remedy else few)
        if self.open_weight is not None:
            said.append(
                f"{percent(self.missing, 1)} of the runs of the emulator have no outcome: intervals hold whether these "
                "would have given what was observed never, or as often as other runs on their soil"
            )
        words = "; ".join(said)
        return f"{words[0].upper()}{words[1:]}." if said[0].startswith("the") else f"{words}."

    def _information(self, shares: Array) -> float:
        """Divergence of the law after from that before, in equal steps of probability before [nats], freed of luck."""
        place = np.minimum((shares * STEPS).astype(int), STEPS - 1)
        parts = np.bincount(place, weights=self.weights, minlength=STEPS)
        divergence = float(np.sum(parts[parts > 0.0] * np.log(parts[parts > 0.0] * STEPS)))
        return max(divergence - 0.5 * (STEPS - 1) / self.effective_count, 0.0)


def _germ_deviation(law: Distribution) -> float:
    """Standard deviation of a law on its own scale, in which a decade counts as a decade."""
    return float(law.germ(law.ppf((np.arange(1000) + 0.5) / 1000.0)).std())


def infer(
    model: Emulator,
    observations: Sequence[posterior.Observation],
    *,
    own: Collection[str] = (),
    bounds: Bounds | None = None,
    refit_count: int = REFIT_COUNT,
    point_count: int = POINT_COUNT,
    seed: int = 0,
    missing: Collection[str] = (),
) -> Posterior:
    """Infer the inputs of an emulator from observed bounces; its input distributions are the prior.

    own: inputs that each bounce draws anew, as its speed where that is not known; the others are those of all bounces.
    bounds: of the outputs at points [point_count, input_count], where they follow the inputs (as in `Emulator.sample`).
    refit_count: fits to groups drawn with replacement, over which the likelihood is averaged; 0: the emulator alone.
    point_count: points that are looked at, of the prior first, then near those that carry weight until 400 do. Where
    these rounds end with fewer the walkers of emcee follow, if it is installed.
    Bounces on one bed (`Observation.bed`) share its effect, as large as that of the groups of the emulator's runs in
    each refit; a bounce without a word for its bed has one of its own.
    missing: outcomes of the emulator's runs of which it is not known what became of them, as of a lander that left the
    bed. A landing on the body has none of these. At a point where the emulator gives them a chance, they would have
    given what was observed never, or as often as the other runs there, or anything between: each weight lies between
    two, and the bounds of an input are the outermost quantiles of all such laws.
    Source of the bounds with missing runs: [DeRobertis-1981] (intervals of measures).
    Raises ValueError for no observation, for names and values that cannot be, and for a shared bed where no group of
    the emulator has two runs.
    """
    shared, seed = _checked(model, observations, own), whole_number("seed", seed, 0)
    if any(len(bed) > 1 for bed in posterior.by_bed(observations)):
        # Rows alone know the effect of a bed.
        model = model.of_rows
    models = model.refits(refit_count, seed) if refit_count else [model]
    laws = {name: model.runs.inputs[name] for name in shared}

    def logarithm(scores: Array, draws: int) -> Array:
        return _likelihood(models, observations, laws, _physical(laws, scores), bounds, draws)

    found = _drawn(laws, logarithm, point_count, seed)
    found = found if found.is_reliable else _walked(found, logarithm, seed)
    lost = [name for name in missing if name in model.outcome_names]
    share = float(np.isin(np.array(model.outcome_names)[model.runs.outcome], lost).mean())
    if not share:
        return found
    return replace(found, open_weight=_open_weight(model, observations, found, lost, seed), missing=share)


def _open_weight(
    model: Emulator, observations: Sequence[posterior.Observation], found: Posterior, lost: Sequence[str], seed: int
) -> Array:
    """How many times its weight each point may have: over the bounces, runs with any outcome over those without."""
    shared, total = dict(zip(found.inputs, found.points.T, strict=True)), np.ones(len(found.points))
    places = [model.outcome_names.index(name) for name in lost]
    for number, one in enumerate(observations):
        x = posterior.completed_points(
            model.runs.inputs, {**shared, **one.known}, len(found.points), seed * 1000 + number
        )
        chances = model.classes.chances(model.terms.matrix(checked_points(model.runs.inputs, x)))
        ended = model.runs.output_outcome if one.outcome is None else model.outcome_names.index(one.outcome)
        total *= 1.0 + chances[:, places].sum(axis=1) / np.maximum(chances[:, ended], LEAST_PROBABILITY)
    return total


def open_quantiles(
    values: Array, weights: Array, factors: Array, probabilities: tuple[float, float]
) -> tuple[float, float]:
    """The smallest quantile of the first probability and the largest of the second, all [point_count].

    Of all laws whose weights lie between `weights` and these times `factors`, which are at least 1.
    Source: [DeRobertis-1981].
    """
    order = np.argsort(values)
    least, most = weights[order], (weights * factors)[order]
    up_to = [np.cumsum(one) - 0.5 * one for one in (least, most)]
    beyond = [one.sum() - below for one, below in zip((least, most), up_to, strict=True)]
    # Below a value a law has most where the points below have their largest weights and the others their smallest.
    largest, smallest = up_to[1] / (up_to[1] + beyond[0]), up_to[0] / (up_to[0] + beyond[1])
    return (
        float(np.interp(probabilities[0], largest, values[order])),
        float(np.interp(probabilities[1], smallest, values[order])),
    )


def _drawn(laws: Mapping[str, Distribution], logarithm: Likelihood, point_count: int, seed: int) -> Posterior:
    """The posterior by weighted points, of the prior and then near those that carry weight.

    Raises ValueError where none does.
    """
    proposal, found = posterior.Proposal(None), list[Posterior]()
    for number in range(1 + MOST_ROUNDS):
        scores, excess = proposal.draw(len(laws), point_count, seed + number)
        logarithms = excess + logarithm(scores, seed)
        if not np.isfinite(logarithms).any():
            raise ValueError(
                "the observations have no likelihood at any point of the prior: they lie beyond bounds of the outputs; "
                "look at their units"
            )
        found.append(posterior_of(laws, _physical(laws, scores), logarithms))
        if found[-1].is_reliable:
            break
        proposal = posterior.Proposal.near(scores, found[-1].weights)
    return max(found, key=lambda one: one.effective_count)


def _walked(found: Posterior, logarithm: Likelihood, seed: int) -> Posterior:
    """The posterior by walkers that begin at the points of another; that one, with what may help, where none arrive."""
    if not posterior.can_walk():
        return replace(found, remedy=posterior.INSTALL)
    shares = [law.cdf(values) for law, values in zip(found.inputs.values(), found.points.T, strict=True)]
    scores = ndtri(np.clip(np.column_stack(shares), LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY))
    random, middle = random_numbers(seed), found.weights @ scores
    spread = np.sqrt(found.weights @ (scores - middle) ** 2) + NARROWEST
    start = scores[random.choice(len(scores), posterior.WALKER_COUNT, p=found.weights)]
    # Walkers that all begin at one point would never leave it.
    start = start + BESIDE * spread * random.standard_normal(start.shape)
    # What each bounce draws anew is drawn at every call: so the walk is right in the mean over it.
    calls = itertools.count(seed + 1)

    def density(at: Array) -> Array:
        value = logarithm(at, next(calls)) - 0.5 * np.sum(at**2, axis=1)
        return np.where(np.isnan(value), -np.inf, value)

    walked = posterior.walk(density, start, seed)
    if walked is None:
        return replace(found, remedy=posterior.ENDLESS)
    points, effective = _physical(found.inputs, walked[0]), walked[1]
    return replace(found, points=points, weights=np.full(len(points), 1.0 / len(points)), effective_count=effective)


def _physical(laws: Mapping[str, Distribution], scores: Array) -> Array:
    """Points [count, input_count] in physical units from normal scores."""
    shares = np.clip(ndtr(scores), LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY)
    return np.column_stack([law.ppf(share) for law, share in zip(laws.values(), shares.T, strict=True)])


def posterior_of(laws: Mapping[str, Distribution], points: Array, logarithms: Array) -> Posterior:
    """The posterior of points [point_count, input_count] that carry these logarithms of weights [point_count]."""
    weights = np.exp(logarithms - logsumexp(logarithms))
    evidence = float(logsumexp(logarithms)) - float(np.log(len(points)))
    return Posterior(dict(laws), points, weights, 1.0 / float(np.sum(weights**2)), evidence)


@one_thread()
def _likelihood(
    models: Sequence[Emulator],
    observations: Sequence[posterior.Observation],
    shared: Mapping[str, Distribution],
    points: Array,
    bounds: Bounds | None,
    seed: int,
) -> Array:
    """Logarithm of the likelihood at points [point_count, shared_count], averaged over the refits, [point_count]."""
    inputs, total = models[0].runs.inputs, np.zeros((len(models), len(points)))
    at = []
    for number, one in enumerate(observations):
        given = {**dict(zip(shared, points.T, strict=True)), **one.known}
        x = checked_points(inputs, posterior.completed_points(inputs, given, len(points), seed * 1000 + number))
        at.append(((x, models[0].terms.matrix(x)), bounds(x) if bounds else (None, None)))
    for bed in posterior.by_bed(observations):
        for place, refit in enumerate(models):
            effect = refit.bed_effect if len(bed) > 1 else BedEffect.none(len(refit.runs.modelled))
            for one, (terms, ends) in ((observations[number], at[number]) for number in bed):
                found, effect = observed_density(refit, one.outputs, terms, one.errors, one.outcome, ends, effect)
                total[place] += found
    # Each refit is one emulator of all bounces, so the mean is over products, not of means.
    return logsumexp(total, axis=0) - np.log(len(models))


def _checked(model: Emulator, observations: Sequence[posterior.Observation], own: Collection[str]) -> list[str]:
    """Names of the inputs that all bounces share. Raises ValueError for names and observations that cannot be."""
    inputs = model.runs.inputs
    if not observations or not all(one.outputs or one.outcome for one in observations):
        raise ValueError(f"{len(observations)} observations; give at least one, each with outputs or an outcome")
    known = {name for one in observations for name in one.known}
    if unknown := sorted((known | set(own)) - set(inputs)):
        raise ValueError(f"{unknown[0]} is no input of the emulator; allowed: {', '.join(inputs)}")
    shared = [name for name in inputs if name not in own and name not in known]
    if not shared:
        raise ValueError("every input is known, or drawn anew by each bounce: nothing is left to infer")
    return shared
