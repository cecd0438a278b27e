"""Designs, expansions, their errors and samples, and how well an emulator predicts."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lithobrake.results.dispersion import ImpactNumbers, LandingEllipses, RestRegion, WithoutScatter
from lithobrake.results.run_results import OutputRange, SampleShares
from lithobrake.vocabulary.estimate import INLINE, Inlined
from lithobrake.vocabulary.plain_text import short_repr

Ends = tuple[float | None, float | None]
ByInput = Mapping[str, float]
IntervalByInput = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class NodeCounts:
    """Numbers of nodes of grids, for comparison with the design of the study."""

    input_counts: tuple[int, ...]
    """numbers of inputs, the rows of the two tables"""
    levels: tuple[int, ...]
    """levels, their columns"""
    tensor: tuple[tuple[int, ...], ...]
    """nodes of the full tensor grid"""
    smolyak: tuple[tuple[int, ...], ...]
    """nodes of the sparse grid"""


@dataclass(frozen=True)
class DesignCounts:
    """The runs of a design: screening, refined, test_kept, test_all."""

    point_count: int
    """points, each run replicate_count times"""
    replicate_count: int
    """runs at every point"""
    run_count: int
    """runs; equal ones are one row in the ledger"""
    with_outputs: int
    """runs after which the lander left, with all outputs"""
    outcomes: Mapping[str, int]
    """number of runs with this outcome; failed: runs without an outcome"""


@dataclass(frozen=True)
class OutputFit:
    """How an output was fitted."""

    method: str
    """ols, omp, lars or gaussian_process"""
    term_count: int
    """terms of this output"""
    condition_number: float | None
    """of the least squares; null for a Gaussian process"""
    rmse_estimate: float
    """root-mean-square error expected at a new run with scatter, in the output's unit"""
    rrmse_estimate: float | None
    """the same over the standard deviation of the runs; null where they do not vary"""
    noise_std: float | None
    """standard deviation between equal runs, in the output's unit; null where not known"""
    noise_from: str | None
    """source of that: repeated points, the nugget of a Gaussian process, or a smaller error"""
    noise_share: float | None
    """share of the variance of the runs that is scatter; null where not known"""


@dataclass(frozen=True)
class ExpansionResults:
    """An expansion: screening in all inputs, refined in the kept ones."""

    inputs: tuple[str, ...]
    """inputs by dotted key, in the order of the study file"""
    term_count: int
    """terms that any output uses"""
    degree: int
    """highest total degree of a term"""
    fits: Mapping[str, OutputFit]
    mean: Mapping[str, float]
    """by output: mean over the distributions of the inputs"""
    std: Mapping[str, float]
    """by output: standard deviation over the distributions of the inputs, without scatter from run to run"""
    sobol_first: Mapping[str, ByInput]
    """by output and input: share of the variance of the expansion that the input explains alone, corrected for
    scatter"""
    sobol_total: Mapping[str, ByInput]
    """the same with all its interactions"""
    sobol_first_interval: Mapping[str, IntervalByInput]
    """its 95 % interval, from resampled residuals of the runs: lower, upper"""
    sobol_total_interval: Mapping[str, IntervalByInput]
    """95 % interval of sobol_total, in the same way"""
    __repr__ = short_repr


@dataclass(frozen=True, kw_only=True)
class OutputErrors:
    """Errors of an expansion on a set of runs, for one output. screening and refined: on the runs of the fit;
    test_screening, test_kept and test_all: on runs that were not used in the fit.
    """

    mape: float | None
    """mean absolute percentage error [%]; null where a true value is 0"""
    q2: float | None
    """explained share of the variance, 1 - rrmse squared; null where the runs do not vary"""
    rrmse: float | None
    """rmse over std; null where the runs do not vary"""
    rmse: float
    """root-mean-square error, in the unit of the output"""
    std: float
    """standard deviation of the runs, in the unit of the output"""
    ape: tuple[float | None, ...] | None = None
    """absolute percentage error of every run [%], in scores.json alone; null where the true value is 0"""
    mape_interval: Ends
    """95 % interval of mape, from resampled runs: lower, upper; null if that bound does not exist"""
    rmse_interval: Ends
    """the same for rmse"""
    rrmse_interval: Ends
    """the same for rrmse"""
    q2_interval: Ends
    """the same for q2"""


@dataclass(frozen=True)
class ExpansionAnalysis:
    """The designs of the analysis, its two expansions and their errors ([expansion] of the study file)."""

    node_counts: NodeCounts
    designs: Mapping[str, DesignCounts]
    outputs_of_runs: Mapping[str, OutputRange]
    """other outputs, over the distinct runs of these designs"""
    screening: ExpansionResults
    """the expansion in all inputs"""
    refined: ExpansionResults
    """the expansion in the kept inputs"""
    kept_inputs: tuple[str, ...]
    """inputs that the refined design varies, by dotted key"""
    kept_share: Mapping[str, float]
    """by output: share of the variance of the screening expansion that the kept inputs explain together"""
    scores: Mapping[str, Mapping[str, OutputErrors]]
    """errors of the expansions by set of runs and output; scores.json also has those of single runs"""
    __repr__ = short_repr


@dataclass(frozen=True)
class SampledOutput(Inlined):
    """An output over the samples that leave, in its unit."""

    mean: float
    """mean"""
    std: float
    """standard deviation"""
    quantiles: Mapping[str, float] = field(metadata=INLINE)
    """by level, as "quantile_0.5" """


@dataclass(frozen=True, kw_only=True)
class SampleResults:
    """Samples of the first touchdown by a model that was fitted to the runs, and their flights to the next impact."""

    model: str
    """what the samples are drawn from: emulator or expansion"""
    sample_count: int
    """samples"""
    leaving_count: int
    """samples that leave the surface"""
    outputs: Mapping[str, SampledOutput]
    """by output; empty where no sample leaves"""
    shares: SampleShares
    flights: ImpactNumbers
    ellipses: LandingEllipses | None
    """of the impacts"""
    regions: tuple[RestRegion, ...]
    """smallest regions that contain 50 and 95 % of the next impacts; empty for few"""
    without_scatter: WithoutScatter | None
    """null where the samples have no scatter from run to run to leave out"""
    __repr__ = short_repr


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
class EmulatorScores(Inlined):
    """Scores on held-out beds."""

    joint: JointScore
    outputs: Mapping[str, OutputScore] = field(metadata=INLINE)


@dataclass(frozen=True)
class EmulatorResults:
    """The emulator of the first touchdown, on held-out beds (docs/emulator.md)."""

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
