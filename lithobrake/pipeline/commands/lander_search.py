"""Where to look for the lander of a study: image windows of an orbiter by the chance that they show it."""

import math
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lithobrake.analysis.share_estimate import plain_interval
from lithobrake.files.atomic import atomic_path, write_rows
from lithobrake.files.reading import read_table
from lithobrake.study import read_study
from lithobrake.study.lander_section import LanderSection
from lithobrake.study.quantity import Uncertain
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import STUDY_FILE
from lithobrake.vocabulary.given_numbers import whole_number
from lithobrake.vocabulary.number_words import percent, with_interval
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.plain_text import show

if TYPE_CHECKING:
    from lithobrake.results.study_results import StudyResults
    from lithobrake.smallbody.image_windows import Imager, ImageWindow

TABLE, FIGURE = "search.csv", "search.png"
COLUMNS = (
    "rank", "image", "time", "boresight_x", "boresight_y", "boresight_z", "latitude_deg [deg]", "longitude_deg [deg]",
    "distance [m]", "pixel [m]", "found", "found_lower", "found_upper",
)  # fmt: skip
# Windows are scored by landers on beds that had no part in their choice: a sixth at a time.
FOLDS = 6
REMEDY = "give a table (CSV) with the columns time, x_m, y_m, z_m, sun_x, sun_y, sun_z: body-fixed, a row an image"


class Images(NamedTuple):
    """Images that could be taken: time in words, place of the orbiter [m] and direction of the Sun, [count, 3]."""

    time: list[str]
    orbiter: Floats
    sun: Floats


@dataclass(frozen=True, eq=False)
class LanderSearch:
    """Images of a search in their order, with the cumulative probability of detection.

    latitude, longitude: places of rest [deg], [count]; first: number of the window that shows each place first, -1 for
    none, [count]; found: chance that the windows up to each show the lander, of landers at rest, by landers on beds
    that had no part in their choice; centre: latitude and longitude [deg] of the mean of the places that each window
    shows, [window_count, 2]; distance of the orbiter from it [m]; ever: part of the places that any image could show.
    """

    windows: "list[ImageWindow]"
    images: Images
    latitude: Floats
    longitude: Floats
    first: np.ndarray
    found: list[Estimate]
    centre: Floats
    distance: Floats
    ever: float


def search_lander(
    results: "StudyResults", images: Path, imager: "Imager", *, count: int = 20, size: float | None = None
) -> LanderSearch:
    """Order the images of a table by the chance that they show the lander of a study, at rest on its body.

    count: most windows; size [m]: longest extent of the lander, None: by the study file. Raises ValueError for a table
    that is none, a lander without a size, a study without landers at rest, and where no image shows any place.
    """
    from lithobrake.smallbody import Shape, image_windows, recognised

    given = read_images(images)
    shape = Shape(*results.body_shape)
    table = results.journeys
    rest = table["end"] == JourneyEnd.AT_REST
    if not rest.any():
        raise ValueError(f"{results.folder} has no lander at rest; there is nothing to look for")
    places = np.column_stack([table[f"position_{axis}"][rest] for axis in "xyz"]).astype(np.float64)
    _refuse_inside(shape, given, images)
    up = shape.normals[shape.nearest(places)[1]]
    extent = size or lander_size(read_study(results.folder / STUDY_FILE).lander)
    shown, toward = recognised(shape, places, up, given.orbiter, given.sun, extent, imager)
    everywhere = np.ones(len(places))
    windows = image_windows(shown, toward, everywhere, imager.field, count)
    if not windows:
        raise ValueError(
            f"none of the {len(given.time)} images of {images} shows a place of rest: too dark, hidden, or too far for "
            f"{imager.pixels:g} pixels on {extent:g} m; give other images, or fewer --lander-pixels"
        )
    bed = np.unique(table["bed"][rest], return_inverse=True)[1]
    first = _held_out_windows(bed, shown, toward, imager.field, len(windows))
    found = [_found(first, number, bed) for number in range(len(windows))]
    middle = np.array([places[window.shown].mean(axis=0) for window in windows])
    centre = np.column_stack(shape.latitude_longitude(middle))
    distance = np.linalg.norm(given.orbiter[[window.image for window in windows]] - middle, axis=1)
    latitude, longitude = table["latitude_deg"][rest], table["longitude_deg"][rest]
    shows = _first_window(windows, len(places))
    ever = float(shown.any(axis=1).mean())
    return LanderSearch(windows, given, latitude, longitude, shows, found, centre, distance, ever)


def _held_out_windows(bed: np.ndarray, shown: np.ndarray, toward: Floats, field: float, count: int) -> np.ndarray:
    """The first window that shows each place, of those chosen without the places of its part of the beds; -1 for none.

    On one bed the parts are of landers.
    """
    from lithobrake.smallbody import image_windows

    unit = bed if bed.max() > 0 else np.arange(len(bed))
    first = np.full(len(bed), -1)
    for fold in range(min(FOLDS, int(unit.max()) + 1)):
        held_out = unit % FOLDS == fold
        chosen = image_windows(shown, toward, (~held_out).astype(np.float64), field, count)
        first[held_out] = _first_window(chosen, len(bed))[held_out]
    return first


