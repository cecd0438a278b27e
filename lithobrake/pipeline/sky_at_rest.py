"""What landers at rest see of the Sun, of Earth and of an orbiter, and where these stand over the body."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lithobrake.files.reading import content_hash, hashed_seed, read_rows
from lithobrake.geometry.naif_kernels import kernel_files
from lithobrake.pipeline.first_touchdown.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_folder import AGAIN
from lithobrake.study import Study, StudyError
from lithobrake.study.delivered_states import orbiter_states
from lithobrake.study.design_sections import SkyBody
from lithobrake.study.lander_section import OUTWARD
from lithobrake.study.quantity import Scalar, Uncertain
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.file_names import JOURNEYS_FILE, SKY_FILE
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import SIDES, SKY

if TYPE_CHECKING:
    from lithobrake.smallbody import Body, Screen

# Of a span of time, evenly over it, each in the middle of its part.
DATES = 24


class Days(NamedTuple):
    """A body far away: latitudes [deg] over which it stands, [journey_count, day_count]."""

    latitude: Floats


class OrbiterPlaces(NamedTuple):
    """An orbiter: body-fixed places [m], [place_count, 3], and the part of the time that each stands for."""

    position: Floats
    weight: Floats


def where_it_stands(study: Study, site: Site, name: SkyBody) -> Days | OrbiterPlaces:
    """Where one of the bodies stands, for all journeys of a study.

    Raises ValueError or ImportError where kernels, orbit or states do not tell.
    """
    if name == "orbiter":
        return _orbiter(study, site)
    count, sky = study.design.run_count, study.sky
    if sky.date is None:
        return Days(_drawn(study, name, sky.latitudes[name])[:, None])
    return Days(np.tile(_dated(study, name, sky_dates(study, DATES)), (count, 1)))


def sky_dates(study: Study, count: int) -> list[Epoch]:
    """The date of the study, or so many over its span."""
    sky = study.sky
    assert sky.date is not None
    start = Epoch.of(sky.date)
    if sky.until is None:
        return [start]
    span = Epoch.of(sky.until).since(start)
    return [start.after(span * ((number + 0.5) / count)) for number in range(count)]


def _drawn(study: Study, name: str, latitude: Scalar) -> Floats:
    """The latitude [deg] over which a body stands for each journey; more journeys change no earlier one."""
    from lithobrake.chaos.design import sample_inputs

    count = study.design.run_count
    if not isinstance(latitude, Uncertain):
        return np.full(count, latitude)
    law = {f"sky.{name}_latitude_deg": latitude.to_chaos()}
    drawn: Floats = sample_inputs(law, count, hashed_seed(study.seed, "sky"))[:, 0]
    return drawn


def _dated(study: Study, name: str, dates: list[Epoch]) -> Floats:
    """Latitudes [deg] over which the Sun or Earth stands at dates, [date_count]."""
    from lithobrake.smallbody import HeliocentricOrbit, latitudes_over

    if study.site.kernels:
        place = _of_kernels(study, name, dates)
        return np.asarray(np.degrees(np.arcsin(place[:, 2] / np.linalg.norm(place, axis=1))))
    given, site = study.sky.orbit, study.site
    assert given is not None
    assert site.pole_right_ascension_deg is not None
    assert site.pole_declination_deg is not None
    orbit = HeliocentricOrbit(**given.model_dump() | {"epoch": Epoch.of(given.epoch)})
    return latitudes_over(orbit, site.pole_right_ascension_deg, site.pole_declination_deg, dates)[name]


def _of_kernels(study: Study, target: str, dates: list[Epoch]) -> Floats:
    """Body-fixed places of a target by the kernels of the study [m], [date_count, 3]."""
    from lithobrake.smallbody import read_places

    texts = [date.text() for date in dates]
    return read_places(study.site.kernels, study.site.kernel_body or study.site.body, target, texts)


def _orbiter(study: Study, site: Site) -> OrbiterPlaces:
    from lithobrake.smallbody import circle_places
    from lithobrake.smallbody.sky import PLACES

    orbiter = study.sky.orbiter
    assert orbiter is not None
    if orbiter.states is not None:
        states, weight = orbiter_states(study)
        return OrbiterPlaces(states.position, weight)
    if orbiter.kernel_name is not None:
        return OrbiterPlaces(
            _of_kernels(study, orbiter.kernel_name, sky_dates(study, PLACES)), np.full(PLACES, 1.0 / PLACES)
        )
    assert orbiter.altitude is not None
    inclination = 90.0 if orbiter.inclination_deg is None else orbiter.inclination_deg
    place = circle_places(site.body.shape.radius + orbiter.altitude, inclination)
    return OrbiterPlaces(place, np.full(PLACES, 1.0 / PLACES))


def refuse_hidden_orbiter(site: Site) -> None:
    """Raise StudyError for states of an orbiter that lie below the ground."""
    orbiter, shape = site.study.sky.orbiter, site.body.shape
    if orbiter is None or orbiter.states is None:
        return
    states, _ = orbiter_states(site.study)
    near = np.flatnonzero(np.linalg.norm(states.position, axis=1) < shape.radius)
    height = shape.height(states.position[near])
    if (height < 0.0).any():
        row = int(np.argmin(height))
        raise StudyError(
            [
                f"sky.orbiter.states: {states.source[near[row]]} lies {-height[row]:.3g} m below the ground; allowed: "
                "above it; is it counted from the centre of the body, in its own axes and in metres? correct it"
            ]
        )


def screens(body: "Body", count: int, blocks: int) -> "Iterator[Screen | None]":
    """The partner of a body for each of so many blocks of directions; None without one.

    It stands over one longitude, or, where it moves in a day of the body by more than from one direction to the next,
    over any alike.
    """
    from lithobrake.smallbody import Screen
    from lithobrake.smallbody.sky import DIRECTIONS

    if body.partner is None:
        yield from [None] * blocks
        return
    orbit, extents = body.orbit, np.ptp(body.partner.body.shape.vertices, axis=0)
    moves = abs(orbit.rate) * body.spin_period > 2.0 * np.pi / DIRECTIONS
    for block in range(blocks):
        # Steps of an irrational part of a turn are spread evenly, however many directions there are.
        turn = (block * count + np.arange(count)) * np.sqrt(2.0) % 1.0 if moves else np.zeros(count)
        angle = orbit.angle + 2.0 * np.pi * turn
        centre = orbit.distance * np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
        # A spheroid takes one root a direction; the partner's facets would move an edge of an eclipse by less than a
        # direction.
        yield Screen(centre, 0.25 * float(extents[0] + extents[1]), 0.5 * float(extents[2]))


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
    sky, site = study.sky.model_dump(mode="json"), study.site
    files = kernel_files(site.kernels) if study.sky.date else []
    files += [sky["orbiter"]["states"]] if sky["orbiter"] and sky["orbiter"]["states"] else []
    pole = [site.pole_right_ascension_deg, site.pole_declination_deg, site.kernel_body]
    if sky["orbiter"]:
        # The file counts with its content, wherever it lies.
        sky["orbiter"] |= {"states": sky["orbiter"]["states"] is not None}
    # One that is not there is refused where it is read.
    hashes = [content_hash(Path(file)) if os.path.isfile(file) else None for file in files]
    return {"sky": sky, "pole": pole, "files": hashes}


def look_up(job: Job) -> None:
    sky, body = job.study.sky, job.site.body
    grounds = [(body, _at_rest(job, JourneyEnd.AT_REST))]
    if len(job.site.ground_names) > 1:
        grounds.append((body.seen_from_partner, _at_rest(job, JourneyEnd.PARTNER)))
    rows = []
    for name in sky.bodies:
        stands = where_it_stands(job.study, job.site, name)
        # Where an orbiter of the first body stands over the partner depends on when.
        for ground, landers in grounds[:1] if name == "orbiter" else grounds:
            rows += rows_of(*(ground, landers, name, stands), sky.mask_of(name), sky.beam_of(name))
    write_table(job.folder, SKY_FILE, tuple(SKY), rows, SKY)


def _at_rest(job: Job, end: JourneyEnd) -> list[dict[str, float]]:
    """Number, place and attitude of each lander at rest that ended so; NaN where it has no attitude."""
    names = ("journey", *(f"position_{axis}" for axis in "xyz"), *(f"attitude_{part}" for part in "wxyz"))
    rows = read_rows(job.folder / JOURNEYS_FILE, ("journey", "end", "attitude_w"), AGAIN)
    found = []
    for row in rows:
        values = {title.split(" ")[0]: value for title, value in row.items()}
        if values["end"] == end:
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
            found[number] = Rotation.from_quat(quaternion, scalar_first=True).apply(np.array(OUTWARD))
    return found
