"""The landers of a set: where each is, on which ground, how it turns, and how it ended."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.smallbody.grounds import BodyGround, Moments, grounds_of
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import UNKNOWN_END

if TYPE_CHECKING:
    from lithobrake.smallbody.body import Body


@dataclass(kw_only=True)
class LanderStates:
    """Landers under way; one entry or row a lander, vectors fixed to the body that it is on.

    duration         longest journey [s]; most: touchdowns of each, after which it is under way; gravity and threads: as
                     of `fly`
    start            time of the first touchdown as of `fly` [s]; mass of `body` [kg] and spin_period [s]
    ground           that it is on, or was before it flew: its place among `grounds`; 0, that of `body`, for one aloft
    position         [m]; axes of the frame of the next touchdown, in rows; time since the first touchdown began [s]
    speed            [m/s], incidence_deg, mean_incidence_deg, spin and attitude: of the next impact, as ImpactStates
    end              a word of JourneyEnd, UNKNOWN_END, or "" while under way; reason: why it failed
    is_down          it is on the ground, not aloft or on a planet
    touchdowns       that have ended, and contacts with the ground in them
    path_length      sum of the straight lines between impacts and of paths in contact [m]
    contact_length   paths in contact with the ground alone [m], and contact_time: time of these [s]
    """

    body: "Body"
    duration: float
    gravity: str
    most: int
    threads: int | None = None
    start: Array
    mass: Array
    spin_period: Array
    position: Array
    axes: Array
    speed: Array
    incidence_deg: Array
    mean_incidence_deg: Array
    spin: Array
    ground: Integers = field(init=False)
    attitude: "list[Rotation | None]" = field(init=False)
    time: Array = field(init=False)
    end: np.ndarray = field(init=False)
    reason: list[str] = field(init=False)
    is_down: np.ndarray = field(init=False)
    touchdowns: Integers = field(init=False)
    contacts: Integers = field(init=False)
    path_length: Array = field(init=False)
    contact_length: Array = field(init=False)
    contact_time: Array = field(init=False)

    def __post_init__(self) -> None:
        count = len(self.position)
        self.attitude, self.reason = [None] * count, [""] * count
        # As wide as the longest of its words: NumPy cuts longer ones without notice.
        self.end = np.full(count, "", dtype=f"<U{max(map(len, (*JourneyEnd, UNKNOWN_END)))}")
        self.ground, self.is_down = np.zeros(count, dtype=np.int64), np.ones(count, dtype=bool)
        self.touchdowns, self.contacts = (np.zeros(count, dtype=np.int64) for _ in range(2))
        self.time, self.path_length = np.zeros(count), np.zeros(count)
        self.contact_length, self.contact_time = np.zeros(count), np.zeros(count)

    def __len__(self) -> int:
        return len(self.end)

    @cached_property
    def grounds(self) -> tuple[BodyGround, ...]:
        """The grounds on which landers are followed: that of the body, then that of its partner."""
        return grounds_of(self.body)

    @property
    def latitude(self) -> Array:
        """Planetocentric latitude of each [deg]."""
        latitude: Array = self.body.shape.latitude_longitude(self.position)[0]
        return latitude

    @property
    def longitude(self) -> Array:
        """East longitude of each, in (-180, 180] [deg]."""
        longitude: Array = self.body.shape.latitude_longitude(self.position)[1]
        return longitude

    @property
    def going(self) -> Integers:
        """Places of the landers that are under way."""
        return np.flatnonzero(self.end == "")

    def clock(self, which: Integers) -> Array:
        """Time of some landers as of `fly` [s]."""
        clock: Array = self.start[which] + self.time[which]
        return clock

    def moments(self, which: Integers) -> Moments:
        """The present times of some landers, and mass and spin period of the body."""
        return Moments(self.clock(which), self.mass[which], self.spin_period[which])

    def on_each(self, which: Integers) -> Iterator[tuple[BodyGround, Integers]]:
        """The grounds that some landers are on, each with the places of its landers among these."""
        for number, ground in enumerate(self.grounds):
            there = np.flatnonzero(self.ground[which] == number)
            if len(there):
                yield ground, there

    def acceleration(self, which: Integers) -> Array:
        """Of what rests where some landers are [m/s2], [count, 3], fixed to the body that each is on."""
        felt, when = np.empty((len(which), 3)), self.moments(which)
        for ground, there in self.on_each(which):
            felt[there] = ground.felt(self.position[which[there]], when.at(there))
        return felt

    def ground_spin(self, which: Integers, when: Moments | None = None) -> Array:
        """Angular velocity of the ground under some landers [rad/s], [count, 3], fixed to it; when: another time."""
        spin, when = np.empty((len(which), 3)), self.moments(which) if when is None else when
        for ground, there in self.on_each(which):
            spin[there] = ground.spin(when.at(there))
        return spin

    def turn_attitudes(self, which: Integers, turns: Array) -> None:
        """Turn the attitudes of some landers by matrices, [count, 3, 3]."""
        for lander, turn in zip(which.tolist(), turns, strict=True):
            attitude = self.attitude[lander]
            if attitude is not None:
                self.attitude[lander] = Rotation.from_matrix(turn) * attitude

    def inertia(self, lander: int) -> Array:
        """Inertia of a lander about its centre of mass [kg m2], [3, 3]; here that of a ball, in any unit."""
        return np.eye(3)
