"""In which axes, and counted from when, flights are passed on."""

from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.export.flown import Flown, body_name, has_journeys, study_body
from lithobrake.export.oem import parsed_epoch
from lithobrake.geometry.body_axes import axes_in_icrf
from lithobrake.results import StudyResults, Table

Floats = NDArray[np.float64]
FRAMES = ("inertial", "fixed", "icrf")
# An epoch that nobody takes for that of a landing.
NO_EPOCH = "2000-01-01T12:00:00"
# Files have times in whole microseconds [s].
RESOLUTION = 1e-6
POLE = ("pole_right_ascension_deg", "pole_declination_deg", "meridian_deg")


@dataclass(frozen=True)
class Frame:
    """Axes with their origin at that of the body's shape, and the clock of the states in them.

    kind    fixed: turn with the body; inertial: those that the body has at the epoch; icrf
    body    name of the body, as body_name gives it
    epoch   from which times count [UTC]
    clock   of the study: each lander at its own time after the epoch, that of the study; given: all first touchdowns
            are at an epoch that the user gave; none: at one that stands for no date
    axes    the body's axes at the epoch along the frame, in rows, [3, 3]
    """

    kind: str
    body: str
    epoch: datetime
    clock: str
    axes: Floats

    @classmethod
    def of(cls, results: StudyResults, kind: str, epoch: str | None) -> "Frame":
        """That of a study. Raises ValueError for a kind or an epoch that there is not, and for ICRF without a pole."""
        if kind not in FRAMES:
            raise ValueError(f"frame is {kind!r}; allowed: {', '.join(FRAMES)}")
        own = (results.study.get("delivery") or {}).get("epoch")
        clock = "given" if epoch is not None else "none" if own is None else "study"
        axes = _icrf_axes(results, clock, own) if kind == "icrf" else np.eye(3)
        start = own if clock == "study" else epoch
        return cls(kind, body_name(results), parsed_epoch(start or NO_EPOCH), clock, axes)

    @property
    def name(self) -> str:
        """As a file names it."""
        return "ICRF" if self.kind == "icrf" else f"{self.body}_{self.kind.upper()}"

    @property
    def sentences(self) -> str:
        """What the axes are, in words."""
        fixed = f"{self.body}_FIXED turns with the body: z along its spin, x at longitude 0, origin at the origin of "
        fixed += "its shape."
        if self.kind == "fixed":
            return f"{fixed} Velocities are against these turning axes."
        if self.kind == "icrf":
            return f"The origin is that of the shape of {self.body}, and moves with the body."
        return (
            f"{self.name} has the axes that {self.body}_FIXED has at REF_FRAME_EPOCH, and does not turn; {fixed} Its "
            "origin moves with the body."
        )

    @property
    def clock_sentence(self) -> str:
        """When the flights are, in words."""
        if self.clock == "study":
            return "Each lander is at its own time, counted from delivery.epoch of the study."
        end = "." if self.clock == "given" else ", which stands for no date: none was given."
        return f"All touchdowns are at the epoch of the frame{end}"

    def timed(self, results: StudyResults, flown: Flown) -> Flown:
        """Flights whose beginnings count from the epoch. Raises ValueError where the study does not tell when."""
        if self.clock != "study":
            return flown
        starts = _first_arcs(results)
        offset = dict(zip(starts["sample"].tolist(), _state_times(results, starts) - starts["begin_s"], strict=True))
        return replace(flown, begin=flown.begin + np.array([offset[one] for one in flown.sample.tolist()]))

    def timed_together(self, results: StudyResults, flown: Flown) -> Flown:
        """First flights that all begin at one time: that of their states, or the epoch where these have many."""
        if self.clock != "study":
            return flown
        times = _state_times(results, _first_arcs(results))
        return replace(flown, begin=np.full_like(flown.begin, times[0] if np.ptp(times) <= RESOLUTION else 0.0))

    def states(self, flown: Flown, time: Floats | float, position: Floats, velocity: Floats) -> Floats:
        """Position [m] and velocity [m/s], [count, 6], along these axes, of body-fixed ones at times in flight [s]."""
        both = (position, velocity) if self.kind == "fixed" else flown.inertial(time, position, velocity)
        return np.concatenate([one @ self.axes for one in both], axis=1)


def _icrf_axes(results: StudyResults, clock: str, own: str | None) -> Floats:
    """The body's axes at the epoch along ICRF, in rows. Raises ValueError where they are not known."""
    site = results.study["site"]
    lacking = [key for key in POLE if site.get(key) is None]
    if lacking:
        raise ValueError(
            f'frame is "icrf" and the study has no site.{lacking[0]}; write pole and meridian into its file, or choose '
            "another frame"
        )
    if clock == "none":
        raise ValueError('frame is "icrf", and its axes need an epoch: give the one at which site.meridian_deg holds')
    if clock == "given" and own is not None:
        raise ValueError(
            f'frame is "icrf" and epoch given; the study has {own}, at which site.meridian_deg holds: leave epoch out'
        )
    right_ascension, declination, meridian = (float(site[key]) for key in POLE)
    return np.asarray(axes_in_icrf(right_ascension, declination, np.radians(meridian)))


def _first_arcs(results: StudyResults) -> Table:
    """The first flight of each journey: from its state to the ground."""
    assert has_journeys(results), "an epoch of delivery goes with journeys"
    return results.arcs.where(results.arcs["arc"] == 0.0)


def _state_times(results: StudyResults, starts: Table) -> Floats:
    """Times of the states after delivery.epoch [s], for first flights that begin with them."""
    delivery: dict[str, Any] = results.study["delivery"]
    if delivery.get("release"):
        return np.full(starts.row_count, float(delivery["release"]["time"]))
    body = study_body(results, *(float(np.median(starts[f"site_{name}"])) for name in ("mass", "spin_period")))
    if body.partner is None:
        return starts["clock_s"]
    longitude = results.study["site"].get("partner_longitude_deg")
    # Over a body that always shows its partner the same face it stands at longitude 0 unless the study says so.
    if longitude is None and body.partner.period == body.spin_period:
        longitude = 0.0
    if not isinstance(longitude, int | float):
        raise ValueError(
            "the study tells no time of its states, as it draws where the partner stands; give an epoch, at which all "
            "first touchdowns are then, with another frame than icrf"
        )
    there = np.full(starts.row_count, float(longitude))
    return starts["clock_s"] - body.partner_time(there, starts["site_spin_period"])
