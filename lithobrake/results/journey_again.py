"""One journey of a study: its touchdowns, and each of them made once more."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.results.journey_track import JourneyMotion, JourneyTrack, TouchdownFacts
from lithobrake.vocabulary.progress import Progress, silent

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies
    from lithobrake.results.study_results import StudyResults
    from lithobrake.results.table import Table
    from lithobrake.touchdown import Outcome


@dataclass(frozen=True, eq=False)
class StudyJourney:
    """One lander of a study from delivery to its end; `print` shows its touchdowns. Nothing is written."""

    results: "StudyResults"
    number: int

    @cached_property
    def touchdowns(self) -> "Table":
        """Its rows of the table `touchdowns`, in order: state in, state out, bed, soil, cost."""
        table = self.results.touchdowns
        return table.where(table["journey"] == self.number)

    @cached_property
    def track(self) -> JourneyTrack:
        """Where it went, and how it ended."""
        table, site = self.results.journeys, self.results.results.site
        (row,) = np.flatnonzero(table["journey"] == self.number)
        touchdowns = self.touchdowns
        rows = [{name: touchdowns[name][one] for name in touchdowns} for one in range(touchdowns.row_count)]
        return JourneyTrack(
            row={name: table[name][row] for name in table},
            touchdowns=tuple(map(TouchdownFacts.of, rows)),
            aim=(site.latitude_deg, site.longitude_deg),
            radius=float(np.linalg.norm(site.place_m)),
            vertices=self.results.body_shape[0],
        )

    def landing(self, touchdown: int, *, frame_count: int = 120, progress: Progress = silent) -> "Outcome":
        """A touchdown, counted from 0, made once more; see StudyResults.landing."""
        return self.results.landing(self._key(touchdown), frame_count=frame_count, progress=progress)

    def landing_bodies(self, touchdown: int, *, frame_count: int = 120, progress: Progress = silent) -> "MovingBodies":
        """The hulls of a touchdown made once more, and how they moved, the lander last."""
        return self.results.landing_bodies(self._key(touchdown), frame_count=frame_count, progress=progress)

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
            raise ValueError(f"touchdown is {touchdown}; allowed: 0 to {count - 1}, those of journey {self.number}")
        return str(self.touchdowns["key"][touchdown])

    def __repr__(self) -> str:
        """Its touchdowns and its end, in lines."""
        return "\n".join([f"Journey {self.number}", *self.track.lines()])


def _part(progress: Progress, number: int, count: int) -> Callable[[float, str], None]:
    """Progress of one of several touchdowns as a part of all."""
    return lambda done, what: progress((number + done) / count, f"touchdown {number}: {what}")
