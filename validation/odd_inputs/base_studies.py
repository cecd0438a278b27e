"""Studies to be made odd: the shipped ones with few landers, and others that have every section of the study file."""

import tomllib
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
from pydantic.fields import FieldInfo

from lithobrake.study.study import Study
from lithobrake.study.units import is_named, limits, table

ROOT = Path(__file__).parents[2]
SHIPPED = tuple(sorted(path.stem for path in (ROOT / "scenarios").glob("*.toml")))
Tables = dict[str, Any]
# What makes a study end within seconds.
SMALL: Tables = {
    "bed": {"bed_count": 4},
    "journey": {"count": 8, "duration": 20_000.0, "emulated_count": 0},
    "hard_ground": {"count": 6},
    "flight": {"flight_count": 4, "duration": 2000.0},
}
FEW = {"lander_count": 2}
BOX = {"shape": "box", "edges": [0.2, 0.02, 0.02], "centre": [0.1, 0.0, 0.0]}
POLE = {"pole_right_ascension_deg": 69.3, "pole_declination_deg": -72.7, "meridian_deg": 10.0}
ORBIT = {
    "semi_major_axis_au": 1.64, "eccentricity": 0.38, "inclination_deg": 3.4, "node_deg": 73.0,
    "perihelion_deg": 319.6, "mean_anomaly_deg": 260.9, "epoch": "2026-06-09T00:00:00",
}  # fmt: skip
# Further studies: what each adds to a shipped one.
ADDED: dict[str, tuple[str, Tables]] = {
    "soils": ("one_ground", {"soil": {
        "ponds": {"latitude_deg": [-40.0, 40.0], "longitude_deg": [-120.0, 0.0], "slope_deg": [0.0, 60.0],
                  "grain": {"friction": 0.3, "restitution": 0.4, "young_modulus": 3e5}},
        "listed": {"facets": "facets.txt", "grain": {"friction": 0.8}}}}),
    "parts": ("one_ground", {
        "lander": {"centre_of_mass": {"x": 0.01, "y": 0.0, "z": 0.0}, "inertia": [0.01, 0.01, 0.004],
                   "part": {"leg": BOX | {"orientation": [1.0, 0.0, 0.0, 0.0], "mass": 0.05, "friction": 0.4},
                            "foot": {"shape": "sphere", "diameter": 0.03, "centre": [0.2, 0.0, 0.0], "density": 900.0,
                                     "restitution": 0.2}}},
        "bed": {"width": [1.2, 1.2], "grain_count": 500}}),
    "hull": ("one_ground", {"lander": {"shape": "hull", "file": "lander.stl", "unit": "m", "edges": None}}),
    "sky": ("one_ground", {"sky": {"sun_latitude_deg": {"distribution": "uniform", "lower": -20.0, "upper": 20.0},
                              "earth_latitude_deg": 5.0, "mask_deg": 10.0, "beam_deg": 60.0,
                              "orbiter": {"altitude": 2000.0, "inclination_deg": 90.0}}}),
    "dated": ("one_ground", {"site": POLE, "sky": {"date": "2027-04-20T00:00:00", "until": "2027-06-20T00:00:00",
                                              "orbit": ORBIT, "orbiter": {"states": "orbiter.csv"}}}),
    "tumbling": ("one_ground", {"site": {"rotation": {"yaw_deg": 10.0, "pitch_deg": 1.0, "roll_deg": 1.0,
                                                 "spin": [0.0, 0.0, 1e-5], "days": 1.0}}}),
    "mesh": ("one_ground", {"site": {
        "body": "body.obj", "name": "Rock", "unit": "m", "gravity_facets": 100, "density": 2000.0,
        "spin_period": 40_000.0, "roughness_deg": 5.0,
        "partner_body": {"name": "Other", "mass": 1e11, "diameter": 300.0, "distance": 2000.0}}}),
    "kernels": ("one_ground", {"site": {"body": "didymos", "kernels": ["body.tpc"]}}),
    "states": ("release", {"delivery": {"release": None, "states": "states.csv", "spin_x": None},
                           "journey": {"count": 8}}),
    "message": ("release", {"delivery": {"release": None, "states": "states.oem"}, "journey": {"count": 8}}),
    "covariance": ("release", {"site": POLE, "delivery": {"frame": "icrf", "epoch": "2027-04-20T12:00:00", "release": {
        "time": 0.0, "position_std": None, "velocity_std": None,
        "covariance": [[(900.0 if row < 3 else 4e-5) * (row == column) for column in range(6)] for row in range(6)]}}}),
    "correlated": ("one_ground", {"delivery": {"correlations": [["north_error", "east_error", 0.5]],
                                          "orientation": [1.0, 0.0, 0.0, 0.0], "pointing_error_deg": 10.0}}),
    "sized": ("one_ground", {"bed": {
        "diameter": {"distribution": "power_law", "value": None, "cumulative_exponent": 2.6, "lower": 0.08,
                     "upper": 0.11},
        "boulders": {"diameter": {"distribution": "constant", "value": 0.2}, "coverage": 0.1, "cover": [-0.1, 0.0]},
        "width": [1.2, 1.2], "grain_count": 600}}),
    "grounds": ("one_ground", {
        "bed": {"grain_count": None, "width": None, "diameter": None},
        "soil": {"ponds": {"slope_deg": [0.0, 5.0], "ground": "rock"}},
        "ground": {"unknown": "patchy", "patch": 20.0, "finest": 0.08, "kind": {
            "gravel": {"weight": 0.75, "grain_size": {"distribution": "log_uniform", "lower": 0.05, "upper": 0.3},
                       "size_ratio": 1.5, "grain": {"friction": 0.5},
                       "boulders": {"diameter": {"distribution": "constant", "value": 0.5}, "coverage": 0.05}},
            "rock": {"weight": 0.25, "rock": True}}}}),
    "asked": ("first_bounce", {
        "limit_states": {"fast": "speed_out > 0.1 and not returns"},
        "design": {"half_width": 0.3, "half_width_of": "fast", "largest_run_count": 8, "side_runs": True,
                   "twin_shift": 1e-4},
        "impact": {"region": {"x": [-0.1, 0.1], "y": [-0.1, 0.1]}},
        "surface": {"slope_deg": 5.0, "slope_azimuth_deg": 10.0},
        "campaign": {"wall_limit": 20.0, "memory_limit": 4e9, "retry_count": 1, "failed_share": 0.1}}),
    "expanded": ("first_bounce", {
        "design": {"run_count": 0}, "journey": {"count": None}, "bed": {"bed_count": 2},
        "monte_carlo": {"sample_count": 200, "scatter": True},
        "expansion": {"points": "sobol_sequence", "screening_count": 40, "screening_degree": 1, "refined_count": 40,
                      "refined_degree": 1, "test_count": 4, "fit": "ols", "kept_share": 0.5,
                      "kept_outputs": ["speed_out"]}}),
    "programmed": ("first_bounce", {"solver": {"command": "python3 -S program.py", "answer": "outputs.json",
                                               "templates": ["program.py"], "inputs": {"plate_tilt": 1.0}}}),
    "options": ("aim", {"aim": {"grid": {"delivery.latitude_deg": None}, "sides": ["z"],
                                "within": ["distance_p95 < 100", "at_rest > 0.5"], "lander_count": 2},
                        "contact": {"steps_per_contact": 25.0, "resolved_speed": 0.3, "held_speed": 0.03},
                        "landing": {"time_limit": 600.0}}),
}  # fmt: skip
NAMES = (*SHIPPED, *ADDED)
# A plate as a program.
PROGRAM = """import json, math
given = json.load(open("inputs.json"))
inputs, seed = given["inputs"], given["seed"]
speed, incidence = inputs["impact.speed"], math.radians(inputs["impact.incidence_deg"])
up, along = speed * math.cos(incidence) * (0.1 + seed % 97 / 250), 0.5 * speed * math.sin(incidence)
rebound = {"velocity_out_x": along, "velocity_out_y": 0.0, "velocity_out_z": up, "spin_out": 0.01}
stays = {"outcome": "captured", "outputs": {"duration": 10.0, "contacts": 1.0}}
json.dump(stays if up < 0.004 else {"outcome": "clear", "outputs": rebound}, open("outputs.json", "w"))
"""


