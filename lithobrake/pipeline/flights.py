"""The flights of the samples that leave the surface, from the site to the next impact."""

import csv
from collections.abc import Iterator
from concurrent.futures import as_completed
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.pipeline.folder import StudyFolder, content_hash
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.samples import Samples, sampling_seed
from lithobrake.quantity import uncertain
from lithobrake.study import Study

if TYPE_CHECKING:
    from lithobrake.smallbody import Body

# Flights handed to a worker at once: enough to fill its lanes, few enough that progress is seen.
FLIGHTS_PER_CALL = 64
SITE_KEYS = ("latitude_deg", "longitude_deg", "heading_deg", "mass", "spin_period")
# sample: row in samples.h5. start_*: right after the bounce, relative to the turning ground; velocity_*: the same in
# the local frame (x along the incoming horizontal velocity, z outward) [m/s]. site_*: where and on which body.
# status: impact, flying, escaped. time_s: length of the flight. latitude, longitude, impact_speed (relative to the
# ground): of the impact, empty where there is none.
COLUMNS = (
    "sample", "start_speed", "start_elevation_deg", "velocity_x", "velocity_y", "velocity_z",
    *(f"site_{key}" for key in SITE_KEYS),
    "status", "time_s", "latitude_deg", "longitude_deg", "impact_speed",
)  # fmt: skip


@dataclass(frozen=True)
class Starts:
    """Samples that fly, shapes [flight_count, ...]: row of each, velocity in its local frame [m/s], its site by key."""

    sample: np.ndarray
    velocity: np.ndarray
    site: dict[str, np.ndarray]


def site_body(study: Study) -> "Body":
    """The body of the study with its shape, at the medians of its mass and spin period."""
    values = site_medians(study)
    return body_with(study.site.body, values["mass"], values["spin_period"])


def site_medians(study: Study) -> dict[str, float]:
    """Latitude, longitude, heading [deg], mass [kg] and spin period [s] of the site, uncertain ones at their median."""
    from lithobrake.quantity import median

    given = {name.removeprefix("site."): median(value) for name, value in study.site_values().items()}
    if "mass" not in given or "spin_period" not in given:
        built_in = _built_in()
        given = {"mass": built_in.mass, "spin_period": built_in.spin_period} | given
    return {key: given[key] for key in SITE_KEYS}


def body_with(source: str, mass: float, spin_period: float) -> "Body":
    """A body from its name or mesh, with this mass [kg] and spin period [s]."""
    from lithobrake.smallbody import Body, Shape

    shape = _built_in().shape if source == "didymos" else _read_shape(Shape, Path(source))
    return Body(shape, mass=mass, spin_period=spin_period)


@lru_cache(maxsize=1)
def _built_in() -> "Body":
    from lithobrake.smallbody import didymos

    return didymos()


@lru_cache(maxsize=1)
def _read_shape(kind: Any, path: Path) -> Any:
    return kind.read(path)


def flight_reads(study: Study) -> dict[str, Any]:
    """What the flights depend on beside the samples."""
    built_in = study.site.body == "didymos"
    body = "didymos" if built_in else content_hash(Path(study.site.body))
    return study.flight.model_dump() | {
        "seed": study.seed,
        "body": body,
        "site": {name: str(value) for name, value in study.site_values().items()},
    }


def starts(study: Study, samples: Samples) -> Starts:
    """The first samples that leave the surface, as many as the study flies, each with its own site."""
    from lithobrake.analysis import sample_inputs

    rows = np.flatnonzero(~samples.stays)[: study.flight.flight_count]
    velocity = np.column_stack([samples.output(f"velocity_out_{axis}") for axis in "xyz"])[rows]
    site = {key: np.full(len(rows), value) for key, value in site_medians(study).items()}
    drawn = {name: value.to_chaos() for name, value in uncertain(study.site_values()).items()}
    table = sample_inputs(drawn, len(samples.stays), sampling_seed(study, "site"))[rows]
    for index, name in enumerate(drawn):
        site[name.removeprefix("site.")] = table[:, index]
    return Starts(rows, velocity, site)


