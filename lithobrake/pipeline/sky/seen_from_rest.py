"""What each lander at rest sees of the Sun, of Earth and of an orbiter, and which of its sides face them."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lithobrake.files.hashing import content_hash
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.fly.flights import write_table
from lithobrake.pipeline.folder.study_folder import AGAIN
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.sky.where_they_stand import Days, OrbiterPlaces, screens, where_it_stands
from lithobrake.study import Study
from lithobrake.study.lander_sides import SIDES
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import JOURNEYS_FILE, SKY, SKY_FILE

if TYPE_CHECKING:
    from lithobrake.smallbody import Body, Screen

# Outward, by the lander's own axes, in the order of SIDES.
NORMALS = np.array([sign * np.eye(3)[axis] for axis in range(3) for sign in (1.0, -1.0)])


class View(NamedTuple):
    """A part of the time: unit vectors to a body from each lander, [lander_count, direction_count, 3], how far away it
    is there [m], the part that each direction stands for, [direction_count], and what hides it."""

    directions: np.ndarray
    distance: np.ndarray | float
    weight: np.ndarray
    screen: "Screen | None"


def sky_files(study: Study) -> list[str]:
    """What the stage writes: nothing where the study does not ask for the sky."""
    return [SKY_FILE] if study.sky.bodies else []


def sky_dependencies(study: Study) -> Any:
    """What of the study the stage depends on, beside the journeys."""
    sky, site = study.sky.model_dump(mode="json"), study.site
    files = [*(site.kernels if study.sky.date else ()), *([sky["orbiter"]["states"]] if sky["orbiter"] else ())]
    pole = [site.pole_right_ascension_deg, site.pole_declination_deg, site.kernel_body]
    if sky["orbiter"]:
        # The file counts with its content, wherever it lies.
        sky["orbiter"] |= {"states": sky["orbiter"]["states"] is not None}
    return {"sky": sky, "pole": pole, "files": [content_hash(Path(file)) for file in files if file]}


def look_up(job: Job) -> None:
    """Write sky.csv, a row for each body in the sky and lander at rest."""
    sky, landers, body = job.study.sky, _at_rest(job), job.site.body
    rows = [
        row
        for name in sky.bodies
        for row in rows_of(
            *(body, landers, name, where_it_stands(job.study, job.site, name)), sky.mask_of(name), sky.beam_of(name)
        )
    ]
    write_table(job.folder, SKY_FILE, tuple(SKY), rows, SKY)


def _at_rest(job: Job) -> list[dict[str, float]]:
    """Number, place and attitude of each lander at rest; NaN where it has no attitude."""
    names = ("journey", *(f"position_{axis}" for axis in "xyz"), *(f"attitude_{part}" for part in "wxyz"))
    rows = read_rows(job.folder / JOURNEYS_FILE, ("journey", "end", "attitude_w"), AGAIN)
    found = []
    for row in rows:
        values = {title.split(" ")[0]: value for title, value in row.items()}
        if values["end"] == JourneyEnd.AT_REST:
            found.append({name: float(values[name] or "nan") for name in names})
    return found


def rows_of(
    body: "Body",
    landers: list[dict[str, float]],
    name: str,
    stands: Days | OrbiterPlaces,
    mask_deg: float,
    beam_deg: float,
) -> list[list[Any]]:
    """The rows of one body in the sky, in the order of the columns SKY."""
    from lithobrake.smallbody import seen_from

    if not landers:
        return []
    place = np.array([[one[f"position_{axis}"] for axis in "xyz"] for one in landers])
    up, sides = body.shape.normals[body.shape.nearest(place)[1]], _side_normals(landers)
    journeys = np.array([int(one["journey"]) for one in landers])
    seen_parts, side_parts = [], []
    for view in views(body, place, journeys, stands):
        seen = seen_from(body.shape, place, up, view.directions, mask_deg, distance=view.distance, screen=view.screen)
        facing = np.einsum("pdi,psi->pds", view.directions, sides) > np.cos(np.radians(beam_deg))
        seen_parts.append(seen @ view.weight)
        side_parts.append(np.einsum("pds,pd,d->ps", facing, seen, view.weight))
    # Parts of all the time add up to 1 but for rounding.
    fractions, by_side = np.minimum(seen_parts, 1.0), np.minimum(np.mean(side_parts, axis=0), 1.0)
    latitudes = stands.latitude.mean(axis=1)[journeys].tolist() if isinstance(stands, Days) else [""] * len(landers)
    rows = []
    for number, (journey, latitude) in enumerate(zip(journeys.tolist(), latitudes, strict=True)):
        known, parts = np.isfinite(sides[number]).all(), fractions[:, number]
        shares = by_side[number].tolist() if known else [""] * len(SIDES)
        rows.append([journey, name, latitude, float(parts.mean()), float(parts.min()), *shares])
    return rows


def views(body: "Body", place: np.ndarray, journeys: np.ndarray, stands: Days | OrbiterPlaces) -> Iterator[View]:
    """The parts of the time, each day of a body far away, or all of an orbiter's, as places [m], [count, 3], see them.

    journeys: which row of its latitudes each place has, [count].
    """
    from lithobrake.smallbody import day_directions
    from lithobrake.smallbody.sky import DIRECTIONS

    if isinstance(stands, OrbiterPlaces):
        way = stands.position[None] - place[:, None]
        distance = np.linalg.norm(way, axis=-1)
        (screen,) = screens(body, len(stands.position), 1)
        yield View(way / distance[..., None], distance, stands.weight, screen)
        return
    days = stands.latitude[journeys].T
    weight = np.full(DIRECTIONS, 1.0 / DIRECTIONS)
    for latitude, screen in zip(days, screens(body, DIRECTIONS, len(days)), strict=True):
        yield View(day_directions(latitude), np.inf, weight, screen)


def _side_normals(landers: list[dict[str, float]]) -> np.ndarray:
    """Outward normals of the sides of each lander, body-fixed, [lander_count, 6, 3]; NaN where it has no attitude."""
    from scipy.spatial.transform import Rotation

    found = np.full((len(landers), len(SIDES), 3), np.nan)
    for number, one in enumerate(landers):
        quaternion = [one[f"attitude_{part}"] for part in "wxyz"]
        if np.isfinite(quaternion).all():
            found[number] = Rotation.from_quat(quaternion, scalar_first=True).apply(NORMALS)
    return found
