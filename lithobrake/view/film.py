"""A motion as a film: MP4 where imageio-ffmpeg is installed, animated WebP else."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.view.motion import INSTALL, DrawnMotion
from lithobrake.vocabulary.progress import Progress, silent

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies

SIZE = (960, 640)
KINDS = (".mp4", ".webp")


def film(bodies: "MovingBodies", path: Path, seconds: float = 8.0, progress: Progress = silent) -> None:
    """Write a film of all frames, evenly in simulated time, that lasts so many seconds; the path's end says which kind.

    Raises ValueError for another kind or duration, ImportError where PyVista, or imageio-ffmpeg for MP4, is absent.
    """
    if path.suffix not in KINDS:
        raise ValueError(f"the film is {path.name!r}; allowed: a name that ends in {' or '.join(KINDS)}")
    if not 0.0 < seconds < np.inf:
        raise ValueError(f"the film lasts {seconds!r} s; allowed: a finite time above 0 s")
    count = len(bodies.time)
    pictures = _pictures(bodies, progress)
    with atomic_path(path) as draft:
        (_write_mp4 if path.suffix == ".mp4" else _write_webp)(draft, pictures, count / seconds)


def _pictures(bodies: "MovingBodies", progress: Progress) -> Iterator[np.ndarray]:
    """The frames at even instants, one after the other."""
    drawn, count = DrawnMotion(bodies, size=SIZE, off_screen=True), len(bodies.time)
    instants = np.linspace(bodies.time[0], bodies.time[-1], count)
    for number, instant in enumerate(instants):
        drawn.go_to(int(np.argmin(np.abs(bodies.time - instant))))
        yield drawn.picture()
        progress((number + 1) / count, "drawing")


def _write_mp4(path: Path, pictures: Iterator[np.ndarray], rate: float) -> None:
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise ImportError(f"imageio-ffmpeg is not installed; install it with: {INSTALL}, or write .webp") from error
    writer = imageio_ffmpeg.write_frames(str(path), SIZE, fps=rate, output_params=["-f", "mp4"], macro_block_size=2)
    writer.send(None)
    for picture in pictures:
        writer.send(np.ascontiguousarray(picture[: SIZE[1], : SIZE[0], :3]))
    writer.close()


def _write_webp(path: Path, pictures: Iterator[np.ndarray], rate: float) -> None:
    from PIL import Image

    first, *others = (Image.fromarray(picture[..., :3]) for picture in pictures)
    first.save(path, "WEBP", save_all=True, append_images=others, duration=round(1000.0 / rate), loop=0, quality=80)
