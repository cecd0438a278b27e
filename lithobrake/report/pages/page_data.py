"""The results of a study as the page shows them: a view, in which whatever is missing is told with its file."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.reading import DamagedFileError, reading
from lithobrake.report.figures.error_figure import Score
from lithobrake.report.figures.scene import Scene, scene
from lithobrake.results import ExplorerTables, StudyResults, Table
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome

Array = NDArray[np.float64]
FILES = ("summary.json", "study.toml")
# What the last stages of either method write before the report.
OF_ANY_STUDY = ("samples.h5", "explorer.h5", "flights.csv", "flight_paths.h5", "rest.csv", "body.obj")
PAPER_FILES = (*FILES, "scores.json", *OF_ANY_STUDY)
DRAWN_FILES = (*FILES, "designs/sequence.csv", *OF_ANY_STUDY)
GROUNDS = ("soil", "hard")


@dataclass(frozen=True)
class Results:
    """What the page shows of any study.

    study, results, provenance: the three tables of summary.json;
    latitude, longitude: of the impacts [deg], shape [impact], and facet, the one of the body that was hit;
    body_vertices of the body [m] and its body_faces, counted from 0; rest: latitude and longitude [deg] of the landers
    that rest, by ground; paths: places on the ways of some flights [m] and how each ended; flights: of the samples;
    explorer: what the page evaluates of the model; samples: of the model. bed and landing are None where a solver of
    the user's own made the touchdowns.
    """

    model: ClassVar[str]
    """What was fitted to the runs and stands for them in the samples, in a word."""
    digits: ClassVar[int]
    """Digits behind the point of a share in per cent without an interval, as its answer prints them."""
    study: dict[str, Any]
    results: dict[str, Any]
    provenance: dict[str, Any]
    study_text: str
    bed: Scene | None
    landing: Scene | None
    latitude: Array
    longitude: Array
    facet: NDArray[np.int64]
    body_vertices: Array
    body_faces: NDArray[np.int64]
    rest: dict[str, tuple[Array, Array]]
    paths: tuple[Array, tuple[str, ...]]
    flights: Table
    explorer: ExplorerTables
    samples: Table

    @property
    def level(self) -> float:
        """Probability that intervals and limits of shares stand for."""
        raise NotImplementedError

    @property
    def shown_landing(self) -> str:
        """Which landing has been kept with its pictures, as a sentence about it begins; empty where none has."""
        return ""

    def table(self, *keys: str) -> Mapping[str, Any]:
        """A table within the results, by the keys that lead to it; an empty one where there is none or it is null."""
        found: Mapping[str, Any] = self.results
        for key in keys:
            found = found.get(key) or {}
        return found


@dataclass(frozen=True)
class PaperResults(Results):
    """Results of the method in two steps; scores: stage, output, score."""

    model, digits = "expansion", 1
    scores: dict[str, dict[str, Score]]

    @property
    def level(self) -> float:
        """That of the limits of outcomes that no run had."""
        return 0.95

    @property
    def shown_landing(self) -> str:
        """That of the medians."""
        return "With every uncertain input at its median"


@dataclass(frozen=True)
class SequenceResults(Results):
    """Results of a sequence; runs: its landings, without side runs; rare: what `lithobrake rare` found, by state."""

    model, digits = "emulator", 0

    runs: Table
    rare: Mapping[str, Mapping[str, Any]]

    @property
    def level(self) -> float:
        """That of all intervals."""
        return float(self.results["returns"]["level"])

    @property
    def shown_landing(self) -> str:
        """The run that its file names, or the first one."""
        attributes = {} if self.landing is None else self.landing.moving.attributes
        if "run" not in attributes:
            return "In the first run"
        which = (
            "of the median speed of those that leave"
            if attributes["status"] == TouchdownOutcome.CLEAR
            else "as none leaves"
        )
        return f"In run {str(attributes['run'])[:8]}, {which}"


class SummaryTable(dict[str, Any]):
    """A table of summary.json; a key that it lacks, as where another version wrote it, is named with the file."""

    def __init__(self, content: Mapping[str, Any], path: Path, remedy: str, inside: str = "") -> None:
        """Take over a table and those in it; inside: its dotted name with a point, empty for the outermost."""
        super().__init__(content)
        self._lacks = f"{path} lacks {inside}{{key}}; {remedy}"
        for key, value in content.items():
            if isinstance(value, dict):
                self[key] = SummaryTable(value, path, remedy, f"{inside}{key}.")

    def __missing__(self, key: str) -> Any:
        """Raise DamagedFileError for a key that is not there."""
        raise DamagedFileError(self._lacks.format(key=key))


def page_results(found: StudyResults) -> PaperResults | SequenceResults:
    """What the page shows of a study. Raises ValueError that names the file when one is missing or damaged."""
    _refuse_without(found.folder, FILES)
    summary = SummaryTable(found.summary, found.folder / "summary.json", found.remedy)
    if summary["study"]["design"]["method"] == "paper":
        _refuse_without(found.folder, PAPER_FILES)
        return PaperResults(**_of_any_study(found, summary), scores=_scores(found))
    _refuse_without(found.folder, DRAWN_FILES)
    runs = found.runs.where(found.runs["design"] == "sequence")
    return SequenceResults(**_of_any_study(found, summary), runs=runs, rare=found.rare)


def _of_any_study(found: StudyResults, summary: SummaryTable) -> dict[str, Any]:
    """The fields that results of every method have."""
    # A program or function of the user's own has neither beds nor pictures.
    has_scenes = bool(summary["results"]["beds"])
    if has_scenes:
        _refuse_without(found.folder, ("landing.h5", "beds/bed_0.h5"))
    latitude, longitude, facet = _impacts(found)
    vertices, faces = found.body_shape
    return {
        "study": summary["study"],
        "results": summary["results"],
        "provenance": summary["provenance"],
        "study_text": found.study_text,
        "bed": scene(found.bed_bodies(0), has_lander=False) if has_scenes else None,
        "landing": scene(found.median_landing, has_lander=True) if has_scenes else None,
        "latitude": latitude,
        "longitude": longitude,
        "facet": facet,
        "body_vertices": vertices,
        "body_faces": faces,
        "paths": found.flight_paths,
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
    path = found.folder / "flights.csv"
    impacts = found.flights.where(found.flights["status"] == FlightStatus.IMPACT)
    return *_places(path, impacts, found.remedy), impacts["facet"].astype(np.int64)


def _resting(found: StudyResults, ground: str) -> tuple[Array, Array]:
    """Where the landers lie that rest on a ground."""
    chosen = (found.rest["status"] == JourneyStatus.SETTLED) & (found.rest["ground"] == ground)
    return _places(found.folder / "rest.csv", found.rest.where(chosen), found.remedy)


def _places(path: Path, table: Table, remedy: str) -> tuple[Array, Array]:
    """Latitude and longitude [deg], shape [row_count] each. Raises DamagedFileError where a row has none."""
    latitude, longitude = table["latitude_deg"], table["longitude_deg"]
    if not np.isfinite(latitude + longitude).all():
        raise DamagedFileError(f"{path} has a row without latitude and longitude; {remedy}")
    return latitude, longitude


def _scores(found: StudyResults) -> dict[str, dict[str, Score]]:
    """Scores by stage and output; a score that does not exist is None."""
    with reading(found.folder / "scores.json", found.remedy):
        return {stage: {name: _score(score) for name, score in table.items()} for stage, table in found.scores.items()}


def _score(score: Mapping[str, Any]) -> Score:
    return Score(
        # A run whose true value is zero has no percentage; it still counts in all other scores.
        ape=np.array([value for value in score["ape"] if value is not None], dtype=float),
        mape=score["mape"],
        q2=score["q2"],
        q2_interval=tuple(score["q2_interval"]),
        rmse=score["rmse"],
        std=score["std"],
    )
