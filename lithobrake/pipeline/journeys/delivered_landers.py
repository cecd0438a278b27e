"""Landers that are delivered to be followed: at the surface all of them touch down, from a release some may not."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.smallbody.landers import ENDS
from lithobrake.study.delivered_states import states_of
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.outcomes import FlightStatus
from lithobrake.vocabulary.quantities import REST_NUMBERS, UNKNOWN_END


@dataclass(frozen=True)
class DeliveredLanders:
    """Landers in their order, [count]: number of the journey, and refit of the emulator, that each keeps.

    begin: those that touch down; place: of each of these among all; end: of those that never do, "" of the others.
    """

    begin: Arrivals
    place: np.ndarray
    number: np.ndarray
    refit: np.ndarray
    end: np.ndarray

    @classmethod
    def at_surface(cls, begin: Arrivals) -> "DeliveredLanders":
        """Landers that all touch down."""
        count = len(begin.rows)
        return cls(begin, np.arange(count), begin.number, begin.refit, np.full(count, "", dtype=object))

    @classmethod
    def flown(cls, design: DrawnDesign, count: int) -> "DeliveredLanders":
        """So many landers of a study that flies them to the ground, each with one refit after the other.

        Of a release, landers that the study has not followed; of a file of states its rows, again where these are
        fewer.
        """
        first, drawn, delivery = len(design.beds), count, design.study.delivery
        if delivery is not None and delivery.states is not None:
            first, drawn = 0, min(len(states_of(design.study).time), count)
        descents, rows, beds = design.flown_landers(first, drawn)
        every, down = Arrivals.of_descents(descents, rows, beds, first), descents.touches_down
        which, refit = np.arange(count) % drawn, np.arange(count) % REFIT_COUNT
        status = zip(down.tolist(), descents.flights.status.tolist(), strict=True)
        ends = ["" if lands else str(ENDS[FlightStatus(word)]) for lands, word in status]
        place = np.flatnonzero(down[which])
        begin = every.taken(which[place], refit[place])
        return cls(begin, place, every.number[which], refit, np.array(ends, dtype=object)[which])

    @classmethod
    def joined(cls, parts: Sequence["DeliveredLanders"]) -> "DeliveredLanders":
        """Landers of several sets, one set after the other."""
        first = np.cumsum([0, *(len(one.end) for one in parts)])
        place = np.concatenate([one.place + start for one, start in zip(parts, first, strict=False)])
        number, refit, end = (
            np.concatenate([getattr(one, name) for one in parts]) for name in ("number", "refit", "end")
        )
        return cls(Arrivals.joined([one.begin for one in parts]), place, number, refit, end)

    def ends(self, landers: StudyLanders | None) -> np.ndarray:
        """How each ended, [count]; landers: those that touch down, None where nothing is known of these."""
        found = np.where(self.end == "", UNKNOWN_END, self.end)
        if landers is not None:
            found[self.place] = landers.end
        return found

    def rest_rows(self, rows: Sequence[Sequence[Any]]) -> list[list[Any]]:
        """REST_NUMBERS of each; rows: of those that touch down."""
        found: list[list[Any]] = [[0.0, *[""] * (len(REST_NUMBERS) - 1)] for _ in self.end]
        for place, row in zip(self.place.tolist(), rows, strict=True):
            found[place] = list(row)
        return found

    def of_all(self, values: np.ndarray) -> np.ndarray:
        """Numbers of those that touch down as those of all, 0 of the others, [count]."""
        found = np.zeros(len(self.end), dtype=values.dtype)
        found[self.place] = values
        return found
