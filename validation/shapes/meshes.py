"""Public meshes that the comparisons of shapes read, and what they have of slope and potential.

Meshes lie below one folder, in which the two repositories have folders of their own:
  gama         https://github.com/jmpearl/GaMA (BSD-3): data/MeshFiles at 7d6348b
  gama_ladder  the same at f109c05: Meshes
  geodesynets  https://github.com/darioizzo/geodesyNets (GPL-3): 3dmeshes/bennu_raw.pk at 9d445ab, in km
None of them is part of this repository.
"""

import pickle
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from lithobrake.smallbody import Body, Shape

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row

HERE = Path(__file__).parent
HOUR = 3600.0
# Files whose lengths are in km, which none of them says; the others are in metres.
IN_KM = ("Bennu_2692.obj", "Phobos_50000.obj", "Itokawa_50000.obj")
LATEST, LADDER = Path("gama/data/MeshFiles"), Path("gama_ladder/Meshes")


class Known(NamedTuple):
    """A body: density [kg/m3] and period of its rotation [h] in all comparisons, and its meshes, coarse ones first."""

    density: float
    period_h: float
    meshes: tuple[Path, ...]


def _ladder(name: str, *counts: int, finest: str) -> tuple[Path, ...]:
    return (*(LADDER / name / f"{name}_{count}.obj" for count in counts), LATEST / name / finest)


# Densities and periods of Bennu, Eros and Itokawa as of [Kanjanatarayont-2026], of the others of the papers behind
# their shapes, rounded.
BODIES = {
    "bennu": Known(1194.0, 4.296061, (Path("geodesynets/bennu_raw.pk"),)),
    "bennu_radar": Known(1194.0, 4.296061, _ladder("Bennu", 108, 538, 1258, finest="Bennu_2692.obj")),
    "2008ev5": Known(1300.0, 3.725, _ladder("2008EV5", 294, 1324, finest="2008EV5_3892.obj")),
    "eros": Known(2670.0, 5.27, _ladder("Eros", 656, 1520, 3316, 7624, finest="Eros_46906.obj")),
    "67p": Known(533.0, 12.4, _ladder("67P", 788, 2888, 13846, finest="67P_51970.obj")),
    "phobos": Known(1860.0, 7.654, _ladder("Phobos", 236, 1226, 5488, finest="Phobos_50000.obj")),
    "itokawa": Known(1950.0, 12.132, (LATEST / "Itokawa" / "Itokawa_50000.obj",)),
}


class OnlyLists(pickle.Unpickler):
    """A reader of pickles that hold lists and numbers alone: it makes no object and calls nothing."""

    def find_class(self, module: str, name: str) -> Any:
        raise pickle.UnpicklingError(f"the file asks for {module}.{name}; allowed: lists of numbers")


def read_shape(path: Path, gravity_facets: int | None = None) -> Shape:
    """A mesh of the folder [m]; pickles hold vertices [km] and triangles. gravity_facets: as of Shape."""
    if path.suffix != ".pk":
        return Shape.read(path, "km" if path.name in IN_KM else "m", gravity_facets=gravity_facets)
    with path.open("rb") as file:
        vertices, faces = OnlyLists(file).load()
    return Shape(1e3 * np.array(vertices), np.array(faces, dtype=np.int64))


def smoothed(shape: Shape) -> Shape:
    """The shape with each vertex moved half the way to the mean of its neighbours."""
    ends = np.unique(np.sort(shape.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    total, count = np.zeros_like(shape.vertices), np.zeros(len(shape.vertices))
    for one, other in (ends.T, ends.T[::-1]):
        np.add.at(total, one, shape.vertices[other])
        np.add.at(count, one, 1.0)
    return Shape(0.5 * (shape.vertices + total / count[:, None]), shape.faces)


def body_of(key: str, shape: Shape, density: float | None = None, period_h: float | None = None) -> Body:
    """The body of a key with this shape; its mass follows from the density and the volume."""
    known = BODIES[key]
    mass = (known.density if density is None else density) * shape.volume
    return Body(shape, mass, (known.period_h if period_h is None else period_h) * HOUR, key)


class Facets(NamedTuple):
    """What the facets of a body have, one each: centre [m], outward normal, area [m2], field of its own gravity.

    acceleration [m/s2]; potential [m2/s2], positive.
    """

    centre: np.ndarray
    normal: np.ndarray
    area: np.ndarray
    acceleration: np.ndarray
    potential: np.ndarray


def facets_of(body: Body, most: int) -> Facets:
    """The facets of a body, at most so many: every so many of a finer mesh, in the order of its file."""
    count = len(body.shape.faces)
    which = np.unique(np.linspace(0, count - 1, min(most, count)).astype(int))
    corners = body.shape.corners[which]
    centre = corners.mean(axis=1)
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return Facets(centre, body.shape.normals[which], area, body.acceleration(centre), body.potential(centre))


def slopes_deg(facets: Facets, acceleration: np.ndarray, spin_rate: float, turned: bool = False) -> np.ndarray:
    """Angle of each facet's normal from the upward plumb line [deg]; turned: normals that face the centre are turned.

    acceleration: of gravity alone [m/s2], [count, 3]. The centre is the mean of the facets' centres.
    """
    felt = acceleration + spin_rate**2 * facets.centre * np.array([1.0, 1.0, 0.0])
    normal = facets.normal
    if turned:
        outward = (normal * (facets.centre - facets.centre.mean(axis=0))).sum(axis=1) >= 0.0
        normal = np.where(outward[:, None], normal, -normal)
    along = -(felt * normal).sum(axis=1) / np.linalg.norm(felt, axis=1)
    found: np.ndarray = np.degrees(np.arccos(np.clip(along, -1.0, 1.0)))
    return found


def measures(facets: Facets, spin_rate: float, of_density: float = 1.0) -> Row:
    """Slopes and spread of the potential of a body; of_density: times the density whose gravity the facets have."""
    gravity = of_density * facets.acceleration
    slope = slopes_deg(facets, gravity, spin_rate)
    turned = slopes_deg(facets, gravity, spin_rate, turned=True)
    latitude = np.degrees(np.arcsin(facets.centre[:, 2] / np.linalg.norm(facets.centre, axis=1)))
    share = facets.area / facets.area.sum()
    across = facets.centre[:, 0] ** 2 + facets.centre[:, 1] ** 2
    potential = -of_density * facets.potential - 0.5 * spin_rate**2 * across
    mean = float(share @ potential)
    low, high = np.abs(latitude) < 20.0, np.abs(latitude) >= 60.0
    return {
        "mean_deg": float(slope.mean()), "equator_deg": float(slope[low].mean()), "pole_deg": float(slope[high].mean()),
        "area_mean_deg": float(share @ slope), "area_equator_deg": float(np.average(slope[low], weights=share[low])),
        "area_pole_deg": float(np.average(slope[high], weights=share[high])),
        "area_mean_turned_deg": float(share @ turned), "mean_turned_deg": float(turned.mean()),
        "facing_centre": float((turned != slope).mean()), "steepest_deg": float(slope.max()),
        "potential_spread": float(np.sqrt(share @ (potential - mean) ** 2) / abs(mean)),
    }  # fmt: skip
