"""The smallest regions of the ground that hold shares of the landers, as results."""

from collections.abc import Sequence

import numpy as np

from lithobrake.analysis import highest_density
from lithobrake.analysis.highest_density import HighestDensity
from lithobrake.results.regions import RestRegion
from lithobrake.results.site_results import SiteResults

SHARES = (0.5, 0.95)
# Of more places than these, the first: they are samples, and the work grows with their square.
MOST_PLACES = 5000


def rest_regions(density: HighestDensity) -> tuple[RestRegion, ...]:
    """Regions of highest density as results."""
    return tuple(
        RestRegion(one.share, one.area_m2, one.largest_extent_m, tuple(map(_line, one.outlines)))
        for one in density.regions
    )


def place_regions(site: SiteResults, rows: Sequence[dict[str, str]], status: str) -> tuple[RestRegion, ...]:
    """Regions of the places of the rows with this status, on a sphere of the radius at the site."""
    down = [row for row in rows if row["status"] == status][:MOST_PLACES]
    if not down:
        return ()
    latitude, longitude = (
        np.radians([float(row[f"{name}_deg"]) for row in down]) for name in ("latitude", "longitude")
    )
    level = np.cos(latitude)
    directions = np.column_stack([level * np.cos(longitude), level * np.sin(longitude), np.sin(latitude)])
    return rest_regions(highest_density(float(np.linalg.norm(site.place_m)) * directions, SHARES))


def _line(outline: np.ndarray) -> tuple[tuple[float, float], ...]:
    return tuple((latitude, longitude) for latitude, longitude in outline.tolist())
