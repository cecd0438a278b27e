"""The ways of the first flights, for a picture of them: places at equal parts of each flight's time."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.folder.study_folder import AGAIN
from lithobrake.vocabulary.quantities import ARC, FIXED

if TYPE_CHECKING:
    from lithobrake.pipeline.folder.study_folder import StudyFolder
    from lithobrake.pipeline.job import Job
    from lithobrake.smallbody import Body, Flights

FILE = "flight_paths.h5"
FORMAT_VERSION = 1
# So many ways tell apart what becomes of landers, and do not hide the body.
PATHS = 16
# Of these journeys at most so many flights.
MOST_ARCS = 128
# Parts of each flight's time, of which the ends are joined by straight lines.
PARTS = 192


@dataclass(frozen=True)
class Ways:
    """Flights whose ways are drawn, a row or entry each.

    position [m] and velocity [m/s] at the start, body-fixed, [path_count, 3]; begin: of the flight in the clock of the
    partner [s]; duration [s]; mass [kg] and spin_period [s] of the body; sample: number of the sample, or of the
    journey; status: how the flight ended, or the journey.
    """

    position: np.ndarray
    velocity: np.ndarray
    begin: np.ndarray
    duration: np.ndarray
    mass: np.ndarray
    spin_period: np.ndarray
    sample: np.ndarray
    status: tuple[str, ...]

    @classmethod
    def of_samples(cls, flown: "Flights", samples: np.ndarray) -> "Ways":
        """The first flights of samples; samples: of all flights, [flight_count]."""
        start, count = flown.start, min(len(samples), PATHS)
        return cls(
            position=start.position[:count],
            velocity=start.velocity[:count],
            begin=start.time[:count],
            duration=flown.time[:count],
            mass=start.mass[:count],
            spin_period=start.spin_period[:count],
            sample=samples[:count],
            status=tuple(str(word) for word in flown.status[:count]),
        )

    @classmethod
    def of_journeys(cls, folder: "StudyFolder") -> "Ways":
        """All flights of the first journeys of landings, as arcs.csv has them."""
        ends = {row["journey"]: row["end"] for row in read_rows(folder / "journeys.csv", ("journey", "end"), AGAIN)}
        rows = read_rows(folder / "arcs.csv", tuple(ARC), AGAIN)
        rows = [row for row in rows if int(row["sample"]) < PATHS][:MOST_ARCS]

        def column(name: str) -> np.ndarray:
            return np.array([float(row[name]) for row in rows])

        position, velocity = (
            np.column_stack([column(f"{of}_{axis}") for axis in "xyz"]) for of in ("position", "velocity")
        )
        return cls(
            position=position,
            velocity=velocity,
            begin=column("clock_s"),
            duration=column("end_s") - column("begin_s"),
            mass=column("site_mass"),
            spin_period=column("site_spin_period"),
            sample=column("sample").astype(np.int64),
            status=tuple(ends[row["sample"]] for row in rows),
        )


def write_flight_paths(job: "Job", body: "Body", ways: Ways) -> None:
    """Fly these again, each until the end of every part of its time, and write flight_paths.h5.

    position [path_count, PARTS + 1, 3] [m], body-fixed; time [path_count, PARTS + 1] [s]; sample [path_count] and, as
    attribute, status.
    """
    from lithobrake.smallbody import fly

    count = len(ways.sample)
    # A flight that ended as it began has one place, wherever its parts are.
    lasting = np.maximum(ways.duration, np.finfo(float).tiny)
    time = lasting[:, None] * np.arange(PARTS + 1) / PARTS
    each = np.repeat(np.arange(count), PARTS)
    parts = fly(
        body, ways.position[each], ways.velocity[each], time[:, 1:].ravel(), gravity=job.study.flight.gravity,
        start_time=ways.begin[each], mass=ways.mass[each], spin_period=ways.spin_period[each],
        threads=getattr(job.executor, "worker_count", None),
        progress=lambda fraction: job.progress(round(fraction * len(each)), len(each), "ways of flights"),
    )  # fmt: skip
    position = np.concatenate([ways.position[:, None], parts.position.reshape(count, PARTS, 3)], axis=1)
    _write(job.folder, position, time, ways)


def _write(folder: "StudyFolder", position: np.ndarray, time: np.ndarray, ways: Ways) -> None:
    import h5py

    with atomic_path(folder / FILE) as draft, h5py.File(draft, "w") as file:
        file.create_dataset("position", data=position)
        file.create_dataset("time", data=time)
        file.create_dataset("sample", data=ways.sample)
        file["position"].attrs.update({"units": "m", "long_name": "places on the way", "frame": FIXED})
        file["time"].attrs.update({"units": "s", "long_name": "time since the start"})
        file["sample"].attrs.update({"units": "", "long_name": "number of the sample or of the journey, from 0"})
        file.attrs["format_version"], file.attrs["status"] = FORMAT_VERSION, ways.status
