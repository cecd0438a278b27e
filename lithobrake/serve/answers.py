"""A model that is served, and what a request for one is answered, whoever asks and however it is evaluated."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from lithobrake.serve.clients import ClientGoneError


@dataclass(frozen=True)
class ServedModel:
    """A model by its name, the names of its inputs and outputs in their order, and the function.

    evaluate: called with the inputs and what the client configures; it gives the outputs, all finite, and raises
    ValueError for inputs or a configuration that it refuses.
    """

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    evaluate: Callable[[list[float], Mapping[str, Any]], list[float]]

    def __post_init__(self) -> None:
        if not self.inputs or not self.outputs:
            raise ValueError(f"model {self.name} has {len(self.inputs)} inputs and {len(self.outputs)} outputs")


FEATURES = ("Evaluate", "Gradient", "ApplyJacobian", "ApplyHessian")
# Evaluates a model at a point with a configuration; the last argument says whether the client has left meanwhile, and
# an evaluation that ends for that raises ClientGoneError.
Evaluate = Callable[[ServedModel, list[float], Mapping[str, Any], Callable[[], bool]], list[float]]


class RequestError(Exception):
    """What a client is answered in place of a result: a kind of error, a sentence, a status of HTTP."""

    def __init__(self, kind: str, message: str, status: int = 400) -> None:
        super().__init__(message)
        self.kind, self.status = kind, status


def evaluate_here(
    model: ServedModel, point: list[float], config: Mapping[str, Any], gone: Callable[[], bool]
) -> list[float]:
    """Evaluate in this process, for as long as it takes."""
    return model.evaluate(point, config)


def answer(
    models: Mapping[str, ServedModel],
    path: str,
    request: Mapping[str, Any],
    evaluate: Callable[[ServedModel, list[float], Mapping[str, Any]], list[float]],
) -> dict[str, Any]:
    """What a request for a model is answered. Raises RequestError, and ClientGoneError where nobody waits for it."""
    name = request.get("name")
    model = models.get(name) if isinstance(name, str) else None
    if model is None:
        raise RequestError("ModelNotFound", f"model {name!r} is not served; there are: {', '.join(models)}")
    if path == "/ModelInfo":
        # The names are more than the protocol asks for: its vectors have none.
        names = {"inputs": list(model.inputs), "outputs": list(model.outputs)}
        return {"support": {feature: feature == "Evaluate" for feature in FEATURES}, **names}
    if path == "/InputSizes":
        return {"inputSizes": [len(model.inputs)]}
    if path == "/OutputSizes":
        return {"outputSizes": [len(model.outputs)]}
    if path != "/Evaluate":
        raise RequestError("UnsupportedFeature", f"{path} is not supported; model {name} supports /Evaluate alone")
    point = _point(model, request.get("input"))
    try:
        outputs = [float(value) for value in evaluate(model, point, request.get("config", {}))]
    except ClientGoneError:
        raise
    except (ValueError, TypeError, OverflowError) as error:
        raise RequestError("InvalidInput", str(error)) from error
    # Whatever else a model raises is its own failure, and the server goes on.
    except Exception as error:
        raise RequestError("InvalidOutput", f"{type(error).__name__}: {error}", 500) from error
    if len(outputs) != len(model.outputs) or not all(map(math.isfinite, outputs)):
        raise RequestError("InvalidOutput", f"model {name} gave {outputs}, not {len(model.outputs)} numbers", 500)
    return {"output": [outputs]}


def _point(model: ServedModel, given: Any) -> list[float]:
    """The inputs of a request."""
    fits = isinstance(given, list) and len(given) == 1 and isinstance(given[0], list)
    if not fits or len(given[0]) != len(model.inputs):
        raise RequestError(
            "InvalidInput",
            f"input of model {model.name} is a list of one list of {len(model.inputs)} numbers: "
            f"{', '.join(model.inputs)}",
        )
    numbers = given[0]
    if not all(isinstance(one, int | float) and not isinstance(one, bool) and abs(one) < 1e300 for one in numbers):
        raise RequestError("InvalidInput", f"input of model {model.name} is {numbers}; allowed: finite numbers")
    return [float(number) for number in numbers]