def base(name: str) -> Tables:
    """The tables of a study by name, with few landers."""
    shipped, added = ADDED.get(name, (name, {}))
    tables = tomllib.loads((ROOT / "scenarios" / f"{shipped}.toml").read_text(encoding="utf-8"))
    for part in ("expansion", "monte_carlo"):
        tables.pop(part, None)
    tables.get("design", {}).clear()
    tables = merged(merged(tables, SMALL | ({"aim": FEW} if "aim" in tables else {})), added)
    if tables["journey"].get("touchdowns") == 1:
        tables.setdefault("monte_carlo", {}).setdefault("sample_count", 200)
    return tables


def merged(tables: Tables, added: Tables) -> Tables:
    """Nested tables with the keys of others; a key that is None there is left out."""
    made = dict(deepcopy(tables))
    for key, value in added.items():
        both = isinstance(value, dict) and isinstance(made.get(key), dict)
        made[key] = merged(made[key], value) if both else deepcopy(value)
    return {key: value for key, value in made.items() if value is not None}


def keys_of(model: Any = Study, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], FieldInfo]]:
    """Every key that the study models know, by its path, with its field; of tables with names of a user's own NAME."""
    for name, field in model.model_fields.items():
        inner, here = table(field), (*path, name)
        if inner is None:
            yield here, field
        else:
            yield from keys_of(inner, (*here, "NAME") if is_named(field) else here)


