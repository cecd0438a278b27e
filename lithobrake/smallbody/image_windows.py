"""Where to look for a lost lander: images of an orbiter in the order in which they are most likely to show it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.smallbody.shape import Shape
from lithobrake.smallbody.sky import seen_from
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.given_numbers import finite_number, numbers, whole_number

# Of a window that adds less than this part of the probability there is no gain but rounding.
LEAST_GAIN = 1e-12


@dataclass(frozen=True)
class Imager:
    """Field of view and detection limits of a camera.

    field [rad]: full angle of the cone within the image; pixel [rad]: angle of a pixel; pixels: along the lander's
    size, so many are needed to recognise it; emission, sun [rad]: largest angle between the ground's normal and the
    camera, and least elevation of the Sun above the ground, at which a lander is recognised.

    Raises ValueError for numbers out of range.
    """

    field: float
    pixel: float
    pixels: float = 3.0
    emission: float = np.radians(75.0)
    sun: float = np.radians(5.0)

    def __post_init__(self) -> None:
        finite_number("field", self.field, above=0.0, at_most=np.pi)
        finite_number("pixel", self.pixel, above=0.0, at_most=self.field)
        finite_number("pixels", self.pixels, above=0.0)
        finite_number("emission", self.emission, above=0.0, at_most=0.5 * np.pi)
        finite_number("sun", self.sun, at_least=0.0, below=0.5 * np.pi)


@dataclass(frozen=True, eq=False)
class ImageWindow:
    """A selected image, its boresight, and the places that it shows.

    image: number of the opportunity; boresight: unit vector, body-fixed, [3]; shown: places that it shows, [count];
    gain: weight of those that no earlier window shows.
    """

    image: int
    boresight: Floats
    shown: NDArray[np.bool_]
    gain: float


def recognised(
    shape: Shape, places: ArrayLike, up: ArrayLike, orbiter: ArrayLike, sun: ArrayLike, size: float, camera: Imager
) -> tuple[NDArray[np.bool_], Floats]:
    """Whether a lander at each place could be detected in an image, if the camera points at it.

    places [m] and outward normals up of the ground, [count, 3]; orbiter [m] and sun (any length), body-fixed, of each
    image, [image_count, 3]; size [m]: longest extent of the lander. It is recognised where the Sun lights its place,
    where neither ground nor angle hide it, and where it covers enough pixels. Shadows and views are those of the shape.
    Returns that, [count, image_count], and unit vectors from the orbiter to the places, [count, image_count, 3].
    """
    ground, toward_sun = numbers("places", places), numbers("sun", sun)
    way = numbers("orbiter", orbiter)[None] - ground[:, None]
    distance = np.linalg.norm(way, axis=-1)
    along = way / distance[..., None]
    shone = np.broadcast_to(toward_sun / np.linalg.norm(toward_sun, axis=1, keepdims=True), way.shape)
    lit = seen_from(shape, ground, up, shone, float(np.degrees(camera.sun)))
    mask = 90.0 - float(np.degrees(camera.emission))
    seen = seen_from(shape, ground, up, along, mask, distance=distance)
    return lit & seen & (distance * camera.pixel * camera.pixels <= size), -along


def image_windows(
    shown: NDArray[np.bool_], toward: Floats, weight: ArrayLike, field: float, count: int
) -> list[ImageWindow]:
    """Choose images and boresights one after another, each with the largest gain over those before it.

    shown, toward: as `recognised` gives them; weight: of each place, [count]; field [rad]: of the camera; count: most
    windows. Ends earlier where no image shows another place. Each image is taken once, in one direction; the directions
    to all places that it shows are tried. So chosen, the windows show at least half of what the best of all choices
    among these would. Raises ValueError for weights that are not at least 0. Source of that bound: [Fisher-1978].
    """
    whole_number("count", count, 1)
    free = np.ones(shown.shape[1])
    left, edge = numbers("weight", weight).copy(), np.cos(0.5 * field) - 1e-12
    if not (left >= 0.0).all():
        raise ValueError(f"weight has {left.min()!r}, but must be at least 0 everywhere")
    found: list[ImageWindow] = []
    least = LEAST_GAIN * left.sum()
    while len(found) < count:
        best: ImageWindow | None = None
        bound = (left @ shown) * free
        # An image gains at most all that it could show; those that cannot beat the best so far are passed over.
        for image in np.argsort(-bound, kind="stable"):
            if bound[image] <= (best.gain if best else least):
                break
            window = _best_boresight(int(image), shown[:, image], toward[:, image], left, edge)
            if best is None or window.gain > best.gain:
                best = window
        if best is None:
            break
        found.append(best)
        left[best.shown], free[best.image] = 0.0, 0.0
    return found


def _best_boresight(image: int, shown: NDArray[np.bool_], toward: Floats, left: Floats, edge: float) -> ImageWindow:
    """The boresight of an image that shows most: toward one of its places, then amid those that are left there."""
    rows = np.flatnonzero(shown)
    within = toward[rows] @ toward[rows].T >= edge
    best = int(np.argmax(within @ left[rows]))
    boresight = toward[rows[best]]
    amid = (left[rows] * within[best]) @ toward[rows]
    amid /= np.linalg.norm(amid)
    # Pointed amid them it may show more, and leaves them less near the edge.
    centred = toward[rows] @ amid >= edge
    if left[rows] @ centred >= left[rows] @ within[best]:
        boresight, members = amid, centred
    else:
        members = within[best]
    all_shown = np.zeros(len(shown), dtype=np.bool_)
    all_shown[rows[members]] = True
    return ImageWindow(image, boresight, all_shown, float(left @ all_shown))
