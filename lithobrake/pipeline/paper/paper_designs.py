"""The points of the designs of the paper method, and the inputs that its screening keeps."""

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.study import Study

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution, Surrogate


def kept_inputs(study: Study, screening: "Surrogate") -> tuple[str, ...]:
    """The smallest set of inputs that together explain the asked share of every deciding output.

    Among sets of one size the one whose weakest output is explained best is taken; the first in order breaks a tie.
    """
    columns = [screening.output_names.index(name) for name in study.design.kept_outputs]
    for size in range(1, len(screening.input_names) + 1):
        groups = list(combinations(screening.input_names, size))
        shares = [min(np.asarray(screening.sobol_group(group))[columns]) for group in groups]
        best = int(np.argmax(shares))
        # All inputs together explain everything, but for rounding.
        if shares[best] >= study.design.kept_share or size == len(screening.input_names):
            return groups[best]
    raise AssertionError("a design has at least one input")


def points(drawn: DrawnDesign, design: str, kept: Sequence[str]) -> np.ndarray:
    """The points of a design, shape [point_count, input_count]; inputs that do not vary are at their median."""
    from lithobrake.analysis import sample_inputs

    study, inputs = drawn.study, drawn.inputs
    varied = inputs if design in ("screening", "test_all") else {name: inputs[name] for name in kept}
    seed = hashed_seed(study.seed, design)
    if design.startswith("test"):
        x = sample_inputs(varied, study.design.test_count, seed=seed)
    else:
        x = _training_points(study, design, varied, seed)
    full = np.tile([distribution.median for distribution in inputs.values()], (len(x), 1))
    full[:, [list(inputs).index(name) for name in varied]] = x
    return full


def _training_points(study: Study, design: str, varied: "dict[str, Distribution]", seed: int) -> np.ndarray:
    """The points of a design to which an expansion is fitted, [point_count, len(varied)]."""
    from lithobrake.chaos import fekete, latin_hypercube, smolyak, sobol_sequence

    section = study.design
    if section.points == "smolyak":
        return smolyak(varied, level=getattr(section, f"{design}_level"))
    count = getattr(section, f"{design}_count")
    if section.points == "fekete":
        return fekete(varied, count, seed, degree=getattr(section, f"{design}_degree"))
    return (sobol_sequence if section.points == "sobol_sequence" else latin_hypercube)(varied, count, seed)


def replicate_count(study: Study, design: str) -> int:
    """Runs at every point of a design; the test sets have one."""
    return 1 if design.startswith("test") else study.design.replicate_count
