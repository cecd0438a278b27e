"""What came out of a study, as summary.json and estimates.json hold it: every key with its type, meaning and unit.

docs/summary.md is made of the words beneath the fields, and of those of a table where a field holds one. Numbers are in
SI where no unit is named.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from lithobrake.results import dispersion, journey_results, model_results, run_results
from lithobrake.results.questions import AimResults, LimitStateResult
from lithobrake.results.site_results import BedNumbers, SiteResults
from lithobrake.results.study_files import json_values, results_in
from lithobrake.vocabulary.plain_text import short_repr


@dataclass(frozen=True)
class Estimates:
    """What the runs of a drawn study say, as estimates.json holds it."""

    returns: run_results.ReturnFraction
    shares: run_results.RunShares
    flights: dispersion.ImpactNumbers
    variance_shares: Mapping[str, run_results.VarianceParts | None]
    outputs: Mapping[str, run_results.OutputEstimate | run_results.OutputDirection]
    runs: run_results.RunResults
    sides: Mapping[str, journey_results.SideResults]
    __repr__ = short_repr


@dataclass(frozen=True, kw_only=True)
class DrawnResults:
    """Results of a drawn study, equal in two executions of one study."""

    units: Mapping[str, str]
    """unit of each output of the emulator"""
    beds: tuple[BedNumbers, ...]
    returns: run_results.ReturnFraction
    shares: run_results.LandingShares
    flights: dispersion.FlightResults
    variance_shares: Mapping[str, run_results.VarianceParts | None]
    outputs: Mapping[str, run_results.OutputEstimate | run_results.OutputDirection]
    runs: run_results.RunResults
    outputs_of_runs: Mapping[str, run_results.OutputRange]
    site: SiteResults
    monte_carlo: model_results.MonteCarlo | None
    """samples of the emulator; null with [journey]"""
    ellipses: dispersion.LandingEllipses | None
    without_scatter: dispersion.WithoutScatter | None
    """null: samples of an emulator have no expansion alone"""
    rest: dispersion.RestResults | journey_results.JourneyRest
    """with [journey]: where, when and how the landers come to rest; otherwise trajectories of samples of the
    emulator"""
    limit_states: Mapping[str, LimitStateResult]
    """each limit state of the study file; empty if it has none"""
    aim: AimResults | None
    """delivery options; null where the study file has none"""
    emulator: model_results.EmulatorResults | None
    """null with [journey]"""
    answer: tuple[str, ...]
    """outcome of the landers, the population for which it holds, and what is missing, in sentences"""
    headline: tuple[str, ...]
    """the answer, then the main numbers, in sentences"""
    sides: Mapping[str, journey_results.SideResults]
    """by the side of the lander that faces the ground at the first touchdown; empty for a sphere, a cube, and if
    attitudes are not known"""
    end_variance_shares: Mapping[str, run_results.VarianceParts | None]
    """with [journey]: parts of the variance of the ends by inputs of the first touchdown: at_rest (0 or 1), and time_s
    and distance_m of the landers at rest; empty without [journey]"""
    ends: Mapping[str, run_results.CountedShare] | None = None
    """with [journey]: how the journeys ended: at_rest, escaped, partner, under_way, failed"""
    delivery: journey_results.DeliveryResults | None = None
    """with [journey]: place and state of the first impacts"""
    journeys: int | None = None
    """with [journey]: how many were followed"""
    touchdowns: int | None = None
    """with [journey]: landings that were simulated for them"""
    sky: Mapping[str, journey_results.SkyResults]
    """visibility of sun, earth and orbiter for the landers at rest; empty without [sky]"""
    emulated: journey_results.EmulatedJourneys | None = None
    """with [journey]: landers that the emulator of the touchdowns followed"""
    soils: Mapping[str, journey_results.SoilResults]
    """with [soil]: by region of the body, in the order of the study file, and `elsewhere`; empty without"""
    regions: tuple[dispersion.RestRegion, ...] = ()
    """smallest regions that contain 50 and 95 % of the next impacts of the samples; empty with [journey], and if there
    are too few"""
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
class PaperResults:
    """Results of a paper study, equal in two executions of one study."""

    units: Mapping[str, str]
    """unit of each output of the expansions"""
    beds: tuple[BedNumbers, ...]
    node_counts: model_results.NodeCounts
    designs: Mapping[str, model_results.DesignCounts]
    outputs_of_runs: Mapping[str, run_results.OutputRange]
    screening: model_results.ExpansionResults
    """the expansion in all inputs"""
    refined: model_results.ExpansionResults
    """the expansion in the kept inputs"""
    kept_inputs: tuple[str, ...]
    """inputs that the refined design varies, by dotted key"""
    kept_share: Mapping[str, float]
    """by output: share of the variance of the screening expansion that the kept inputs explain together"""
    scores: Mapping[str, Mapping[str, model_results.OutputErrors]]
    """errors of the expansions by set of runs and output; scores.json also has those of single runs"""
    monte_carlo: model_results.ExpansionSamples
    site: SiteResults
    variance_shares: Mapping[str, run_results.VarianceParts | None]
    """null: one bed, one impact point and one attitude have no parts"""
    shares: run_results.SampleShares
    returns: run_results.ReturnFraction
    flights: dispersion.FlightResults
    ellipses: dispersion.LandingEllipses | None
    without_scatter: dispersion.WithoutScatter | None
    """null where the samples have no scatter from run to run"""
    rest: dispersion.RestResults
    answer: tuple[str, ...]
    """outcome of the landers, the population for which it holds, and what is missing, in sentences"""
    headline: tuple[str, ...]
    """the answer, then the main numbers, in sentences"""
    regions: tuple[dispersion.RestRegion, ...] = ()
    """smallest regions that hold 50 and 95 % of the next impacts of the samples; empty for few"""
    __repr__ = short_repr


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
    results: DrawnResults | PaperResults
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
        is_paper = content["study"]["design"]["method"] == "paper"
        results: DrawnResults | PaperResults = (
            results_in(PaperResults, content["results"], "results")
            if is_paper
            else results_in(DrawnResults, content["results"], "results")
        )
        provenance = results_in(Provenance, content["provenance"], "provenance")
        return cls(content["format_version"], content["study"], results, provenance)
