"""The flights of the samples that leave the surface, from the site to the next impact, and their paths."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.atomic import atomic_path, write_rows
from lithobrake.files.reading import content_hash, read_rows
from lithobrake.geometry.mesh_units import labelled_mesh, mesh_unit
from lithobrake.pipeline.first_touchdown.samples import Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.site import SITE_KEYS, Site
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.study import BUILT_IN_BODIES, Study
from lithobrake.study.units import input_units
from lithobrake.vocabulary import file_names
from lithobrake.vocabulary.number_words import QUANTILES
from lithobrake.vocabulary.outcomes import FlightStatus
from lithobrake.vocabulary.quantities import ARC, FIXED, FLIGHT, Quantity, quantity

if TYPE_CHECKING:
    from lithobrake.smallbody import Body, Flights

PATHS_FILE = "flight_paths.h5"
FORMAT_VERSION = 1
# So many ways tell apart what becomes of landers, and do not hide the body.
PATHS = 16
# Of these journeys at most so many flights.
MOST_ARCS = 128
# Parts of each flight's time, of which the ends are joined by straight lines.
PARTS = 192
# Flights of which the Jacobi constant is looked at.
CHECKED = 200
# docs/flights.md says what each is.
COLUMNS = (
    "sample", "start_speed", "start_elevation_deg", "velocity_x", "velocity_y", "velocity_z",
    *(f"site_{key}" for key in SITE_KEYS),
    "status", "time_s", "latitude_deg", "longitude_deg", "facet", "impact_speed", "impact_incidence_deg",
)  # fmt: skip


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
    def of_study(cls, job: Job) -> "Ways":
        if job.study.design.run_count:
            ways = cls._of_journeys(job.folder)
            if len(ways.sample):
                return ways
        return cls._of_samples(job)

    @classmethod
    def _of_samples(cls, job: Job) -> "Ways":
        """The first flights of samples; none where there are no samples."""
        samples = Samples.load(job.folder) if job.study.sample_count else None
        start = starts(job.site, samples) if samples else Starts.none()
        first = Starts(start.sample[:PATHS], start.velocity[:PATHS], {k: v[:PATHS] for k, v in start.site.items()})
        flown = fly_starts(job, first, "paths of flights")
        return cls(
            position=flown.start.position,
            velocity=flown.start.velocity,
            begin=flown.start.time,
            duration=flown.time,
            mass=flown.start.mass,
            spin_period=flown.start.spin_period,
            sample=first.sample,
            status=tuple(str(word) for word in flown.status),
        )

    @classmethod
    def _of_journeys(cls, folder: "StudyFolder") -> "Ways":
        ends = {
            row["journey"]: row["end"]
            for row in read_rows(folder / file_names.JOURNEYS_FILE, ("journey", "end"), AGAIN)
        }
        rows = read_rows(folder / file_names.ARCS_FILE, tuple(ARC), AGAIN)
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


def write_paths(job: Job) -> None:
    """Write the shape of the body, and paths of flights: of the landers, or of the samples where these have none."""
    write_shape(job.site.body, job.folder)
    _write_flight_paths(job, job.site.body, Ways.of_study(job))


def _write_flight_paths(job: "Job", body: "Body", ways: Ways) -> None:
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

    with atomic_path(folder / PATHS_FILE) as draft, h5py.File(draft, "w") as file:
        file.create_dataset("position", data=position)
        file.create_dataset("time", data=time)
        file.create_dataset("sample", data=ways.sample)
        file["position"].attrs.update({"units": "m", "long_name": "places on the way", "frame": FIXED})
        file["time"].attrs.update({"units": "s", "long_name": "time since the start"})
        file["sample"].attrs.update({"units": "", "long_name": "number of the sample or of the journey, from 0"})
        file.attrs["format_version"], file.attrs["status"] = FORMAT_VERSION, ways.status


@dataclass(frozen=True)
class Starts:
    """Samples that fly, shapes [flight_count, ...]: row of each, velocity in its local frame [m/s], its site by key."""

    sample: np.ndarray
    velocity: np.ndarray
    site: dict[str, np.ndarray]

    @classmethod
    def none(cls) -> "Starts":
        return cls(np.empty(0, dtype=np.int64), np.empty((0, 3)), {key: np.empty(0) for key in SITE_KEYS})


def flight_dependencies(study: Study) -> dict[str, Any]:
    built_in = study.site.body in BUILT_IN_BODIES
    mesh = labelled_mesh(Path(study.site.body))
    body = study.site.body if built_in else content_hash(mesh)
    # A key that came later is left out where it says nothing, so that folders of before stay whole.
    turning = study.site.rotation
    later = {
        "gravity_facets": study.site.gravity_facets,
        "extents": study.site.extents,
        "partner_body": None if study.site.partner_body is None else study.site.partner_body.model_dump(),
        "rotation": None if turning is None else turning.model_dump(mode="json"),
    }
    return (
        study.flight.model_dump()
        | {key: value for key, value in later.items() if value is not None}
        | {
            "seed": study.seed,
            "body": body,
            "unit": "m" if built_in else mesh_unit(mesh, study.site.unit),
            "partner": study.site.partner,
            # A distribution is no JSON value; as text it has its kind and all parameters.
            "site": {name: str(value) for name, value in study.site_values().items()},
        }
    )


def starts(site: Site, samples: Samples) -> Starts:
    """The first samples that leave the surface, as many as the study flies, each with its own site."""
    rows = np.flatnonzero(samples.leaves)[: site.study.flight.flight_count]
    velocity = np.column_stack([samples.output(f"velocity_out_{axis}") for axis in "xyz"])[rows]
    sites = {key: values[rows] for key, values in site.sampled(len(samples.outcome)).items()}
    return Starts(rows, velocity, sites)


def fly_samples(job: Job) -> None:
    study, body, samples = job.study, job.site.body, Samples.load(job.folder)
    start = starts(job.site, samples)
    if study.flight.gravity == "table":
        job.progress(0, 1, "gravity table")
        error = body.shape.table_error
        job.say(
            f"Gravity table: {error.median:.1e} of the surface gravity off the facets' sum in the median, "
            f"{error.p95:.1e} at the 95th percentile of {error.point_count} points."
        )
    for words in job.site.remarks:
        job.say(words)
    job.folder.write_json(file_names.FLIGHT_CHECKS_FILE, _checks(job, start))
    flown = fly_starts(job, start, "flights")
    write_table(job.folder, file_names.SAMPLE_FLIGHTS_FILE, COLUMNS, flight_rows(start, flown))
    if study.monte_carlo.scatter:
        _fly_without_scatter(job, samples)


def _fly_without_scatter(job: Job, samples: Samples) -> None:
    """Write the flights of an expansion without the scatter from run to run."""
    start = starts(job.site, samples.expansion_alone())
    flown = fly_starts(job, start, "flights without scatter")
    write_table(job.folder, file_names.FLIGHTS_WITHOUT_SCATTER_FILE, COLUMNS, flight_rows(start, flown))


def write_table(
    folder: StudyFolder,
    name: str,
    columns: Sequence[str],
    rows: Iterable[list[Any]],
    known: Mapping[str, Quantity] = FLIGHT,
) -> None:
    """Write a CSV file of the folder, with the unit behind each name that does not hold it; known: its quantities."""
    study_units = input_units()
    units = {column: quantity(column, known, study_units).units for column in columns}
    titles = [
        column if not unit or column.endswith(f"_{unit}") else f"{column} [{unit}]" for column, unit in units.items()
    ]
    write_rows(folder / name, titles, rows)


def fly_starts(job: Job, start: Starts, what: str, body: "Body | None" = None) -> "Flights":
    """Fly on as many threads as the study has workers; the result does not depend on their number.

    body: None for that of the site.
    """
    from lithobrake.smallbody import fly

    study, count = job.study, len(start.sample)
    body = job.site.body if body is None else body
    origin, axes = job.site.frames(start.site)
    return fly(
        body,
        origin,
        np.einsum("nij,ni->nj", axes, start.velocity),
        study.flight.duration,
        gravity=study.flight.gravity,
        start_time=job.site.clock(start.site),
        mass=start.site["mass"],
        spin_period=start.site["spin_period"],
        threads=getattr(job.executor, "worker_count", None),
        progress=lambda fraction: job.progress(round(fraction * count), count, what),
    )


def _checks(job: Job, start: Starts) -> dict[str, Any]:
    """How exact the flights are: the table's error, and the drift of the Jacobi constant of the first flights.

    With a partner there is no such constant, nor where the body does not turn uniformly, so these flights are made once
    more without either.
    """
    part = Starts(start.sample[:CHECKED], start.velocity[:CHECKED], {k: v[:CHECKED] for k, v in start.site.items()})
    body, gravity = job.site.body, job.study.flight.gravity
    drift = np.abs(fly_starts(job, part, "checks of flights", replace(body, partner=None, rotation=None)).jacobi_drift)
    return {
        "gravity": gravity,
        "gravity_table_error": dict(body.shape.table_error._asdict()) if gravity == "table" else None,
        "jacobi_flight_count": len(drift),
        "jacobi_drift_median_m2_s2": float(np.median(drift)) if len(drift) else None,
        "jacobi_drift_largest_m2_s2": float(drift.max()) if len(drift) else None,
    }


def write_shape(body: "Body", folder: StudyFolder) -> None:
    # repr has all digits, so that who reads the file has the same body; OBJ counts vertices from 1.
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in body.shape.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (body.shape.faces + 1).tolist()]
    with atomic_path(folder / file_names.BODY_FILE) as draft:
        draft.write_text("\n".join(lines) + "\n", encoding="utf-8")


def flight_rows(start: Starts, flown: "Flights") -> Iterator[list[Any]]:
    """Rows of COLUMNS."""
    speed = np.linalg.norm(start.velocity, axis=1)
    # No arc sine, which has no value for a lander left at rest, and few digits near the vertical.
    elevation = np.degrees(np.arctan2(start.velocity[:, 2], np.hypot(*start.velocity[:, :2].T)))
    before = np.column_stack([speed, elevation, start.velocity, *(start.site[key] for key in SITE_KEYS)]).tolist()
    after = np.column_stack([flown.latitude, flown.longitude, flown.impact_speed, np.degrees(flown.incidence)]).tolist()
    down = flown.facet >= 0
    for row, sample in enumerate(start.sample.tolist()):
        latitude, longitude, speed_there, incidence = after[row] if down[row] else [""] * 4
        # The partner's facets are not those of body.obj.
        facet = int(flown.facet[row]) if flown.status[row] == FlightStatus.IMPACT else ""
        end = [str(flown.status[row]), float(flown.time[row]), latitude, longitude, facet, speed_there, incidence]
        yield [sample, *before[row], *end]


def flight_numbers(flights: Sequence[dict[str, str]]) -> dict[str, Any]:
    """Median and the middle nine tenths of time of flight, speed and incidence of the impacts on the body."""
    down = [row for row in flights if row["status"] == FlightStatus.IMPACT]
    table: dict[str, Any] = {}
    for name in ("time_s", "impact_speed", "impact_incidence_deg") if down else ():
        values = np.array([float(row[name]) for row in down])
        table[name] = {f"quantile_{level:g}": float(np.quantile(values, level)) for level in QUANTILES}
    return table


def read_table(folder: StudyFolder, name: str) -> list[dict[str, str]]:
    """The rows of a CSV file of samples by column. Raises ValueError for a damaged file."""
    return read_rows(folder / name, ("sample", "status"), AGAIN)
