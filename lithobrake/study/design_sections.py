"""The tables of the study file that say which runs are made, what is fitted to them and how it is sampled."""

from typing import Annotated, Literal

from pydantic import Field, StrictBool, StrictStr

from lithobrake.study.quantity import Number, Whole
from lithobrake.study.section import Section
from lithobrake.vocabulary.quantities import OUTPUTS, OutputName

Level = Annotated[int, Whole("", at_least=1, at_most=8)]
Degree = Annotated[int, Whole("", at_least=1, at_most=15)]
PointCount = Annotated[int, Whole("", at_least=2, at_most=1_000_000)] | None


# What a study that names no method is made by.
DEFAULT_METHOD: Literal["sequence", "paper"] = "sequence"
# Keys that only the sequence takes; all others belong to the paper's method.
SEQUENCE_KEYS = ("run_count", "half_width", "half_width_of", "largest_run_count", "side_runs", "twin_shift")


class DesignSection(Section):
    """Which runs are made, and what is fitted to them; each key but the first belongs to one of the two methods."""

    method: Literal["sequence", "paper"] = DEFAULT_METHOD
    """How runs are chosen: "sequence", every run with soil, place, azimuth and attitude of its own out of one sequence,
    on many beds; "paper", a screening over all inputs, then more runs over those that matter."""
    run_count: Annotated[int, Whole("", at_least=2, at_most=1_000_000)] = 240
    """sequence: number of runs; a larger one keeps the runs of a smaller one, each on its bed."""
    half_width: Annotated[float, Number("", above=0, below=0.5)] | None = None
    """sequence: half the interval that the answer is to have, as a share of 1; more runs than run_count are made, on
    more beds, until it has. Absent: run_count runs, whatever their interval."""
    half_width_of: StrictStr | None = None
    """sequence: name of the limit state that half_width is asked of. Absent: of the return fraction."""
    largest_run_count: PointCount = None
    """sequence: most runs that half_width may ask for. Absent: ten times run_count."""
    side_runs: StrictBool = False
    """sequence: whether to make, beside it, up to 20 of its runs again on a second soil, and up to 12 at a place a
    little beside, which tell what soil and chaos do."""
    twin_shift: Annotated[float, Number("m", above=0)] = 1e-4
    """sequence: how far beside, with side_runs."""
    points: Literal["smolyak", "sobol_sequence", "latin_hypercube", "fekete"] = "smolyak"
    """paper: where the runs stand: "smolyak", its sparse grid, takes the levels and inputs with two limits;
    "sobol_sequence" (a larger count keeps the runs of a smaller one), "latin_hypercube" and "fekete" (best conditioned
    for the degree) take the counts and any input."""
    screening_level: Level = 3
    """paper: level of the Smolyak grid over all uncertain inputs."""
    screening_count: PointCount = None
    """paper: number of points over all uncertain inputs, for the other methods."""
    screening_degree: Degree = 3
    """paper: total degree of the expansion in all uncertain inputs."""
    refined_level: Level = 5
    """paper: level of the Smolyak grid over the kept inputs; the others stay at their median."""
    refined_count: PointCount = None
    """paper: number of points over the kept inputs, for the other methods."""
    refined_degree: Degree = 5
    """paper: total degree of the expansion in the kept inputs."""
    replicate_count: Annotated[int, Whole("", at_least=1, at_most=1000)] = 1
    """paper: runs at every point of these two designs, each with draws of its own (bed, place, azimuth, attitude): two
    or more tell the scatter that no expansion removes."""
    fit: Literal["ols", "lars", "omp", "gaussian_process", "best"] = "ols"
    """paper: how expansions are fitted: "ols", least squares of the degrees above (the paper's); the others choose
    their terms themselves, "best" for each output by the smallest expected error."""
    kept_share: Annotated[float, Number("", above=0, at_most=1)] = 0.9
    """paper: share of the explained variance that the kept inputs must reach in every output of kept_outputs."""
    kept_outputs: Annotated[tuple[OutputName, ...], Field(min_length=1)] = OUTPUTS
    """paper: outputs that decide which inputs are kept."""
    test_count: Annotated[int, Whole("", at_least=2, at_most=100_000)] = 40
    """paper: fresh random runs in each of the two test sets (kept inputs vary; all inputs vary)."""

    @property
    def most_runs(self) -> int:
        """Runs of the sequence at most."""
        if self.half_width is None:
            return self.run_count
        return self.largest_run_count or 10 * self.run_count

    @property
    def keys_of_the_other_method(self) -> set[str]:
        """Keys that mean nothing here."""
        is_sequence = self.method == "sequence"
        return {key for key in type(self).model_fields if key != "method" and (key in SEQUENCE_KEYS) != is_sequence}


class MonteCarloSection(Section):
    """Samples of the emulator, or of the refined expansion."""

    sample_count: Annotated[int, Whole("", at_least=100, at_most=100_000_000)] = 100_000
    """How many samples."""
    scatter: StrictBool = False
    """paper: whether samples get the scatter from run to run on top of the expansion: what the expansion leaves of the
    refined runs, drawn jointly for all outputs; samples.h5 then has them without it too. (An emulator's always do.)"""
