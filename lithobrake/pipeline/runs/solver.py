"""A program or function of the user's own that makes the touchdowns: what it is told, and what it has to answer."""

import hashlib
import math
import reprlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from lithobrake.campaign import Command, ModelServer
from lithobrake.campaign.single_run import Model, output_number
from lithobrake.campaign.worker import pickled
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, OUTPUTS, SPIN_OUT, Row

# A landing as a vector: the outcome as its place among TouchdownOutcome, and the outputs.
LANDING = ("outcome", *OUTPUTS)
# What speed and elevation may be off their components: numbers printed with six digits, as C and C++ do, agree so far.
PRINTED = 2e-5


@dataclass(frozen=True)
class SolverModel:
    """Touchdowns by a program; setting: what it is told beside the values of a run."""

    command: Command
    setting: Mapping[str, Any]

    def __call__(self, values: Row, seed: int) -> dict[str, Any]:
        """Make one touchdown. Raises ValueError for an outcome or outputs that a study cannot use."""
        return checked(self.command.answer, self.command.ask({"inputs": values, "seed": seed, "setting": self.setting}))


@dataclass(frozen=True)
class ServerModel:
    """Touchdowns by a model of a server: its one vector has the uncertain inputs, by names in their order.

    setting: what it is told beside the values of a run.
    """

    server: ModelServer
    names: tuple[str, ...]
    setting: Mapping[str, Any]

    def __call__(self, values: Row, seed: int) -> dict[str, Any]:
        """Make one touchdown. Raises ValueError for an answer that a study cannot use."""
        config = {"seed": seed, "inputs": values, "setting": self.setting}
        vectors = self.server.evaluate([[values[name] for name in self.names]], config, LANDING)
        numbers = [number for vector in vectors for number in vector]
        outcomes = tuple(TouchdownOutcome)
        # A float is in a range of whole numbers only where it is whole.
        if len(numbers) != len(LANDING) or numbers[0] not in range(len(outcomes)):
            raise ValueError(
                f"{self.server.address} answered {reprlib.repr(numbers)}; allowed: {len(LANDING)} numbers, "
                f"{', '.join(LANDING)}, the outcome from 0: {', '.join(outcomes)}"
            )
        outcome = outcomes[int(numbers[0])]
        outputs = dict(zip(OUTPUTS, numbers[1:], strict=True)) if outcome == TouchdownOutcome.CLEAR else {}
        return checked(f"{self.server.address}'s answer", {"outcome": outcome, "outputs": outputs})


@dataclass(frozen=True)
class FunctionModel:
    function: Model

    def __call__(self, values: Row, seed: int) -> dict[str, Any]:
        """Make one touchdown. Raises ValueError for an answer that a study cannot use."""
        answer = self.function(values, seed)
        if not isinstance(answer, Mapping) or not isinstance(answer.get("outputs", {}), Mapping):
            raise ValueError(
                f"the model gave {reprlib.repr(answer)}; it must give a dict with an outcome and outputs by name"
            )
        outputs = {name: output_number(name, value) for name, value in answer.get("outputs", {}).items()}
        # An output without a value is absent, as in a program's answer.
        known = {name: value for name, value in outputs.items() if not math.isnan(value)}
        return checked("the model's answer", {**answer, "outputs": known})


def function_identity(function: Model) -> str:
    """What tells one function from another: the hash of its pickle, which is its name and its attributes.

    Raises ValueError for a function that cannot be sent to a worker process.
    """
    return hashlib.sha256(pickled("the model", function)).hexdigest()[:16]


def checked(what: str, answer: Mapping[str, Any]) -> dict[str, Any]:
    """An answer as a study keeps it; what: who says it. Raises ValueError for one that a study cannot use."""
    outcome, outputs = answer.get("outcome", TouchdownOutcome.CLEAR), completed(answer["outputs"])
    if outcome not in list(TouchdownOutcome):
        raise ValueError(f"{what} has the outcome {outcome!r}; allowed: {', '.join(TouchdownOutcome)}")
    if outcome == TouchdownOutcome.CLEAR:
        refuse_contradictions(what, outputs)
    return {"outcome": str(outcome), "outputs": outputs, "draws": answer.get("draws", {})}


def completed(outputs: Mapping[str, float]) -> dict[str, float]:
    """The outputs with speed [m/s], elevation [rad] and spin [rad/s], where only components of them were given."""
    found = {name: float(value) for name, value in outputs.items()}
    if all(f"velocity_out_{axis}" in found for axis in "xyz"):
        x, y, z = (found[f"velocity_out_{axis}"] for axis in "xyz")
        found.setdefault("speed_out", math.hypot(x, y, z))
        found.setdefault("elevation_out", math.atan2(z, math.hypot(x, y)))
    if all(name in found for name in SPIN_OUT):
        found.setdefault("spin_out", math.hypot(*(found[name] for name in SPIN_OUT)))
    return found


def refuse_contradictions(what: str, outputs: Mapping[str, float]) -> None:
    """Raise ValueError unless these are outputs [SI] of a lander that leaves: all there, outwards, of one velocity."""
    lacking = [name for name in OUTPUTS if name not in outputs]
    if lacking:
        raise ValueError(f"{what} lacks {', '.join(lacking)}; a lander that leaves has all of them")
    if outputs["velocity_out_z"] <= 0.0:
        raise ValueError(
            f"{what} has the outcome clear and a velocity_out_z of {outputs['velocity_out_z']:g} m/s; a lander "
            "that leaves moves outwards, along +z: reverse the axis, or give another outcome"
        )
    if outputs["spin_out"] < 0.0:
        raise ValueError(f"{what} has a spin_out of {outputs['spin_out']:g} rad/s; it is a size: at least 0")
    _refuse_parts(what, outputs)
    components = {name: value for name, value in outputs.items() if name.startswith(("velocity_out_", "spin_out_"))}
    for name, follows in completed(components).items():
        # Speed, elevation and components are read by different stages, which would describe different landings.
        if not math.isclose(outputs[name], follows, rel_tol=PRINTED, abs_tol=0.0):
            raise ValueError(
                f"{what} has {outputs[name]:.8g} for {name}, and {follows:.8g} follows from "
                f"{'spin' if name == 'spin_out' else 'velocity'}_out_x, _y and _z (SI, angles in rad): leave it out, "
                "or correct one of them"
            )


def _refuse_parts(what: str, outputs: Mapping[str, float]) -> None:
    """Raise ValueError where of a spin or an attitude a part is missing, or an attitude is no unit quaternion."""
    for names in (SPIN_OUT, ORIENTATION_OUT):
        given = [name for name in names if name in outputs]
        if given and len(given) < len(names):
            lacking = ", ".join(name for name in names if name not in given)
            raise ValueError(f"{what} has {', '.join(given)} and lacks {lacking}; give all of them, or none")
    length = math.hypot(*(outputs[name] for name in ORIENTATION_OUT if name in outputs))
    if ORIENTATION_OUT[0] in outputs and not math.isclose(length, 1.0, rel_tol=PRINTED):
        raise ValueError(
            f"{what} has a quaternion orientation_out_w, _x, _y, _z of length {length:.8g}; allowed: 1; divide by it"
        )
