"""What came out of a study, as summary.json and estimates.json hold it: every key with its type, meaning and unit.

docs/summary.md is made of the words beneath the fields, and of those of a table where a field holds one. Numbers are in
SI where no unit is named.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from lithobrake.results import dispersion, ground_results, journey_results, model_results, run_results
from lithobrake.results.questions import AimResults, LimitStateResult
from lithobrake.results.site_results import BedNumbers, SiteResults
from lithobrake.results.study_files import json_values, results_in
from lithobrake.vocabulary.plain_text import short_repr


@dataclass(frozen=True)
class Estimates:
    """Results of the first touchdowns of the landers, as estimates.json holds it."""

    returns: run_results.ReturnFraction
    shares: run_results.RunShares
    flights: dispersion.ImpactNumbers
    variance_shares: Mapping[str, run_results.VarianceParts | None]
    outputs: Mapping[str, run_results.OutputEstimate | run_results.OutputDirection]
    runs: run_results.RunResults
    sides: Mapping[str, journey_results.SideResults]
    __repr__ = short_repr


@dataclass(frozen=True, kw_only=True)
class Results:
    """Results of a study, equal in two executions of it. What the study does not ask for is null or empty."""

    answer: tuple[str, ...]
    """outcome of the landers, the population for which it holds, and what is missing, in sentences"""
    headline: tuple[str, ...]
    """the answer, then the main numbers, in sentences"""
    units: Mapping[str, str]
    """unit of each output of a touchdown"""
    beds: tuple[BedNumbers, ...]
    site: SiteResults
    ends: Mapping[str, run_results.CountedShare]
    """how the landers ended: at_rest, escaped, partner and under_way, which add up to 1 and whose bounds hold whatever
    journeys came to that failed; and failed, the fraction of all journeys; empty without landers"""
    journeys: int
    """landers that were followed"""
    touchdowns: int
    """landings that were simulated for them"""
    rest: journey_results.JourneyRest | None
    """where, when and how the landers come to rest; null without landers"""
    delivery: journey_results.DeliveryResults | None
    """place and state of the first impacts; null without landers"""
    returns: run_results.ReturnFraction
    shares: run_results.RunShares
    flights: dispersion.FlightResults
    variance_shares: Mapping[str, run_results.VarianceParts | None]
    """by output of the first touchdown, and `returns`"""
    end_variance_shares: Mapping[str, run_results.VarianceParts | None]
    """parts of the variance of the ends by inputs of the first touchdown: at_rest (0 or 1), and time_s and distance_m
    of the landers at rest; empty with journey.touchdowns"""
    outputs: Mapping[str, run_results.OutputEstimate | run_results.OutputDirection]
    runs: run_results.RunResults
    outputs_of_runs: Mapping[str, run_results.OutputRange]
    sides: Mapping[str, journey_results.SideResults]
    """by the side of the lander that faces the ground at the first touchdown; empty for a sphere, a cube, and if
    attitudes are not known"""
    over_grounds: ground_results.OverGrounds | None
    """with ground.unknown = "everywhere": what one of the grounds would give; null without"""
    finer_ground: ground_results.FinerGround | None
    """with [ground]: ground that is finer than any bed; null without"""
    ground_curve: ground_results.GroundCurve | None
    """with [ground] and grains of several sizes: how journeys end against the size of the grains; null without"""
    grounds: Mapping[str, ground_results.GroundKindResults]
    """with [ground]: by kind of ground, in the order of the study file; empty without"""
    soils: Mapping[str, journey_results.SoilResults]
    """with [soil]: by region of the body, in the order of the study file, and `elsewhere`; empty without"""
    sky: Mapping[str, journey_results.SkyResults]
    """visibility of sun, earth and orbiter for the landers at rest; empty without [sky]"""
    limit_states: Mapping[str, LimitStateResult]
    """each limit state of the study file; empty if it has none"""
    emulator: model_results.EmulatorResults | None
    """the emulator of the first touchdown; null if too few landers leave for one, or there are none"""
    emulated: journey_results.EmulatedJourneys | None
    """landers that the emulator of all touchdowns followed to rest; null with journey.emulated_count = 0"""
    hard_ground: Mapping[str, dispersion.FollowedLanders]
    """landers that were followed on other ground: hard, equivalent (hard ground with the restitution of the soil) and
    expansion (the soil by the refined expansion); empty with hard_ground.count = 0"""
    aim: AimResults | None
    """delivery options; null where the study file has none"""
    samples: model_results.SampleResults | None
    """samples of the first touchdown; null with monte_carlo.sample_count = 0"""
    expansion: model_results.ExpansionAnalysis | None
    """expansions of the first touchdown; null without [expansion]"""
    __repr__ = short_repr

    @property
    def spreads(self) -> dict[str, run_results.OutputEstimate]:
        """The outputs with mean and quantiles."""
        return {name: one for name, one in self.outputs.items() if isinstance(one, run_results.OutputEstimate)}

    @property
    def directions(self) -> dict[str, run_results.OutputDirection]:
        """The outputs with neither beginning nor end."""
        return {name: one for name, one in self.outputs.items() if isinstance(one, run_results.OutputDirection)}


@dataclass(frozen=True)
class RunTimes:
    """Time of the runs."""

    asked: int
    """runs of all designs"""
    distinct: int
    """distinct runs, as in the ledger"""
    wall_s: float
    """wall time of all of them together"""
    cpu_s: float
    """CPU time of all of them together"""
    longest_wall_s: float
    """wall time of the longest"""


@dataclass(frozen=True)
class Provenance:
    """Origin of the results; everything that may differ between two executions of one study."""

    date: str
    """when the summary was made, UTC"""
    folder: str
    """folder of the study, as it was given"""
    host: str
    """name of the machine"""
    system: str
    """operating system"""
    cores: int | None
    """number of cores"""
    python: str
    """version of Python"""
    packages: Mapping[str, str]
    """version of each package that numbers depend on"""
    wall_s: Mapping[str, float]
    """wall time of each stage when its files were made"""
    runs: RunTimes
    __repr__ = short_repr


@dataclass(frozen=True)
class Summary:
    """summary.json. In brackets it has the JSON values of a part, `summary["results"]`, for scripts that read keys."""

    format_version: int
    """version of the format; files with different versions have different keys"""
    study: Mapping[str, Any]
    """the study with all defaults, as the tables of its file (every key: lithobrake new)"""
    results: Results
    """the results, equal in two executions of one study"""
    provenance: Provenance
    """origin of the results; everything that may differ between two executions of one study"""
    __repr__ = short_repr

    def __getitem__(self, part: str) -> Any:
        """The JSON values of a part."""
        value = getattr(self, part)
        return json_values(value) if is_dataclass(value) else value

    def to_json(self) -> dict[str, Any]:
        """The JSON values of the file."""
        return {part.name: self[part.name] for part in fields(self)}

    @classmethod
    def of_json(cls, content: Mapping[str, Any]) -> "Summary":
        """Read from the JSON values of a file. Raises KeyError and ValueError as `results_in` does."""
        results = results_in(Results, content["results"], "results")
        provenance = results_in(Provenance, content["provenance"], "provenance")
        return cls(content["format_version"], content["study"], results, provenance)
