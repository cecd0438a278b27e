"""The tables of the study file that say which runs are made, what is fitted to them, and what is asked."""

import math
import re
from dataclasses import dataclass
from itertools import product
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, ConfigDict, Field, StrictBool, StrictStr

from lithobrake.study.quantity import MaybeUncertain, Number, Scalar, Section, Whole, refuse
from lithobrake.vocabulary.limit_state import ALLOWED, COMPARED, EXAMPLE, LimitState, NoLimitStateError
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import OUTPUTS, OutputName

Level = Annotated[int, Whole("", at_least=1, at_most=8)]
Degree = Annotated[int, Whole("", at_least=1, at_most=15)]
PointCount = Annotated[int, Whole("", at_least=2, at_most=1_000_000)] | None

# What comes of an aim, and may be limited as the aim itself is.
AT_REST = JourneyEnd.AT_REST.value
# The side that faces the ground, among the names of what is chosen.
SIDE = "aim.sides"
AIM_RESULTS = (AT_REST, "missing", "distance_p95", "time_p95")
_LIMIT = re.compile(r"\s*([\w.-]+?)\s*(<=|>=|<|>)\s*([-+.0-9eE]+)\s*")
Latitude = Annotated[Scalar, MaybeUncertain("deg", at_least=-90, at_most=90)]
Turn = Annotated[float, Number("deg", at_least=-360, at_most=360)]
SkyBody = Literal["sun", "earth", "orbiter"]


class DesignSection(Section):
    """Number of landers; each has its own soil, impact point, azimuth and attitude, on one of many beds."""

    # 20 landings on each of 12 beds; with fewer beds Student's t widens the interval (docs/estimates.md).
    run_count: Annotated[int, Whole("", at_least=0, at_most=1_000_000)] = 240
    """Number of landers; a larger one keeps those of a smaller one, each on its bed. 0, only with [expansion]:
    the study has expansions alone."""
    half_width: Annotated[float, Number("", above=0, below=0.5)] | None = None
    """Requested half-width of the interval of the result, as a fraction of 1. More runs than run_count are made, on
    more beds, until it is reached. Absent: run_count runs, whatever their interval."""
    half_width_of: StrictStr | None = None
    """Name of the limit state to whose probability half_width applies. Absent: it applies to the
    fraction at rest, or with journey.touchdowns = 1 to the return fraction."""
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


class ExpansionSection(Section):
    """The analysis of the paper: polynomial chaos expansions of the first touchdown. A screening varies all uncertain
    inputs, a refined design those that matter, and fresh random runs test both. Absent: none is made."""

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


class MonteCarloSection(Section):
    """Samples of the first touchdown, each with its flight to the next impact: by the refined expansion where the study
    has one, otherwise by the emulator."""

    sample_count: Annotated[int, Whole("", at_least=0, at_most=100_000_000)] | None = None
    """Number of samples. Absent: 100 000 with journey.touchdowns = 1 or design.run_count = 0, otherwise none."""
    scatter: StrictBool = False
    """With [expansion] only: whether samples include the scatter from run to run. It consists of the
    residuals of the expansion at the refined runs, sampled jointly for all outputs; samples.h5 then also has the
    samples without it. (Samples of an emulator always include it.)"""


class CampaignSection(Section):
    """How runs are made, and how many may fail. Nothing here changes the result of a run."""

    wall_limit: Annotated[float, Number("s", at_least=0.1)] | None = None
    """Longest wall-clock time of a run; it is then ended and counts as failed. Absent: no limit."""
    memory_limit: Annotated[float, Number("bytes", at_least=1e6)] | None = None
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


def condition_text(given: object) -> str:
    if not isinstance(given, str):
        raise refuse(given, ALLOWED, f"write it in quotation marks, as in {EXAMPLE}")
    try:
        return LimitState.of(given).text
    except NoLimitStateError as error:
        raise refuse(given, ALLOWED, str(error)) from error


