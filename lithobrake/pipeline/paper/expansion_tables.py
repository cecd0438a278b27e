"""What the explorer evaluates where an expansion stands for the runs: its tables in the form of an emulator's."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.emulate.explorer_tables import FILE, save_explorer
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulate.samples import CLEAR
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper.expansion_samples import draw_samples, outcome_model
from lithobrake.pipeline.paper.run_noise import Scatter
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.explorer_tables import ExplorerTables
from lithobrake.study.quantity import median

if TYPE_CHECKING:
    from lithobrake.analysis import OutcomeModel
    from lithobrake.chaos import Distribution, Surrogate

SPEED = "impact.speed"
# Points to a term at which a quadratic is read off: more than enough, as it has no scatter.
POINTS_PER_TERM = 3


def sample_expansion(job: Job) -> None:
    """Draw the samples, and write what the explorer evaluates."""
    draw_samples(job)
    write_expansion_explorer(job)


def write_expansion_explorer(job: Job) -> None:
    """Write explorer.h5: the refined expansion, then the same fitted to other draws of its residuals."""
    from lithobrake.chaos import coefficient_changes, load

    refined, runs = load(job.folder / "refined.json"), DesignRuns.load(job.folder, "refined")
    x = runs.columns(refined.input_names)
    changes = coefficient_changes(
        refined, x, runs.y, count=REFIT_COUNT - 1, seed=hashed_seed(job.study.seed, "refits")
    )  # fmt: skip
    outcome, fixed = outcome_model(job), job.study.touchdown_values()[SPEED]
    job.progress(0, 1, "tables of the explorer")
    scatter = Scatter.of(job, refined)
    if not job.study.monte_carlo.scatter:
        scatter = Scatter(np.zeros_like(scatter.rows[:1]), scatter.speed, scatter.grows)
    save_explorer(
        job.folder / FILE,
        ExplorerTables(
            expansion_tables(job.design.inputs, refined, changes, outcome, scatter),
            input_names=tuple(job.design.inputs),
            output_names=tuple(refined.output_names),
            outcome_names=tuple(map(str, outcome.names)),
            output_outcome=str(outcome.names[CLEAR]),
            group_count=int(runs.has_outputs.sum()),
            # Runs on one bed bound no share over other beds.
            interval_reach=float("nan"),
            bound={SPEED: median(fixed)},
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
    from lithobrake.chaos import input_tables

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
    from lithobrake.chaos import basis_matrix, sobol_sequence

    terms = np.vstack([np.zeros_like(leading[:1]), leading])
    x = sobol_sequence(inputs, POINTS_PER_TERM * len(terms))
    logits, matrix = outcome.logits(x), basis_matrix(inputs, terms, x)
    met = np.isfinite(logits[0])
    table = np.zeros((len(terms), len(met)))
    # The logits are quadratic, so a quadratic through them is they themselves.
    table[:, met] = np.linalg.lstsq(matrix, logits[:, met])[0]
    table[0, ~met] = -np.inf
    return table[0], table[1:].T
