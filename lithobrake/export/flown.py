"""The flights of a finished study, made again from its files to see where each was in between.

A flight is one arc of a journey: the first, from the touchdown to the next impact, or one between later impacts.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake import smallbody
from lithobrake.results import StudyResults, Table
from lithobrake.smallbody import Body, Flights, Shape, fly
from lithobrake.smallbody.built_in_bodies import ball_partner
from lithobrake.study import BUILT_IN_BODIES
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.outcomes import FlightStatus
from lithobrake.vocabulary.plain_text import program_name

# Arrays of Flown with an entry or row a flight.
_EACH = (
    "sample", "arc", "begin", "start_time", "position", "velocity", "mass", "spin_period", "end_time", "duration",
)  # fmt: skip


@dataclass(frozen=True)
class ExportOptions:
    """Options of exported files: flights, frame, epoch, step, resolution.

    samples       whose flights or attitudes are passed on, by their number in flights.csv, or of journeys
    frame         "inertial": axes that do not turn and are the body's at the epoch; "fixed": body-fixed axes; "icrf":
                  through pole and meridian of the study
    epoch         at which all first touchdowns are [UTC]; None: each lander at its own time after delivery.epoch of the
                  study; where that has none, an epoch that stands for no date, and the file says so
    step          between states [s]; None: a hundredth of the longest flight, and between attitudes as long as the
                  lander takes to turn by 10 degrees at most
    resolution_deg   edge of a cell of the map, at least 0.05 (26 million cells, 104 MB); it has to divide 180
    run           whose landing is made again, by its row in `runs`, its key, or how that begins; None: the one that the
                  study keeps
    replaces      write over files that exist
    progress      told the fraction that is done of such a landing, or of the flights, and what is being done
    body_number   of the body in SPICE; None: that of a built-in body, or of kernel_body in the study
    """

    samples: Sequence[int] = ()
    frame: str = "inertial"
    epoch: str | None = None
    step: float | None = None
    resolution_deg: float = 1.0
    run: str | int | None = None
    replaces: bool = False
    progress: Progress = silent
    body_number: int | None = None

    def __post_init__(self) -> None:
        # Samples that are asked for twice stand once.
        object.__setattr__(self, "samples", tuple(dict.fromkeys(self.samples)))


@dataclass(frozen=True)
class Flown:
    """Flights of a study, all at the same time since their starts; one row or entry a flight.

    time           since the start [s]
    sample         row in samples.h5
    arc            number of the flight in the sample's journey, from 0
    begin          of the flight, since the touchdown [s]
    start_time     of the flight in the clock of the partner's motion [s]: start_time of smallbody.fly
    position       at the time [m], velocity [m/s], body-fixed, [count, 3]
    mass           of the body [kg]; spin_period [s]
    end_time       from the start to the end of the flight [s]
    gravity        as the study has it: table or exact; duration: for how long the flight was allowed to last [s]
    """

    body: Body
    time: float
    sample: NDArray[np.int64]
    arc: NDArray[np.int64]
    begin: Array
    start_time: Array
    position: Array
    velocity: Array
    mass: Array
    spin_period: Array
    end_time: Array
    duration: Array
    gravity: str

    @classmethod
    def of(cls, results: StudyResults) -> "Flown":
        """All flights of a study to the next impact, of journeys of landings the first of each.

        Raises ValueError where it has none.
        """
        if has_journeys(results):
            # As if all of them left at once.
            first = cls._of_arcs(results, results.arcs.where(results.arcs["arc"] == 0.0))
            return replace(first, begin=np.zeros(len(first.sample)))
        table = results.flights
        if not table.row_count:
            raise ValueError(f"{results.folder / 'flights.csv'} has no flights: no sample left the surface")
        mass, spin_period = table["site_mass"], table["site_spin_period"]
        body = study_body(results, float(np.median(mass)), float(np.median(spin_period)))
        where = ("latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error")
        origin, axes = body.delivered_frame(*(table[f"site_{name}"] for name in where))
        local = np.column_stack([table[f"velocity_{axis}"] for axis in "xyz"])
        return cls(
            body=body,
            time=0.0,
            sample=table["sample"].astype(np.int64),
            arc=np.zeros(table.row_count, dtype=np.int64),
            begin=np.zeros(table.row_count),
            start_time=body.partner_time(table["site_partner_longitude_deg"], spin_period),
            position=origin,
            velocity=np.einsum("nij,ni->nj", axes, local),
            mass=mass,
            spin_period=spin_period,
            end_time=table["time_s"],
            duration=np.full(table.row_count, results.study["flight"]["duration"]),
            gravity=results.study["flight"]["gravity"],
        )

    def journeys(self, results: StudyResults, samples: Sequence[int]) -> "Flown":
        """All flights of these landers, or of these samples the flight to the next impact.

        Raises ValueError for one that did not fly.
        """
        chosen = self.of_samples(samples)
        if not samples or not has_journeys(results):
            return chosen
        return self._of_arcs(results, results.arcs.where(np.isin(results.arcs["sample"], samples)))

    @classmethod
    def _of_arcs(cls, results: StudyResults, arcs: Table) -> "Flown":
        """Flights of journeys of landings. Raises ValueError where there is none."""
        if not arcs.row_count:
            raise ValueError(f"{results.folder / 'arcs.csv'} has no flights: no lander left the surface")
        body = study_body(results, *(float(np.median(arcs[f"site_{name}"])) for name in ("mass", "spin_period")))
        noted = _noted(arcs, results.study["journey"]["duration"])
        return cls(body=body, time=0.0, gravity=results.study["flight"]["gravity"], **noted)

    def of_samples(self, samples: Sequence[int]) -> "Flown":
        """The flights of these samples, in their order. Raises ValueError for a sample that did not fly."""
        rows = {sample: row for row, sample in enumerate(self.sample.tolist())}
        lacking = [sample for sample in samples if sample not in rows]
        if lacking:
            first, last = self.sample[0], self.sample[-1]
            raise ValueError(
                f"sample {lacking[0]} has no flight; the {len(rows)} samples with one lie from {first} to {last}: take "
                "numbers of the column sample of flights.csv, or of arcs.csv where a study follows journeys"
            )
        return self._rows(np.array([rows[sample] for sample in samples], dtype=np.int64))

    def at(self, time: float) -> "Flown":
        """Those that still fly at a later time after the start [s], flown on to it."""
        aloft = self._rows(np.flatnonzero(self.end_time > time))
        if not len(aloft.sample):
            return aloft
        flights = aloft._flights(time - self.time)
        # In pieces a flight may meet the partner, whose ground moves, a little before its end.
        on = np.flatnonzero(flights.status != FlightStatus.PARTNER)
        return replace(aloft._ended(flights), time=time)._rows(on)

    def ends(self) -> tuple[Array, Array]:
        """Position [m] and velocity [m/s], body-fixed, [count, 3], at the end of flights that begin here.

        They go as the study flew them, in one piece, and so end where it says to the last bit.
        """
        flights = self._flights(self.duration - self.time)
        return flights.position, flights.velocity

    def inertial(self, time: Array | float, position: Array, velocity: Array) -> tuple[Array, Array]:
        """Body-fixed states at times since the start [s] in axes that do not turn, the body's at the touchdown."""
        rate = 2.0 * np.pi / self.spin_period
        spin, angle = np.outer(rate, [0.0, 0.0, 1.0]), rate * (self.begin + time)
        c, s = np.cos(angle), np.sin(angle)
        turned = []
        for vector in (position, velocity + np.cross(spin, position)):
            x, y, z = vector.T
            turned.append(np.column_stack([c * x - s * y, s * x + c * y, z]))
        return turned[0], turned[1]

    def _flights(self, duration: Array | float) -> Flights:
        """Flights that go on for so long [s], or to their end."""
        return fly(
            *(self.body, self.position, self.velocity, duration),
            gravity=self.gravity,
            start_time=self.start_time + self.time,
            mass=self.mass,
            spin_period=self.spin_period,
        )

    def _ended(self, flights: Flights) -> "Flown":
        """The same at the ends of these flights."""
        return replace(self, position=flights.position, velocity=flights.velocity)

    def _rows(self, rows: NDArray[np.int64]) -> "Flown":
        return replace(self, **{name: getattr(self, name)[rows] for name in _EACH})


