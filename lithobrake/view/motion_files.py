"""A motion or a whole journey as a film, a page, or another file of the kind that its name ends with."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.atomic import atomic_path, write_whole
from lithobrake.view.drawn_motion import DrawnMotion, write_vtkhdf
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.extra_library import extra_library

if TYPE_CHECKING:
    from lithobrake.results import JourneyMotion, JourneyTrack
    from lithobrake.results.motions import MovingBodies

SIZE = (960, 640)
KINDS = (".mp4", ".webp")
# Of each touchdown of a journey.
FILM_PICTURES = 120
# How long a map is seen before the touchdown that it leads to [s]; pixels per inch of what is said over it.
MAP_SECONDS, DPI = 2.0, 100.0
ALL_KINDS = (".vtkhdf", *KINDS, ".png")
# Of a contact sheet.
PICTURES = 12
JOURNEY_KINDS = (".html", *KINDS, ".png", ".vtkhdf")
# Of these kinds each touchdown has a file of its own.
FILE_EACH = (".vtkhdf", ".h5")


def film(bodies: "MovingBodies", path: Path, seconds: float = 8.0, progress: Progress = silent) -> None:
    """Write a film of all frames, evenly in simulated time, that lasts so many seconds; the path's end says which kind.

    Raises ValueError for another kind or duration, ImportError where PyVista, or imageio-ffmpeg for MP4, is absent.
    """
    _refuse(path, seconds)
    count = len(bodies.time)
    _write(path, _told(_pictures(bodies, count), count, progress), count / seconds)


def journey_film(motion: "JourneyMotion", path: Path, seconds: float = 8.0, progress: Progress = silent) -> None:
    """Write a film of a journey: before each touchdown the map with the way to it, and at the end the whole way.

    seconds: that each touchdown lasts. Raises as film does.
    """
    _refuse(path, seconds)
    rate, parts = FILM_PICTURES / seconds, len(motion.bodies)
    total = parts * FILM_PICTURES + (parts + 1) * round(MAP_SECONDS * rate)
    _write(path, _told(_journey_pictures(motion, round(MAP_SECONDS * rate)), total, progress), rate)


def _refuse(path: Path, seconds: float) -> None:
    if path.suffix not in KINDS:
        raise ValueError(f"the film is {path.name!r}; allowed: a name that ends in {' or '.join(KINDS)}")
    refuse_film(path, seconds)


def refuse_film(path: Path, seconds: float) -> None:
    """Raise ValueError for a film of no duration, ImportError where what draws or writes it is absent.

    Any other file is none, and is not refused.
    """
    if path.suffix not in KINDS:
        return
    if not 0.0 < seconds < np.inf:
        raise ValueError(f"the film lasts {seconds!r} s; allowed: a finite time above 0 s")
    extra_library("pyvista", "PyVista", "view")
    if path.suffix == ".mp4":
        _film_library()


def _told(pictures: Iterator[np.ndarray], count: int, progress: Progress) -> Iterator[np.ndarray]:
    """So many pictures, each told as a part of all."""
    for number, picture in enumerate(pictures, start=1):
        progress(number / count, "drawing")
        yield picture


def _pictures(bodies: "MovingBodies", count: int, words: str = "") -> Iterator[np.ndarray]:
    """So many pictures at even instants, one after the other."""
    drawn = DrawnMotion(bodies, size=SIZE, off_screen=True, words=words)
    for instant in np.linspace(bodies.time[0], bodies.time[-1], count):
        drawn.go_to(int(np.argmin(np.abs(bodies.time - instant))))
        yield drawn.picture()


def _journey_pictures(motion: "JourneyMotion", map_count: int) -> Iterator[np.ndarray]:
    """The pictures of a journey: maps, each so many times, and touchdowns."""
    track = motion.track
    for facts, bodies in zip(track.touchdowns, motion.bodies, strict=False):
        yield from [map_picture(track, facts.number)] * map_count
        yield from _pictures(bodies, FILM_PICTURES, f"journey {track.number}, {facts.words}")
    yield from [map_picture(track)] * map_count


def map_picture(track: "JourneyTrack", shown: int | None = None) -> np.ndarray:
    """The map up to a touchdown, or the whole of it, with what is said of it, as large as a picture of the film."""
    from PIL import Image

    from lithobrake.report.figures.landing_figure import caption, picture
    from lithobrake.report.figures.map_frames import track_map
    from lithobrake.report.figures.style import figure_style

    words = track.end_words if shown is None else track.touchdowns[shown].words
    with figure_style():
        drawn = picture(track_map(track, shown))
        height = round(drawn.shape[0] * SIZE[0] / drawn.shape[1])
        small = Image.fromarray(drawn).resize((SIZE[0], height), Image.Resampling.LANCZOS)
        strip = picture(caption(f"Journey {track.number}: {words}", (SIZE[0] / DPI, (SIZE[1] - height) / DPI)), DPI)
    return np.concatenate([strip, np.asarray(small)])


def _write(path: Path, pictures: Iterator[np.ndarray], rate: float) -> None:
    """Write pictures to a film of the kind that the name says, so many a second."""
    with atomic_path(path) as draft:
        (_write_mp4 if path.suffix == ".mp4" else _write_webp)(draft, pictures, rate)


def _film_library() -> Any:
    return extra_library("imageio_ffmpeg", "imageio-ffmpeg", "view", ", or write .webp")


def _write_mp4(path: Path, pictures: Iterator[np.ndarray], rate: float) -> None:
    library = _film_library()
    writer = library.write_frames(str(path), SIZE, fps=rate, output_params=["-f", "mp4"], macro_block_size=2)
    writer.send(None)
    for picture in pictures:
        writer.send(np.ascontiguousarray(picture[: SIZE[1], : SIZE[0], :3]))
    writer.close()


def _write_webp(path: Path, pictures: Iterator[np.ndarray], rate: float) -> None:
    from PIL import Image

    first, *others = (Image.fromarray(picture[..., :3]) for picture in pictures)
    first.save(path, "WEBP", save_all=True, append_images=others, duration=round(1000.0 / rate), loop=0, quality=80)


def refuse_other_kinds(path: Path, kinds: tuple[str, ...] = ALL_KINDS) -> None:
    """Raise ValueError for a name that ends otherwise."""
    if path.suffix not in kinds:
        raise ValueError(f"--out is {str(path)!r}; allowed: a name that ends in {', '.join(kinds)}")


def write_motion(bodies: "MovingBodies", path: Path, seconds: float = 8.0, progress: Progress = silent) -> None:
    """Write a motion for ParaView (.vtkhdf), as a film of so many seconds (.mp4, .webp), or on a sheet (.png)."""
    refuse_other_kinds(path)
    if path.suffix == ".vtkhdf":
        write_vtkhdf(bodies, path)
    elif path.suffix == ".png":
        contact_sheet(bodies, path)
    else:
        film(bodies, path, seconds, progress)


def contact_sheet(bodies: "MovingBodies", path: str | Path, picture_count: int = PICTURES) -> None:
    """Write a PNG with so many pictures of a landing, half of them up to its deepest point, each with its time [s].

    Of ground that repeats the images around the lander's way are drawn. Raises ValueError for bodies that are no
    landing.
    """
    from lithobrake.report.figures.hulls import scene
    from lithobrake.report.figures.landing_figure import landing_figure
    from lithobrake.report.figures.style import figure_style

    if bodies.attributes.get("format") != "lithobrake landing":
        raise ValueError(
            f"{bodies.attributes.get('format', 'the motion')} is no landing, and a contact sheet shows one; "
            "take a file that ends in .vtkhdf, .mp4 or .webp for other motions"
        )
    with figure_style(), atomic_path(path) as draft:
        figure = landing_figure(scene(bodies, has_lander=True), picture_count)
        figure.savefig(draft, format="png")


def write_journey(motion: "JourneyMotion", path: Path, seconds: float = 8.0, progress: Progress = silent) -> list[Path]:
    """Write a journey and give the paths of its files.

    A page with every touchdown to turn (.html), a film of so many seconds a touchdown (.mp4, .webp), a sheet with the
    map and pictures of each touchdown (.png), or for ParaView a file a touchdown, NAME_0.vtkhdf and on.
    """
    refuse_other_kinds(path, JOURNEY_KINDS)
    if path.suffix == ".vtkhdf":
        paths = touchdown_paths(path, len(motion.bodies))
        for bodies, one in zip(motion.bodies, paths, strict=True):
            write_vtkhdf(bodies, one)
        return paths
    if path.suffix in KINDS:
        journey_film(motion, path, seconds, progress)
    elif path.suffix == ".png":
        from lithobrake.report.figures.landing_figure import journey_sheet

        write_whole(path, journey_sheet(motion))
    else:
        from lithobrake.report.pages.one_journey_page import one_journey_page

        write_whole(path, one_journey_page(motion))
    return [path]


def touchdown_paths(path: Path, count: int) -> list[Path]:
    """Names of a file for each touchdown: the number stands behind the stem."""
    return [path.with_name(f"{path.stem}_{number}{path.suffix}") for number in range(count)]


def written_over(path: Path) -> list[Path]:
    """What a journey of any number of touchdowns may replace."""
    return sorted(path.parent.glob(f"{path.stem}_[0-9]*{path.suffix}")) if path.suffix in FILE_EACH else [path]
