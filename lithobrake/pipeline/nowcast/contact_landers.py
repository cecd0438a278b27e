"""Landers at a first contact that was observed: what is known of their arrival, and how they go on to their ends."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL, Observation
from lithobrake.analysis.observed_draws import weighted_quantiles
from lithobrake.geometry.attitude import about_z, angles, quaternion
from lithobrake.pipeline.journeys.emulated_touchdowns import EmulatedTouchdowns
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.pipeline.nowcast.contact_emulator import AfterContact, FirstContacts
from lithobrake.smallbody.landers import follow
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import (
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    ORIENTATION,
    SPIN,
    UNKNOWN_END,
    Row,
)

# What may be known of the arrival.
KNOWN = (IMPACT_SPEED, IMPACT_INCIDENCE, *SPIN, *ORIENTATION)
# Ends and median of an interval.
ENDS = (0.5 - 0.5 * LEVEL, 0.5, 0.5 + 0.5 * LEVEL)


def with_known(begin: Arrivals, known: Mapping[str, float], where: str) -> Arrivals:
    """Landers with what is known of their arrival in the place of the draw.

    Attitude and spin are those in the frame of the touchdown: x along the incoming horizontal velocity, z outward.
    Raises ValueError, with the file, for what is no part of an arrival, and a part of an attitude alone.
    """
    if unknown := sorted(set(known) - set(KNOWN)):
        raise ValueError(f"{where} gives {unknown[0]} of the contact; allowed: {', '.join(KNOWN)}")
    orientation = [known[name] for name in ORIENTATION if name in known]
    if orientation and (len(orientation) < len(ORIENTATION) or not np.linalg.norm(orientation) > 0.0):
        raise ValueError(f"{where} gives a part of the attitude; allowed: {', '.join(ORIENTATION)} together, not all 0")
    if not known:
        return begin
    unit = np.array(orientation) / np.linalg.norm(orientation) if orientation else ()
    given = {**known, **dict(zip(ORIENTATION, map(float, unit), strict=False))}
    turns = any(name in known for name in (*SPIN, *ORIENTATION))
    rows = [(_in_frame(row) if turns else row) | given for row in begin.rows]
    return replace(begin, rows=rows)


def _in_frame(row: Row) -> Row:
    """A first touchdown with attitude and spin turned so that the azimuth is 0."""
    from scipy.spatial.transform import Rotation

    turn = about_z(-np.radians(row[IMPACT_AZIMUTH]))
    spin = turn.apply([row[name] for name in SPIN])
    attitude = Rotation.from_quat([row[name] for name in ORIENTATION], scalar_first=True)
    turned = zip((*SPIN, *ORIENTATION), (*spin.tolist(), *quaternion(turn * attitude)), strict=True)
    return row | dict(turned) | {IMPACT_AZIMUTH: 0.0}


@dataclass(frozen=True)
class ContactLanders:
    """Landers from their first contact to their ends, [lander_count]; numbers are NaN where a lander does not rest.

    contact: place of each among the first contacts; from_contact [m]: over the ground, from the first contact.
    """

    contact: Integers
    refit: Integers
    end: np.ndarray
    numbers: Mapping[str, Array]

    @classmethod
    def of(cls, contacts: FirstContacts, which: Integers, contact: Observation, title: str) -> "ContactLanders":
        """Those of some first contacts, with the motion after them that was observed."""
        begin = contacts.begin.taken(contacts.lander[which], contacts.refit[which])
        landers = StudyLanders.of(contacts.emulator.design, begin)
        first = contacts.answers(which, contact.outputs, contact.errors)
        follow(landers, AfterContact(first, EmulatedTouchdowns(contacts.emulator, begin, title)))
        rests, site = landers.end == JourneyEnd.AT_REST, contacts.emulator.design.site
        numbers = {
            "time_s": landers.time,
            "latitude_deg": landers.latitude,
            "longitude_deg": landers.longitude,
            "distance": landers.ways_from_aims,
            "from_contact": site.aim_radius * angles(_units(begin.origin), _units(landers.position)),
        }
        known = {name: np.where(rests, values, np.nan) for name, values in numbers.items()}
        return cls(which, contacts.refit[which], landers.end.astype(str), known)

    @property
    def rests(self) -> np.ndarray:
        rests: np.ndarray = self.end == JourneyEnd.AT_REST.value
        return rests

    @property
    def unknown(self) -> np.ndarray:
        unknown: np.ndarray = self.end == UNKNOWN_END
        return unknown

    def quantiles(self, name: str) -> list[float | None]:
        """Ends and median of the interval of a number of the landers at rest; None where none rests."""
        found = weighted_quantiles(self.numbers[name], np.ones(len(self.end)), ENDS)
        return [value if np.isfinite(value) else None for value in found]

    def rows(self) -> list[list[Any]]:
        """Rows of the table, "" for what a lander does not have."""
        numbers = zip(*(values.tolist() for values in self.numbers.values()), strict=True)
        cells = ([value if np.isfinite(value) else "" for value in row] for row in numbers)
        words = enumerate(zip(self.refit.tolist(), self.end.tolist(), strict=True))
        return [[number, *own, *row] for (number, own), row in zip(words, cells, strict=True)]


def _units(places: Array) -> Array:
    units: Array = places / np.linalg.norm(places, axis=1, keepdims=True)
    return units
