"""The files of a study as the report reads them."""

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.report.error_figure import Score
from lithobrake.report.scene import Scene, read_scene

Array = NDArray[np.float64]
FILES = ("summary.json", "scores.json", "samples.h5", "flights.csv", "rest.csv", "body.obj", "study.toml")


@dataclass(frozen=True)
class Samples:
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
    samples: Samples
    latitude: Array
    longitude: Array
    facet: NDArray[np.int64]
    body_vertices: Array
    body_faces: NDArray[np.int64]
    rest: dict[str, tuple[Array, Array]]


def read_results(folder: Path) -> Results:
    """Read a study's folder. Raises ValueError that names the file when one is missing."""
    _refuse_without(folder, FILES)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    has_scenes = not summary["study"].get("solver", {}).get("command")
    if has_scenes:
        _refuse_without(folder, ("landing.h5", "beds/bed_0.h5"))
    impacts = read_columns(folder / "flights.csv", {"status": "impact"}, "latitude_deg", "longitude_deg", "facet")
    places = ("latitude_deg", "longitude_deg")
    rest = {
        ground: read_columns(folder / "rest.csv", {"ground": ground, "status": "settled"}, *places)
        for ground in ("soil", "hard")
    }
    vertices, faces = read_body(folder / "body.obj")
    return Results(
        study=summary["study"],
        results=summary["results"],
        provenance=summary["provenance"],
        study_text=(folder / "study.toml").read_text(encoding="utf-8"),
        bed=read_scene(folder / "beds/bed_0.h5", has_lander=False) if has_scenes else None,
        landing=read_scene(folder / "landing.h5", has_lander=True) if has_scenes else None,
        scores=read_scores(folder / "scores.json"),
        samples=read_samples(folder / "samples.h5"),
        latitude=impacts[0],
        longitude=impacts[1],
        facet=impacts[2].astype(np.int64),
        body_vertices=vertices,
        body_faces=faces,
        rest={ground: (columns[0], columns[1]) for ground, columns in rest.items()},
    )


def _refuse_without(folder: Path, needed: tuple[str, ...]) -> None:
    missing = [name for name in needed if not (folder / name).is_file()]
    if missing:
        raise ValueError(
            f"{folder} lacks {', '.join(missing)}, so there is no report yet; run the study to its end first"
        )


def read_scores(path: Path) -> dict[str, dict[str, Score]]:
    """Scores by stage and output; a score that does not exist is None."""
    content = json.loads(path.read_text(encoding="utf-8"))
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


def read_samples(path: Path) -> Samples:
    """Samples by name."""
    import h5py

    with h5py.File(path, "r") as file:
        inputs, outputs = file["inputs"][:], file["outputs"][:]
        leaves = file["outcome"][:] == list(file.attrs["outcomes"]).index("clear")
        input_names, output_names = [str(name) for name in file.attrs["input_names"]], list(file.attrs["output_names"])
    return Samples(
        {name: inputs[:, column] for column, name in enumerate(input_names)},
        {str(name): outputs[:, column] for column, name in enumerate(output_names)},
        leaves,
    )


def read_columns(path: Path, wanted: Mapping[str, str], *names: str) -> list[Array]:
    """Columns of numbers of a CSV file, of the rows that have the wanted words, shape [row] each."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if all(row[key] == word for key, word in wanted.items())]
    return [np.array([float(row[name]) for row in rows]) for name in names]


def read_body(path: Path) -> tuple[Array, NDArray[np.int64]]:
    """Vertices of the body [m], shape [vertex, 3], and its faces, counted from 0, shape [face, 3]."""
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
    vertices = np.array([[float(word) for word in words[1:4]] for words in lines if words[0] == "v"])
    return vertices, np.array([[int(word) - 1 for word in words[1:4]] for words in lines if words[0] == "f"])
