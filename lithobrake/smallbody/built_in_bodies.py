"""Built-in bodies, generated from published extents."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.body import Body, Partner
from lithobrake.smallbody.shape import Shape
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES, KnownBody

# Ecliptic longitude and latitude of the pole [deg], of spin and mutual orbit: right ascension 69.327 and declination
# -72.725 deg (J2000) in the frames kernel of the Didymos system, version 007 (Nair 2023, JHU/APL; orbit solution 542,
# before the impact of DART). No flight depends on it.
DIDYMOS_POLE = (310.0, -80.6)
RINGS = 15  # between a pole and the band along the equator: 8 * 15 * 16 = 1920 facets


def didymos(*, partner: bool = True, extents: Sequence[float] | None = None) -> Body:
    """(65803) Didymos: a top shape with an equatorial ridge, extents 851 x 849 x 620 m, 5.32e11 kg, 2.2600 h.

    partner: Dimorphos attracts and may be hit; False leaves Didymos alone, as the published landing dispersion does.
    extents: others along x, y and z [m], None: these; the mass stays.

    The flanks are an ellipsoid; the ridge stands 20 m above it, narrowing over 12 degrees of latitude. Both are choices
    within the 15 m by which the extents are known; no boulder or crater is drawn. The pole is DIDYMOS_POLE.

    Sources: [Daly-2023] (extents, +-15 m); [Naidu-2020] (period before the DART impact). The mass is a choice inside
    the published 5.4 +- 0.4 e11 kg of the system less Dimorphos; the density follows as 2396 kg/m3, published is
    2400 +- 300.
    """
    return built_in_body("didymos", partner=partner, extents=extents)


def dimorphos(*, partner: bool = True, extents: Sequence[float] | None = None) -> Body:
    """Dimorphos: an ellipsoid of extents 177 x 174 x 116 m, 4.3e9 kg, turning in 11.3674 h, its orbit's period.

    partner: Didymos attracts and may be hit; it stands over longitude 0 at all times. False leaves Dimorphos alone.
    extents: others along x, y and z [m], None: these; the mass stays.

    One face towards Didymos is assumed, not measured: the impact of DART may have set it tumbling. Its shape is that
    before the impact. The orbit is taken as a circle (published eccentricity below 0.03) in the equator of Didymos; its
    radius follows from period, masses and flattenings as 1157 m, published are 1144 +- 70 m. The pole is that of the
    orbit, DIDYMOS_POLE.

    Sources: [Daly-2023] (extents and mass); [Naidu-2024] (period); [Thomas-2023] and [Scheirich-2024] (distance and
    eccentricity).
    """
    # From Dimorphos, which always shows the same face, Didymos never moves; it turns once in its own period.
    return built_in_body("dimorphos", partner=partner, extents=extents)


def built_in_body(name: str, *, partner: bool = True, extents: Sequence[float] | None = None) -> Body:
    """The built-in body of a name in lower case, as the functions of these names make it."""
    known, given = BUILT_IN_BODIES[name], None if extents is None else tuple(extents)
    if not partner:
        return _alone(known, given)
    assert known.partner is not None
    assert known.orbit_period is not None
    other = Partner(_alone(BUILT_IN_BODIES[known.partner]), period=known.orbit_period, longitude_deg=0.0)
    return replace(_alone(known, given), partner=other)


@lru_cache(maxsize=8)
def ball_partner(
    body: Body,
    name: str,
    mass: float,
    diameter: float,
    *,
    polar_diameter: float | None = None,
    spin_period: float | None = None,
    period: float | None = None,
    distance: float | None = None,
) -> Partner:
    """A partner of a body: a ball of a mass [kg] and a diameter [m] on a circle, flattened to a polar diameter [m].

    The orbit is given by its period [s], or by the distance of the centres [m]; with neither, the body keeps one face
    to its partner. Without a spin period [s] the partner always shows the body one face.
    """
    shape = _ball(diameter, name)
    if polar_diameter is not None:
        shape = Shape(shape.vertices * np.array([1.0, 1.0, polar_diameter / diameter]), shape.faces, name=name)
    ball = Body(shape, mass, body.spin_period, name)
    if distance is not None:
        # The orbit of Partner, the other way round.
        flattened = 1.0 + 1.5 * (body.flattening + ball.flattening) / distance**2
        total = body.gravitational_parameter + ball.gravitational_parameter
        period = 2.0 * math.pi * math.sqrt(distance**3 / (total * flattened))
    period = body.spin_period if period is None else period
    return Partner(replace(ball, spin_period=spin_period or period), period=period, longitude_deg=0.0)


def _ball(diameter: float, name: str) -> Shape:
    """A ball of facets whose volume and moments of inertia are those of one of a diameter [m]."""
    round_one = top_shape((diameter,) * 3, 0.0, name=name)
    # Rows of facets are not spread evenly over latitudes, so it is flattened by a thousandth.
    first, second, third = np.diag(round_one.inertia_per_density)
    stretch = math.sqrt((second + third - first) / (first + second - third))
    size = (math.pi / 6.0 * diameter**3 / (stretch * round_one.volume)) ** (1.0 / 3.0)
    return Shape(round_one.vertices * (size * np.array([1.0, 1.0, stretch])), round_one.faces, name=name)


# Moments, tables and grids of a shape are made once, and serve all who ask for its body.
@lru_cache(maxsize=8)
def _alone(known: KnownBody, extents: tuple[float, ...] | None = None) -> Body:
    shape = top_shape(extents or known.extents or (), known.ridge_height, name=known.key)
    return Body(shape, known.mass, known.spin_period, known.key)


def top_shape(extents: Sequence[float], ridge_height: float, *, name: str = "top") -> Shape:
    """An ellipsoid with a ridge around its equator; its bounding box has exactly the given extents [m].

    The ridge adds ridge_height exp(-(latitude / 12 degrees)**2) [m] to the radius. The mesh has a row of facets
    standing upright along the equator, so the normal at latitude 0, longitude 0 is +x.
    """
    directions, faces = _rings()
    semi = 0.5 * np.array(extents) - np.array([ridge_height, ridge_height, 0.0])
    radius = 1.0 / np.linalg.norm(directions / semi, axis=1)
    latitude = np.degrees(np.arcsin(directions[:, 2]))
    vertices = directions * (radius + ridge_height * np.exp(-((latitude / 12.0) ** 2)))[:, None]
    # Facets cut the corners of a smooth curve; half a percent brings the box back to what was published.
    vertices *= np.array(extents) / (vertices.max(axis=0) - vertices.min(axis=0))
    return Shape(vertices, faces, name=name)


def _rings() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Unit directions and facets: rings of 4, 8, 12 ... points around each pole, joined along the equator."""
    spacing = np.pi / (2 * RINGS + 1)
    first = [0, *(1 + np.cumsum([4 * i for i in range(RINGS)])).tolist()]
    angles = [np.zeros(1)] + [(np.arange(4 * i) + 0.5) * (0.5 * np.pi / i) for i in range(1, RINGS + 1)]
    turns = np.concatenate(angles)
    tilt = np.repeat(0.5 * np.pi - spacing * np.arange(RINGS + 1), [len(a) for a in angles])
    cap = np.stack([np.cos(tilt) * np.cos(turns), np.cos(tilt) * np.sin(turns), np.sin(tilt)], axis=1)
    # The cosine of a right angle is not 0 to the last bit.
    cap[0] = (0.0, 0.0, 1.0)
    facets = [facet for ring in range(RINGS) for facet in _strip(ring, first)]
    count, size = len(cap), 4 * RINGS
    north = np.array(facets, dtype=np.int64)
    rim = first[RINGS] + np.arange(size)
    after = first[RINGS] + (np.arange(size) + 1) % size
    band = np.concatenate(
        [np.stack([rim, rim + count, after + count], axis=1), np.stack([rim, after + count, after], axis=1)]
    )
    # Mirrored facets would face inwards, so their corners run the other way round.
    south = north[:, ::-1] + count
    return np.concatenate([cap, cap * [1.0, 1.0, -1.0]]), np.concatenate([north, south, band])


def _strip(ring: int, first: list[int]) -> list[list[int]]:
    """Facets between one ring and the next, which has one more point in each of the four sectors."""
    facets = []
    for sector in range(4):
        for i in range(ring + 1):
            outer = [first[ring + 1] + (sector * (ring + 1) + i + step) % (4 * (ring + 1)) for step in (0, 1)]
            inner = [first[ring] + (sector * ring + i + step) % max(4 * ring, 1) for step in (0, 1)]
            facets.append([inner[0], *outer])
            if i < ring:
                facets.append([inner[0], outer[1], inner[1]])
    return facets
