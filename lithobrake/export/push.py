"""A hop of landers at rest: their states just after a commanded push, as the delivery of the next study."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.export.flown import refuse_rotation
from lithobrake.files.atomic import write_rows
from lithobrake.files.reading import content_hash, hashed_seed
from lithobrake.results import StudyResults
from lithobrake.smallbody import Body, Shape
from lithobrake.vocabulary.file_names import JOURNEYS_FILE
from lithobrake.vocabulary.given_numbers import finite_number, whole_number
from lithobrake.vocabulary.outcomes import JourneyEnd

TITLES = (
    "time_s", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "q_w", "q_x", "q_y", "q_z",
    "rate_x_rad_s", "rate_y_rad_s", "rate_z_rad_s",
)  # fmt: skip
# Beyond it errors along two axes are no angles any more.
WIDEST_DEG = 30.0


@dataclass(frozen=True)
class Push:
    """A commanded change of velocity of a lander at rest.

    speed [m/s] and its standard deviation; elevation above the plane of the ground, heading from north toward east, and
    the standard deviation of the direction along either of two axes across it [deg]; spin: angular velocity that the
    push leaves, against the ground, about the horizontal axis to the left of the velocity [rad/s]; seed of the errors.
    Raises ValueError for numbers out of range.
    """

    speed: float
    elevation_deg: float
    heading_deg: float = 0.0
    speed_std: float = 0.0
    direction_std_deg: float = 0.0
    spin: float = 0.0
    seed: int = 1

    def __post_init__(self) -> None:
        finite_number("speed", self.speed, above=0.0)
        finite_number("elevation_deg", self.elevation_deg, above=0.0, at_most=90.0)
        for name in ("heading_deg", "spin"):
            finite_number(name, getattr(self, name))
        finite_number("speed_std", self.speed_std, at_least=0.0)
        finite_number("direction_std_deg", self.direction_std_deg, at_least=0.0, at_most=WIDEST_DEG)
        whole_number("seed", self.seed, 0)

    def velocities(self, north: np.ndarray, up: np.ndarray, hop: str = "") -> np.ndarray:
        """Velocities [m/s] from places with these unit vectors, all [count, 3]; errors that point down are mirrored.

        hop: words that tell one hop from the next, whose errors are others.
        """
        drawn = np.random.default_rng(hashed_seed(self.seed, "push", hop)).standard_normal((len(up), 3))
        east = np.cross(north, up)
        elevation, heading = math.radians(self.elevation_deg), math.radians(self.heading_deg)
        ahead = math.cos(heading) * north + math.sin(heading) * east
        left, along = np.cross(up, ahead), math.cos(elevation) * ahead + math.sin(elevation) * up
        errors = np.radians(self.direction_std_deg) * drawn[:, :2]
        direction = along + errors[:, :1] * left + errors[:, 1:] * np.cross(along, left)
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        below = np.minimum((direction * up).sum(axis=1), 0.0)
        direction -= 2.0 * below[:, None] * up
        speed = np.abs(self.speed + self.speed_std * drawn[:, 2])
        return np.asarray(speed[:, None] * direction)


def _north(up: np.ndarray) -> np.ndarray:
    """The direction to the pole of the spin, laid into grounds with these normals, [count, 3].

    Along x where the ground faces a pole and has no north.
    """
    pole = np.broadcast_to([0.0, 0.0, 1.0], up.shape)
    laid = np.where(np.abs(up[:, 2:]) < 1.0 - 1e-12, pole, [1.0, 0.0, 0.0])
    laid = laid - (laid * up).sum(axis=1, keepdims=True) * up
    north: np.ndarray = laid / np.linalg.norm(laid, axis=1, keepdims=True)
    return north


def write_push(results: StudyResults, path: Path, push: Push) -> int:
    """Write a state for each lander at rest, just after a push, as `delivery.states` takes it; returns their number.

    Body-fixed, at time 0, in the order of the journeys. Raises ValueError where no lander with an attitude is at rest,
    or the body does not turn uniformly.
    """
    refuse_rotation(results)
    table = results.journeys
    chosen = np.flatnonzero((table["end"] == JourneyEnd.AT_REST) & np.isfinite(table["attitude_w"]))
    if not len(chosen):
        raise ValueError(f"{results.folder} has no lander at rest whose attitude is known; none can be pushed")
    place = np.column_stack([table[f"position_{axis}"] for axis in "xyz"])[chosen]
    body = Body(Shape(*results.body_shape), results.results.site.mass_kg, results.results.site.spin_period_s)
    # The facet on which a lander rests, also under an overhang.
    up = body.shape.normals[body.shape.nearest(place)[1]]
    velocity = push.velocities(_north(up), up, content_hash(results.folder / JOURNEYS_FILE))
    attitude = np.column_stack([table[f"attitude_{part}"] for part in "wxyz"])[chosen]
    aside = np.cross(up, velocity)
    # A push straight up has no side, and leaves no spin.
    length = np.linalg.norm(aside, axis=1)[:, None]
    rate = push.spin * np.divide(aside, length, out=np.zeros_like(aside), where=length > 0.0)
    rate[:, 2] += body.spin_rate
    own = Rotation.from_quat(attitude, scalar_first=True).inv().apply(rate)
    rows = np.column_stack([np.zeros(len(chosen)), place, velocity, attitude, own])
    write_rows(path, TITLES, rows.tolist())
    return len(chosen)
