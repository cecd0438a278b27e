"""What a study says of a requirement: the deliveries that meet it, and the edges of what is admissible."""

from dataclasses import dataclass

from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.requirement import AdmissibleEdge, Verdict


@dataclass(frozen=True)
class RequiredDelivery:
    """A delivery of the grid: values in the order of the parameters.

    probability: with its interval; unknown: fraction of its landers of unknown outcome; beyond: what their impacts are
    beyond, in words.
    """

    values: tuple[float, ...]
    probability: Estimate
    unknown: float
    beyond: str
    verdict: Verdict


@dataclass(frozen=True)
class RequirementEdge:
    """The edge of what is admissible along one parameter, by its number.

    values: of the others, in the order of the parameters; None for this one.
    """

    along: int
    values: tuple[float | None, ...]
    edge: AdmissibleEdge


@dataclass(frozen=True)
class SimulatedCorner:
    """A corner of what is admissible, by simulated landings and by the emulator; agrees: None without intervals.

    landings, emulator: as means over beds, with intervals of one level, whatever that of the requirement is.
    """

    values: tuple[float, ...]
    journeys: int
    landings: Estimate
    emulator: Estimate
    agrees: bool | None


@dataclass(frozen=True)
class Requirement:
    """A requirement and what was found of it.

    name, condition: of the limit state; required: its least probability; level: of the intervals; names, units: of the
    parameters; grid: values of each in ascending order; deliveries: all combinations, the last parameter fastest;
    corners: numbers of the deliveries that meet it and lie farthest out; landers: of each delivery; refits: of the
    emulator, to resampled beds; one_ground: whether intervals are those of one ground.
    """

    name: str
    condition: str
    required: float
    level: float
    names: tuple[str, ...]
    units: tuple[str, ...]
    grid: tuple[tuple[float, ...], ...]
    deliveries: tuple[RequiredDelivery, ...]
    edges: tuple[RequirementEdge, ...]
    corners: tuple[int, ...]
    simulated: tuple[SimulatedCorner, ...]
    landers: int
    refits: int
    beds: int
    one_ground: bool

    def count(self, verdict: Verdict) -> int:
        """How many deliveries have this verdict."""
        return sum(one.verdict is verdict for one in self.deliveries)
