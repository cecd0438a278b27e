# %% [markdown]
# # Your own shape
#
# A body is a closed triangle mesh with a mass and a spin. This notebook makes one (a lumpy ellipsoid of 200 m),
# computes its gravity, and launches landers from its surface.

# %%
from pathlib import Path

import numpy as np

from lithobrake.smallbody import Body, Shape, fly

# %% [markdown]
# ## A mesh
#
# A file from an archive can be used in the same way. This mesh is made of rings of latitude, with outward normals.

# %%
rings, sectors = 8, 16
latitude = np.linspace(np.pi / 2, -np.pi / 2, rings + 1)[1:-1]
longitude = np.arange(sectors) * 2 * np.pi / sectors
grid = [
    (
        100 * np.cos(b) * np.cos(a) * (1 + 0.1 * np.cos(3 * a)),
        90 * np.cos(b) * np.sin(a) * (1 + 0.1 * np.cos(3 * a)),
        70 * np.sin(b),
    )
    for b in latitude
    for a in longitude
]
vertices = [(0.0, 0.0, 70.0), *grid, (0.0, 0.0, -70.0)]
north, south = 1, len(vertices)


def corner(ring: int, sector: int) -> int:
    """Number of a vertex, from 1."""
    return 2 + ring * sectors + sector % sectors


faces = []
for k in range(sectors):
    faces.append((north, corner(0, k), corner(0, k + 1)))
    for ring in range(rings - 2):
        a, b, c, d = corner(ring, k), corner(ring + 1, k), corner(ring + 1, k + 1), corner(ring, k + 1)
        faces += [(a, b, c), (a, c, d)]
    faces.append((south, corner(rings - 2, k + 1), corner(rings - 2, k)))
lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in faces]
Path("lumpy.obj").write_text("\n".join(lines) + "\n")

# %% [markdown]
# ## A body
#
# An open or folded mesh is refused, with a message.

# %%
shape = Shape.read("lumpy.obj", unit="m")
body = Body(shape, mass=5.0e9, spin_period=5 * 3600.0, name="lumpy")
site, axes = body.local_frame(20.0, 45.0, 0.0)  # latitude, longitude, heading [deg]
print(f"{len(shape.faces)} facets, {shape.volume:.4g} m3, {body.density:.0f} kg/m3")
pull = np.linalg.norm(body.effective_acceleration(site))
print(f"at the site a lander is held with {pull:.3g} m/s2, rotation included")

# %% [markdown]
# ## Landers that leave the surface
#
# Two hundred landers leave at up to 60 degrees from the vertical.

# %%
random = np.random.default_rng(2)
count = 200
turn, up = random.uniform(0.0, 2.0 * np.pi, count), random.uniform(0.5, 1.0, count)
across = np.sqrt(1.0 - up**2)
local = random.uniform(0.01, 0.12, count)[:, None] * np.column_stack([across * np.cos(turn), across * np.sin(turn), up])
flights = fly(body, np.tile(site, (count, 1)), local @ axes, 12 * 3600.0)
shares = {str(status): float((flights.status == status).mean()) for status in np.unique(flights.status)}
print(shares)

# %% [markdown]
# A result on the last line of a cell is displayed.

# %%
flights
