"""Which runs a study asks for: the points of its designs, and the inputs that the screening keeps."""

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.hashing import hashed_seed
from lithobrake.pipeline.beds import touchdown_reads
from lithobrake.pipeline.touchdown_runs import drawn_reads
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution, Surrogate


def design_inputs(study: Study) -> "dict[str, Distribution]":
    """The uncertain inputs of the touchdown with their distributions, in the order of the file's sections."""
    return {name: value.to_chaos() for name, value in uncertain(study.touchdown_values()).items()}


def design_reads(study: Study) -> dict[str, Any]:
    """What the runs of any design depend on."""
    values = study.touchdown_values()
    fixed = {name: value for name, value in values.items() if name not in uncertain(values)}
    inputs = {name: distribution.to_json() for name, distribution in design_inputs(study).items()}
    return {"touchdown": touchdown_reads(study), "drawn": drawn_reads(study), "fixed": fixed, "inputs": inputs}


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


def points(study: Study, design: str, kept: Sequence[str]) -> np.ndarray:
    """The points of a design, shape [point_count, input_count]; inputs that do not vary are at their median."""
    from lithobrake.analysis import sample_inputs

    inputs = design_inputs(study)
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