def has_journeys(results: StudyResults) -> bool:
    """Whether landers were followed beyond the first touchdown, so that their flights are passed on."""
    return results.results.journeys > 0 and results.study["journey"]["touchdowns"] != 1


def flight_count(results: StudyResults) -> int:
    """Number of flights that `Flown.of` gives."""
    return int((results.arcs["arc"] == 0.0).sum()) if has_journeys(results) else results.flights.row_count


def _noted(arcs: Table, duration: float) -> dict[str, Any]:
    """Flights as a table has them that notes where each began; duration: of the journeys [s]."""
    position, velocity = (np.column_stack([arcs[f"{of}_{axis}"] for axis in "xyz"]) for of in ("position", "velocity"))
    return {
        "sample": arcs["sample"].astype(np.int64),
        "arc": arcs["arc"].astype(np.int64),
        "begin": arcs["begin_s"],
        "start_time": arcs["clock_s"],
        "position": position,
        "velocity": velocity,
        "mass": arcs["site_mass"],
        "spin_period": arcs["site_spin_period"],
        "end_time": arcs["end_s"] - arcs["begin_s"],
        # Before the first touchdown a lander may fly as long as after it.
        "duration": duration - np.maximum(arcs["begin_s"], 0.0),
    }


def study_body(results: StudyResults, mass: float, spin_period: float) -> Body:
    """The body of a study from body.obj, with the partner that the study gave it.

    Raises ValueError for a body with a rotation of its own.
    """
    refuse_rotation(results)
    site, name = results.study["site"], body_name(results)
    is_built_in = site["body"] in BUILT_IN_BODIES
    partner = smallbody.built_in_body(site["body"], partner=site["partner"]).partner if is_built_in else None
    vertices, faces = results.body_shape
    # A study of before this key has none.
    shape = _shape(vertices.tobytes(), faces.tobytes(), name, site.get("gravity_facets"))
    body = Body(shape, mass, spin_period, name, partner)
    given = site.get("partner_body")
    return body if given is None else replace(body, partner=ball_partner(body, **given))


# Files of several kinds are written of one study: moments, grid and table of its body are made once for all of them.
@lru_cache(maxsize=2)
def _shape(vertices: bytes, faces: bytes, name: str, gravity_facets: int | None) -> Shape:
    """The shape of arrays of three numbers a row, by their content."""
    return Shape(
        np.frombuffer(vertices, np.float64).reshape(-1, 3),
        np.frombuffer(faces, np.int64).reshape(-1, 3),
        name=name,
        gravity_facets=gravity_facets,
    )


def refuse_rotation(results: StudyResults) -> None:
    """Raise ValueError where the body of a study does not turn uniformly, which no other program is told of."""
    # A study of before this key has none.
    if results.study["site"].get("rotation") is not None:
        raise ValueError(
            f"{results.folder}: the body has [site.rotation], and what is passed on has no place for an attitude over "
            "time; allowed: studies without it"
        )


def body_name(results: StudyResults) -> str:
    """The name of the body as other programs take it: capitals, digits and underscores."""
    site = results.study["site"]
    return program_name(site.get("name") or Path(site["body"]).stem)
