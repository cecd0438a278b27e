"""Where landers rest: the smallest regions that hold shares of them, and how much ground these cover.

A region is one of directions from the centre (lithobrake.analysis.regions), with an area on a ball. On an
ellipsoid the same directions cover more ground at the ends of the long axis and less at the poles.
"""

from typing import Any

import numpy as np
from branches import LANDERS, branches
from samples import Sample
from scipy.spatial import KDTree

from lithobrake.analysis.regions import DensityRegion, highest_density

DIRECTIONS = 5000  # over which the ground is averaged: a region of a tenth of it has 500 of them
HALVES = 30  # of the beds, for the interval of an area
NORMAL_90 = 1.645  # half width of an interval of 90 % in standard errors
SEED = 1


def semi_axes() -> np.ndarray:
    """Those of Dimorphos in the studies [m], [3]."""
    extents = [branches(lander)[0].tables(1)["site"]["extents"] for lander in LANDERS]
    assert all(one == extents[0] for one in extents)
    return 0.5 * np.array(extents[0])


def even_directions(count: int) -> np.ndarray:
    """Directions spread evenly: a spiral whose turns are golden sections, [count, 3]."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    across = np.sqrt(1.0 - z**2)
    return np.column_stack([across * np.cos(turn), across * np.sin(turn), z])


def ground_area(directions: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Area of an ellipsoid for each unit of solid angle [m2/sr], [count], in directions from its centre.

    r^2 over the cosine between direction and normal; the normal is along direction / axes^2.
    """
    scaled = directions / axes**2
    radius = 1.0 / np.sqrt(np.sum(directions * scaled, axis=1))
    return radius**4 * np.linalg.norm(scaled, axis=1)


def inside(directions: np.ndarray, region: DensityRegion, points: np.ndarray) -> np.ndarray:
    """Which directions [count, 3] lie in a region of places [point_count, 3].

    All outlines have the region on one side, so that of the nearest piece tells; it is the side with more than its
    part of the places.
    """
    lines = [direction(*np.radians(line).T) for line in region.outlines]
    start, end = (np.concatenate([line[part] for line in lines]) for part in (slice(-1), slice(1, None)))
    tree, left = KDTree(0.5 * (start + end)), np.cross(start, end)

    def on_the_left(places: np.ndarray) -> np.ndarray:
        return np.sum(left[tree.query(places)[1]] * places, axis=1) > 0.0

    units = points / np.linalg.norm(points, axis=1)[:, None]
    found = on_the_left(directions)
    return found if on_the_left(units).mean() > found.mean() else ~found


def direction(latitude: np.ndarray, longitude: np.ndarray) -> np.ndarray:
    """Directions [count, 3] of latitudes and longitudes [rad]."""
    level = np.cos(latitude)
    return np.column_stack([level * np.cos(longitude), level * np.sin(longitude), np.sin(latitude)])


def areas(points: np.ndarray, axes: np.ndarray) -> tuple[tuple[DensityRegion, ...], np.ndarray]:
    """Regions of places [count, 3] on an ellipsoid of these semi-axes [m], and the ground that each covers [m2].

    That is its area on the ball of the places' root mean square radius, times the mean ground for a unit of solid angle
    in the region.
    """
    directions, square = even_directions(DIRECTIONS), np.mean(np.sum(points**2, axis=1))
    ground, found = ground_area(directions, axes), highest_density(points, tolerance=0.0).regions
    return found, np.array([one.area_m2 / square * ground[inside(directions, one, points)].mean() for one in found])


def regions(of: Sample, axes: np.ndarray) -> list[dict[str, Any]]:
    """Smallest regions of half and of 95 % of the landers, of as many of each branch as it weighs.

    Their areas have intervals of 90 %: the area scatters over random halves of the beds as it would over other beds, as
    many as these, and does so where it is no smooth function of the places. Source: [Shao-1989].
    """
    random = np.random.default_rng(SEED)
    # As many of each branch as it weighs, and no lander twice.
    size = round(of.weight.sum() / of.weight.max())
    rows = np.sort(random.choice(len(of.rows), size, replace=False, p=of.weight / of.weight.sum()))
    points = np.column_stack([of.column(f"position_{axis}")[rows] for axis in "xyz"])
    beds, bed = np.unique(of.beds[rows], return_inverse=True)
    found, area = areas(points, axes)
    halves = [np.isin(bed, random.choice(len(beds), len(beds) // 2, replace=False)) for _ in range(HALVES)]
    half_width = NORMAL_90 * np.std([areas(points[half], axes)[1] for half in halves], axis=0, ddof=1)
    total = float(np.mean(ground_area(even_directions(DIRECTIONS), axes)) * 4.0 * np.pi)
    return [
        {
            "share": one.share, "area_m2": float(area[k]), "lower": float(max(area[k] - half_width[k], 0.0)),
            "upper": float(min(area[k] + half_width[k], total)), "of_ground": float(area[k] / total),
            "outlines": [np.round(line, 2).tolist() for line in one.outlines],
        }
        for k, one in enumerate(found)
    ]  # fmt: skip
