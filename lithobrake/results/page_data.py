"""The results of a study as the page shows them; a file that is missing or damaged is named."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.reading import DamagedFileError, reading
from lithobrake.results import ExplorerTables, MovingBodies, StudyResults, Table
from lithobrake.results.journey_results import JourneyRest
from lithobrake.results.model_results import EmulatorResults, OutputErrors
from lithobrake.results.questions import RareLimitState
from lithobrake.results.run_results import CountedShare
from lithobrake.results.study_files import results_in
from lithobrake.results.summary import DrawnResults, PaperResults, Provenance
from lithobrake.vocabulary import file_names
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import EXPANSION_LEVEL
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome

FILES = (file_names.SUMMARY_FILE, file_names.STUDY_FILE)
# What the last stages of either method write before the report.
OF_ANY_STUDY = ("flight_paths.h5", file_names.BODY_FILE)
OF_SAMPLES = (
    file_names.SAMPLES_FILE,
    file_names.EXPLORER_FILE,
    file_names.SAMPLE_FLIGHTS_FILE,
    file_names.REST_FILE,
)
PAPER_FILES = (*FILES, file_names.SCORES_FILE, *OF_SAMPLES, *OF_ANY_STUDY)
DRAWN_FILES = (*FILES, "designs/drawn.csv", *OF_SAMPLES, *OF_ANY_STUDY)
JOURNEY_FILES = (
    *FILES,
    "designs/drawn.csv",
    file_names.JOURNEYS_FILE,
    file_names.TOUCHDOWNS_FILE,
    file_names.TOUCHDOWN_EXPLORER_FILE,
    *OF_ANY_STUDY,
)
GROUNDS = ("soil", "hard")


@dataclass(frozen=True)
class PageData:
    """What the page shows of any study.

    study: the tables of its file; results and provenance: those of summary.json; body_vertices of the body [m] and its
    body_faces, counted from 0; paths: places on the ways of some flights [m] and how each ended; path_times: times at
    these places since the flight began [s], and the number of the sample or journey of each. bed and landing are None
    where a solver of the user's own made the touchdowns.
    """

    digits: ClassVar[int]
    """Digits behind the point of a share in per cent without an interval, as its answer prints them."""
    study: dict[str, Any]
    results: DrawnResults | PaperResults
    provenance: Provenance
    study_text: str
    bed: MovingBodies | None
    landing: MovingBodies | None
    body_vertices: Array
    body_faces: NDArray[np.int64]
    paths: tuple[Array, tuple[str, ...]]
    path_times: tuple[Array, NDArray[np.int64]]

    @property
    def level(self) -> float:
        """Probability that intervals and limits of shares stand for."""
        raise NotImplementedError

    @property
    def shown_landing(self) -> str:
        """Which landing has been kept with its pictures, as a sentence about it begins; empty where none has."""
        return ""


@dataclass(frozen=True)
class SampledPage(PageData):
    """What the page shows of a study whose runs a model stands for, which was sampled.

    latitude, longitude: of the impacts of samples [deg], shape [impact], and facet, the one of the body that was hit;
    rest: latitude and longitude [deg] of the landers that rest, by ground; flights: of the samples; explorer: what the
    page evaluates of the model; samples: of the model.
    """

    model: ClassVar[str]
    """What was fitted to the runs and stands for them in the samples, in a word."""
    latitude: Array
    longitude: Array
    facet: NDArray[np.int64]
    rest: dict[str, tuple[Array, Array]]
    flights: Table
    explorer: ExplorerTables
    samples: Table


@dataclass(frozen=True)
class PaperPage(SampledPage):
    """Results of a paper study; scores: by set of runs and output, with the error of each run; runs: of all designs."""

    model, digits = "expansion", 1
    results: PaperResults
    runs: Table
    scores: Mapping[str, Mapping[str, OutputErrors]]

    @property
    def level(self) -> float:
        """That of the limits of outcomes that no run had."""
        return EXPANSION_LEVEL

    @property
    def shown_landing(self) -> str:
        """That of the medians."""
        return "With every uncertain input at its median"


@dataclass(frozen=True)
class RunsPage(PageData):
    """Results of drawn landings; runs: without auxiliary ones."""

    digits = 0

    results: DrawnResults
    runs: Table

    @property
    def level(self) -> float:
        """That of all intervals."""
        return self.results.returns.share.level

    @property
    def shown_landing(self) -> str:
        """The run that its file names, or the first one."""
        attributes = {} if self.landing is None else self.landing.attributes
        if "run" not in attributes:
            return "In the first run"
        which = (
            "the one with the median rebound speed"
            if attributes["status"] == TouchdownOutcome.CLEAR
            else "since none leaves the surface"
        )
        return f"In run {str(attributes['run'])[:8]}, {which}"


@dataclass(frozen=True)
class DrawnPage(RunsPage, SampledPage):
    """Results of a drawn study of single landings; rare: what `lithobrake rare` found, by limit state."""

    model = "emulator"

    rare: Mapping[str, RareLimitState]

    @property
    def emulator(self) -> EmulatorResults:
        """What the emulator of the landings is worth."""
        found = self.results.emulator
        assert found is not None
        return found


@dataclass(frozen=True)
class JourneyPage(RunsPage):
    """Results of a study whose landers were followed to rest; journeys: a row each; at_rest: numbers of those at rest.

    ends: shares of the journeys by end; touchdowns: a row each, and runs the first ones alone; explorer: what the page
    evaluates of their emulator, None where there is none.
    """

    journeys: Table
    touchdowns: Table
    ends: Mapping[str, CountedShare]
    at_rest: JourneyRest
    explorer: ExplorerTables | None

    @property
    def shown_landing(self) -> str:
        """The first touchdown that its file names."""
        words = super().shown_landing
        return f"{words} (first touchdown)" if words else ""


def page_results(found: StudyResults) -> PaperPage | DrawnPage | JourneyPage:
    """What the page shows of a study. Raises ValueError that names the file when one is missing or damaged."""
    _refuse_without(found.folder, FILES)
    results = found.results
    if isinstance(results, PaperResults):
        _refuse_without(found.folder, PAPER_FILES)
        shared = _of_any_study(found) | _of_samples(found)
        return PaperPage(results=results, **shared, runs=found.runs, scores=_scores(found))
    journeys = _journeys(found, results)
    _refuse_without(found.folder, JOURNEY_FILES if journeys else DRAWN_FILES)
    runs = found.runs.where(found.runs["design"] == "drawn")
    if journeys:
        return JourneyPage(results=results, **_of_any_study(found), runs=runs, **journeys)
    if results.emulator is None:
        raise DamagedFileError(f"{found.folder / 'summary.json'} has no results of an emulator; {found.remedy}")
    return DrawnPage(results=results, **_of_any_study(found), **_of_samples(found), runs=runs, rare=found.rare)


def _journeys(found: StudyResults, results: DrawnResults) -> dict[str, Any]:
    """The fields that only a study of journeys has; empty for any other."""
    if results.ends is None or not isinstance(results.rest, JourneyRest):
        return {}
    _refuse_without(found.folder, JOURNEY_FILES)
    tables = {"journeys": found.journeys, "touchdowns": found.touchdowns, "explorer": found.touchdown_explorer}
    return {**tables, "ends": results.ends, "at_rest": results.rest}


def _of_any_study(found: StudyResults) -> dict[str, Any]:
    """The fields that results of every method have."""
    # A program or function of the user's own has neither beds nor pictures.
    has_scenes = bool(found.results.beds)
    if has_scenes:
        _refuse_without(found.folder, (file_names.LANDING_FILE, "beds/bed_0.h5"))
    vertices, faces = found.body_shape
    return {
        "study": found.study,
        "provenance": found.summary.provenance,
        "study_text": found.study_text,
        "bed": found.bed_bodies(0) if has_scenes else None,
        "landing": found.median_landing if has_scenes else None,
        "body_vertices": vertices,
        "body_faces": faces,
        "paths": found.flight_paths,
        "path_times": found.flight_path_times,
    }


def _of_samples(found: StudyResults) -> dict[str, Any]:
    """The fields of a study whose model was sampled."""
    latitude, longitude, facet = _impacts(found)
    return {
        "latitude": latitude,
        "longitude": longitude,
        "facet": facet,
        "flights": found.flights,
        "explorer": found.explorer,
        "samples": found.samples,
        "rest": {ground: _resting(found, ground) for ground in GROUNDS},
    }


def _refuse_without(folder: Path, needed: tuple[str, ...]) -> None:
    missing = [name for name in needed if not (folder / name).is_file()]
    if missing:
        raise ValueError(
            f"{folder} lacks {', '.join(missing)}, so there is no report yet; run the study to its end first"
        )


def _impacts(found: StudyResults) -> tuple[Array, Array, NDArray[np.int64]]:
    """Latitude, longitude [deg] and facet of each impact."""
    path = found.folder / file_names.SAMPLE_FLIGHTS_FILE
    impacts = found.flights.where(found.flights["status"] == FlightStatus.IMPACT)
    return *_places(path, impacts, found.remedy), impacts["facet"].astype(np.int64)


def _resting(found: StudyResults, ground: str) -> tuple[Array, Array]:
    """Where the landers lie that rest on a ground."""
    chosen = (found.rest["status"] == JourneyStatus.SETTLED) & (found.rest["ground"] == ground)
    return _places(found.folder / file_names.REST_FILE, found.rest.where(chosen), found.remedy)


def _places(path: Path, table: Table, remedy: str) -> tuple[Array, Array]:
    """Latitude and longitude [deg], shape [row_count] each. Raises DamagedFileError where a row has none."""
    latitude, longitude = table["latitude_deg"], table["longitude_deg"]
    if not np.isfinite(latitude + longitude).all():
        raise DamagedFileError(f"{path} has a row without latitude and longitude; {remedy}")
    return latitude, longitude


def _scores(found: StudyResults) -> dict[str, dict[str, OutputErrors]]:
    """Errors by set of runs and output."""
    with reading(found.folder / file_names.SCORES_FILE, found.remedy):
        return {
            stage: {name: results_in(OutputErrors, errors, f"{stage}.{name}") for name, errors in table.items()}
            for stage, table in found.scores.items()
        }
