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
    """Each of the other keys goes with one of the two methods."""

    method: Annotated[Method, BeforeValidator(method_name)] = DEFAULT_METHOD
    """How runs are chosen: "drawn", every run with soil, impact point, azimuth and attitude of its own, on many beds;
    "paper", a screening over all inputs, then more runs over those that matter."""


class DrawnKeys(MethodKey):
    """With method = "drawn" only:"""

    run_count: Annotated[int, Whole("", at_least=2, at_most=1_000_000)] = 240
    """Number of runs; a larger one keeps the runs of a smaller one, each on its bed."""
    half_width: Annotated[float, Number("", above=0, below=0.5)] | None = None
    """Half the interval that the answer is to have, as a share of 1; more runs than run_count are made, on more beds,
    until it has. Absent: run_count runs, whatever their interval."""
    half_width_of: StrictStr | None = None
    """Name of the limit state that half_width is asked of. Absent: of the return fraction."""
    largest_run_count: PointCount = None
    """Most runs that half_width may ask for. Absent: ten times run_count."""
    side_runs: StrictBool = False
    """Whether to make, beside these, up to 20 of the runs again on a second soil, and up to 12 at a point a little
    beside, which measure the effects of soil and chaos."""
    twin_shift: Annotated[float, Number("m", above=0)] = 1e-4
    """How far beside, with side_runs."""

    @property
    def most_runs(self) -> int:
        """Drawn runs at most."""
        if self.half_width is None:
            return self.run_count
        return self.largest_run_count or 10 * self.run_count


class PaperKeys(MethodKey):
    """With method = "paper" only:"""

    points: Literal["smolyak", "sobol_sequence", "latin_hypercube", "fekete"] = "smolyak"
    """Where the runs stand: "smolyak", its sparse grid, takes the levels and inputs with two limits;
    "sobol_sequence" (a larger count keeps the runs of a smaller one), "latin_hypercube" and "fekete" (best conditioned
    for the degree) take the counts and any input."""
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
    """Runs at every point of these two designs, each with draws of its own (bed, impact point, azimuth, attitude): two
    or more measure the scatter that no expansion removes."""
    fit: Literal["ols", "lars", "omp", "gaussian_process", "best"] = "ols"
    """How expansions are fitted: "ols", least squares of the degrees above (the paper's); the others choose their terms
    themselves, "best" for each output by the smallest expected error."""
    kept_share: Annotated[float, Number("", above=0, at_most=1)] = 0.9
    """Share of the explained variance that the kept inputs must reach in every output of kept_outputs."""
    kept_outputs: Annotated[tuple[OutputName, ...], Field(min_length=1)] = OUTPUTS
    """Outputs that decide which inputs are kept."""
    test_count: Annotated[int, Whole("", at_least=2, at_most=100_000)] = 40
    """Fresh random runs in each of the two test sets (kept inputs vary; all inputs vary)."""


# Keys of the last base stand first.
class DesignSection(PaperKeys, DrawnKeys):
    """Which runs are made, and what is fitted to them."""

    @property
    def keys_of_the_other_method(self) -> set[str]:
        """Keys that mean nothing here."""
        other = PaperKeys if self.method == "drawn" else DrawnKeys
        return other.model_fields.keys() - MethodKey.model_fields.keys()


class MonteCarloSection(Section):
    """Samples of the emulator, or, with design.method = "paper", of the refined expansion."""

    sample_count: Annotated[int, Whole("", at_least=100, at_most=100_000_000)] = 100_000
    """How many samples."""
    scatter: StrictBool = False
    """With design.method = "paper" only: whether samples get the scatter from run to run on top of the expansion: what
    the expansion leaves of the refined runs, drawn jointly for all outputs; samples.h5 then has them without it too.
    (An emulator's always do.)"""


class CampaignSection(Section):
    """How runs are made, and how many may fail; nothing here changes what a run gives."""

    wall_limit: Annotated[float, Number("s", above=0)] | None = None
    """Longest time that one run may take on the clock; it is then ended and counts as failed. Absent: any time."""
    memory_limit: Annotated[float, Number("bytes", above=0)] | None = None
    """Most memory that one run may hold, with all that it starts; above that it is ended. Absent: any (Linux only)."""
    retry_count: Annotated[int, Whole("", at_least=0, at_most=100)] = 1
    """How often a run that failed is tried again."""
    failed_share: Annotated[float, Number("", at_least=0, below=1)] = 0.05
    """Largest share of failed runs of a design with which an expansion is still fitted."""


class SolverSection(Section):
    """A program of your own that makes the touchdowns in place of this one (docs/own_solver.md)."""

    command: str | None = None
    """Its command line, started in a folder for each run, where it reads inputs.json and writes outputs.json; words
    that name files count from the study file. Or "umbridge:http://HOST:PORT/MODEL", the model of a server in its place.
    Absent: this program's own soil."""
    templates: list[str] = Field(default=[])
    """Files, counted from the study file, in which {{ grain.friction }} becomes that number of a run and {{ seed }} its
    seed; each is put into the run's folder under its own name."""
    answer: str = "outputs.json"
    """Name of the file that the program writes, with the ending .json, .csv, .yaml, .yml, .h5 or .hdf5."""
    inputs: dict[str, Annotated[Scalar, MaybeUncertain("")]] = Field(default={})
    """Numbers that only your program knows, by names of your own."""
