"""A small body: a shape with a mass that turns, alone or with a partner."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.smallbody import attraction
from lithobrake.smallbody.acceleration import Entry, Orbit
from lithobrake.smallbody.rotation import AttitudeHistory
from lithobrake.smallbody.shape import Shape, checked_points, delivered_directions
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT
from lithobrake.vocabulary.given_numbers import finite_number, numbers

# Each takes the error of an orbit's distance down by the part that flattening has in the attraction, a few percent.
ORBIT_ITERATIONS = 10
# Escape speed [m/s] above which a partner is a planet, on which landers are not followed: that of small bodies in pairs
# is below it, and what arrives faster does not bounce but breaks.
FASTEST_LANDING = 300.0


@dataclass(frozen=True)
class Body:
    """A shape of constant density, turning about +z through the origin of its frame.

    mass          [kg]
    spin_period   sidereal, counter-clockwise seen from +z [s]; infinite for a body that does not turn
    partner       the other body of a binary, which flights feel and may hit; None: the body is alone
    rotation      its attitudes against axes that turn so, for a body that does not; None: it turns as said

    Acceleration and potential are those of the body itself, without its partner. For the partner, its centre of mass
    counts as the origin.
    """

    shape: Shape
    mass: float
    spin_period: float
    name: str = "body"
    partner: "Partner | None" = None
    rotation: AttitudeHistory | None = None

    def __post_init__(self) -> None:
        finite_number(f"{self.name}: mass", self.mass, above=0.0)
        if not numbers(f"{self.name}: spin_period", self.spin_period) > 0.0:
            raise ValueError(
                f"{self.name}: spin_period is {self.spin_period} s; it must be above 0 (infinite: no spin)."
            )
        if self.partner is not None:
            apart, reach = self.orbit.distance, self.shape.radius + self.partner.body.shape.radius
            if apart <= reach:
                raise ValueError(
                    f"{self.name}: the partner's period of {self.partner.period:g} s puts the two centres "
                    f"{apart:.4g} m apart, within their radii together ({reach:.4g} m); give a longer period."
                )

    @cached_property
    def orbit(self) -> Orbit[float]:
        """How the partner moves in the frame of this body."""
        return self.orbit_with(self.gravitational_parameter, self.spin_rate)

    def orbit_with(self, parameter: Entry, spin_rate: Entry) -> Orbit[Entry]:
        """As orbit, with a G mass [m3/s2] and spin rate [rad/s] in place of the body's own; all 0 without a partner."""
        if self.partner is None:
            return Orbit(*(0.0 * parameter,) * 8)
        return self.partner.orbit(parameter, spin_rate, self.flattening)

    @property
    def density(self) -> float:
        """Mass over volume [kg/m3]."""
        return self.mass / self.shape.volume

    @property
    def gravitational_parameter(self) -> float:
        """G mass [m3/s2]."""
        return GRAVITATIONAL_CONSTANT * self.mass

    @property
    def flattening(self) -> float:
        """(C - (A + B) / 2) / mass [m2] of the moments of inertia, C about the spin axis: J2 times a radius squared."""
        # Averaged over a turn about z, off-diagonal moments and the difference of the two in the equator drop out.
        first, second, third = np.diag(self.shape.inertia_per_density)
        return float((third - 0.5 * (first + second)) / self.shape.volume)

    @property
    def spin_rate(self) -> float:
        """Angular velocity about +z [rad/s]."""
        return 2.0 * math.pi / self.spin_period

    def _field(self, points: ArrayLike) -> NDArray[np.float64]:
        p = checked_points(self.name, points)
        rows = p.reshape(-1, 3)
        field = attraction.field(rows, self.shape.gravity_at(rows)) * (GRAVITATIONAL_CONSTANT * self.density)
        return field.reshape(*p.shape[:-1], 5)

    def acceleration(self, points: ArrayLike) -> NDArray[np.float64]:
        """Gravity [m/s2] at body-fixed points [m], both of shape [..., 3], anywhere: outside, on and in the body."""
        return self._field(points)[..., :3]

    def potential(self, points: ArrayLike) -> NDArray[np.float64]:
        """Potential of gravity [m2/s2], positive, its gradient is the acceleration; points [m], shape [..., 3]."""
        potential: NDArray[np.float64] = self._field(points)[..., 3]
        return potential

    def laplacian(self, points: ArrayLike) -> NDArray[np.float64]:
        """Laplacian of the potential [1/s2]: -4 pi G density inside, half of it on a facet, 0 outside."""
        laplacian: NDArray[np.float64] = -self._field(points)[..., 4]
        return laplacian

    def effective_acceleration(
        self,
        points: ArrayLike,
        *,
        mass: ArrayLike | None = None,
        spin_period: ArrayLike | None = None,
        time: ArrayLike | None = None,
    ) -> NDArray[np.float64]:
        """Gravity and the push of rotation [m/s2] of points at rest in the body-fixed frame, both [..., 3].

        mass [kg] and spin_period [s], of shape [...], stand in place of the body's own. time [s], of shape [...]: the
        push is that of the body's history of rotation then, centrifugal and of the change of its spin; without one, or
        where time is None, that of the uniform spin.
        """
        p = checked_points(self.name, points)
        # The shape stays, so that gravity goes with the mass.
        ratio = numbers("mass", self.mass if mass is None else mass)[..., None] / self.mass
        periods = numbers("spin_period", self.spin_period if spin_period is None else spin_period)
        if not ((ratio > 0.0).all() and (periods > 0.0).all()):
            raise ValueError(f"mass is {mass!r} kg and spin_period {spin_period!r} s; both must be above 0.")
        spin_rate = 2.0 * math.pi / periods[..., None]
        if self.rotation is not None and time is not None:
            rates, times = (np.broadcast_to(one, p.shape[:-1]).ravel() for one in (spin_rate[..., 0], time))
            spin, change = (one.reshape(p.shape) for one in self.rotation.at(times).whole_spin(rates))
            return self.acceleration(p) * ratio - np.cross(spin, np.cross(spin, p)) - np.cross(change, p)
        return self.acceleration(p) * ratio + spin_rate**2 * p * np.array([1.0, 1.0, 0.0])

    def felt(self, points: Array, time: Array, mass: Array, spin_period: Array) -> Array:
        """Acceleration [m/s2] of what rests on the ground, [count, 3], body-fixed, at points [count, 3] and times [s].

        The partner acts by its tide: as a point, less what it does to the body as a whole. Rotation and tide are those
        at the times, where the body does not turn uniformly, too. mass [kg] and spin_period [s]: of each, [count].
        """
        own: Array = self.effective_acceleration(points, mass=mass, spin_period=spin_period, time=time)
        if self.partner is None:
            return own
        orbit = self.orbit_with(GRAVITATIONAL_CONSTANT * mass, 2.0 * np.pi / spin_period)
        if not np.any(orbit.distance):
            return own
        angle = orbit.angle + orbit.rate * time
        centre = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
        centre *= np.reshape(orbit.distance, (-1, 1))
        if self.rotation is not None:
            centre = self.rotation.at(time).out_of_frame(centre)
        way = centre - points
        strength = self.partner.body.gravitational_parameter
        near, mean = (one / np.linalg.norm(one, axis=1, keepdims=True) ** 3 for one in (way, centre))
        found: Array = own + strength * (near - mean)
        return found

    def slope(self, latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> NDArray[np.float64]:
        """Angle between the outward normal and the upward plumb line, gravity and rotation together [rad], shape [...].

        Above a right angle the ground does not hold what lies on it.
        """
        points, facets = self.shape.locate(latitude_deg, longitude_deg)
        felt = self.effective_acceleration(points)
        along = -(felt * self.shape.normals[facets]).sum(axis=-1) / np.linalg.norm(felt, axis=-1)
        slope: NDArray[np.float64] = np.arccos(np.clip(along, -1.0, 1.0))
        return slope

    def local_frame(
        self, latitude_deg: ArrayLike, longitude_deg: ArrayLike, heading_deg: ArrayLike = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Origins on the surface [m], shape [..., 3], and axes in rows, shape [..., 3, 3], all body-fixed.

        z is the outward normal of the facet, x lies in the facet at heading_deg from north, clockwise seen from outside
        as on a compass (90 is east), and y = z cross x. North is the direction of growing latitude laid into the facet,
        at a pole along the meridian of longitude_deg.
        """
        if not np.isfinite(numbers("heading_deg", heading_deg)).all():
            raise ValueError(f"heading_deg is {heading_deg!r}; it must be finite.")
        degrees = np.broadcast_arrays(latitude_deg, longitude_deg, heading_deg)
        points, facets = self.shape.locate(degrees[0], degrees[1])
        up = self.shape.normals[facets]
        latitudes, longitudes, headings = (np.radians(angle) for angle in degrees)
        c, s = np.cos(longitudes), np.sin(longitudes)
        meridian = np.stack([-np.sin(latitudes) * c, -np.sin(latitudes) * s, np.cos(latitudes)], axis=-1)
        north = meridian - (meridian * up).sum(axis=-1, keepdims=True) * up
        length = np.linalg.norm(north, axis=-1, keepdims=True)
        if (length < 1e-9).any():
            first = np.flatnonzero(length.reshape(-1) < 1e-9)[0]
            latitude, longitude = (float(angle.reshape(-1)[first]) for angle in degrees[:2])
            raise ValueError(
                f"{self.name}: the facet at latitude_deg {latitude}, longitude_deg {longitude} faces along the "
                "meridian, so north has no direction on it; choose a site beside it."
            )
        north /= length
        turn = headings[..., None]
        ahead = np.cos(turn) * north + np.sin(turn) * np.cross(north, up)
        return points, np.stack([ahead, np.cross(up, ahead), up], axis=-2)

    def delivered_frame(
        self,
        latitude_deg: ArrayLike,
        longitude_deg: ArrayLike,
        heading_deg: ArrayLike,
        north_error: ArrayLike,
        east_error: ArrayLike,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """As local_frame, of places that errors of delivery [m] moved north and east; every argument of shape [count].

        The way is that of a great circle as long as the error on a ball of the radius at the site: whatever its length,
        it ends on the body, and on a ball it is the way over the ground.
        """
        columns = np.column_stack([latitude_deg, longitude_deg, heading_deg, north_error, east_error])
        # Most studies have one site, or few: each is looked for once.
        unique, index = np.unique(columns, axis=0, return_inverse=True)
        latitude, longitude, heading, north, east = unique.T
        moved = (north != 0.0) | (east != 0.0)
        if moved.any():
            there = delivered_directions(self.shape, latitude[moved], longitude[moved], north[moved], east[moved])
            latitude[moved], longitude[moved] = self.shape.latitude_longitude(there)
        origin, axes = self.local_frame(latitude, longitude, heading)
        return origin[index.reshape(-1)], axes[index.reshape(-1)]

    @property
    def seen_from_partner(self) -> "Body":
        """The other body of the binary with this one as its partner, at the numbers of both, from a time 0 on.

        Its axes turn uniformly, and so do those of this body there. Raises ValueError for a body that is alone.
        """
        if self.partner is None:
            raise ValueError(f"{self.name} has no partner; allowed: a body of a binary.")
        there, alone = self.partner, replace(self, partner=None, rotation=None)
        return replace(there.body, partner=Partner(alone, there.period, there.facing_deg, there.longitude_deg))

    def partner_time(self, longitude_deg: ArrayLike, spin_period: ArrayLike) -> NDArray[np.float64]:
        """Times [s] at which the partner stands over these longitudes, for spin periods [s], all of shape [count].

        0 where it does not move or is none.
        """
        longitude = np.radians(longitude_deg)
        if self.partner is None:
            return np.zeros_like(longitude)
        # Against the ground, which turns as well; a partner over one place for good has no rate, and nothing to divide
        # by.
        rate = 2.0 * np.pi * (1.0 / self.partner.period - 1.0 / np.asarray(spin_period))
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(rate == 0.0, 0.0, (longitude - self.orbit.angle) / rate)


@dataclass(frozen=True)
class Partner:
    """The other body of a binary, seen from the one that holds this: it orbits in the sense of that one's spin.

    body            its shape, mass and spin, about the same direction
    period          of the mutual orbit [s]; the distance follows from it, both masses and both flattenings
    longitude_deg   east longitude of its centre at time 0, in the frame of the body that holds it
    facing_deg      the longitude on the partner that faces that body at time 0, and always where it turns once an orbit
    """

    body: "Body"
    period: float
    longitude_deg: float = 0.0
    facing_deg: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.period) and self.period > 0.0):
            raise ValueError(f"{self.body.name}: the orbit's period is {self.period} s; it must be finite and above 0.")
        if not (math.isfinite(self.longitude_deg) and math.isfinite(self.facing_deg)):
            raise ValueError(
                f"{self.body.name}: longitude_deg is {self.longitude_deg}, facing_deg {self.facing_deg}; both must be "
                "finite."
            )
        if self.body.partner is not None:
            raise ValueError(f"{self.body.name}: a partner has no partner of its own; give it partner=None.")

    @property
    def is_planet(self) -> bool:
        """Whether it is too heavy for landings: nothing arrives on it slower than FASTEST_LANDING."""
        return 2.0 * self.body.gravitational_parameter / self.body.shape.radius > FASTEST_LANDING**2

    def orbit(self, parameter: Entry, spin_rate: Entry, flattening: float) -> Orbit[Entry]:
        """Its motion in the frame of a body of this G mass [m3/s2] and spin rate [rad/s]: numbers, or one a flight.

        flattening: of that body [m2]. Both bodies attract as their second moments do on average over a turn. Source:
        [Murray-1999], chapter 5 (MacCullagh's formula).
        """
        total = parameter + self.body.gravitational_parameter
        mean_motion = 2.0 * math.pi / self.period
        distance = sphere = (total / mean_motion**2) ** (1.0 / 3.0)
        flattened = 1.5 * (flattening + self.body.flattening)
        for _ in range(ORBIT_ITERATIONS):
            distance = sphere * (1.0 + flattened / distance**2) ** (1.0 / 3.0)
        # Zero times the parameter makes it a number a flight where that is.
        angle = 0.0 * parameter + math.radians(self.longitude_deg)
        mass_fraction = self.body.gravitational_parameter / total
        return Orbit(
            distance=distance,
            angle=angle,
            rate=mean_motion - spin_rate,
            attitude=angle + math.pi - math.radians(self.facing_deg),
            swing=self.body.spin_rate - spin_rate,
            pull=mass_fraction * mean_motion**2 * distance,
            drift=mass_fraction * mean_motion * distance,
            mass_fraction=mass_fraction,
        )