def fresh_value(field: FieldInfo) -> Any:
    """A usual value of a key that a study does not have."""
    if field.examples:
        return tomllib.loads(f"x = {field.examples[0]}")["x"]
    if isinstance(field.default, bool | int | float | str | list | tuple) and field.default is not None:
        return list(field.default) if isinstance(field.default, tuple) else field.default
    return 1.0 if limits(field) is not None else "x"


def write_files(folder: Path) -> None:
    """The files that these studies name: states, meshes, facets, a kernel and a program."""
    vertices, faces = _octahedron(8)
    body = vertices * [90.0, 85.0, 60.0]
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in body] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    (folder / "body.obj").write_text("\n".join(lines) + "\n")
    (folder / "lander.stl").write_text(_stl(*_octahedron(2)))
    (folder / "facets.txt").write_text("\n".join(map(str, range(40))) + "\n")
    rows = [(0.0, -150.0 - 5 * row, 3.0 * row, 2.0 * row, 0.0, 0.05 + 0.001 * row, 0.0) for row in range(8)]
    titles = "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s"
    (folder / "states.csv").write_text("\n".join([titles, *(",".join(map(str, _moved(row))) for row in rows)]) + "\n")
    meta = "META_START\nOBJECT_NAME = L\nOBJECT_ID = L\nCENTER_NAME = DIMORPHOS\nREF_FRAME = DIMORPHOS_FIXED\n"
    meta += "TIME_SYSTEM = UTC\nMETA_STOP\n"
    states = [f"2027-04-20T12:00:00 {' '.join(f'{1e-3 * one:.9f}' for one in _moved(row)[1:])}\n" for row in rows]
    (folder / "states.oem").write_text(f"CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2027-01-01T00:00:00\n{meta}"
                                       + "".join(states))  # fmt: skip
    turn = np.linspace(0.0, 2.0 * np.pi, 12)
    orbiter = [
        f"{1000.0 * row},{2000 * np.cos(angle)},{2000 * np.sin(angle)},0,0,0,0" for row, angle in enumerate(turn)
    ]
    (folder / "orbiter.csv").write_text("\n".join([titles, *orbiter]) + "\n")
    (folder / "body.tpc").write_text(
        "KPL/PCK\n\\begindata\nBODY920065803_POLE_RA = ( 69.327 0. 0. )\nBODY920065803_POLE_DEC = ( -72.725 0. 0. )\n"
        "BODY920065803_PM = ( 120.0 3823.0 0. )\n\\begintext\n"
    )
    (folder / "program.py").write_text(PROGRAM)


def _moved(row: tuple[float, ...]) -> list[float]:
    return [float(f"{one:.6g}") for one in row]


def _octahedron(cuts: int) -> tuple[np.ndarray, np.ndarray]:
    """Unit vertices and outward facets of an octahedron whose faces are cut into cuts**2 triangles."""
    places: dict[tuple[int, ...], int] = {}
    faces = []
    for signs in np.ndindex(2, 2, 2):
        side = 1 - 2 * np.array(signs)
        at = {
            (i, j): places.setdefault(tuple(side * [cuts - i - j, i, j]), len(places))
            for i in range(cuts + 1)
            for j in range(cuts + 1 - i)
        }
        found = [[at[i, j], at[i + 1, j], at[i, j + 1]] for i, j in at if i + j < cuts]
        found += [[at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]] for i, j in at if i + j < cuts - 1]
        faces += [face if side.prod() > 0 else face[::-1] for face in found]
    points = np.array(list(places), dtype=float)
    return points / np.linalg.norm(points, axis=1)[:, None], np.array(faces)


def _stl(vertices: np.ndarray, faces: np.ndarray) -> str:
    lines = ["solid lander"]
    for face in faces:
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += [f"  vertex {x:.6g} {y:.6g} {z:.6g}" for x, y, z in 0.1 * vertices[face]]
        lines += [" endloop", "endfacet"]
    return "\n".join([*lines, "endsolid lander", ""])
