"""The ways of the first flights, for a picture of them: places at equal parts of each flight's time."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.vocabulary.quantities import FIXED

if TYPE_CHECKING:
    from lithobrake.pipeline.folder.study_folder import StudyFolder
    from lithobrake.pipeline.job import Job
    from lithobrake.smallbody import Body, Flights

FILE = "flight_paths.h5"
FORMAT_VERSION = 1
# So many ways tell apart what becomes of landers, and do not hide the body.
PATHS = 16
# Parts of each flight's time, of which the ends are joined by straight lines.
PARTS = 192


def write_flight_paths(job: "Job", body: "Body", flown: "Flights", samples: np.ndarray) -> None:
    """Fly the first starts again, each until the end of every part of its time, and write flight_paths.h5.

    position [path_count, PARTS + 1, 3] [m], body-fixed; time [path_count, PARTS + 1] [s]; sample [path_count] and, as
    attribute, status: how each ended. samples: of all flights, [flight_count].
    """
    from lithobrake.smallbody import fly

    count = min(len(samples), PATHS)
    # A flight that ended as it began has one place, wherever its parts are.
    lasting = np.maximum(flown.time[:count], np.finfo(float).tiny)
    time = lasting[:, None] * np.arange(PARTS + 1) / PARTS
    each = np.repeat(np.arange(count), PARTS)
    start = flown.start
    parts = fly(
        body, start.position[each], start.velocity[each], time[:, 1:].ravel(), gravity=job.study.flight.gravity,
        start_time=start.time[each], mass=start.mass[each], spin_period=start.spin_period[each],
        threads=getattr(job.executor, "worker_count", None),
        progress=lambda fraction: job.progress(round(fraction * len(each)), len(each), "ways of flights"),
    )  # fmt: skip
    position = np.concatenate([start.position[:count, None], parts.position.reshape(count, PARTS, 3)], axis=1)
    _write(job.folder, position, time, samples[:count], [str(word) for word in flown.status[:count]])


def _write(
    folder: "StudyFolder", position: np.ndarray, time: np.ndarray, samples: np.ndarray, status: list[str]
) -> None:
    import h5py

    with atomic_path(folder / FILE) as draft, h5py.File(draft, "w") as file:
        file.create_dataset("position", data=position)
        file.create_dataset("time", data=time)
        file.create_dataset("sample", data=samples)
        file["position"].attrs.update({"units": "m", "long_name": "places on the way", "frame": FIXED})
        file["time"].attrs.update({"units": "s", "long_name": "time since the start"})
        file["sample"].attrs.update({"units": "", "long_name": "row of the sample, from 0"})
        file.attrs["format_version"], file.attrs["status"] = FORMAT_VERSION, status
