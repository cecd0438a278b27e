"""A small study folder with made-up arrays in every file that the report reads."""

import csv
import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

from ..synthetic_landings import Truth
from .sequence_study import write_sequence

INPUTS = ["grain.young_modulus", "grain.restitution", "grain.friction"]
OUTPUTS = ["speed_out", "elevation_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z"]
OCTAHEDRON = 0.05 * np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
OCTAHEDRON_FACES = np.array([(x, y, z) for x in (0, 1) for y in (2, 3) for z in (4, 5)])


@pytest.fixture(scope="session")
def study_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished study without its report."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "beds").mkdir()
    (folder / "study.toml").write_text('title = "A made-up study"\n', encoding="utf-8")
    write_bodies(folder / "beds" / "bed_0.h5", 12, {"width": [0.6, 0.6], "surface_height": 0.2})
    landing = {"status": "clear", "width": [0.6, 0.6], "speed": 0.2, "incidence": np.pi / 6}
    write_bodies(folder / "landing.h5", 13, landing)
    write_samples(folder / "samples.h5")
    write_flights(folder / "flights.csv")
    write_paths(folder / "flight_paths.h5")
    write_rest(folder / "rest.csv")
    write_octahedron(folder / "body.obj")
    scores = made_up_scores()
    (folder / "scores.json").write_text(json.dumps(scores), encoding="utf-8")
    (folder / "summary.json").write_text(json.dumps(made_up_summary(scores)), encoding="utf-8")
    return folder


def write_bodies(path: Path, count: int, attributes: dict[str, object]) -> None:
    """Octahedra that sink for eight frames."""
    time = np.linspace(0.0, 0.7, 8)
    grid = np.stack(np.meshgrid([-0.15, 0.0, 0.15], [-0.1, 0.1], [0.3, 0.5, 0.7], indexing="ij"), axis=-1)
    position = np.repeat(grid.reshape(-1, 3)[None, :count], len(time), axis=0)
    position[:, :, 2] -= 0.25 * time[:, None]
    orientation = np.zeros((len(time), count, 4))
    orientation[:, :, 0] = 1.0
    with h5py.File(path, "w") as file:
        file["vertices"] = np.tile(OCTAHEDRON, (count, 1))
        file["vertex_start"] = len(OCTAHEDRON) * np.arange(count + 1)
        file["faces"] = np.tile(OCTAHEDRON_FACES, (count, 1))
        file["face_start"] = len(OCTAHEDRON_FACES) * np.arange(count + 1)
        for name, data in (("time", time), ("position", position), ("orientation", orientation)):
            file[f"frames/{name}"] = data
        if "status" in attributes:
            file["frames/force"] = 0.1 * np.exp(-5.0 * time)[:, None] * np.linspace(0.1, 1.0, count)
        for name in ("time", "kinetic_ratio", "unbalanced_force", "gravity"):
            file[f"history/{name}"] = time if name == "time" else np.exp(-10 * time)
        file.attrs.update(attributes)


def write_samples(path: Path) -> None:
    generator = np.random.default_rng(5)
    inputs = generator.uniform(0.3, 0.9, (400, len(INPUTS)))
    outputs = 0.1 + 0.05 * inputs[:, :1] + 0.01 * generator.normal(size=(400, len(OUTPUTS)))
    with h5py.File(path, "w") as file:
        file["inputs"], file["outputs"], file["outcome"] = inputs, outputs, (np.arange(400) < 40).astype(np.uint8)
        file.attrs["input_names"], file.attrs["output_names"] = INPUTS, OUTPUTS
        file.attrs["outcomes"] = ["clear", "captured", "left_sideways", "time_limit", "outside"]


def write_flights(path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        starts = ["start_speed [m/s]", "start_elevation_deg", "velocity_x [m/s]", "velocity_y [m/s]"]
        ends = ["status", "time_s", "latitude_deg", "longitude_deg", "facet", "impact_speed"]
        table.writerow(["sample", *starts, *ends])
        for index in range(100):
            start = [index, 0.002 * (index + 1), 20.0 + index % 50, 0.001, 0.001 * (index % 7 - 3)]
            if index % 4:
                end = ["impact", 100.0 + index, 0.3 * index - 15, 2.0 * index - 100, index % 3, 0.05]
            else:
                end = ["escaped" if index % 8 else "flying", 43200.0, "", "", "", ""]
            table.writerow(start + end)


def write_paths(path: Path) -> None:
    """Two straight ways out from the body."""
    way = np.linspace(500.0, 2000.0, 5)[:, None] * [1.0, 0.0, 0.2]
    with h5py.File(path, "w") as file:
        file["position"] = np.stack([way, way[::-1]])
        file.attrs["status"] = ["escaped", "impact"]


def write_rest(path: Path) -> None:
    """Landers that were followed on hard ground only."""
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["ground", "sample", "status", "latitude_deg", "longitude_deg"])
        for index in range(50):
            place = [0.1 * index, 5.0 + 0.2 * index] if index % 5 else ["", ""]
            table.writerow(["hard", index, "settled" if index % 5 else "escaped", *place])


