"""The flights of the runs themselves: each run's own velocity from many sites, and how these flights end."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.files.reading import hashed_seed, read_rows
from lithobrake.pipeline.first_touchdown.flights import Starts, flight_dependencies, fly_starts, write_table
from lithobrake.pipeline.first_touchdown.samples import VELOCITY
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.site import SITE_KEYS, Site
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.study import Study
from lithobrake.study.delivery_checks import drawn_together
from lithobrake.vocabulary.outcomes import CapturedFate, FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import DRAWN_DESIGNS, FLIGHT, RUN

# Flights of each run. In equal steps of the heading so many leave nothing to gain from more.
FLIGHT_COUNT = 64
# Numbers of a site in the order of their powers: those that matter most fill their plane best.
FIRST = ("heading_deg", "partner_longitude_deg")
LATTICE = (*FIRST, *(key for key in SITE_KEYS if key not in FIRST))
RUN_FLIGHTS_FILE: str = "run_flights.csv"
IMPACTS: str = "run_impacts.csv"
# What may become of a run at one of its sites; of a captured one, whether the ground there holds it.
FATES = (
    *(FlightStatus.IMPACT, FlightStatus.FLYING, FlightStatus.ESCAPED, FlightStatus.PARTNER),
    *(CapturedFate.SETTLED, CapturedFate.LOFTED),
)
RETURNS = (FlightStatus.IMPACT, CapturedFate.SETTLED)
COLUMNS = ("design", "run", "key", "outcome", "flight_count", *FATES, "returns")
# Of each flight of the drawn runs that ends on the body.
IMPACT_NUMBERS = ("time_s", "impact_speed", "impact_incidence_deg")
IMPACT_COLUMNS = ("run", *IMPACT_NUMBERS)


def run_sites(site: Site, run_count: int, flight_count: int = FLIGHT_COUNT) -> dict[str, np.ndarray]:
    """Sites of the flights of runs by the keys of SITE_KEYS, each [run_count, flight_count].

    Each uncertain number goes through its law in equal steps from a random first one of the run, the heading in order,
    the others so that together they fill all that may be evenly (a lattice of powers of one generator): a share of
    these flights hardly scatters. More runs change no earlier site.
    """
    sites, laws = site.columns((run_count, flight_count)), site.distributions
    generator = _generator(flight_count)
    for run in range(run_count):
        random = np.random.Generator(np.random.PCG64(hashed_seed(site.study.seed, "flights of runs", run)))
        # All keys take their random numbers, whether uncertain or not, so that one more leaves the others as they were.
        for key in SITE_KEYS:
            first = random.random()
            if key in laws:
                steps = np.arange(flight_count) * pow(generator, LATTICE.index(key), flight_count)
                share = (steps / flight_count + first) % 1.0
                # Half a unit in the last place off the ends, where an unbounded law is infinite.
                sites[key][run] = laws[key].ppf(np.clip(share, 2.0**-54, 1.0 - 2.0**-53))
    together = drawn_together(site.study, {key: values.ravel() for key, values in sites.items()})
    return {key: values.reshape(run_count, flight_count) for key, values in together.items()}


def _generator(count: int) -> int:
    """The number next to the golden section of a count that has no divisor with it."""
    golden = 0.5 * (math.sqrt(5.0) - 1.0) * count
    return min((one for one in range(1, count + 1) if math.gcd(one, count) == 1), key=lambda one: abs(one - golden))


@dataclass(frozen=True)
class RunFlights:
    """returns [run_count]: share of the flights of each run that come down again, NaN for a run without an answer.

    fates [run_count, len(FATES)]: how many of its flights ended so.
    """

    returns: np.ndarray
    fates: np.ndarray

    @classmethod
    def load(cls, folder: StudyFolder, design: str) -> "RunFlights":
        """Those of the runs of a design, in its order. Raises DamagedFileError for another file."""
        rows = [row for row in read_rows(folder / RUN_FLIGHTS_FILE, COLUMNS, AGAIN) if row["design"] == design]
        returns = np.array([float(row["returns"] or "nan") for row in rows])
        return cls(returns, np.array([[int(row[fate]) for fate in FATES] for row in rows]).reshape(-1, len(FATES)))


def run_flight_dependencies(study: Study) -> dict[str, Any]:
    return {name: value for name, value in flight_dependencies(study).items() if name != "flight_count"}


@dataclass(frozen=True)
class RunImpacts:
    """Flights of the drawn runs that end on the body, [impact_count] each: the run, and numbers of IMPACT_NUMBERS."""

    run: np.ndarray
    numbers: dict[str, np.ndarray]

    @classmethod
    def load(cls, folder: StudyFolder) -> "RunImpacts":
        """Those of a folder. Raises DamagedFileError for another file."""
        rows = read_rows(folder / IMPACTS, IMPACT_COLUMNS, AGAIN)
        numbers = {name: np.array([float(row[name]) for row in rows]) for name in IMPACT_NUMBERS}
        return cls(np.array([int(row["run"]) for row in rows], dtype=np.int64), numbers)


def fly_runs(job: Job) -> None:
    """Fly every run that left, its pair and its twin, from the same sites, and write how their flights end."""
    designs = DRAWN_DESIGNS if job.study.design.side_runs else DRAWN_DESIGNS[:1]
    rows: list[list[Any]] = []
    for design in designs:
        runs = DesignRuns.load(job.folder, design)
        fates, impacts = _flown(job, runs, design)
        rows += [[design, *row] for row in _rows(runs, fates)]
        if design == designs[0]:
            write_table(job.folder, IMPACTS, IMPACT_COLUMNS, impacts, RUN | FLIGHT)
    write_table(job.folder, RUN_FLIGHTS_FILE, COLUMNS, rows)


def _flown(job: Job, runs: DesignRuns, design: str) -> tuple[np.ndarray, list[list[Any]]]:
    """How many flights of each run ended how, [run_count, len(FATES)], none for a run without an outcome; and impacts.

    The impacts are rows of IMPACT_COLUMNS.
    """
    sites = run_sites(job.site, runs.run_count)
    fates = np.zeros((runs.run_count, len(FATES)), dtype=np.int64)
    captured = np.array(runs.outcomes) == TouchdownOutcome.CAPTURED
    if captured.any():
        held = _held(job.site, {key: values[captured] for key, values in sites.items()}).sum(axis=1)
        # A captured lander stays only where the ground holds it, which differs from site to site as flights do.
        fates[captured, FATES.index(CapturedFate.SETTLED)] = held
        fates[captured, FATES.index(CapturedFate.LOFTED)] = FLIGHT_COUNT - held
    left = np.flatnonzero(runs.has_outputs)
    velocity = np.column_stack([runs.output(name) for name in VELOCITY])[left]
    site = {key: values[left].ravel() for key, values in sites.items()}
    row = np.repeat(left, FLIGHT_COUNT)
    start = Starts(row, np.repeat(velocity, FLIGHT_COUNT, axis=0), site)
    flown = fly_starts(job, start, f"flights of the {design.replace('_', ' ')}")
    for column, fate in enumerate(FATES[:4]):
        fates[:, column] = np.bincount(row[flown.status == fate], minlength=runs.run_count)
    down = flown.status == FlightStatus.IMPACT
    numbers = np.column_stack([flown.time, flown.impact_speed, np.degrees(flown.incidence)])[down].tolist()
    return fates, [[run, *one] for run, one in zip(row[down].tolist(), numbers, strict=True)]


def _held(site: Site, sites: dict[str, np.ndarray]) -> np.ndarray:
    """Whether the ground holds what lies at these sites [count, flight_count]."""
    shape, flat = sites["mass"].shape, {key: values.ravel() for key, values in sites.items()}
    origin, axes = site.frames(flat)
    here = {"mass": flat["mass"], "spin_period": flat["spin_period"], "time": site.clock(flat)}
    felt = site.body.effective_acceleration(origin, **here)
    held: np.ndarray = (np.einsum("ni,ni->n", felt, axes[:, 2]) < 0.0).reshape(shape)
    return held


def _rows(runs: DesignRuns, fates: np.ndarray) -> Iterator[list[Any]]:
    returning = fates[:, [FATES.index(fate) for fate in RETURNS]].sum(axis=1)
    for run, (key, outcome) in enumerate(zip(runs.keys, runs.outcomes, strict=True)):
        count = int(fates[run].sum())
        share = float(returning[run]) / count if count else ""
        yield [run, key, outcome, count, *fates[run].tolist(), share]
