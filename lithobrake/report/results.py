"""The results of a study as the page shows them: a view, in which whatever is missing is told with its file."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.outcomes import FlightStatus, JourneyStatus
from lithobrake.reading import DamagedFileError, reading
from lithobrake.report.error_figure import Score
from lithobrake.report.scene import Scene, scene
from lithobrake.results import StudyResults, Table

Array = NDArray[np.float64]
FILES = ("summary.json", "scores.json", "samples.h5", "flights.csv", "rest.csv", "body.obj", "study.toml")


@dataclass(frozen=True)
class Results:
    """All that the page shows.

    study, results, provenance: the three tables of summary.json; scores: stage, output, score;
    latitude, longitude: of the impacts [deg], shape [impact], and facet, the one of the body that was hit;
    body_vertices of the body [m] and its body_faces, counted from 0; rest: latitude and longitude [deg] of the landers
    that rest, by ground. bed and landing are None where a solver of the user's own made the touchdowns.
    """

    study: dict[str, Any]
    results: dict[str, Any]
    provenance: dict[str, Any]
    study_text: str
    bed: Scene | None
    landing: Scene | None
    scores: dict[str, dict[str, Score]]
    samples: Table
    latitude: Array
    longitude: Array
    facet: NDArray[np.int64]
    body_vertices: Array
    body_faces: NDArray[np.int64]
    rest: dict[str, tuple[Array, Array]]

    @property
    def is_drawn(self) -> bool:
        """Whether all runs were drawn out of one sequence: no designs, no expansions, and intervals in their place."""
        return not self.scores


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


def page_results(found: StudyResults) -> Results:
    """What the page shows of a study. Raises ValueError that names the file when one is missing or damaged."""
    is_drawn = found.study["design"].get("method") == "sequence"
    _refuse_without(found.folder, tuple(name for name in FILES if not (is_drawn and name == "scores.json")))
    summary = SummaryTable(found.summary, found.folder / "summary.json", found.remedy)
    # A program or function of the user's own has neither beds nor pictures.
    has_scenes = bool(summary["results"]["beds"])
    if has_scenes:
        _refuse_without(found.folder, ("landing.h5", "beds/bed_0.h5"))
    impacts = found.flights.where(found.flights["status"] == FlightStatus.IMPACT)
    latitude, longitude = _places(found.folder / "flights.csv", impacts, found.remedy)
    vertices, faces = found.body_shape
    return Results(
        study=summary["study"],
        results=summary["results"],
        provenance=summary["provenance"],
        study_text=found.study_text,
        bed=scene(found.bed_bodies(0), has_lander=False) if has_scenes else None,
        landing=scene(found.median_landing, has_lander=True) if has_scenes else None,
        scores={} if is_drawn else _scores(found),
        samples=found.samples,
        latitude=latitude,
        longitude=longitude,
        facet=impacts["facet"].astype(np.int64),
        body_vertices=vertices,
        body_faces=faces,
        rest={ground: _resting(found, ground) for ground in ("soil", "hard")},
    )


def _refuse_without(folder: Path, needed: tuple[str, ...]) -> None:
    missing = [name for name in needed if not (folder / name).is_file()]
    if missing:
        raise ValueError(
            f"{folder} lacks {', '.join(missing)}, so there is no report yet; run the study to its end first"
        )


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
