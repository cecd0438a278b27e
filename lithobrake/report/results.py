"""The files of a study as the report reads them."""

import csv
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.report.error_figure import Score
from lithobrake.report.scene import Scene, read_scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Samples:
    """The Monte Carlo: inputs in the study file's units and outputs [SI] by name, shape [sample]; which stay."""

    inputs: dict[str, Array]
    outputs: dict[str, Array]
    stays: NDArray[np.bool_]


@dataclass(frozen=True)
class Results:
    """All that the page shows.

    study, results, provenance: the three tables of summary.json; scores: stage, output, score;
    latitude, longitude: of the impacts [deg], shape [impact]; body_vertices: of the body [m], or None. bed and landing
    are None where a solver of the user's own made the touchdowns.
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
    body_vertices: Array | None


def read_results(folder: Path) -> Results:
    """Read a study's folder. Raises ValueError that names the file when one is missing."""
    _refuse_without(folder, ("summary.json", "scores.json", "samples.h5", "flights.csv", "study.toml"))
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    has_scenes = not summary["study"].get("solver", {}).get("command")
    if has_scenes:
        _refuse_without(folder, ("landing.h5", "beds/bed_0.h5"))
    latitude, longitude = read_impacts(folder / "flights.csv")
    return Results(
        study=summary["study"],
        results=summary["results"],
        provenance=summary["provenance"],
        study_text=(folder / "study.toml").read_text(encoding="utf-8"),
        bed=read_scene(folder / "beds/bed_0.h5", has_lander=False) if has_scenes else None,
        landing=read_scene(folder / "landing.h5", has_lander=True) if has_scenes else None,
        scores=read_scores(folder / "scores.json"),
        samples=read_samples(folder / "samples.h5"),
        latitude=latitude,
        longitude=longitude,
        body_vertices=read_vertices(folder / "body.obj"),
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
        inputs, outputs, stays = file["inputs"][:], file["outputs"][:], file["stays"][:].astype(bool)
        input_names, output_names = [str(name) for name in file.attrs["input_names"]], list(file.attrs["output_names"])
    return Samples(
        {name: inputs[:, column] for column, name in enumerate(input_names)},
        {str(name): outputs[:, column] for column, name in enumerate(output_names)},
        stays,
    )


def read_impacts(path: Path) -> tuple[Array, Array]:
    """Latitude and longitude [deg] of the flights that ended in an impact, shape [impact] each."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["status"] == "impact"]
    return (
        np.array([float(row["latitude_deg"]) for row in rows]),
        np.array([float(row["longitude_deg"]) for row in rows]),
    )


def read_vertices(path: Path) -> Array | None:
    """Vertices of the body [m], shape [vertex, 3], or None when the study keeps no shape."""
    if not path.is_file():
        return None
    lines = path.read_text(encoding="utf-8").splitlines()
    return np.array([[float(word) for word in line.split()[1:4]] for line in lines if line.startswith("v ")])
