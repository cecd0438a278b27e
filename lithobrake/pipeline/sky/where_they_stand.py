"""Where Sun, Earth and an orbiter stand over the body of a study, and what its partner hides."""

from collections.abc import Iterator
from datetime import datetime
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.study.delivered_states import orbiter_states
from lithobrake.study.quantity import Scalar, Uncertain
from lithobrake.study.sky_checks import utc
from lithobrake.study.sky_section import SkyBody

if TYPE_CHECKING:
    from lithobrake.smallbody import Body, Screen

Floats = np.ndarray
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


def sky_dates(study: Study, count: int) -> list[datetime]:
    """The date of the study [UTC], or so many over its span."""
    sky = study.sky
    assert sky.date is not None
    start = utc(sky.date)
    if sky.until is None:
        return [start]
    span = utc(sky.until) - start
    return [start + span * ((number + 0.5) / count) for number in range(count)]


def _drawn(study: Study, name: str, latitude: Scalar) -> Floats:
    """The latitude [deg] over which a body stands for each journey; more journeys change no earlier one."""
    from lithobrake.chaos.design import sample_inputs

    count = study.design.run_count
    if not isinstance(latitude, Uncertain):
        return np.full(count, latitude)
    law = {f"sky.{name}_latitude_deg": latitude.to_chaos()}
    drawn: Floats = sample_inputs(law, count, hashed_seed(study.seed, "sky"))[:, 0]
    return drawn


def _dated(study: Study, name: str, dates: list[datetime]) -> Floats:
    """Latitudes [deg] over which the Sun or Earth stands at dates, [date_count]."""
    from lithobrake.smallbody import HeliocentricOrbit, latitudes_over

    if study.site.kernels:
        place = _of_kernels(study, name, dates)
        return np.asarray(np.degrees(np.arcsin(place[:, 2] / np.linalg.norm(place, axis=1))))
    given, site = study.sky.orbit, study.site
    assert given is not None
    assert site.pole_right_ascension_deg is not None
    assert site.pole_declination_deg is not None
    orbit = HeliocentricOrbit(**given.model_dump() | {"epoch": utc(given.epoch)})
    return latitudes_over(orbit, site.pole_right_ascension_deg, site.pole_declination_deg, dates)[name]


def _of_kernels(study: Study, target: str, dates: list[datetime]) -> Floats:
    """Body-fixed places of a target by the kernels of the study [m], [date_count, 3]."""
    from lithobrake.smallbody import read_places

    texts = [date.isoformat() for date in dates]
    return read_places(study.site.kernels, study.site.kernel_body or study.site.body, target, texts)


def _orbiter(study: Study, site: Site) -> OrbiterPlaces:
    from lithobrake.smallbody import circle_places
    from lithobrake.smallbody.sky import PLACES

    orbiter = study.sky.orbiter
    assert orbiter is not None
    if orbiter.states is not None:
        states = orbiter_states(study)
        # Each stands for half the time to its neighbours.
        ends = np.concatenate([states.time[:1], 0.5 * (states.time[1:] + states.time[:-1]), states.time[-1:]])
        weight = np.diff(ends)
        return OrbiterPlaces(states.position, weight / weight.sum())
    if orbiter.kernel_name is not None:
        return OrbiterPlaces(
            _of_kernels(study, orbiter.kernel_name, sky_dates(study, PLACES)), np.full(PLACES, 1.0 / PLACES)
        )
    assert orbiter.altitude is not None
    inclination = 90.0 if orbiter.inclination_deg is None else orbiter.inclination_deg
    place = circle_places(site.body.shape.radius + orbiter.altitude, inclination)
    return OrbiterPlaces(place, np.full(PLACES, 1.0 / PLACES))


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
        turn = (block * count + np.arange(count)) * np.sqrt(2.0) % 1.0 if moves else np.zeros(count)
        angle = orbit.angle + 2.0 * np.pi * turn
        centre = orbit.distance * np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
        yield Screen(centre, 0.25 * float(extents[0] + extents[1]), 0.5 * float(extents[2]))
