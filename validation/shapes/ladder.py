"""How fine must a shape be: height, slope, gravity and where landers end, on coarse meshes of a body and on its finest.

    python validation/shapes/ladder.py --meshes FOLDER

FOLDER has the meshes that meshes.py names. Writes ladder.csv beside this script, one line a mesh. All
meshes of a body have the mass of the finest one. Every comparison is with that one, over SITES places that are evenly
spread in direction:
  height     rms distance of the places on the finest mesh from the coarse one, over the radius of equal volume
  slope      mean over the surface, and rms difference at the places [deg]
  gravity    median and largest relative difference ABOVE radii over the places
  landers    released at rest ABOVE radii over the places, on hard ground (RESTITUTION along and across the normal,
             FRICTION where they slide) for a day: median distance between where the same lander ends on the two
             meshes, median distance from release to end, and share at rest
The line "shifted" has the finest mesh again, with landers released SHIFT radii to the side: by so much do ends of the
same lander differ without any change of the mesh. Gravity of the landers is that of at most GRAVITY_FACETS facets.
"""

import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
from meshes import BODIES, HERE, body_of, facets_of, read_shape, slopes_deg

from lithobrake.smallbody import Body, HardSurface, Landers, Launch, Shape, hop
from lithobrake.vocabulary.constants import DAY

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, command_line, timed, write_made, write_rows

SITES, SLOPES_OF = 200, 2000
ABOVE, SHIFT, REST_HEIGHT = 0.1, 1e-4, 1e-4  # in radii
RESTITUTION, FRICTION = (0.6, 0.8), 0.6
GRAVITY_FACETS = 600


def directions(count: int) -> np.ndarray:
    """Unit vectors on a spiral of equal areas, [count, 3]."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    angle = np.pi * (1.0 + 5.0**0.5) * np.arange(count)
    across = np.sqrt(1.0 - z**2)
    return np.stack([across * np.cos(angle), across * np.sin(angle), z], axis=1)


def radius_of(shape: Shape) -> float:
    """That of the sphere of equal volume [m]."""
    return float((0.75 * shape.volume / np.pi) ** (1.0 / 3.0))


def places_of(shape: Shape) -> np.ndarray:
    """Outermost places of the ground in the directions [m], [SITES, 3]."""
    way = directions(SITES)
    latitude = np.degrees(np.arcsin(way[:, 2]))
    return shape.surface_point(latitude, np.degrees(np.arctan2(way[:, 1], way[:, 0])))


def site_slopes_deg(body: Body, places: np.ndarray) -> np.ndarray:
    """Slope of the facet next to each place [deg], under the acceleration at the place on it."""
    height, facet = body.shape.nearest(places)
    normal = body.shape.normals[facet]
    felt = body.effective_acceleration(places - height[:, None] * normal)
    along = -(felt * normal).sum(axis=1) / np.linalg.norm(felt, axis=1)
    found: np.ndarray = np.degrees(np.arccos(np.clip(along, -1.0, 1.0)))
    return found


def followed(body: Body, places: np.ndarray, shift: float = 0.0) -> Landers:
    """Landers released over the places, all followed to their ends; shift: along the ground, in radii."""
    radius = radius_of(body.shape)
    up = places / np.linalg.norm(places, axis=1, keepdims=True)
    aside = np.cross(up, [0.0, 0.6, 0.8])
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    start = places + radius * (ABOVE * up + shift * aside)
    ground = HardSurface(*RESTITUTION, rest_height=REST_HEIGHT * radius)
    return hop(body, Launch(start, np.zeros(3)), ground, DAY, friction=FRICTION, gravity="exact", threads=1)


def thin_body(path: Path, finest: Body) -> Body:
    """The body with this mesh as its ground, and the gravity of few facets."""
    count = len(read_shape(path).faces)
    return replace(finest, shape=read_shape(path, GRAVITY_FACETS if count > GRAVITY_FACETS else None))


def row_of(path: Path, key: str, finest: Body, places: np.ndarray, ends: Landers, shift: float = 0.0) -> Row:
    """Compare one mesh with the finest of its body."""
    body = replace(body_of(key, read_shape(path)), mass=finest.mass)
    radius, facets = radius_of(finest.shape), facets_of(body, SLOPES_OF)
    height = body.shape.nearest(places)[0]
    slope = slopes_deg(facets, facets.acceleration, body.spin_rate)
    away = site_slopes_deg(body, places) - site_slopes_deg(finest, places)
    over = places * (1.0 + ABOVE * radius / np.linalg.norm(places, axis=1, keepdims=True))
    pull, theirs = body.acceleration(over), finest.acceleration(over)
    off = np.linalg.norm(pull - theirs, axis=1) / np.linalg.norm(theirs, axis=1)
    found = followed(thin_body(path, finest), places, shift)
    rests = (found.end == "at_rest") & (ends.end == "at_rest")
    apart = np.linalg.norm(found.position - ends.position, axis=1)[rests]
    travelled = np.linalg.norm(found.position - places, axis=1)[found.end == "at_rest"]
    return {
        "body": key, "mesh": path.name, "case": "shifted" if shift else "mesh", "facets": len(body.shape.faces),
        "radius_m": radius, "edge_m": float(np.sqrt(4.0 / np.sqrt(3.0) * facets.area.mean())),
        "height_rms": float(np.sqrt((height**2).mean()) / radius),
        "slope_deg": float(facets.area @ slope / facets.area.sum()),
        "slope_rms_deg": float(np.sqrt((away**2).mean())), "gravity_median": float(np.median(off)),
        "gravity_largest": float(off.max()), "both_at_rest": int(rests.sum()),
        "at_rest": float((found.end == "at_rest").mean()),
        "apart": float(np.median(apart) / radius), "travelled": float(np.median(travelled) / radius),
        "touchdowns": float(found.touchdowns.mean()),
    }  # fmt: skip


def ladder(folder: Path, key: str) -> list[Row]:
    """All meshes of a body, and the finest with shifted landers."""
    paths = [folder / one for one in BODIES[key].meshes]
    finest = body_of(key, read_shape(paths[-1]))
    places = places_of(finest.shape)
    ends = followed(thin_body(paths[-1], finest), places)
    rows = []
    for path, shift in [*((one, 0.0) for one in paths), (paths[-1], SHIFT)]:
        row, cost = timed(lambda path=path, shift=shift: row_of(path, key, finest, places, ends, shift))
        rows.append({name: float(f"{v:.5g}") if isinstance(v, float) else v for name, v in row.items()})
        rows[-1]["cpu_s"] = round(cost, 1)
        print(rows[-1], flush=True)
    return rows


def main() -> None:
    folder = command_line(__doc__, meshes=Path).parse_args().meshes
    # Comets and asteroids turn about their centres of mass, these meshes about their origins; nothing is moved.
    warnings.filterwarnings("ignore", message=".*the centre of mass lies at")
    rows = [row for key, known in BODIES.items() if len(known.meshes) > 1 for row in ladder(folder, key)]
    write_rows(HERE / "ladder.csv", rows[0], rows)
    write_made(HERE / "ladder.csv", "validation/shapes/ladder.py --meshes FOLDER", rows=len(rows))


if __name__ == "__main__":
    main()
