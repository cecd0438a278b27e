"""One readable JSON file for each emulator: its runs, its choices and its coefficients, bit for bit.

Nothing in the file is executed, and whoever has lost this program can still read what was fitted to what.
"""

from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from lithobrake.chaos import storage
from lithobrake.chaos.basis import multi_index_set
from lithobrake.emulator.latent_variable import BRANCHES, LATENT_DEGREE, LATENTS, LatentTerms
from lithobrake.emulator.law import Choices, ClassChoice, Law, OutcomeClasses
from lithobrake.emulator.mean_law import Terms
from lithobrake.emulator.ridge_ladder import Ladder, Rung
from lithobrake.emulator.stochastic_expansion import StochasticExpansion
from lithobrake.emulator.training_runs import TrainingRuns
from lithobrake.emulator.validation import Scores
from lithobrake.vocabulary.array_types import Array

FORMAT = "lithobrake emulator"
# JSON has no infinity: no bound and no kernel are null.
SCORES = ("energy", "energy_of_rows", "gain", "gain_error")


@dataclass(frozen=True)
class Parts:
    """What an emulator is made of. weights: how often each run counts [run_count], 1 but for refits."""

    runs: TrainingRuns
    terms: Terms
    choices: Choices
    class_choice: ClassChoice
    weights: Array
    law: Law
    classes: OutcomeClasses
    scores: Scores
    expansion: StochasticExpansion | None = None

    @cached_property
    def row_points(self) -> Array:
        """Standardised inputs of the runs with outputs [output_run_count, input_count]."""
        return self.terms.matrix(self.runs.x[self.runs.has_outputs])[:, : len(self.runs.inputs)]


def content_of(model: Parts, statement: str) -> dict[str, Any]:
    """The parts of an emulator as JSON values."""
    runs = model.runs
    return {
        "statement": statement,
        "scores": {key: getattr(model.scores, key) for key in SCORES},
        "crps_skill": model.scores.crps_skill.tolist(),
        "band_90": model.scores.band_90.tolist(),
        "kernel_widths": [_finite(width) for width in model.choices.widths],
        "location_ladders": [[asdict(rung) for rung in ladder] for ladder in model.choices.location],
        "scale_ladders": [[asdict(rung) for rung in ladder] for ladder in model.choices.scale],
        "multi_indices": model.terms.indices.tolist(),
        "location": model.law.location.tolist(),
        "log_scale": model.law.log_scale.tolist(),
        "scale_limits": model.law.scale_limits.tolist(),
        "class_inverse_penalty": model.class_choice.inverse_penalty,
        "class_rung": None if model.class_choice.rung is None else asdict(model.class_choice.rung),
        "class_intercepts": model.classes.intercepts.tolist(),
        "class_slopes": model.classes.slopes.tolist(),
        "class_never": model.classes.never.tolist(),
        "weights": model.weights.tolist(),
        "rows": model.law.rows.tolist(),
        "pit": model.scores.pit.tolist(),
        "expansion": None if model.expansion is None else _expansion_to_json(model.expansion),
        **runs_to_json(runs),
    }


def parts_of(content: dict[str, Any]) -> Parts:
    """The parts that `content_of` wrote; raises ValueError where they do not fit together."""
    runs = runs_from_json(content)
    modelled, inputs = len(runs.modelled), len(runs.inputs)
    indices = storage.indices_from_json(content["multi_indices"], inputs)
    linear = multi_index_set(inputs, 1)[1:]
    if not np.array_equal(indices[:inputs], linear) or (indices[inputs:].sum(axis=1) < 2).any():
        raise ValueError("multi_indices must begin with the linear terms in the order of the inputs")
    choices = Choices(
        tuple(_ladder_from_json(rows, inputs) for rows in content["location_ladders"]),
        tuple(_ladder_from_json(rows, inputs) for rows in content["scale_ladders"]),
        _widths_from_json(content["kernel_widths"], inputs),
    )
    weights = column_from_json("weights", content["weights"], len(runs.x))
    law = Law(
        _table("location", content["location"], (1 + len(indices), modelled)),
        _table("log_scale", content["log_scale"], (1 + len(indices), modelled)),
        _table("scale_limits", content["scale_limits"], (2, modelled)),
        _table("rows", content["rows"], (len(runs.y), modelled)),
        weights[runs.has_outputs],
    )
    count = len(runs.outcome_names)
    classes = OutcomeClasses(
        column_from_json("class_intercepts", content["class_intercepts"], count),
        _table("class_slopes", content["class_slopes"], (count, len(indices))),
        column_from_json("class_never", content["class_never"], count),
    )
    scores = Scores(
        **{key: float(content["scores"][key]) for key in SCORES},
        crps_skill=column_from_json("crps_skill", content["crps_skill"], modelled),
        band_90=column_from_json("band_90", content["band_90"], modelled),
        pit=_table("pit", content["pit"], (len(runs.y), modelled)),
    )
    if len(choices.location) != modelled or len(choices.scale) != modelled:
        raise ValueError("location_ladders and scale_ladders must have one entry for each modelled output")
    rung = content["class_rung"]
    class_choice = ClassChoice(
        float(content["class_inverse_penalty"]), None if rung is None else _ladder_from_json([rung], inputs)[0]
    )
    expansion = _expansion_from_json(content.get("expansion"), runs)
    return Parts(runs, Terms(runs.inputs, indices), choices, class_choice, weights, law, classes, scores, expansion)


