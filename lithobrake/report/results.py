"""The files of a study as the report reads them."""

import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.mesh_files import read_mesh
from lithobrake.outcomes import FlightStatus, JourneyStatus, SampleOutcome
from lithobrake.reading import NUMBER, DamagedFileError, parsed, read_json, read_rows, reading
from lithobrake.report.error_figure import Score
from lithobrake.report.scene import Scene, read_scene

Array = NDArray[np.float64]
FILES = ("summary.json", "scores.json", "samples.h5", "flights.csv", "rest.csv", "body.obj", "study.toml")
FORMAT_VERSION = 2


@dataclass(frozen=True)
class SampleColumns:
    """The Monte Carlo: inputs in the study file's units and outputs [SI] by name, shape [sample]; which leave."""

    inputs: dict[str, Array]
    outputs: dict[str, Array]
    leaves: NDArray[np.bool_]


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
    samples: SampleColumns
    latitude: Array
    longitude: Array
    facet: NDArray[np.int64]
    body_vertices: Array
    body_faces: NDArray[np.int64]
    rest: dict[str, tuple[Array, Array]]


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


def read_results(folder: Path) -> Results:
    """Read a study's folder. Raises ValueError that names the file when one is missing or damaged."""
    _refuse_without(folder, FILES)
    remedy = f"make it again with: lithobrake run STUDY.toml --out {shlex.quote(str(folder))}"

    def read(name: str, reader: Callable[..., Any], *arguments: Any) -> Any:
        with reading(folder / name, remedy):
            return reader(folder / name, *arguments)

    summary = read_summary(folder / "summary.json", remedy)
    # A program or function of the user's own has neither beds nor pictures.
    has_scenes = bool(summary["results"]["beds"])
    if has_scenes:
        _refuse_without(folder, ("landing.h5", "beds/bed_0.h5"))
    places = ("latitude_deg", "longitude_deg")
    impacts = read("flights.csv", read_columns, remedy, {"status": FlightStatus.IMPACT}, *places, "facet")
    rest = {
        ground: read("rest.csv", read_columns, remedy, {"ground": ground, "status": JourneyStatus.SETTLED}, *places)
        for ground in ("soil", "hard")
    }
    vertices, faces = read("body.obj", read_body)
    return Results(
        study=summary["study"],
        results=summary["results"],
        provenance=summary["provenance"],
        study_text=read("study.toml", lambda path: path.read_text(encoding="utf-8")),
        bed=read("beds/bed_0.h5", read_scene, False) if has_scenes else None,
        landing=read("landing.h5", read_scene, True) if has_scenes else None,
        scores=read("scores.json", read_scores),
        samples=read("samples.h5", read_samples),
        latitude=impacts[0],
        longitude=impacts[1],
        facet=impacts[2].astype(np.int64),
        body_vertices=vertices,
        body_faces=faces,
        rest={ground: (columns[0], columns[1]) for ground, columns in rest.items()},
    )


def read_summary(path: Path, remedy: str) -> SummaryTable:
    """The tables of summary.json. Raises DamagedFileError for a damaged file, and for another format."""
    content = read_json(path, {"format_version": int, "study": dict, "results": dict, "provenance": dict}, remedy)
    if content["format_version"] != FORMAT_VERSION:
        raise DamagedFileError(
            f"{path} has format {content['format_version']}; this version reads {FORMAT_VERSION}; {remedy}"
        )
    return SummaryTable(content, path, remedy)


def _refuse_without(folder: Path, needed: tuple[str, ...]) -> None:
    missing = [name for name in needed if not (folder / name).is_file()]
    if missing:
        raise ValueError(
            f"{folder} lacks {', '.join(missing)}, so there is no report yet; run the study to its end first"
        )


def read_scores(path: Path) -> dict[str, dict[str, Score]]:
    """Scores by stage and output; a score that does not exist is None."""
    known, absent = (
        {"rmse": NUMBER, "std": NUMBER},
        {"ape": [NUMBER | None], "mape": NUMBER | None, "q2": NUMBER | None},
    )
    content = parsed(path.read_text(encoding="utf-8"), {str: {str: known | absent}})
    return {
        stage: {
            name: Score(
                # A run whose true value is zero has no percentage; it still counts in all other scores.
                ape=np.array([value for value in score["ape"] if value is not None], dtype=float),
                mape=score["mape"],
                q2=score["q2"],
                q2_interval=tuple(score["q2_interval"]),
                rmse=score["rmse"],
                std=score["std"],
            )
            for name, score in table.items()
        }
        for stage, table in content.items()
    }


def read_samples(path: Path) -> SampleColumns:
    """Samples by name."""
    import h5py

    with h5py.File(path, "r") as file:
        inputs, outputs = file["inputs"][:], file["outputs"][:]
        leaves = file["outcome"][:] == list(file.attrs["outcomes"]).index(SampleOutcome.CLEAR)
        input_names, output_names = [str(name) for name in file.attrs["input_names"]], list(file.attrs["output_names"])
    return SampleColumns(
        {name: inputs[:, column] for column, name in enumerate(input_names)},
        {str(name): outputs[:, column] for column, name in enumerate(output_names)},
        leaves,
    )


def read_columns(path: Path, remedy: str, wanted: Mapping[str, str], *names: str) -> list[Array]:
    """Columns of numbers of a CSV file, of the rows that have the wanted words, shape [row] each."""
    rows = read_rows(path, (*wanted, *names), remedy)
    chosen = [row for row in rows if all(row[key] == word for key, word in wanted.items())]
    return [np.array([float(row[name]) for row in chosen]) for name in names]


def read_body(path: Path) -> tuple[Array, NDArray[np.int64]]:
    """Vertices of the body [m], shape [vertex, 3], and its faces, counted from 0, shape [face, 3]."""
    vertices, faces = read_mesh(path, "m")
    if not len(vertices) or not len(faces) or not 0 <= faces.min() <= faces.max() < len(vertices):
        raise ValueError("it has no vertices, or faces without them")
    return vertices, faces
