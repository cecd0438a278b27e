"""The tables of the study file that say which runs are made and by what, what is fitted to them, how it is sampled."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictBool, StrictStr

from lithobrake.study.quantity import MaybeUncertain, Number, Scalar, Section, Whole
from lithobrake.vocabulary.quantities import OUTPUTS, OutputName

Level = Annotated[int, Whole("", at_least=1, at_most=8)]
Degree = Annotated[int, Whole("", at_least=1, at_most=15)]
PointCount = Annotated[int, Whole("", at_least=2, at_most=1_000_000)] | None

Method = Literal["drawn", "paper"]
DEFAULT_METHOD: Method = "drawn"
# Another name of the drawn method: it is accepted where a study is read, and found nowhere behind that.
ALIASES = {"sequence": "drawn"}


def method_name(given: Any) -> Any:
    """The name of a method, also where an alias of it is given; anything else as it is."""
    return ALIASES.get(given, given) if isinstance(given, str) else given


class MethodKey(Section):
    """Each of the other keys belongs to one of the two methods."""

    method: Annotated[Method, BeforeValidator(method_name)] = DEFAULT_METHOD
    """How runs are chosen. "drawn": every run has its own soil, impact point, azimuth and attitude, on many beds.
    "paper": a screening over all inputs, then more runs over those that matter."""


class DrawnKeys(MethodKey):
    """With method = "drawn" only:"""

    # 20 landings on each of 12 beds; with fewer beds Student's t widens the interval (docs/estimates.md).
    run_count: Annotated[int, Whole("", at_least=2, at_most=1_000_000)] = 240
    """Number of runs; a larger one keeps the runs of a smaller one, each on its bed."""
    half_width: Annotated[float, Number("", above=0, below=0.5)] | None = None
    """Requested half-width of the interval of the result, as a fraction of 1. More runs than run_count are made, on
    more beds, until it is reached. Absent: run_count runs, whatever their interval."""
    half_width_of: StrictStr | None = None
    """Name of the limit state to whose probability half_width applies. Absent: it applies to the return fraction."""
    largest_run_count: PointCount = None
    """Largest number of runs with half_width. Absent: ten times run_count."""
    # Strict, as pydantic would take "yes", "off" and 1 for truth values.
    side_runs: StrictBool = False
    """Whether to make auxiliary runs: up to 20 of the runs again on a second soil, and up to 12 again at a slightly
    shifted impact point. They measure the effects of soil and chaos."""
    twin_shift: Annotated[float, Number("m", above=0)] = 1e-4
    """Shift of the impact point, with side_runs."""

    @property
    def most_runs(self) -> int:
        if self.half_width is None:
            return self.run_count
        return self.largest_run_count or 10 * self.run_count


class PaperKeys(MethodKey):
    """With method = "paper" only:"""

    points: Literal["smolyak", "sobol_sequence", "latin_hypercube", "fekete"] = "smolyak"
    """Design of the runs. "smolyak", a sparse grid, uses the levels, and needs inputs with two limits. "sobol_sequence"
    (a larger count keeps the runs of a smaller one), "latin_hypercube" and "fekete" (best conditioned for the degree)
    use the counts, and allow any input."""
    screening_level: Level = 3
    """Level of the Smolyak grid over all uncertain inputs."""
    screening_count: PointCount = None
    """Number of points over all uncertain inputs, for the other methods."""
    screening_degree: Degree = 3
    """Total degree of the expansion in all uncertain inputs."""
    refined_level: Level = 5
    """Level of the Smolyak grid over the kept inputs; the others stay at their median."""
    refined_count: PointCount = None
    """Number of points over the kept inputs, for the other methods."""
    refined_degree: Degree = 5
    """Total degree of the expansion in the kept inputs."""
    replicate_count: Annotated[int, Whole("", at_least=1, at_most=1000)] = 1
    """Runs at every point of these two designs; what is random (bed, impact point, azimuth, attitude) is sampled for
    each of them. Two or more measure the scatter that no expansion removes."""
    fit: Literal["ols", "lars", "omp", "gaussian_process", "best"] = "ols"
    """How expansions are fitted. "ols": least squares of the degrees above, as in the paper. The others choose their
    terms themselves; "best" takes the fit with the smallest expected error for each output."""
    kept_share: Annotated[float, Number("", above=0, at_most=1)] = 0.9
    """Fraction of the explained variance that the kept inputs must reach in every output of kept_outputs."""
    kept_outputs: Annotated[tuple[OutputName, ...], Field(min_length=1)] = OUTPUTS
    """Outputs that decide which inputs are kept."""
    test_count: Annotated[int, Whole("", at_least=2, at_most=100_000)] = 40
    """Fresh random runs in each of the two test sets (kept inputs vary; all inputs vary)."""


# Keys of the last base stand first.
class DesignSection(PaperKeys, DrawnKeys):
    """Which runs are made, and what is fitted to them."""

    @property
    def keys_of_the_other_method(self) -> set[str]:
        other = PaperKeys if self.method == "drawn" else DrawnKeys
        return other.model_fields.keys() - MethodKey.model_fields.keys()


class MonteCarloSection(Section):
    """Samples of the emulator, or, with design.method = "paper", of the refined expansion."""

    sample_count: Annotated[int, Whole("", at_least=100, at_most=100_000_000)] = 100_000
    """Number of samples."""
    scatter: StrictBool = False
    """With design.method = "paper" only: whether samples include the scatter from run to run. It consists of the
    residuals of the expansion at the refined runs, sampled jointly for all outputs; samples.h5 then also has the
    samples without it. (Samples of an emulator always include it.)"""


class CampaignSection(Section):
    """How runs are made, and how many may fail. Nothing here changes the result of a run."""

    wall_limit: Annotated[float, Number("s", above=0)] | None = None
    """Longest wall-clock time of a run; it is then ended and counts as failed. Absent: no limit."""
    memory_limit: Annotated[float, Number("bytes", above=0)] | None = None
    """Largest memory of a run and all processes that it starts; above that it is ended (Linux only). Absent: no
    limit."""
    retry_count: Annotated[int, Whole("", at_least=0, at_most=100)] = 1
    """Number of times that a failed run is tried again."""
    failed_share: Annotated[float, Number("", at_least=0, below=1)] = 0.05
    """Largest fraction of failed runs of a design with which an expansion is still fitted."""


class SolverSection(Section):
    """A program of your own that computes the touchdowns instead of lithobrake (docs/own_solver.md)."""

    command: str | None = None
    """Its command line. It is started in a folder for each run, where it reads inputs.json and writes outputs.json;
    file names are relative to the study file. Or "umbridge:http://HOST:PORT/MODEL", a model on a server. Absent:
    lithobrake simulates the soil."""
    templates: list[str] = Field(default=[])
    """Files, relative to the study file, in which {{ grain.friction }} is replaced by that number of a run and {{ seed
    }} by its seed; each is written to the run's folder under its own name."""
    answer: str = "outputs.json"
    """Name of the file that the program writes, with the ending .json, .csv, .yaml, .yml, .h5 or .hdf5."""
    inputs: dict[str, Annotated[Scalar, MaybeUncertain("")]] = Field(default={})
    """Numbers that only your program uses, by names of your own."""
