"""The results of a study as the page shows them; a file that is missing or damaged is named."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.reading import DamagedFileError, reading
from lithobrake.results import ExplorerTables, MovingBodies, StudyResults, Table
from lithobrake.results.journey_results import JourneyRest
from lithobrake.results.model_results import ExpansionAnalysis, OutputErrors, SampleResults
from lithobrake.results.questions import RareLimitState
from lithobrake.results.study_files import results_in
from lithobrake.results.summary import Provenance, Results
from lithobrake.vocabulary import file_names
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import DRAWN_DESIGNS, PAPER_DESIGNS

FILES = (file_names.SUMMARY_FILE, file_names.STUDY_FILE)
PATHS_FILE = "flight_paths.h5"
Places = tuple[Array, Array]


@dataclass(frozen=True)
class PageJourneys:
    """The drawn landers.

    table: a row each; touchdowns: a row each; rest: numbers of those at rest; explorer: what the page evaluates of the
    emulator of all touchdowns, None where there is none; partner: name of the other body of a binary.
    """

    table: Table
    touchdowns: Table
    rest: JourneyRest
    explorer: ExplorerTables | None
    partner: str | None

    @property
    def is_on_partner(self) -> "NDArray[np.bool_]":
        """Which landers ended on the ground of the partner, in whose frame their places are, shape [lander]."""
        body: NDArray[np.str_] = self.table["body"]
        return np.zeros(len(body), dtype=bool) if self.partner is None else body == self.partner

    @property
    def elsewhere(self) -> Table:
        """The landers that did not end on the partner: their places are on the body of the site."""
        return self.table.where(~self.is_on_partner)


@dataclass(frozen=True)
class PageSamples:
    """Samples of the first touchdown.

    table: a row each; flights: to the next impact; latitude, longitude: of the impacts [deg], shape [impact], and
    facet, the one of the body that was hit; explorer: what the page evaluates of the model.
    """

    results: SampleResults
    table: Table
    flights: Table
    explorer: ExplorerTables
    latitude: Array
    longitude: Array
    facet: NDArray[np.int64]


@dataclass(frozen=True)
class PageExpansion:
    """The expansions; runs: of all designs; scores: by set of runs and output, with the error of each run."""

    results: ExpansionAnalysis
    runs: Table
    scores: Mapping[str, Mapping[str, OutputErrors]]


@dataclass(frozen=True)
class PageData:
    """What the page shows of a study.

    study: the tables of its file; results and provenance: those of summary.json; body_vertices of the body [m] and its
    body_faces, counted from 0; paths: places on the ways of some flights [m] and how each ended; path_times: times at
    these places since the flight began [s], and the number of the sample or journey of each. bed and landing are None
    where a solver of the user's own made the touchdowns; runs: first touchdowns of the drawn landers, without auxiliary
    runs; hard_ground: latitude and longitude [deg] of the landers at rest, by ground; rare: by limit state.
    """

    study: dict[str, Any]
    results: Results
    provenance: Provenance
    study_text: str
    bed: MovingBodies | None
    landing: MovingBodies | None
    body_vertices: Array
    body_faces: NDArray[np.int64]
    paths: tuple[Array, tuple[str, ...]]
    path_times: tuple[Array, NDArray[np.int64]]
    runs: Table
    journeys: PageJourneys | None
    samples: PageSamples | None
    expansion: PageExpansion | None
    hard_ground: Mapping[str, Places]
    rare: Mapping[str, RareLimitState]

    @property
    def to_rest(self) -> bool:
        """Whether drawn landers are followed to rest, and not for their first touchdown alone."""
        return self.journeys is not None and self.study["journey"]["touchdowns"] != 1

    @property
    def level(self) -> float:
        """Probability that intervals of shares stand for."""
        return self.results.returns.share.level

    @property
    def has_interval(self) -> bool:
        """Whether the runs show how certain the return fraction is."""
        return self.results.returns.share.lower is not None

    @property
    def digits(self) -> int:
        """Decimals of a share in per cent without an interval."""
        return 1 if self.journeys is None else 0

    @property
    def shown_landing(self) -> str:
        """Which landing has been kept with its pictures, as a sentence about it begins; empty where none has."""
        if self.journeys is None:
            return "With every uncertain input at its median"
        attributes = {} if self.landing is None else self.landing.attributes
        of = " (first touchdown)" if self.to_rest else ""
        if "run" not in attributes:
            return f"In the first run{of}"
        is_median = attributes["status"] == TouchdownOutcome.CLEAR
        which = "the one with the median rebound speed" if is_median else "since none leaves the surface"
        return f"In run {str(attributes['run'])[:8]}, {which}{of}"


def page_results(found: StudyResults) -> PageData:
    """What the page shows of a study. Raises ValueError that names the file when one is missing or damaged."""
    _refuse_without(found.folder, FILES)
    results = found.results
    _refuse_without(found.folder, _needed(results))
    has_paths = (found.folder / PATHS_FILE).is_file()
    vertices, faces = found.body_shape
    return PageData(
        study=found.study,
        results=results,
        provenance=found.summary.provenance,
        study_text=found.study_text,
        # A program or function of the user's own has neither beds nor pictures.
        bed=found.bed_bodies(0) if results.beds else None,
        landing=found.median_landing if results.beds else None,
        body_vertices=vertices,
        body_faces=faces,
        paths=found.flight_paths if has_paths else (np.empty((0, 0, 3)), ()),
        path_times=found.flight_path_times if has_paths else (np.empty((0, 0)), np.empty(0, dtype=np.int64)),
        runs=found.runs.where(found.runs["design"] == DRAWN_DESIGNS[0]),
        journeys=_journeys(found),
        samples=_samples(found),
        expansion=_expansion(found),
        hard_ground={ground: _resting(found, ground) for ground in results.hard_ground},
        rare=found.rare,
    )


def _needed(results: Results) -> list[str]:
    """The files without which the page lacks a part of these results."""
    has_emulator = results.emulated is not None and results.emulated.why is None
    parts: list[tuple[object, tuple[str, ...]]] = [
        (results.expansion, (file_names.SCORES_FILE,)),
        (results.ends, ("designs/drawn.csv", file_names.JOURNEYS_FILE, file_names.TOUCHDOWNS_FILE)),
        (has_emulator, (file_names.TOUCHDOWN_EXPLORER_FILE,)),
        (results.samples, (file_names.SAMPLES_FILE, file_names.EXPLORER_FILE, file_names.SAMPLE_FLIGHTS_FILE)),
        (results.hard_ground, (file_names.REST_FILE,)),
        (results.beds, (file_names.LANDING_FILE, "beds/bed_0.h5")),
    ]
    return [*(name for part, names in parts if part for name in names), file_names.BODY_FILE]


def _refuse_without(folder: Path, needed: tuple[str, ...] | list[str]) -> None:
    missing = [name for name in needed if not (folder / name).is_file()]
    if missing:
        raise ValueError(
            f"{folder} lacks {', '.join(missing)}, so there is no report yet; run the study to its end first"
        )


def _journeys(found: StudyResults) -> PageJourneys | None:
    rest = found.results.rest
    if rest is None:
        return None
    has_explorer = (found.folder / file_names.TOUCHDOWN_EXPLORER_FILE).is_file()
    explorer = found.touchdown_explorer if has_explorer else None
    return PageJourneys(found.journeys, found.touchdowns, rest, explorer, found.results.site.partner)


def _samples(found: StudyResults) -> PageSamples | None:
    results, path = found.results.samples, found.folder / file_names.SAMPLE_FLIGHTS_FILE
    if results is None:
        return None
    impacts = found.flights.where(found.flights["status"] == FlightStatus.IMPACT)
    latitude, longitude = _places(path, impacts, found.remedy)
    facet = impacts["facet"].astype(np.int64)
    return PageSamples(results, found.samples, found.flights, found.explorer, latitude, longitude, facet)


def _expansion(found: StudyResults) -> PageExpansion | None:
    results, path = found.results.expansion, found.folder / file_names.SCORES_FILE
    if results is None:
        return None
    with reading(path, found.remedy):
        scores = {
            stage: {name: results_in(OutputErrors, errors, f"{stage}.{name}") for name, errors in table.items()}
            for stage, table in found.scores.items()
        }
    return PageExpansion(results, found.runs.where(np.isin(found.runs["design"], PAPER_DESIGNS)), scores)


def _resting(found: StudyResults, ground: str) -> Places:
    """Where the landers are that come to rest on a ground."""
    chosen = (found.rest["end"] == JourneyEnd.AT_REST) & (found.rest["ground"] == ground)
    return _places(found.folder / file_names.REST_FILE, found.rest.where(chosen), found.remedy)


def _places(path: Path, table: Table, remedy: str) -> Places:
    """Latitude and longitude [deg], shape [row_count] each. Raises DamagedFileError where a row has none."""
    latitude, longitude = table["latitude_deg"], table["longitude_deg"]
    if not np.isfinite(latitude + longitude).all():
        raise DamagedFileError(f"{path} has a row without latitude and longitude; {remedy}")
    return latitude, longitude