def fly_samples(job: Job) -> None:
    """Fly the samples that leave, on all workers, and write flights.csv in the order of the samples."""
    start = starts(job.study, Samples.load(job.folder))
    body = site_body(job.study)
    if job.study.flight.gravity == "table":
        # Built here and kept on disk, it is read by all workers in place of being built by each.
        body.shape.tabled_gravity  # noqa: B018
    blocks = list(_blocks(job.study, start))
    futures = {job.executor.submit(fly_block, *block): index for index, block in enumerate(blocks)}
    ends: list[dict[str, np.ndarray]] = [{} for _ in blocks]
    done = 0
    job.progress(done, len(start.sample), "flights")
    for future in as_completed(futures):
        ends[futures[future]] = future.result()
        done += len(ends[futures[future]]["time_s"])
        job.progress(done, len(start.sample), "flights")
    _write_shape(body, job.folder)
    with atomic_path(job.folder / "flights.csv") as draft, draft.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(COLUMNS)
        table.writerows(_rows(start, ends))


def _write_shape(body: "Body", folder: StudyFolder) -> None:
    """Write the body's shape beside the map, in metres, for whoever draws it."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in body.shape.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (body.shape.faces + 1).tolist()]
    with atomic_path(folder / "body.obj") as draft:
        draft.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _blocks(study: Study, start: Starts) -> Iterator[tuple[Any, ...]]:
    """Arguments of fly_block; the cut into blocks depends on the study only, never on the number of workers."""
    for first in range(0, len(start.sample), FLIGHTS_PER_CALL):
        part = slice(first, first + FLIGHTS_PER_CALL)
        site = {key: column[part] for key, column in start.site.items()}
        yield study.site.body, site, start.velocity[part], study.flight.duration, study.flight.gravity


def fly_block(
    source: str, site: dict[str, np.ndarray], velocity: np.ndarray, duration: float, gravity: str
) -> dict[str, np.ndarray]:
    """Fly some samples; velocity in the local frame of each site [m/s], shape [flight_count, 3].

    Gives status, time_s [s], latitude_deg, longitude_deg and impact_speed [m/s] of each, shape [flight_count].
    """
    from lithobrake.smallbody import fly

    table = np.column_stack([site[key] for key in SITE_KEYS])
    position, direction = np.empty((len(table), 3)), np.empty((len(table), 3))
    kinds = {"status": "U8", "time_s": float, "latitude_deg": float, "longitude_deg": float, "impact_speed": float}
    result = {name: np.empty(len(table), dtype=kind) for name, kind in kinds.items()}
    # Each different body flies its own samples; where the body is certain, there is one.
    for mass, spin_period in np.unique(table[:, 3:], axis=0):
        body = body_with(source, float(mass), float(spin_period))
        own = np.flatnonzero((table[:, 3] == mass) & (table[:, 4] == spin_period))
        for row in own:
            position[row], axes = body.local_frame(*table[row, :3].tolist())
            direction[row] = velocity[row] @ axes
        flown = fly(body, position[own], direction[own], duration, gravity=gravity, threads=1)
        result["status"][own], result["time_s"][own] = flown.status, flown.time
        result["latitude_deg"][own], result["longitude_deg"][own] = flown.latitude, flown.longitude
        result["impact_speed"][own] = flown.impact_speed
    return result


def _rows(start: Starts, ends: list[dict[str, np.ndarray]]) -> Iterator[list[Any]]:
    end = {name: np.concatenate([block[name] for block in ends]) for name in (ends[0] if ends else ())}
    speed = np.linalg.norm(start.velocity, axis=1)
    for row, sample in enumerate(start.sample.tolist()):
        elevation = float(np.degrees(np.arcsin(start.velocity[row, 2] / speed[row])))
        before = [sample, float(speed[row]), elevation, *start.velocity[row].tolist()]
        site = [float(start.site[key][row]) for key in SITE_KEYS]
        hit = end["status"][row] == "impact"
        where = [float(end[name][row]) if hit else "" for name in ("latitude_deg", "longitude_deg", "impact_speed")]
        yield [*before, *site, str(end["status"][row]), float(end["time_s"][row]), *where]


def read_flights(folder: StudyFolder) -> list[dict[str, str]]:
    """The rows of flights.csv by column."""
    with (folder / "flights.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
