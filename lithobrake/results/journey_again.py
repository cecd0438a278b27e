"""One journey of a study: its touchdowns, and each of them made once more."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lithobrake.results.journey_track import JourneyMotion, JourneyTrack, TouchdownFacts
from lithobrake.vocabulary.progress import Progress, silent
from lithobrake.vocabulary.screen import in_lines

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lithobrake.results.moving_bodies import MovingBodies
    from lithobrake.results.site_results import SiteResults
    from lithobrake.results.table import Table
    from lithobrake.touchdown import Outcome


@dataclass(frozen=True, eq=False)
class StudyJourney:
    """One lander of a study from delivery to its end; `print` shows its touchdowns. Nothing is written.

    track: where it went, and how it ended. touchdowns: its rows of the table `touchdowns`, in order: state in, state
    out, bed, soil, cost. land_again, bodies_again: StudyResults.landing and landing_bodies.
    """

    track: JourneyTrack
    touchdowns: "Table"
    land_again: "Callable[..., Outcome]"
    bodies_again: "Callable[..., MovingBodies]"

    def landing(self, touchdown: int, *, frame_count: int = 120, progress: Progress = silent) -> "Outcome":
        """A touchdown, counted from 0, made once more; see StudyResults.landing."""
        return self.land_again(self._key(touchdown), frame_count=frame_count, progress=progress)

    def landing_bodies(self, touchdown: int, *, frame_count: int = 120, progress: Progress = silent) -> "MovingBodies":
        """The hulls of a touchdown made once more, and how they moved, the lander last."""
        return self.bodies_again(self._key(touchdown), frame_count=frame_count, progress=progress)

    def motion(self, *, frame_count: int = 120, progress: Progress = silent) -> JourneyMotion:
        """All touchdowns made once more, but for one that failed."""
        numbers = [number for number, outcome in enumerate(self.touchdowns["outcome"]) if outcome not in ("", "failed")]
        shown = [
            self.landing_bodies(number, frame_count=frame_count, progress=_part(progress, number, len(numbers)))
            for number in numbers
        ]
        return JourneyMotion(self.track, shown)

    def _key(self, touchdown: int) -> str:
        """The key of a touchdown. Raises ValueError for a number that the journey has not."""
        count = self.touchdowns.row_count
        if not 0 <= touchdown < count:
            raise ValueError(
                f"touchdown is {touchdown}; allowed: 0 to {count - 1}, those of journey {self.track.number}"
            )
        return str(self.touchdowns["key"][touchdown])

    def __repr__(self) -> str:
        """Its touchdowns and its end, in lines."""
        return "\n".join([f"Journey {self.track.number}", *map(in_lines, self.track.lines())])


def track_of(
    row: Mapping[str, Any], touchdowns: "Table", site: "SiteResults", vertices: "NDArray[np.float64]"
) -> JourneyTrack:
    """The track of a journey: its row of `journeys`, its touchdowns, the aim point, and the body [m], [vertex, 3]."""
    rows = [{name: touchdowns[name][one] for name in touchdowns} for one in range(touchdowns.row_count)]
    aim = site.latitude_deg, site.longitude_deg
    return JourneyTrack(row, tuple(map(TouchdownFacts.of, rows)), aim, math.hypot(*site.place_m), vertices)


def _part(progress: Progress, number: int, count: int) -> Callable[[float, str], None]:
    """Progress of one of several touchdowns as a part of all."""
    return lambda done, what: progress((number + done) / count, f"touchdown {number}: {what}")
