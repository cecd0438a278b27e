"""Monte Carlo on the refined expansion with the scatter of single runs, and its tables for the explorer."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.analysis import OutcomeModel, sample_inputs
from lithobrake.chaos import basis_matrix, input_tables, sobol_sequence
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.expansion.expansions import runs_of_designs
from lithobrake.pipeline.first_touchdown.emulator import draw_emulator_samples
from lithobrake.pipeline.first_touchdown.explorer_tables import EXPLORER_FILE, save_explorer
from lithobrake.pipeline.first_touchdown.samples import CLEAR, Samples, sampling_seed, touchdown_values
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.table import ExplorerTables
from lithobrake.study.quantity import median
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.file_names import REFINED_FILE
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import IMPACT_SPEED

if TYPE_CHECKING:
    from lithobrake.analysis import OutcomeModel
    from lithobrake.chaos import Distribution, Surrogate

# An angle scatters as much after a slow impact as after a fast one.
ANGLES = ("elevation_out",)
# Points at which the expansion is evaluated at once; between two blocks progress is shown.
_BLOCK = 1 << 20
# Points to a term at which a quadratic is read off: more than enough, as it has no scatter.
POINTS_PER_TERM = 3


@dataclass(frozen=True)
class Scatter:
    """Rows of joint differences of single runs from the expansion, made at impacts of about `speed` [m/s].

    rows    [row_count, output_count], SI; drawn whole, so that outputs stay together
    grows   which outputs scatter in proportion to the impact speed, [output_count]: velocities and spin
    """

    rows: np.ndarray
    speed: float
    grows: np.ndarray

    @classmethod
    def of(cls, job: Job, refined: "Surrogate") -> "Scatter":
        from lithobrake.chaos import joint_scatter

        runs = DesignRuns.load(job.folder, "refined")
        rows = joint_scatter(refined, runs.columns(refined.input_names), runs.y)
        # Every run has its impact speed among its inputs, whether the study varies it or not.
        speeds = runs.inputs[IMPACT_SPEED][runs.has_outputs]
        grows = np.array([name not in ANGLES for name in refined.output_names])
        return cls(rows, float(np.sqrt(np.mean(speeds**2))), grows)

    def draw(self, speed: np.ndarray, random: np.random.Generator) -> np.ndarray:
        """Differences for impacts at speeds [m/s], shape [count]; shape [count, output_count].

        Drawn at full size, those of fast impacts would throw a slow lander up faster than it came.
        """
        rows = self.rows[random.integers(len(self.rows), size=len(speed))]
        drawn: np.ndarray = rows * np.where(self.grows, (speed / self.speed)[:, None], 1.0)
        return drawn


def _draw_expansion_samples(job: Job) -> None:
    from lithobrake.chaos import load

    study, inputs = job.study, job.design.inputs
    refined = load(job.folder / REFINED_FILE)
    x = sample_inputs(inputs, study.sample_count, sampling_seed(study, "samples"))
    smooth = _evaluate(refined, x[:, [list(inputs).index(name) for name in refined.input_names]], job)
    job.progress(0, 1, "chances of the outcomes")
    random = np.random.Generator(np.random.PCG64(sampling_seed(study, "capture")))
    drawn = outcome_model(job).draw(x, random)
    outputs, without_scatter = smooth, None
    if study.monte_carlo.scatter:
        speed = touchdown_values(study, inputs, x, IMPACT_SPEED)
        generator = np.random.Generator(np.random.PCG64(sampling_seed(study, "scatter")))
        outputs, without_scatter = smooth + Scatter.of(job, refined).draw(speed, generator), smooth
    Samples.of(inputs, refined.output_names, x, outputs, drawn, without_scatter).save(job.folder)


def outcome_model(job: Job) -> "OutcomeModel":
    """The chances of the outcomes, learnt from all runs of the study that have one; a run that failed says nothing.

    Raises ValueError when no run has ended.
    """
    inputs = job.design.inputs
    runs = runs_of_designs(job).values()
    x = np.concatenate([one.columns(list(inputs)) for one in runs])
    outcomes = [outcome for one in runs for outcome in one.outcomes]
    names = tuple(TouchdownOutcome)
    ended = np.isin(outcomes, names)
    if not ended.any():
        raise ValueError("every run has failed (runs.sqlite has the reasons); remove their cause")
    return OutcomeModel(inputs, x[ended], [outcome for outcome in outcomes if outcome in names], names)


def _evaluate(surrogate: "Surrogate", x: np.ndarray, job: Job) -> np.ndarray:
    outputs = np.empty((len(x), len(surrogate.output_names)))
    for start in range(0, len(x), _BLOCK):
        outputs[start : start + _BLOCK] = surrogate(x[start : start + _BLOCK])
        job.progress(min(start + _BLOCK, len(x)), len(x), "samples")
    return outputs


def draw_samples(job: Job) -> None:
    """Sample the first touchdown by the refined expansion where the study has one, else by the emulator."""
    if job.study.expansion is None:
        draw_emulator_samples(job)
        return
    _draw_expansion_samples(job)
    write_expansion_explorer(job)


def write_expansion_explorer(job: Job) -> None:
    """Write explorer.h5: the refined expansion, then the same fitted to other draws of its residuals."""
    from lithobrake.chaos import coefficient_changes, load

    refined, runs = load(job.folder / REFINED_FILE), DesignRuns.load(job.folder, "refined")
    x = runs.columns(refined.input_names)
    changes = coefficient_changes(
        refined, x, runs.y, count=REFIT_COUNT - 1, seed=hashed_seed(job.study.seed, "refits")
    )  # fmt: skip
    outcome, fixed = outcome_model(job), job.study.touchdown_values()[IMPACT_SPEED]
    job.progress(0, 1, "tables of the explorer")
    scatter = Scatter.of(job, refined)
    if not job.study.monte_carlo.scatter:
        scatter = Scatter(np.zeros_like(scatter.rows[:1]), scatter.speed, scatter.grows)
    save_explorer(
        job.folder / EXPLORER_FILE,
        ExplorerTables(
            expansion_tables(job.design.inputs, refined, changes, outcome, scatter),
            input_names=tuple(job.design.inputs),
            output_names=tuple(refined.output_names),
            outcome_names=tuple(map(str, outcome.names)),
            output_outcome=str(outcome.names[CLEAR]),
            group_count=int(runs.has_outputs.sum()),
            # Runs on one bed bound no share over other beds.
            interval_reach=float("nan"),
            unseen_limit=float("nan"),
            bound={IMPACT_SPEED: median(fixed)},
        ),
    )


def expansion_tables(
    inputs: "Mapping[str, Distribution]",
    refined: "Surrogate",
    changes: tuple[np.ndarray, np.ndarray],
    outcome: "OutcomeModel",
    scatter: Scatter,
) -> dict[str, np.ndarray]:
    """Tables of an expansion and of its refits, as `lithobrake.emulator.law_tables` says, over all inputs of a study.

    changes: of the coefficients, as `lithobrake.chaos.coefficient_changes` gives them. Outputs have no bounds and rows
    of scatter no smoothing; chances of outcomes follow the first terms, all of degree one and two. Beside them grows
    [output_count], 1 where scatter is in proportion to the impact's speed, and scatter_speed [1], of the runs [m/s].
    """
    terms = _terms(inputs, refined.input_names, changes[0])
    location = _locations(list(inputs), terms, refined, changes)
    intercepts, slopes = _classes(inputs, terms[: _leading_count(len(inputs))], outcome)
    (refits, _, count), rows = location.shape, scatter.rows
    return {
        **input_tables(inputs, terms),
        "multi_indices": terms.astype(float),
        "kernel_widths": np.full(len(inputs), np.inf),
        "row_inputs": np.zeros((len(rows), len(inputs))),
        "location": location,
        "log_scale": np.zeros((refits, len(terms) + 1, count)),
        "scale_limits": np.zeros((refits, 2, count)),
        "rows": np.repeat(rows[None], refits, axis=0),
        "row_weights": np.full((refits, len(rows)), 1.0 / len(rows)),
        "smoothing_size": np.zeros(refits),
        "smoothing_root": np.zeros((refits, count, count)),
        "class_intercepts": np.repeat(intercepts[None], refits, axis=0),
        "class_slopes": np.repeat(slopes[None], refits, axis=0),
        "class_never": np.zeros((refits, len(outcome.names))),
        "lower": np.full(count, -np.inf),
        "upper": np.full(count, np.inf),
        "distant": np.zeros(count),
        "grows": scatter.grows.astype(float),
        "scatter_speed": np.array([scatter.speed]),
    }


def _leading_count(input_count: int) -> int:
    """Number of terms of degree one and two."""
    return input_count + input_count * (input_count + 1) // 2


def _terms(inputs: "Mapping[str, Distribution]", kept: Sequence[str], indices: np.ndarray) -> np.ndarray:
    """Multi-indices over all inputs, without the constant: all of degree one, all of degree two, others of the kept."""
    own = np.eye(len(inputs), dtype=np.int64)
    pairs = [own[i] + own[j] for i in range(len(inputs)) for j in range(i, len(inputs))]
    higher = [index for index in _embedded(indices, list(inputs), kept) if index.sum() > 2]
    return np.array([*own, *pairs, *higher])


def _embedded(indices: np.ndarray, names: list[str], kept: Sequence[str]) -> np.ndarray:
    """Multi-indices [term_count, kept_count] over all inputs."""
    whole = np.zeros((len(indices), len(names)), dtype=np.int64)
    whole[:, [names.index(name) for name in kept]] = indices
    return whole


def _locations(
    names: list[str], terms: np.ndarray, refined: "Surrogate", changes: tuple[np.ndarray, np.ndarray]
) -> np.ndarray:
    """Coefficients of the constant and the terms, [refit_count, 1 + term_count, output_count]: the expansion first."""
    place = {(0,) * len(names): 0} | {tuple(index): row for row, index in enumerate(terms.tolist(), start=1)}

    def rows_of(indices: np.ndarray) -> list[int]:
        return [place[tuple(index)] for index in _embedded(indices, names, refined.input_names).tolist()]

    table = np.zeros((1 + len(changes[1]), len(place), len(refined.output_names)))
    table[:, rows_of(refined.multi_indices)] = refined.coefficients
    table[1:, rows_of(changes[0])] += changes[1]
    return table


def _classes(
    inputs: "Mapping[str, Distribution]", leading: np.ndarray, outcome: "OutcomeModel"
) -> tuple[np.ndarray, np.ndarray]:
    """Intercepts [class_count] of the outcomes' logits and their slopes [class_count, leading_count]."""
    terms = np.vstack([np.zeros_like(leading[:1]), leading])
    x = sobol_sequence(inputs, POINTS_PER_TERM * len(terms))
    logits, matrix = outcome.logits(x), basis_matrix(inputs, terms, x)
    met = np.isfinite(logits[0])
    table = np.zeros((len(terms), len(met)))
    # The logits are quadratic, so a quadratic through them is they themselves.
    table[:, met] = np.linalg.lstsq(matrix, logits[:, met])[0]
    table[0, ~met] = -np.inf
    return table[0], table[1:].T
