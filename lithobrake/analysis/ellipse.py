"""Ellipses that hold a share of the places where landers came down."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.vocabulary.given_numbers import numbers

# Places whose directions cancel more than this have no middle that means anything.
SMALLEST_RESULTANT = 0.7
SMALLEST_COUNT = 10
# Places closer together than this [rad] differ by rounding only.
SMALLEST_SIZE = 1e-12


@dataclass(frozen=True)
class Ellipses:
    """Ellipses about the mean direction of places on a sphere, similar to each other, one for each share.

    latitude_deg, longitude_deg   of the middle
    heading_deg                   of the longer axis there, from north toward east, in [0, 180)
    semi_axes_deg                 of each share, longer and shorter, as angles at the sphere's centre; a share whose
                                  ellipse would reach round more than half of the sphere is left out
    """

    latitude_deg: float
    longitude_deg: float
    heading_deg: float
    semi_axes_deg: dict[float, tuple[float, float]]


def dispersion_ellipses(
    latitude_deg: ArrayLike, longitude_deg: ArrayLike, shares: tuple[float, ...] = (0.5, 0.95)
) -> Ellipses | None:
    """Ellipses that hold shares of places, both of shape [count]; None if these are few, all around, or one place.

    The places are laid flat about their mean direction, keeping distance and direction from it (azimuthal equidistant);
    the axes are those of their second moments, and each ellipse is as large as it takes to hold its share of them: no
    law is assumed. Raises ValueError for shares outside 0 to 1, for places that are not finite or of other latitudes.
    Source: [Mardia-2000], section 9.2 (mean direction, resultant length).
    """
    if not all(0.0 < share < 1.0 for share in shares):
        raise ValueError(f"shares are {shares}; each must lie between 0 and 1")
    latitude, longitude = _angles(latitude_deg, longitude_deg)
    if latitude.size < SMALLEST_COUNT:
        return None
    across = np.cos(latitude)
    places = np.stack([across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1)
    mean = places.mean(axis=0)
    if np.linalg.norm(mean) < SMALLEST_RESULTANT:
        return None
    flat, middle = _laid_flat(places, mean / np.linalg.norm(mean))
    values, vectors = np.linalg.eigh(flat.T @ flat / len(flat))
    # Places on one line have no width; a billionth of the length keeps the division below.
    sizes = np.sqrt(np.maximum(values, 1e-18 * values[1]))
    if sizes[1] < SMALLEST_SIZE:
        return None
    distance = np.linalg.norm(flat @ vectors / sizes, axis=1)
    scales = {share: float(np.quantile(distance, share)) for share in shares}
    north, east = vectors[:, 1]
    return Ellipses(
        *middle,
        math.degrees(math.atan2(east, north)) % 180.0,
        {
            share: (math.degrees(k * sizes[1]), math.degrees(k * sizes[0]))
            for share, k in scales.items()
            if k * sizes[1] <= 0.5 * math.pi
        },
    )


def _angles(latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Latitudes and longitudes [rad], both [count]; raises ValueError for what is no place on a sphere."""
    latitude, longitude = numbers("latitude_deg", latitude_deg), numbers("longitude_deg", longitude_deg)
    if latitude.ndim != 1 or latitude.shape != longitude.shape:
        raise ValueError(
            f"latitude_deg has shape {latitude.shape} and longitude_deg {longitude.shape}, but both must be [count]"
        )
    wrong = ~((np.abs(latitude) <= 90.0) & (np.abs(longitude) <= 360.0))
    if wrong.any():
        place = int(np.flatnonzero(wrong)[0])
        raise ValueError(
            f"place {place} has latitude_deg {latitude[place]:g} and longitude_deg {longitude[place]:g}, but they must "
            "lie in -90 to 90 and -360 to 360: leave out places that are not known"
        )
    return np.radians(latitude), np.radians(longitude)


def _laid_flat(
    places: NDArray[np.float64], middle: NDArray[np.float64]
) -> tuple[NDArray[np.float64], tuple[float, float]]:
    """Distances north and east [rad] of unit vectors [count, 3] from a middle, [count, 2], and its place [deg]."""
    latitude, longitude = math.asin(min(max(middle[2], -1.0), 1.0)), math.atan2(middle[1], middle[0])
    c, s = math.cos(longitude), math.sin(longitude)
    north = np.array([-math.sin(latitude) * c, -math.sin(latitude) * s, math.cos(latitude)])
    level = np.stack([places @ north, places @ np.array([-s, c, 0.0])], axis=1)
    length = np.linalg.norm(level, axis=1)
    angle = np.arctan2(length, places @ middle)
    flat = level * np.divide(angle, length, out=np.ones_like(angle), where=length > 0.0)[:, None]
    return flat, (math.degrees(latitude), math.degrees(longitude))
