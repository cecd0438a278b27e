"""An emulator: what a stochastic model does at inputs that nobody has run, as draws or as plain tables."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from html import escape

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.chaos.basis import checked_points, input_tables
from lithobrake.chaos.storage import read, write
from lithobrake.chaos.training_data import one_thread
from lithobrake.emulator.density import BedEffect, Kernels, kernels_of, observed_density
from lithobrake.emulator.latent_variable import BRANCHES
from lithobrake.emulator.law import best_choices, drawn_rows, fit_classes, fit_law, row_weights, smoothed, smoothing
from lithobrake.emulator.mean_law import MeanLaw, candidate_terms, found_inputs, mean_law
from lithobrake.emulator.output_law import OutputLaw, output_law
from lithobrake.emulator.ridge_ladder import TermTable
from lithobrake.emulator.storage import FORMAT, Parts, content_of, parts_of
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import random_numbers, sample_count
from lithobrake.vocabulary.number_words import LEVEL, percent
from lithobrake.vocabulary.plain_text import html_table

NO_ROWS = "the emulator is a stochastic expansion, which has no rows to draw from: give fit form='rows'"
# Draws that are made at once: bounds the memory, and belongs to what a seed gives.
_BLOCK = 1 << 18


@dataclass(frozen=True)
class Draws:
    """y [point_count, count, output_count], NaN where the drawn outcome has no outputs; outcome [point_count, count],
    places among the outcome names; row [point_count, count], the run whose scatter and riders a draw has, or -1: of
    what has no outputs, and of an expansion, whose draws come from no run.
    """

    y: Array
    outcome: NDArray[np.int64]
    row: NDArray[np.int64]


@dataclass(frozen=True)
class Emulator(Parts):
    """Conditional distribution of a stochastic model's outputs at given inputs; made by `fit`."""

    @property
    def outcome_names(self) -> tuple[str, ...]:
        """Names of the outcomes, in the order of their chances."""
        return self.runs.outcome_names

    @property
    def output_names(self) -> tuple[str, ...]:
        """Names of the outputs, in the order of their columns."""
        return self.runs.output_names

    @property
    def follows_inputs(self) -> bool:
        """Whether draws depend on the inputs; else each is one of the runs."""
        return self.choices.follows_inputs or self.expansion is not None

    def __repr__(self) -> str:
        """Say what it draws at which inputs, and what these are worth."""
        return f"Emulator of {', '.join(self.output_names)} at {', '.join(self.runs.inputs)}. {self.statement}"

    def _repr_html_(self) -> str:
        """What it makes of the inputs, the outcomes and the outputs, for a notebook."""
        ended = np.asarray(self.runs.outcome)
        outcomes = [(name, int((ended == place).sum())) for place, name in enumerate(self.outcome_names)]
        modelled = [self.output_names[place] for place in self.runs.modelled]
        scores = zip(modelled, self.scores.crps_skill.tolist(), self.scores.band_90.tolist(), strict=True)
        return (
            f"<p>{escape(self.statement)}</p>"
            + html_table(f"Outcomes of {len(ended)} runs", ("outcome", "runs"), outcomes)
            + html_table("Outputs, on held-out groups", ("output", "CRPS skill", "in the 90 % band"), scores)
        )

    @property
    def statement(self) -> str:
        """What the emulator makes of the inputs, in a sentence."""
        return self.statement_on("groups")

    def statement_on(self, groups: str) -> str:
        """The same, with the caller's word for the groups that were left out."""
        count, number = len(self.runs.y), len(np.unique(self.runs.group))
        if not self.follows_inputs:
            return (
                f"The inputs do not improve the prediction: on held-out {groups} no regression on them scores better, "
                f"by more than a standard error, than resampling the {count} runs with outputs ({number} {groups}), so "
                "samples are resampled runs."
            )
        share = self.scores.gain / self.scores.energy_of_rows
        said = (
            f"On held-out {groups} the inputs improve the energy score by {percent(share, 1)} "
            f"(standard error {percent(self.scores.gain_error / self.scores.energy_of_rows, 1)}) "
            f"over resampling the {count} runs with outputs ({number} {groups})."
        )
        return f"{said} {form_statement(self)}".rstrip()

    def outcome_probability(self, x: ArrayLike) -> Array:
        """Chances of the outcomes at x [point_count, input_count], shape [point_count, outcome_count]."""
        return self.classes.chances(self._matrix(x))

    def sample(
        self, x: ArrayLike, count: int, seed: int = 0, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None
    ) -> Array:
        """Draw `count` runs at each x [point_count, input_count], shape [point_count, count, output_count].

        NaN where the drawn outcome has no outputs. lower, upper: bounds at x, as in `fit`; bounds that were the same
        in all runs are known. Raises ValueError for points outside the inputs, and where bounds are missing.
        """
        return self.draw(x, count, seed, lower=lower, upper=upper).y

    @one_thread()
    def draw(
        self, x: ArrayLike, count: int, seed: int = 0, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None
    ) -> Draws:
        """Draw as `sample` does, and say with which outcome and from which run."""
        points = checked_points(self.runs.inputs, x)
        count = sample_count("count", count, len(points) * len(self.output_names))
        low, high = self.runs.bounds_at(lower, upper, len(points))
        random = random_numbers(seed)
        parts = []
        step = max(1, _BLOCK // max(count, len(self.runs.y)))
        for start in range(0, len(points), step):
            block = slice(start, start + step)
            parts.append(self._block(points[block], count, low[block], high[block], random))
        if not parts:
            empty = np.empty((0, count), dtype=np.int64)
            return Draws(np.empty((0, count, len(self.output_names))), empty, empty)
        return Draws(*(np.concatenate(part) for part in zip(*parts, strict=True)))

    @one_thread()
    def log_density(
        self,
        observed: Mapping[str, float],
        x: ArrayLike,
        *,
        errors: Mapping[str, float] | None = None,
        outcome: str | None = None,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
    ) -> Array:
        """Logarithm of the density of one observed run at each x [point_count, input_count], shape [point_count].

        That of what `draw` draws, with kernels three times as wide. observed: outputs by name, in their units, any of
        those that have a law (riders have none); errors: standard deviation of each that was observed with one.
        outcome: how the run ended; None: as runs with outputs do. An outcome without outputs has its chance alone.
        lower, upper: as in `sample`.
        Raises ValueError for names and values that cannot be.
        """
        given, alone = (lower, upper), BedEffect.none(len(self.runs.modelled))
        points = checked_points(self.runs.inputs, x)
        at = points, self.terms.matrix(points)
        return observed_density(self, observed, at, errors or {}, outcome, given, alone)[0]

    def output_law(
        self, x: ArrayLike, output: str | None = None, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None
    ) -> OutputLaw:
        """The law of one output at each x [point_count, input_count], of runs that have outputs: with its density,
        probabilities, quantiles and mean. That of what `draw` draws.

        output: its name; None where there is one that is no rider. lower, upper: as in `sample`.
        """
        return output_law(self, checked_points(self.runs.inputs, x), output, (lower, upper))

    def refits(self, count: int = 200, seed: int = 0) -> list["Emulator"]:
        """Fit anew to groups drawn with replacement, `count` times: how far the emulator itself is uncertain.

        TrainingRuns within a group stay as they are, and what was chosen by leaving groups out is kept.
        Source: [Field-2007]; [Huang-2018] (few groups).
        """
        return [self.reweighted(weights) for weights in self.runs.weights_of_refits(count, seed)]

    @one_thread()
    def reweighted(self, weights: ArrayLike) -> "Emulator":
        """Fit anew with each run counted as often as weights say [run_count]."""
        counted = self.runs.checked_weights(weights)
        matrix = self.terms.matrix(self.runs.x)
        there, indices = self.runs.has_outputs, self.terms.indices
        law = fit_law(TermTable(indices, matrix[there], counted[there]), self.runs.coordinates, self.choices)
        factors, penalty = self.class_choice.factors(indices), self.class_choice.inverse_penalty
        classes = fit_classes(matrix, factors, self.runs.outcome, len(self.outcome_names), penalty, counted)
        expansion = None if self.expansion is None else self.expansion.reweighted(self.runs, counted)
        return replace(self, weights=counted, law=law, classes=classes, expansion=expansion)

    def mean_law(self, physical: bool = False) -> MeanLaw:
        """Mean and Sobol indices of E[y | x] for each modelled output, freed of noise.

        physical: of the outputs in their units; else of their coordinates (logit, logarithm), in which the law is made.
        """
        target = self.runs.y[:, list(self.runs.modelled)] if physical else self.runs.coordinates
        there = self.runs.has_outputs
        x, weights, ladders = self.runs.x[there], self.weights[there], self.choices.location
        if self.follows_inputs and not any(ladders):
            # Near runs and an expansion have a mean too, which no location says.
            terms = candidate_terms(self.runs.inputs)
            ladders = best_choices(TermTable(terms.indices, terms.matrix(x), weights), self.runs.coordinates).location
        return mean_law(self.runs.inputs, x, target, ladders, weights)

    def found_inputs(self, level: float = LEVEL, seed: int = 0) -> dict[str, bool]:
        """Say which inputs change the mean of any output: one test for all inputs and outputs together.

        If none does, none is found with probability `level`. An input counts with its products with others, so that one
        which is found may have next to no variance of an output of its own; which output it changes is not said.
        """
        there = self.runs.has_outputs
        found = found_inputs(self.runs.inputs, self.runs.x[there], self.runs.coordinates, level, seed)
        return dict(zip(self.runs.inputs, found.tolist(), strict=True))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything into one readable JSON file, from which `load` gives the same draws."""
        write(FORMAT, content_of(self, self.statement), path)

    @property
    def kernels(self) -> Kernels:
        """The kernels about the residual rows whose sum is the density of an observed run. Raises ValueError for an
        expansion, which has no rows.
        """
        if self.expansion is not None:
            raise ValueError(NO_ROWS)
        return kernels_of(self)

    @property
    def of_rows(self) -> "Emulator":
        """The emulator by rows about a location and a scale, which knows what runs of one group have in common."""
        return self if self.expansion is None else replace(self, expansion=None)

    @property
    def bed_effect(self) -> BedEffect:
        """What runs of one group have in common, before any is seen. Raises ValueError where no group has two runs."""
        return BedEffect.of_groups(self.kernels.whitened, self.law.weights, self.runs.group[self.runs.has_outputs])

    def _matrix(self, x: ArrayLike) -> Array:
        return self.terms.matrix(checked_points(self.runs.inputs, x))

    def _block(
        self, points: Array, count: int, lower: Array, upper: Array, random: np.random.Generator
    ) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
        """Draws at some points: y, outcome and row, as in Draws."""
        matrix = self.terms.matrix(points)
        linear, columns = matrix[:, : len(self.runs.inputs)], list(self.runs.modelled)
        outcome = drawn_rows(self.classes.chances(matrix), count, random)
        without = outcome != self.runs.output_outcome
        if self.expansion is not None:
            y = self.runs.outputs_of(
                self.expansion.draws(points, count, random)[:, :, None], lower[:, None], upper[:, None]
            )
            y[without] = np.nan
            return y, outcome, np.full(outcome.shape, -1)
        chances = row_weights(linear, self.row_points, self.law.weights, self.choices.widths)
        row = drawn_rows(chances, count, random)
        location, scale = self.law.at(matrix)
        size, root = smoothing(self.law.rows, self.law.weights)
        scatter = smoothed(self.law.rows[row], size, root, random)
        y = self.runs.y[row]
        coordinate = location[:, None] + scale[:, None] * scatter
        y[:, :, columns] = self.runs.outputs_of(coordinate, lower[:, None], upper[:, None])
        y[without] = np.nan
        # A place among the runs with outputs becomes one among all runs.
        places = np.nonzero(self.runs.has_outputs)[0][row]
        places[without] = -1
        return y, outcome, places


def form_statement(model: Parts) -> str:
    """Which form scored best, in a sentence; none for rows about a location and a scale, the form of most emulators."""
    if model.expansion is not None:
        terms = model.expansion.terms
        latent = "two branches" if terms.latent == BRANCHES else f"a {terms.latent} latent variable"
        return f"A stochastic expansion of degree {terms.degree} with {latent} scored best of all forms."
    if not any(model.choices.location) and not any(model.choices.scale):
        return "Samples are whole runs, the nearer the likelier: of all forms they scored best."
    return ""


def load(path: str | os.PathLike[str]) -> Emulator:
    """Read what `Emulator.save` wrote. Raises ValueError if the file is of another kind, or damaged."""
    parts = read(FORMAT, parts_of, path)
    return Emulator(**{field.name: getattr(parts, field.name) for field in fields(parts)})


def law_tables(models: Sequence[Emulator]) -> dict[str, Array]:
    """Tables of emulators that share runs and choices, as refits do; the first axis of a law's own is the emulator.

    multi_indices [term_count, input_count], without the constant; kernel_widths [input_count], infinite where nearness
    in an input does not count; row_inputs [row_count, input_count], standardised; location, log_scale, scale_limits,
    rows, row_weights and classes as in Law and OutcomeClasses; smoothing_size [model_count] and smoothing_root
    [model_count, coordinate_count, coordinate_count]; lower, upper [coordinate_count] of the first run; distant
    [coordinate_count], 1 where these bend no coordinate and draws are only kept inside. Raises ValueError for no
    emulator, and for an expansion.
    """
    if not models:
        raise ValueError("models are none, but must be at least one emulator: give those of refits")
    if models[0].expansion is not None:
        raise ValueError(NO_ROWS)
    first, columns = models[0], list(models[0].runs.modelled)
    linear = first.terms.matrix(first.runs.x)[first.runs.has_outputs, : len(first.runs.inputs)]
    smooth = [smoothing(model.law.rows, model.law.weights) for model in models]
    return {
        **input_tables(first.runs.inputs, first.terms.indices),
        "multi_indices": first.terms.indices.astype(float),
        "kernel_widths": np.array(first.choices.widths),
        "row_inputs": linear,
        "location": np.stack([model.law.location for model in models]),
        "log_scale": np.stack([model.law.log_scale for model in models]),
        "scale_limits": np.stack([model.law.scale_limits for model in models]),
        "rows": np.stack([model.law.rows for model in models]),
        "row_weights": np.stack([model.law.weights for model in models]),
        "smoothing_size": np.array([size for size, _ in smooth]),
        "smoothing_root": np.stack([root for _, root in smooth]),
        "class_intercepts": np.stack([model.classes.intercepts for model in models]),
        "class_slopes": np.stack([model.classes.slopes for model in models]),
        "class_never": np.stack([model.classes.never for model in models]),
        "lower": first.runs.lower[0, columns],
        "upper": first.runs.upper[0, columns],
        "distant": np.isin(columns, first.runs.distant).astype(float),
    }