class LimitStatesSection(Section):
    """Conditions whose probability the study estimates, by names of your own: fast = "speed_out > 0.1 and not returns".

    Outputs of the first touchdown [SI] are compared with numbers; returns, captured, impact, flying, escaped and
    partner are true or false. Or, of the whole journey, near = "distance < 20 and face == +z": distance, latitude_deg,
    longitude_deg, time_s, tilt_deg, path_length, contacts, touchdowns, sun_hours, earth_hours and orbiter_hours of the
    landers at rest, the face that is down, and at_rest, escaped, partner, under_way (docs/reliability.md)."""

    # Keys are names of the user's own: pydantic checks extra keys by the annotation of __pydantic_extra__.
    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Annotated[str, BeforeValidator(condition_text)]] = Field(init=False)

    def conditions(self) -> dict[str, str]:
        given: dict[str, Any] = self.__pydantic_extra__ or {}
        return dict(given)


class AimSection(Section):
    """Delivery options to compare: speeds, angles and sites, each with landers that are followed to rest.

    See docs/aiming.md."""

    grid: dict[str, list[Annotated[float, Number("")]]] = Field(default={})
    """Keys of [delivery], one to three, or "delivery.errors", the factor of all its errors, and their values in
    ascending order: all combinations are options. Everything else is sampled."""
    sides: list[str] = Field(default=[])
    """Sides of the lander that face the ground at the first touchdown, as further options; the lander is turned about
    the vertical at random, without a pointing error. For a box its axes, such as "z", or "x or y" where edges are
    equal; for a mesh "+x" to "-z"."""
    within: list[str] = Field(default=[])
    """Conditions that the best option must satisfy, such as "incidence_deg < 45": a name of the grid without its table,
    or at_rest, missing (fractions), distance_p95 [m], time_p95 [s], or a limit state of journeys (a fraction);
    compared with a number by <, <=, > or >=."""
    best: StrictStr | None = None
    """Name of the limit state of journeys that most landers meet at the best option, such as distance < 20. Absent:
    that at which most landers come to rest."""
    lander_count: Annotated[int, Whole("", at_least=2, at_most=10_000)] = 10
    """Landers of each option for each of the 50 refits of the emulator to resampled beds."""

    @property
    def count(self) -> int:
        """How many aims there are, of which none is made for that."""
        lengths = [*map(len, self.grid.values()), *([len(self.sides)] if self.sides else [])]
        return math.prod(lengths) if lengths else 0

    def aims(self) -> list[dict[str, float]]:
        """All aims, the last of the names running fastest; a side by its place among `sides`."""
        columns = [*self.grid.values(), *([list(map(float, range(len(self.sides))))] if self.sides else [])]
        return [dict(zip(self.names, values, strict=True)) for values in product(*columns)] if columns else []

    @property
    def names(self) -> tuple[str, ...]:
        """What is chosen, by dotted key."""
        return (*self.grid, *([SIDE] if self.sides else []))


@dataclass(frozen=True)
class AimLimit:
    """A limit that the best aim must keep, as `incidence_deg < 45`."""

    name: str
    sign: str
    number: float

    @classmethod
    def of(cls, text: str) -> "AimLimit | None":
        """Read one; None for a text that is none."""
        match = _LIMIT.fullmatch(text)
        try:
            limit = cls(match[1], match[2], float(match[3])) if match else None
        except ValueError:
            return None
        return limit if limit is not None and math.isfinite(limit.number) else None

    def keeps(self, value: float | None) -> bool:
        """Whether a value keeps it; what is not known does not."""
        return value is not None and bool(COMPARED[self.sign](value, self.number))


class OrbitSection(Section):
    """Heliocentric orbit of the body, or of the binary that it is in, by osculating elements (ecliptic and equinox of
    J2000), as a catalogue of small bodies has them. The examples are those of Didymos [SBDB-Didymos]."""

    semi_major_axis_au: Annotated[float, Number("", at_least=0.01, at_most=1e5)] = Field(examples=["1.64271"])
    """Semi-major axis in astronomical units."""
    eccentricity: Annotated[float, Number("", at_least=0, below=1)] = Field(examples=["0.383123"])
    """Eccentricity."""
    inclination_deg: Annotated[float, Number("deg", at_least=0, at_most=180)] = Field(examples=["3.41388"])
    """Inclination."""
    node_deg: Turn = Field(examples=["72.9858"])
    """Longitude of the ascending node."""
    perihelion_deg: Turn = Field(examples=["319.5807"])
    """Argument of perihelion."""
    mean_anomaly_deg: Turn = Field(examples=["260.861"])
    """Mean anomaly at `epoch`."""
    epoch: str = Field(examples=['"2026-06-09T00:00:00"'])
    """Date and time at which these elements hold (UTC)."""