def write_octahedron(path: Path) -> None:
    """A body of eight facets."""
    lines = [f"v {x} {y} {z}" for x, y, z in (1e4 * OCTAHEDRON).tolist()]
    corners = 1e4 * OCTAHEDRON[OCTAHEDRON_FACES]
    outward = np.einsum(
        "fi,fi->f", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]
    )
    faces = np.where((outward > 0)[:, None], OCTAHEDRON_FACES, OCTAHEDRON_FACES[:, ::-1])
    path.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]) + "\n", encoding="utf-8")


def made_up_scores() -> dict[str, dict[str, dict[str, object]]]:
    ape = [0.5, 1.0, 1.5, 3.0]
    score = {"mape": 1.5, "q2": 0.8, "rrmse": 0.45, "rmse": 0.01, "std": 0.022, "ape": ape}
    score |= {"mape_interval": [1.1, 2.2], "q2_interval": [0.7, 0.85]}
    stages = ("screening", "refined", "test_kept", "test_all", "test_screening")
    return {stage: dict.fromkeys(OUTPUTS, score) for stage in stages}


def made_up_summary(scores: dict[str, dict[str, dict[str, object]]]) -> dict[str, object]:
    sobol = {name: dict(zip(INPUTS, (0.1, 0.5, 0.3), strict=True)) for name in OUTPUTS}
    sobol_interval = {name: {key: [0.9 * one, 1.1 * one] for key, one in row.items()} for name, row in sobol.items()}
    spread = dict.fromkeys(OUTPUTS, 0.02)
    quantiles = {"quantile_0.05": 0.08, "quantile_0.5": 0.1, "quantile_0.95": 0.12}
    share = {"count": 200, "share": 0.5, "lower": None, "upper": None}
    ends_of_samples = (
        "captured", "left_sideways", "time_limit", "outside", "impact", "flying", "escaped", "returns", "missing"
    )  # fmt: skip
    fit = {"method": "ols", "term_count": 10, "condition_number": 5.3, "rmse_estimate": 0.01}
    fit |= {"noise_std": 0.005, "noise_share": 0.06}
    fits = dict.fromkeys(OUTPUTS, fit)
    expansion = {
        "term_count": 10,
        "fits": fits,
        "mean": spread,
        "std": spread,
        "sobol_first": sobol,
        "sobol_total": sobol,
        "sobol_first_interval": sobol_interval,
        "sobol_total_interval": sobol_interval,
    }
    levels = np.arange(1, 4)
    ellipses = {
        "latitude_deg": 1.0,
        "longitude_deg": 10.0,
        "heading_deg": 30.0,
        "shares": [
            {"share": share, "semi_axes_deg": [long, 2.0], "semi_axes_m": [7.4 * long, 15.0]}
            for share, long in ((0.5, 8.0), (0.95, 20.0))
        ],
    }
    none = {"count": 0, "share": 0.0, "lower": None, "upper": None}
    ends = ("lofted", "outside", "outside_too_slow", "sliding", "bouncing", "flying", "partner")
    hard = {"sample_count": 50, **dict.fromkeys(ends, none), "settled": share, "escaped": share, "ellipses": ellipses}
    uniform = {"distribution": "uniform", "lower": 0.3, "upper": 0.9}
    outputs = {name: {"mean": 0.1, "std": 0.02, **quantiles} for name in OUTPUTS}
    # A symmetric study: across, there is nothing but rounding.
    outputs["velocity_out_y"] = {key: -2.2e-14 * value for key, value in outputs["velocity_out_y"].items()}
    return {
        "format_version": 3,
        "study": {
            "title": "A made-up study",
            "seed": 7,
            "bed": {"grain_count": 12, "width": [0.6, 0.6]},
            "grain": {
                "young_modulus": {"distribution": "log_uniform", "lower": 1e6, "upper": 1e8},
                "restitution": uniform,
                "friction": uniform,
            },
            "design": {"points": "smolyak", "screening_level": 2, "refined_level": 3, "kept_outputs": OUTPUTS},
            "flight": {"duration": 43200.0},
            "rest": {
                "count": 50,
                "duration": 86400.0,
                "normal_restitution": 0.6,
                "tangential_restitution": 0.8,
                "friction": 0.5,
                "rest_height": 0.01,
            },
            "site": {"body": "didymos"},
        },
        "results": {
            "beds": [
                {
                    "solid_fraction": 0.58,
                    "coordination_number": 4.1,
                    "surface_height_m": 0.2,
                    "mean_diameter_m": 0.1,
                    "smallest_width_m": 0.5,
                    "smallest_depth_m": 0.1,
                    "large_enough": True,
                }
            ],
            "designs": {
                name: {
                    "point_count": 25,
                    "replicate_count": 1,
                    "run_count": 25,
                    "with_outputs": 24,
                    "outcomes": {"captured": 1, "clear": 24},
                }
                for name in ("screening", "refined", "test_kept", "test_all")
            },
            "outputs_of_runs": {"penetration": {"median": 0.01, "smallest": 0.0, "largest": 0.02, "unit": "m"}},
            "node_counts": {
                "input_counts": [1, 2, 3],
                "levels": levels.tolist(),
                "tensor": [((2**levels + 1) ** n).tolist() for n in (1, 2, 3)],
                "smolyak": [[3, 5, 9], [5, 13, 29], [7, 25, 69]],
            },
            "screening": {"inputs": INPUTS, **expansion},
            "refined": {"inputs": INPUTS[1:], **expansion},
            "kept_inputs": INPUTS[1:],
            "kept_share": dict.fromkeys(OUTPUTS, 0.93),
            "scores": scores,
            "monte_carlo": {
                "sample_count": 400,
                "leaving_count": 360,
                "outputs": outputs,
            },
            "site": {
                "body": "didymos",
                "mass_kg": 5.3e11,
                "spin_period_s": 8136.0,
                "extents_m": [851.0, 849.0, 620.0],
                "facet_count": 1996,
                "latitude_deg": 0.0,
                "longitude_deg": 0.0,
                "heading_deg": 90.0,
                "place_m": [425.0, 0.0, 0.0],
                "centroid_m": [-2.2e-14, 2.1e-14, 0.0],
                "effective_acceleration_outward": 1.1e-5,
                "effective_acceleration_along_heading": -2.7e-19,
                "escape_speed_m_s": 0.4086,
                "bulk_density_kg_m3": 2790.3,
            },
            "shares": {
                "sample_count": 400,
                "flight_count": 100,
                **dict.fromkeys(ends_of_samples, share),
                "captured": none | {"upper_limit": 0.03},
            },
            "returns": {
                "share": 0.5,
                "why": "Another bed gives another figure.",
                "flight_sampling": 0.04,
                "level": 0.9,
            },
            "answer": ["On this bed, at this place: 50.0 % come down again.", "Another bed gives another figure."],
            "flights": {"gravity_table_error": None, "jacobi_drift_largest_m2_s2": None, "time_s": quantiles},
            "ellipses": ellipses,
            "without_scatter": None,
            "rest": {
                "why_no_soil": "impact.speed is no uncertain input",
                "trained_ranges": {},
                "soil": None,
                "hard": hard | {"time_s": quantiles},
            },
        },
        "provenance": {
            "date": "2026-03-01T09:30:00+00:00",
            "host": "somewhere",
            "packages": {"numpy": "2.0"},
            "wall_s": {"bed": 12.5},
        },
    }


@pytest.fixture(scope="session")
def sequence_folder(study_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished study of 120 landings on 12 beds, without its report."""
    folder = tmp_path_factory.mktemp("sequence") / "study"
    shutil.copytree(study_folder, folder, ignore=shutil.ignore_patterns("report", "scores.json"))
    # Long enough to be folded on the page.
    study_file = (folder / "study.toml").read_text(encoding="utf-8") + "# A remark.\n" * 20
    (folder / "study.toml").write_text(study_file, encoding="utf-8")
    write_sequence(folder, made_up_summary(made_up_scores()), Truth(rim="fast_flat"), 120, 12)
    return folder