def _expansion_to_json(expansion: StochasticExpansion) -> dict[str, Any]:
    return {
        "latent": expansion.terms.latent,
        "noise": expansion.noise,
        "parameters": expansion.parameters.tolist(),
        "multi_indices": expansion.terms.indices.tolist(),
        "odds": expansion.terms.odds.tolist(),
    }


def _expansion_from_json(content: dict[str, Any] | None, runs: TrainingRuns) -> StochasticExpansion | None:
    """An expansion, where there is one; raises ValueError where it does not fit the runs, or itself."""
    # Emulators from before there were expansions have rows, and no such key.
    if content is None:
        return None
    latent, noise, inputs = content["latent"], float(content["noise"]), len(runs.inputs)
    indices = storage.indices_from_json(content["multi_indices"], inputs + 1)
    odds = storage.indices_from_json(content["odds"], inputs) if latent == BRANCHES else np.empty((0, inputs), int)
    highest = 1 if latent == BRANCHES else LATENT_DEGREE
    if latent not in LATENTS or indices[:, -1].max() > highest or not 0.0 < noise < np.inf:
        raise ValueError(f"latent must be one of {', '.join(LATENTS)}, its powers up to {highest}, noise above 0")
    if runs.y.shape[1] != 1:
        raise ValueError("output_names must hold one output, which is no rider")
    terms = LatentTerms(runs.inputs, latent, indices, odds)
    parameters = column_from_json("parameters", content["parameters"], terms.parameter_count)
    return StochasticExpansion(terms, parameters, noise)


def runs_to_json(runs: TrainingRuns) -> dict[str, Any]:
    return {
        "inputs": storage.inputs_to_json(runs.inputs),
        "output_names": list(runs.output_names),
        "riders": [runs.output_names[k] for k in runs.riders],
        "distant_bounds": [runs.output_names[k] for k in runs.distant],
        "outcome_names": list(runs.outcome_names),
        "output_outcome": runs.outcome_names[runs.output_outcome],
        "group": runs.group.tolist(),
        "outcome": runs.outcome.tolist(),
        "x": runs.x.tolist(),
        "y": runs.y.tolist(),
        "lower": _table_to_json(runs.lower),
        "upper": _table_to_json(runs.upper),
    }


def runs_from_json(content: dict[str, Any]) -> TrainingRuns:
    """The runs of a file; raises ValueError where its tables do not fit together."""
    inputs, names = storage.inputs_from_json(content["inputs"]), tuple(storage.names_from_json(content["output_names"]))
    outcome_names = tuple(storage.names_from_json(content["outcome_names"]))
    x = storage.numbers_from_json("x", content["x"], len(inputs))
    outcome, group = (column_from_json(key, content[key], len(x)).astype(np.int64) for key in ("outcome", "group"))
    if outcome.min() < 0 or outcome.max() >= len(outcome_names) or group.min() < 0:
        raise ValueError("outcome and group must be places from 0 on, one for each run")
    output_outcome = outcome_names.index(content["output_outcome"])
    count = int((outcome == output_outcome).sum())
    return TrainingRuns(
        inputs,
        x,
        outcome,
        outcome_names,
        output_outcome,
        group,
        _table("y", content["y"], (count, len(names))),
        _table_from_json("lower", content["lower"], (count, len(names)), -np.inf),
        _table_from_json("upper", content["upper"], (count, len(names)), np.inf),
        names,
        tuple(names.index(rider) for rider in content["riders"]),
        tuple(names.index(output) for output in content["distant_bounds"]),
    )


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _ladder_from_json(rows: Any, input_count: int) -> Ladder:
    """Rungs of a ladder; raises ValueError for other inputs than there are."""
    ladder = tuple(Rung(tuple(row.pop("amplitudes")), tuple(row.pop("fades")), **row) for row in map(dict, rows))
    if any(len(numbers) != input_count for rung in ladder for numbers in (rung.amplitudes, rung.fades)):
        raise ValueError(f"a rung must have amplitudes and fades for each of {input_count} inputs")
    return ladder


def _widths_from_json(values: Any, input_count: int) -> tuple[float, ...]:
    """Widths of a kernel, null where it does not look at an input."""
    widths = tuple(float("inf") if value is None else float(value) for value in values)
    if len(widths) != input_count or not min(widths) > 0.0:
        raise ValueError(f"kernel_widths must be {input_count} numbers above 0, or null")
    return widths


def _table_to_json(bounds: Array) -> list[list[float | None]]:
    """Bounds, one row for all runs where they never differ."""
    rows = bounds[:1] if (bounds == bounds[0]).all() else bounds
    return [[_finite(value) for value in row] for row in rows.tolist()]


def _table_from_json(name: str, rows: Any, shape: tuple[int, int], none: float) -> Array:
    table = np.array([[none if value is None else value for value in row] for row in rows], dtype=float)
    if table.ndim != 2 or len(table) not in (1, shape[0]) or table.shape[1] != shape[1]:
        raise ValueError(f"{name} must be one row, or one for each run with outputs, of {shape[1]} numbers or null")
    return np.array(np.broadcast_to(table, shape))


def _table(name: str, rows: Any, shape: tuple[int, int]) -> Array:
    table = storage.numbers_from_json(name, rows, shape[1])
    if len(table) != shape[0]:
        raise ValueError(f"{name} has {len(table)} rows, but must have {shape[0]}")
    return table


def column_from_json(name: str, values: Any, count: int) -> Array:
    """A list of finite numbers [count]."""
    return _table(name, [[value] for value in values], (count, 1))[:, 0]
