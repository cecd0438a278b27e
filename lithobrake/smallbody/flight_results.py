"""How flights ended."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.body import Body
from lithobrake.smallbody.grounds import Moments, PartnerGround
from lithobrake.vocabulary.outcomes import FlightStatus
from lithobrake.vocabulary.plain_text import html_table

STATUSES = np.array([status.value for status in FlightStatus])
ESCAPE_RADII = 10.0  # radii of the body beyond which a flight with positive energy has escaped
ESCAPE_ORBITS = 4.0  # the same for a binary, in distances of the centres


@dataclass(frozen=True)
class StartStates:
    """How flights began; every array has one entry or row a flight.

    time            [s] (see fly)
    position        [m], velocity [m/s], body-fixed, shape [count, 3]
    mass            of the body [kg]; spin_period [s]
    """

    time: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    mass: NDArray[np.float64]
    spin_period: NDArray[np.float64]


@dataclass(frozen=True)
class Flights:
    """How each flight ended; every array has one entry or row a flight.

    start           how they began
    status          words of FlightStatus. "escaped": farther from the origin than ESCAPE_RADII times the farthest
                    vertex, moving outwards, with positive two-body energy in the inertial frame. In a binary: also
                    farther from the common centre of mass than ESCAPE_ORBITS times the distance of the two, with the
                    energy of both masses there
    time            from the start to the end of the flight [s]
    position        [m], velocity [m/s], at that time in the body-fixed frame, shape [count, 3]
    latitude        planetocentric [deg], longitude east in (-180, 180] [deg], of that position; of an impact on the
                    partner those on the partner
    impact_speed    relative to the turning ground that was hit [m/s]; nan where there was no impact
    incidence       angle between the incoming velocity and the facet's inward normal [rad]; nan likewise
    facet           index of the facet that was hit, of the body's or its partner's; -1 likewise
    step_count      steps that the integration tried
    """

    body: Body
    start: StartStates
    status: NDArray[np.str_]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    facet: NDArray[np.int64]
    step_count: NDArray[np.int64]

    def _repr_html_(self) -> str:
        """How many ended in which way, after how long and how fast, for a notebook."""
        rows = []
        for status in dict.fromkeys(self.status.tolist()):
            these = self.status == status
            impact = self.impact_speed[these]
            speed = float(np.median(impact)) if np.isfinite(impact).all() else "none"
            rows.append((status, int(these.sum()), float(these.mean()), float(np.median(self.time[these])), speed))
        head = ("ended", "flights", "share", "median time [s]", "median impact speed [m/s]")
        return html_table(f"{len(self)} flights around {self.body.name or 'a body'}", head, rows)

    def __len__(self) -> int:
        return len(self.status)

    @cached_property
    def on_ground(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Position [m] and velocity [m/s] at the end in the frame of the ground: the partner's where that was hit."""
        position, velocity = self.position.copy(), self.velocity.copy()
        hit = np.flatnonzero(self.status == FlightStatus.PARTNER)
        if len(hit) and self.body.partner is not None:
            when = Moments(self.start.time + self.time, self.start.mass, self.start.spin_period).at(hit)
            ground = PartnerGround(self.body.partner.body, self.body)
            position[hit], velocity[hit] = ground.states_on_ground(position[hit], velocity[hit], when)
        return position, velocity

    @cached_property
    def latitude(self) -> NDArray[np.float64]:
        """Planetocentric latitude at the end [deg]."""
        return self.body.shape.latitude_longitude(self.on_ground[0])[0]

    @cached_property
    def longitude(self) -> NDArray[np.float64]:
        """East longitude at the end, in (-180, 180] [deg]."""
        return self.body.shape.latitude_longitude(self.on_ground[0])[1]

    @cached_property
    def impact_speed(self) -> NDArray[np.float64]:
        """Speed relative to the ground at the impact [m/s], nan without one."""
        return np.where(self.facet >= 0, np.linalg.norm(self.on_ground[1], axis=1), np.nan)

    @cached_property
    def normals(self) -> NDArray[np.float64]:
        """Outward normal of the facet that was hit, in the frame of its ground, [count, 3]; nan without an impact."""
        normals = np.full((len(self), 3), np.nan)
        hit = self.status == FlightStatus.IMPACT
        normals[hit] = self.body.shape.normals[self.facet[hit]]
        if self.body.partner is not None:
            hit = self.status == FlightStatus.PARTNER
            normals[hit] = self.body.partner.body.shape.normals[self.facet[hit]]
        return normals

    @cached_property
    def incidence(self) -> NDArray[np.float64]:
        """Angle of the incoming velocity from the facet's inward normal [rad], nan without an impact."""
        inward = -np.einsum("fi,fi->f", self.on_ground[1], self.normals)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.arccos(np.clip(inward / self.impact_speed, -1.0, 1.0))

    @cached_property
    def jacobi_drift(self) -> NDArray[np.float64]:
        """Change of the Jacobi constant from start to end [m2/s2]: the error of integration and gravity together.

        With a partner, or where the body does not turn uniformly, there is no such constant: nan.
        """
        if self.body.partner is not None or self.body.rotation is not None:
            return np.full(len(self), np.nan)
        return self._jacobi(self.position, self.velocity) - self._jacobi(self.start.position, self.start.velocity)

    def _jacobi(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> NDArray[np.float64]:
        """Half the squared speed, less that of the turning ground, less the potential, of each flight [m2/s2]."""
        spin_rate = 2.0 * np.pi / self.start.spin_period
        turning = spin_rate**2 * (position[:, 0] ** 2 + position[:, 1] ** 2)
        # The shape is one for all flights, so their potentials differ by the mass alone.
        depth = self.body.potential(position) * (self.start.mass / self.body.mass)
        constant: NDArray[np.float64] = 0.5 * ((velocity * velocity).sum(axis=1) - turning) - depth
        return constant
