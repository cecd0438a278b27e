"""Slopes per facet of public meshes: their means beside published ones, and facet by facet beside another code.

    python validation/shapes/slopes.py --meshes FOLDER

FOLDER has the meshes that meshes.py names. Writes two tables beside this script, each with how it was
made: slopes.csv, what published.py compares, one line a body, mesh and density (smoothed: each vertex moved half the
way to the mean of its neighbours); and slopes_facets.csv, the other code, one line a mesh. Means are over at most 8000
facets, every so many of a finer mesh. The other code is polyhedral-gravity (pip install "polyhedral-gravity>=3.2"),
which the source of the published numbers used, at 1000 facets of a mesh. It is asked a little inside the mesh, as the
source did: by 1e-4 of the diagonal; lithobrake is asked on the facets, and at the same points.
"""

import sys
import time
from pathlib import Path

import numpy as np
from meshes import BODIES, HERE, body_of, facets_of, measures, read_shape, slopes_deg, smoothed
from published import CLOSE_DEG, PUBLISHED

from lithobrake.smallbody import Body

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, command_line, write_made, write_rows

MEAN_OF, ASKED = 8000, 1000  # facets of a mesh: those of a mean, and those at which the other code is asked
INSIDE = 1e-4
COMMAND = "validation/shapes/slopes.py --meshes FOLDER"


def published_rows(key: str, mesh: str, body: Body) -> list[Row]:
    """One line for each density and period at which the source has numbers of this body. mesh: its name."""
    facets, rows = facets_of(body, MEAN_OF), []
    for density, period_h in dict.fromkeys((one.density, one.period_h) for one in PUBLISHED if one.body == key):
        own = body_of(key, body.shape, density, period_h)
        found = measures(facets, own.spin_rate, density / body.density)
        count = {"facets": len(body.shape.faces), "averaged": len(facets.area)}
        rows.append({"body": key, "mesh": mesh, **count, "density": density, "period_h": period_h, **found})
    return rows


def other_code(body: Body, points: np.ndarray) -> np.ndarray:
    """Acceleration of gravity at points [m/s2] by polyhedral-gravity."""
    import polyhedral_gravity as library

    polyhedron = library.Polyhedron(
        polyhedral_source=(body.shape.vertices, body.shape.faces), density=body.density,
        normal_orientation=library.NormalOrientation.OUTWARDS, integrity_check=library.PolyhedronIntegrity.DISABLE,
    )  # fmt: skip
    return np.array([one[1] for one in library.evaluate(polyhedron, points, parallel=False)])


def facet_row(key: str, name: str, body: Body) -> Row:
    """Compare slopes facet by facet with the other code."""
    some = facets_of(body, ASKED)
    extent = np.linalg.norm(np.ptp(body.shape.vertices, axis=0))
    inside = some.centre - INSIDE * extent * some.normal
    start = time.process_time()
    theirs = slopes_deg(some, other_code(body, inside), body.spin_rate)
    cost = time.process_time() - start
    ours = slopes_deg(some, body.acceleration(inside), body.spin_rate)
    on_facets = slopes_deg(some, some.acceleration, body.spin_rate)
    away = on_facets - theirs
    return {
        "body": key, "mesh": name, "facets": len(body.shape.faces), "compared": len(some.area),
        "mean_deg": on_facets.mean(), "other_mean_deg": theirs.mean(),
        "correlation": np.corrcoef(on_facets, theirs)[0, 1],
        "rms_deg": np.sqrt((away**2).mean()), "close_share": (np.abs(away) <= CLOSE_DEG).mean(),
        "largest_deg": np.abs(away).max(), "largest_same_points_deg": np.abs(ours - theirs).max(), "other_cpu_s": cost,
    }  # fmt: skip


def main() -> None:
    folder = command_line(__doc__, meshes=Path).parse_args().meshes
    means: list[Row] = []
    by_facet: list[Row] = []
    for key, known in BODIES.items():
        finest = known.meshes[-1]
        body = body_of(key, read_shape(folder / finest))
        if any(one.body == key for one in PUBLISHED):
            means += published_rows(key, "public", body)
            means += published_rows(key, "smoothed", body_of(key, smoothed(body.shape)))
        by_facet.append(facet_row(key, finest.name, body))
        print(by_facet[-1], flush=True)
    for name, rows in (("slopes", means), ("slopes_facets", by_facet)):
        short = [{k: float(f"{v:.7g}") if isinstance(v, float) else v for k, v in row.items()} for row in rows]
        write_rows(HERE / f"{name}.csv", rows[0], short)
        write_made(HERE / f"{name}.csv", COMMAND, rows=len(rows))


if __name__ == "__main__":
    main()
