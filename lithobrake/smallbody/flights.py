"""How flights ended."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.body import Body

STATUSES = np.array(["flying", "impact", "escaped"])
ESCAPE_RADII = 10.0  # radii of the body beyond which a flight with positive energy has escaped


@dataclass(frozen=True)
class Flights:
    """How each flight ended; every array has one entry or row a flight.

    status          "impact", "flying" (still, at the end of the duration) or "escaped": farther from the origin than
                    ESCAPE_RADII times the farthest vertex, moving outwards, with positive two-body energy in the
                    inertial frame
    time            from the start to the end of the flight [s]
    position        [m], velocity [m/s], at that time in the body-fixed frame, shape [count, 3]
    latitude        planetocentric [deg], longitude east in (-180, 180] [deg], of that position
    impact_speed    relative to the turning ground [m/s]; nan where there was no impact
    incidence       angle between the incoming velocity and the facet's inward normal [rad]; nan likewise
    facet           index of the facet that was hit; -1 likewise
    step_count      steps that the integration tried
    """

    body: Body
    start_position: NDArray[np.float64]
    start_velocity: NDArray[np.float64]
    status: NDArray[np.str_]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    facet: NDArray[np.int64]
    step_count: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.status)

    @cached_property
    def latitude(self) -> NDArray[np.float64]:
        """Planetocentric latitude at the end [deg]."""
        return self.body.shape.latitude_longitude(self.position)[0]

    @cached_property
    def longitude(self) -> NDArray[np.float64]:
        """East longitude at the end, in (-180, 180] [deg]."""
        return self.body.shape.latitude_longitude(self.position)[1]

    @cached_property
    def impact_speed(self) -> NDArray[np.float64]:
        """Speed relative to the ground at the impact [m/s], nan without one."""
        return np.where(self.facet >= 0, np.linalg.norm(self.velocity, axis=1), np.nan)

    @cached_property
    def incidence(self) -> NDArray[np.float64]:
        """Angle of the incoming velocity from the facet's inward normal [rad], nan without an impact."""
        inward = -np.einsum("fi,fi->f", self.velocity, self.body.shape.normals[self.facet])
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.arccos(np.clip(inward / self.impact_speed, -1.0, 1.0))

    @cached_property
    def jacobi_drift(self) -> NDArray[np.float64]:
        """Change of the Jacobi constant from start to end [m2/s2]: the error of integration and gravity together."""
        return self.body.jacobi(self.position, self.velocity) - self.body.jacobi(
            self.start_position, self.start_velocity
        )
