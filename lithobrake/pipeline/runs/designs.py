"""Which runs a study asks for: the points of its designs, and the inputs that the screening keeps."""

from typing import TYPE_CHECKING, Any

from lithobrake.pipeline.runs.beds import touchdown_reads
from lithobrake.pipeline.runs.touchdown_runs import drawn_reads
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution


def design_inputs(study: Study) -> "dict[str, Distribution]":
    """The uncertain inputs of the touchdown with their distributions, in the order of the file's sections."""
    return {name: value.to_chaos() for name, value in uncertain(study.touchdown_values()).items()}


def design_reads(study: Study) -> dict[str, Any]:
    """What the runs of any design depend on."""
    values = study.touchdown_values()
    fixed = {name: value for name, value in values.items() if name not in uncertain(values)}
    inputs = {name: distribution.to_json() for name, distribution in design_inputs(study).items()}
    return {"touchdown": touchdown_reads(study), "drawn": drawn_reads(study), "fixed": fixed, "inputs": inputs}