def _first_window(windows: "list[ImageWindow]", count: int) -> np.ndarray:
    """The first of the windows that shows each place, -1 for none, [count]; those without weight count, too."""
    first = np.full(count, -1)
    for number, window in enumerate(windows):
        first[(first < 0) & window.shown] = number
    return first


def _found(first: np.ndarray, number: int, bed: np.ndarray) -> Estimate:
    """Chance that the windows up to a number show the lander, by places that had no part in their choice."""
    hits = ((first >= 0) & (first <= number)).astype(np.float64)
    lower, upper = plain_interval(hits, bed) or (None, None)
    return Estimate(float(hits.mean()), lower, upper)


def imager_of(
    field_deg: float, image_pixels: int, lander_pixels: float, emission_deg: float, sun_deg: float
) -> "Imager":
    """A camera by the angles [deg] of the command line and the pixels across its field. Raises ValueError as Imager."""
    from lithobrake.smallbody import Imager

    whole_number("image_pixels", image_pixels, 1)
    field = math.radians(field_deg)
    return Imager(field, field / image_pixels, lander_pixels, math.radians(emission_deg), math.radians(sun_deg))


def search_files(folder: Path) -> tuple[Path, Path]:
    """The files of a search in a folder: table and map."""
    return folder / TABLE, folder / FIGURE


def read_images(path: Path) -> Images:
    """Read a table of images. Raises ValueError with the row of what is wrong."""
    names = ("time", *(f"{axis}_m" for axis in "xyz"), *(f"sun_{axis}" for axis in "xyz"))
    rows = read_table(path, names, REMEDY).rows
    if not rows:
        raise ValueError(f"{path} has no images; {REMEDY}")
    values = np.full((len(rows), 6), np.nan)
    for number, row in enumerate(rows):
        for column, name in enumerate(names[1:]):
            with suppress(ValueError):
                values[number, column] = float(row[name])
            if not np.isfinite(values[number, column]):
                raise ValueError(
                    f"{path}, row {number + 1}: {name} is {show(row[name])}; allowed: a finite number; correct it"
                )
        if not values[number, 3:].any():
            raise ValueError(f"{path}, row {number + 1}: sun_x to sun_z are 0; allowed: a direction; correct them")
    return Images([row["time"] for row in rows], values[:, :3], values[:, 3:])


def _refuse_inside(shape: "object", images: Images, path: Path) -> None:
    """Raise ValueError for an orbiter that is below the ground."""
    height = shape.height(images.orbiter)  # type: ignore[attr-defined]
    if (height <= 0.0).any():
        row = int(np.argmin(height))
        raise ValueError(
            f"{path}, row {row + 1}: the orbiter is {-height[row]:.3g} m below the ground; allowed: above it, in "
            "metres from the centre of the body, in its own axes; correct it"
        )


def lander_size(lander: LanderSection) -> float:
    """The longest extent of a lander's main shape [m]. Raises ValueError for a mesh and an uncertain diameter."""
    if lander.edges is not None:
        return max(lander.edges)
    if lander.diameter is None:
        raise ValueError("the lander is a mesh, whose extent is unknown here; allowed: --size; give its longest extent")
    if isinstance(lander.diameter, Uncertain):
        raise ValueError("the diameter of the lander is uncertain; allowed: --size; give the size to look for")
    return lander.diameter


def write_search(search: LanderSearch, imager: "Imager", folder: Path) -> tuple[Path, Path]:
    """Write the windows as a table and as a map into a folder; returns both files."""
    from lithobrake.report.figures.search_figure import search_figure
    from lithobrake.report.figures.style import figure_style

    rows = []
    for rank, window in enumerate(search.windows):
        found, far = search.found[rank], search.distance[rank]
        bounds = ["" if one is None else one for one in (found.lower, found.upper)]
        rows.append([
            rank + 1, window.image + 1, search.images.time[window.image], *window.boresight.tolist(),
            *search.centre[rank].tolist(), far, far * imager.pixel, found.value,
            *bounds,
        ])  # fmt: skip
    table, picture = search_files(folder)
    write_rows(table, list(COLUMNS), iter(rows))
    with figure_style(), atomic_path(picture) as draft:
        search_figure(search.latitude, search.longitude, search.first, search.centre).savefig(
            draft, format="png", metadata={"Software": None}
        )
    return table, picture


def search_lines(search: LanderSearch) -> list[str]:
    """The search in sentences and a line for each of the first windows."""
    count = len(search.windows)
    lines = [
        f"{count} of {len(search.images.time)} images show the lander with a probability of "
        f"{with_interval(search.found[-1])}, given that it is at rest on the body; all of them together could show "
        f"{percent(search.ever)}."
    ]
    lines += [
        f"  {rank + 1}. {search.images.time[window.image]}: toward {search.centre[rank][0]:.1f} deg, "
        f"{search.centre[rank][1]:.1f} deg; found by then {with_interval(search.found[rank])}"
        for rank, window in enumerate(search.windows[:10])
    ]
    return lines