class OrbiterSection(Section):
    """An orbiter that landers communicate with, given in one of three ways: a circle (`altitude`, `inclination_deg`),
    with all phases of the orbit and of the body's rotation; a table of body-fixed states (`states`); or SPICE
    (`kernel_name`) from sky.date to sky.until."""

    altitude: Annotated[float, Number("m", above=0, at_most=1e9)] | None = Field(default=None, examples=["2000.0"])
    """Height of the circle above the sphere around the body that touches its highest point."""
    inclination_deg: Annotated[float, Number("deg", at_least=0, at_most=180)] | None = Field(
        default=None, examples=["90.0"]
    )
    """Inclination of the circle to the body's equator; absent: 90, over the poles."""
    states: str | None = Field(default=None, examples=['"orbiter.csv"'])
    """File of body-fixed states, relative to the study file, in the format of delivery.states; each state represents
    half the time to each of its neighbours."""
    kernel_name: str | None = Field(default=None, examples=['"HERA"'])
    """Name or number, as text, of the orbiter in site.kernels."""

    @property
    def ways(self) -> list[str]:
        return [key for key in ("altitude", "states", "kernel_name") if getattr(self, key) is not None]


class SkySection(Section):
    """How long a lander at rest sees the Sun, Earth and an orbiter, and which of its sides face them. During one day of
    the small body, Sun and Earth are overhead at one latitude each, which changes with the season. Either give the
    latitudes (a distribution represents a year: each lander samples its own), or give `date`, from which they follow by
    site.pole_right_ascension_deg, site.pole_declination_deg and the heliocentric orbit, or by site.kernels. The shape
    hides what is behind it, and so does the partner of a binary, as a spheroid of its extents.
    """

    sun_latitude_deg: Latitude | None = None
    """Latitude at which the Sun is overhead. Absent: no sunlight is computed, unless `date` is given."""
    earth_latitude_deg: Latitude | None = None
    """Latitude at which Earth is overhead. Absent: its visibility is not computed, unless `date` is given."""
    date: str | None = None
    """UTC date and time, for example "2027-04-20T00:00:00", for the positions of Sun and Earth."""
    until: str | None = None
    """End of a time span that begins at `date`, for example a year: fractions are means over 24 days of it, and
    `sky.csv` also has the fraction of the worst day."""
    orbit: OrbitSection | None = None
    orbiter: OrbiterSection | None = None
    mask_deg: Annotated[float, Number("deg", at_least=0, below=90)] = 0.0
    """Elevation above the plane of the ground below which Earth and the orbiter are not visible."""
    beam_deg: Annotated[float, Number("deg", above=0, at_most=90)] = 90.0
    """Half the opening angle of an antenna's beam about the normal of its side, for Earth and the orbiter."""

    @property
    def latitudes(self) -> dict[SkyBody, Scalar]:
        given: dict[SkyBody, Scalar | None] = {"sun": self.sun_latitude_deg, "earth": self.earth_latitude_deg}
        return {name: latitude for name, latitude in given.items() if latitude is not None}

    @property
    def bodies(self) -> tuple[SkyBody, ...]:
        far: tuple[SkyBody, ...] = tuple(self.latitudes) if self.date is None else ("sun", "earth")
        return far if self.orbiter is None else (*far, "orbiter")

    def mask_of(self, body: SkyBody) -> float:
        """Least height above the ground [deg]; the Sun is seen down to the ground."""
        return 0.0 if body == "sun" else self.mask_deg

    def beam_of(self, body: SkyBody) -> float:
        """Largest angle from the normal of a side that faces the body [deg]; a panel has light from all of its sky."""
        return 90.0 if body == "sun" else self.beam_deg
