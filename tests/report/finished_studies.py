"""Finished studies in small: a function makes their touchdowns, the pipeline every file but the beds.

A function has no beds and no pictures. Those are put in by hand, and the summary is written anew by what writes it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zlib import crc32

import h5py
import numpy as np

import lithobrake
from lithobrake.dem import ConvexHull
from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.answer.study_summary import write_summary
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job, Silent
from lithobrake.study import check_tables
from lithobrake.touchdown import Bed

from ..pipeline.expansion.test_expansion_tables import TWO_STEPS, UNCERTAIN, land
from ..pipeline.few_terms import few_terms
from ..pipeline.journeys.bouncing_lander import bounce, journey_tables
from ..pipeline.synthetic_lander import SyntheticLander, synthetic_tables
from ..synthetic_landings import Truth

OCTAHEDRON = 0.05 * np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
OCTAHEDRON_FACES = np.array([(x, y, z) for x in (0, 1) for y in (2, 3) for z in (4, 5)])
ARRIVAL: dict[str, Any] = {
    "speed": {"distribution": "uniform", "lower": 0.05, "upper": 0.4},
    "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 60.0},
}
GRAIN_COUNT = 12
# Short times of flight: some landers still fly, and all is known within seconds.
FIRST: dict[str, dict[str, Any]] = {
    "design": {"run_count": 96, "side_runs": True}, "bed": {"bed_count": 12}, "impact": ARRIVAL,
    "site": {"latitude_deg": 50.0}, "monte_carlo": {"sample_count": 1000},
    "flight": {"flight_count": 200, "duration": 240.0}, "hard_ground": {"count": 20},
    "journey": {"touchdowns": 1, "duration": 3600.0}, "limit_states": {"fast": "speed_out > 0.05"},
}  # fmt: skip
PAPER: dict[str, dict[str, Any]] = {
    **UNCERTAIN, "design": {"run_count": 0}, "expansion": TWO_STEPS,
    "monte_carlo": {"sample_count": 400, "scatter": True}, "flight": {"flight_count": 100, "duration": 3600.0},
    "journey": {"touchdowns": 1, "duration": 7200.0}, "hard_ground": {"count": 20},
}  # fmt: skip
ASKED: dict[str, dict[str, Any]] = {
    "expansion": TWO_STEPS, "monte_carlo": {"sample_count": 400}, "flight": {"flight_count": 100, "duration": 3600.0},
    "hard_ground": {"count": 20}, "limit_states": {"fast": "speed_out > 0.03"},
}  # fmt: skip


@dataclass(frozen=True)
class Steady:
    """A model with a seed from its inputs to six digits: their last bits differ between processors, and so would all
    that comes out."""

    model: Callable[..., Any]

    def __call__(self, values: Mapping[str, float], seed: int) -> Any:
        """Land once."""
        words = ",".join(f"{name}={float(value):.6g}" for name, value in sorted(values.items()))
        return self.model(values, crc32(words.encode()))


def first_study(folder: Path) -> None:
    """First touchdowns on ground that holds what lies there: landers leave, are captured, and are lost over the rim."""
    lander = SyntheticLander(Truth(rim="fast_flat", capture=0.2), follows_speed=True)
    with few_terms():
        _finish(folder, synthetic_tables(**FIRST), lander)


def paper_study(folder: Path) -> None:
    """Expansions on ground that throws off what lies there."""
    _finish(folder, synthetic_tables(**PAPER), land)


def asked_study(folder: Path) -> None:
    """Landers that are followed to rest on Dimorphos, five of which do not come to rest, and all that can be asked."""
    with few_terms():
        _finish(folder, journey_tables(**ASKED), bounce_once)


def bounce_once(values: dict[str, float], seed: int) -> dict[str, Any]:
    """A touchdown of a journey, or of a design that has none."""
    return bounce({"journey": 0, "touchdown": 0, **values}, seed)


def _finish(folder: Path, tables: dict[str, Any], model: Callable[..., Any]) -> None:
    """Run a study with a function, then give it the beds and the pictures that one with soil has."""
    tables = tables | {"title": "A study in small"}
    lithobrake.run(tables, folder, workers=1, model=Steady(model), report=False)
    study = check_tables(tables, Path())
    (folder / "beds").mkdir()
    for name in bed_files(study):
        bed().save(folder / name)
    write_landing(folder / "landing.h5")
    made = StudyFolder(folder)
    key = made.key_of("summary.json") or ""
    write_summary(Job(DrawnDesign(study), tables, made, None, Silent()))  # type: ignore[arg-type]
    made.note("summary", ["summary.json"], key, made.wall_times()["summary"])


def sinking(count: int) -> dict[str, np.ndarray]:
    """Frames of bodies that sink: "time" [s], "position" [m] and "orientation"."""
    time = np.linspace(0.0, 0.7, 8)
    grid = np.stack(np.meshgrid([-0.15, 0.0, 0.15], [-0.1, 0.1], [0.3, 0.5, 0.7], indexing="ij"), axis=-1)
    position = np.repeat(grid.reshape(-1, 3)[None, :count], len(time), axis=0)
    position[:, :, 2] -= 0.25 * time[:, None]
    orientation = np.zeros((len(time), count, 4))
    orientation[:, :, 0] = 1.0
    return {"time": time, "position": position, "orientation": orientation}


def bed() -> Bed:
    """A few octahedra that have sunk into their box."""
    frames = sinking(GRAIN_COUNT)
    history = {name: np.exp(-10.0 * frames["time"]) for name in ("kinetic_ratio", "unbalanced_force", "gravity")}
    return Bed(
        grains=[ConvexHull(OCTAHEDRON)] * GRAIN_COUNT, position=frames["position"][-1],
        orientation=frames["orientation"][-1], diameter=np.full(GRAIN_COUNT, 0.1), width=(0.6, 0.6),
        gravity=(0.0, 0.0, -5e-5), density=2500.0, young_modulus=1e7, poisson_ratio=0.25, seed=1, surface_height=0.2,
        surface_top=0.25, solid_fraction=0.58, coordination_number=4.1, frames=frames,
        history={"time": frames["time"], **history},
    )  # fmt: skip


def write_landing(path: Path) -> None:
    """Write a landing whose lander, the last body, sinks with the grains."""
    frames = sinking(GRAIN_COUNT + 1)
    with h5py.File(path, "w") as file:
        for name, rows in (("vertices", OCTAHEDRON), ("faces", OCTAHEDRON_FACES)):
            file[name] = np.tile(rows, (GRAIN_COUNT + 1, 1))
        for name, rows in (("vertex_start", OCTAHEDRON), ("face_start", OCTAHEDRON_FACES)):
            file[name] = len(rows) * np.arange(GRAIN_COUNT + 2)
        for name, data in frames.items():
            file[f"frames/{name}"] = data
        file["frames/force"] = 0.1 * np.exp(-5.0 * frames["time"])[:, None] * np.linspace(0.1, 1.0, GRAIN_COUNT + 1)
        file.attrs.update({"status": "clear", "width": [0.6, 0.6], "speed": 0.2, "incidence": np.pi / 6})
