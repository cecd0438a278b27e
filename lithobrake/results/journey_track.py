"""One journey in numbers and words, and its touchdowns made once more."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lithobrake.geometry.attitude import angles, directions
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.known_bodies import printed_name
from lithobrake.vocabulary.number_words import counted, duration
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.plain_text import in_lines, short_repr
from lithobrake.vocabulary.quantities import IMPACT_INCIDENCE, IMPACT_SPEED

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lithobrake.results.motions import MovingBodies
    from lithobrake.results.site_results import SiteResults
    from lithobrake.results.table import Table
    from lithobrake.touchdown import Outcome

HEADS = (
    "touch-     after      impact   incidence   rebound   on the bed  to the next",
    " down    delivery     [m/s]      [deg]      [m/s]        [s]         [m]",
)
_FAILED = "failed"
# A body by its name, and latitude and longitude on it [deg].
Place = tuple[str, float, float]


@dataclass(frozen=True)
class TouchdownFacts:
    """A touchdown of a journey in numbers.

    number: in its journey, from 0. begin, end: since delivery [s]. speed [m/s], incidence_deg from the
    surface normal: of the impact. outcome: how it ended. speed_out [m/s]: None unless the lander flies on.
    latitude_deg, longitude_deg: of the impact; body: on whose ground it is; radius: of that body there [m].
    """

    number: int
    begin: float
    end: float
    speed: float
    incidence_deg: float
    outcome: str
    speed_out: float | None
    latitude_deg: float
    longitude_deg: float
    body: str
    radius: float

    @classmethod
    def of(cls, row: Mapping[str, Any], descent: float) -> "TouchdownFacts":
        """Those of a row of touchdowns, by the names of the table `touchdowns` of a study's results.

        descent: time from delivery to the first touchdown [s], from which the table counts.
        """
        left = row["outcome"] == TouchdownOutcome.CLEAR
        return cls(
            number=int(row["touchdown"]),
            begin=descent + float(row["begin_s"]),
            end=descent + float(row["end_s"]),
            speed=float(row[IMPACT_SPEED]),
            incidence_deg=float(row[IMPACT_INCIDENCE]),
            outcome=str(row["outcome"]) or _FAILED,
            speed_out=float(row["speed_out"]) if left else None,
            latitude_deg=float(row["latitude_deg"]),
            longitude_deg=float(row["longitude_deg"]),
            body=str(row["body"]),
            radius=math.hypot(*(float(row[f"position_{axis}"]) for axis in "xyz")),
        )

    @property
    def left(self) -> str:
        """The speed with which the lander flies on, or how it ended else."""
        short: dict[str, str] = {TouchdownOutcome.CAPTURED: "at rest", TouchdownOutcome.TIME_LIMIT: "time is up"}
        return short.get(self.outcome, self.outcome) if self.speed_out is None else f"{self.speed_out:.3g}"

    @property
    def place(self) -> Place:
        """Body, latitude and longitude of the impact [deg]."""
        return self.body, self.latitude_deg, self.longitude_deg

    def to_next(self, there: Place | None, radius: float, end: JourneyEnd | None) -> str:
        """How far it is over the ground to the next touchdown [m], or, where there is none, how the last flight ended.

        there: where the next is; radius: of the body [m], as if it were a ball.
        """
        if there is not None and there[0] != self.body:
            return f"to {printed_name(there[0])}"
        if there is not None:
            return f"{radius * float(angles(directions(*self.place[1:]), directions(*there[1:]))):.3g}"
        return end.label if end is not None and self.speed_out is not None else ""

    def cells(self, to_next: str) -> tuple[str, ...]:
        """What stands under HEADS."""
        numbers = f"{self.speed:.3g}", f"{self.incidence_deg:.0f}", self.left, f"{self.end - self.begin:.0f}"
        return str(self.number), duration(self.begin), *numbers, to_next

    def line(self, to_next: str) -> str:
        """These as a line under HEADS."""
        widths = 5, 11, 11, 10, 13, 11, 13
        text = "".join(f"{cell:>{width}}" for cell, width in zip(self.cells(to_next), widths, strict=True))
        return text.rstrip()

    @property
    def words(self) -> str:
        """A caption: number, time since delivery, impact."""
        impact = f"{self.speed:.3g} m/s at {self.incidence_deg:.0f} deg"
        return f"touchdown {self.number}, {duration(self.begin)} after delivery: {impact}"


@dataclass(frozen=True, eq=False)
class JourneyTrack:
    """Places of one lander in order, and its end.

    row: of the table `journeys`, nothing where it has nothing. aim: latitude and longitude of the aim point [deg];
    radius: of the body there [m]; vertices of the body [m], shape [vertex, 3], body-fixed. descent: time from delivery
    to the first touchdown [s]. partner: name of the other body of a binary.
    """

    row: Mapping[str, Any]
    touchdowns: tuple[TouchdownFacts, ...]
    aim: tuple[float, float]
    radius: float
    vertices: "NDArray[np.float64]"
    descent: float
    partner: str | None
    __repr__ = short_repr

    @property
    def number(self) -> int:
        """Number of the journey, from 0."""
        return int(self.row["journey"])

    @property
    def end(self) -> JourneyEnd:
        """How it ended."""
        return JourneyEnd(self.row["end"])

    @property
    def end_place(self) -> Place | None:
        """Where the end is; None where the lander is not on the ground."""
        latitude, longitude = self.row["latitude_deg"], self.row["longitude_deg"]
        return (str(self.row["body"]), latitude, longitude) if _is_there(latitude) else None

    @property
    def places_on_body(self) -> list[tuple[float, float]]:
        """Latitude and longitude [deg] of each touchdown on the body of the aim point, NaN of one on the partner."""
        places = [one.place for one in self.touchdowns]
        return [(math.nan, math.nan) if place[0] == self.partner else place[1:] for place in places]

    @property
    def end_label(self) -> str:
        """How it ended, in a few words, with the body on which it rests where that is the partner."""
        on_partner = self.end is JourneyEnd.PARTNER and self.row["body"]
        return f"at rest on {printed_name(self.row['body'])}" if on_partner else self.end.label

    def to_next(self, number: int) -> str:
        """How far it is from a touchdown to the next, or what became of the last flight."""
        there = self.touchdowns[number + 1].place if number + 1 < len(self.touchdowns) else None
        here = self.touchdowns[number]
        return here.to_next(there, here.radius if here.body == self.partner else self.radius, self.end)

    def lines(self) -> list[str]:
        """A line for each touchdown, under two lines of heads, and the end."""
        rows = [one.line(self.to_next(number)) for number, one in enumerate(self.touchdowns)]
        return [*HEADS, *rows, self.end_words]

    @property
    def end_words(self) -> str:
        """How, when and where it ended, after how many contacts, and how the lander lies, in a sentence."""
        contacts, touchdowns = int(self.row["contacts"]), len(self.touchdowns)
        label = self.end_label
        said = f"{label[:1].upper()}{label[1:]} {duration(self.descent + self.row['time_s'])} after delivery, after "
        said += f"{counted(contacts, 'contact')} in {counted(touchdowns, 'touchdown')}"
        if self.end_place is not None:
            body, latitude, longitude = self.end_place
            said += f", at latitude {latitude:.3f} and longitude {longitude:.3f} deg"
            if body == self.partner:
                said += "" if self.end is JourneyEnd.PARTNER else f" on {printed_name(body)}"
            else:
                said += f", {self.row['distance']:.3g} m from the aim point"
        if self.row["face"]:
            said += f"; side {self.row['face']} is down, tilted by {self.row['tilt_deg']:.1f} deg"
        return f"{said}: {self.row['reason']}." if self.row["reason"] else f"{said}."


@dataclass(frozen=True, eq=False)
class JourneyMotion:
    """A journey with the bodies of its touchdowns and how they moved, in their order; the lander is the last body.

    A touchdown that failed has no bodies, and is the last of its journey.
    """

    track: JourneyTrack
    bodies: "Sequence[MovingBodies]"


def _is_there(cell: Any) -> bool:
    return cell != "" and not math.isnan(cell)


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
    row: Mapping[str, Any], touchdowns: "Table", arcs: "Table", site: "SiteResults", vertices: "NDArray[np.float64]"
) -> JourneyTrack:
    """The track of a journey: its row of `journeys`, its touchdowns and flights, the aim point, and the body [m],
    [vertex, 3].
    """
    rows = [{name: touchdowns[name][one] for name in touchdowns} for one in range(touchdowns.row_count)]
    descent = descent_time(arcs["begin_s"].tolist())
    facts = tuple(TouchdownFacts.of(one, descent) for one in rows)
    return JourneyTrack(
        row, facts, (site.latitude_deg, site.longitude_deg), math.hypot(*site.place_m), vertices, descent, site.partner
    )


def descent_time(begins: Sequence[float]) -> float:
    """Time from delivery to the first touchdown [s]: begins of the flights of a journey count from that touchdown."""
    return max(-begins[0], 0.0) if begins else 0.0


def _part(progress: Progress, number: int, count: int) -> Progress:
    """Progress of one of several touchdowns as a part of all."""
    return lambda done, what: progress((number + done) / count, f"touchdown {number}: {what}")
