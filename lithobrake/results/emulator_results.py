"""How well the emulator of a drawn study predicts landings on beds that it has not seen."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lithobrake.results.json_values import INLINE


@dataclass(frozen=True)
class JointScore:
    """The score of all outputs together."""

    energy_skill: float
    """1 - energy score divided by that of resampling runs without regard to the inputs"""


@dataclass(frozen=True)
class OutputScore:
    """The scores of an output on held-out beds."""

    crps_skill: float
    """1 - CRPS divided by that of resampling runs without regard to the inputs"""
    band_90: float
    """share of runs inside the middle 90 % of their predictive distribution"""
    pit: tuple[int, ...]
    """number of runs by their PIT value (quantile in the predictive distribution), in ten bins"""


@dataclass(frozen=True)
class EmulatorScores:
    """Scores on held-out beds."""

    joint: JointScore
    outputs: Mapping[str, OutputScore] = field(metadata=INLINE)


@dataclass(frozen=True)
class EmulatorResults:
    """The emulator of a drawn study, on held-out beds (docs/emulator.md)."""

    of: str
    """which landings it describes, in words"""
    statement: str
    """predictive value of the inputs, in a sentence"""
    follows_inputs: bool
    """whether samples depend on the inputs; otherwise runs are resampled"""
    found_inputs: tuple[str, ...]
    """significant inputs: they change a mean, alone or by products; one test of 90 % for all"""
    scores: EmulatorScores
    warning: str | None
    """if its fraction lies outside the interval of the runs, a sentence that states this; otherwise null"""
