"""Landers at a first contact that was observed: what is known of their arrival, and how they go on to their ends."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL, Estimate, Observation, share_estimate
from lithobrake.analysis.confidence import normal_quantile
from lithobrake.analysis.observed_draws import OUTSIDE, observed_draws, weighted_quantiles
from lithobrake.geometry.attitude import about_z, angles, quaternion
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.journeys.emulated_touchdowns import EmulatedTouchdowns
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.pipeline.nowcast.contact_emulator import AfterContact, FirstContacts
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.results.site_results import MOST_UNKNOWN
from lithobrake.smallbody.landers import follow
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    JOURNEY_DESIGN,
    ORIENTATION,
    SPIN,
    UNKNOWN_END,
    Row,
)

# What may be known of the arrival.
KNOWN = (IMPACT_SPEED, IMPACT_INCIDENCE, *SPIN, *ORIENTATION)
# Ends and median of an interval.
ENDS = (0.5 - 0.5 * LEVEL, 0.5, 0.5 + 0.5 * LEVEL)
# Simulated journeys that resemble the contact: fewer say nothing of sides.
FEWEST_JOURNEYS = 20.0


def checked_known(known: Mapping[str, float], folder: StudyFolder, where: str) -> None:
    """Raise ValueError, with the file, for numbers that no arrival has, and a spin beyond all simulated touchdowns."""
    for name, value in known.items():
        if not math.isfinite(value):
            raise ValueError(f"{where} has {value:g} for {name}; allowed: a finite number; leave out what is not known")
    if known.get(IMPACT_SPEED, 0.0) < 0.0:
        raise ValueError(f"{where} has {known[IMPACT_SPEED]:g} m/s for {IMPACT_SPEED}; allowed: 0 or more")
    if spin := math.hypot(*(known.get(name, 0.0) for name in SPIN)):
        inputs = DesignRuns.load(folder, JOURNEY_DESIGN).inputs
        fastest = float(np.linalg.norm([inputs[name] for name in SPIN if name in inputs], axis=0).max())
        if spin > fastest:
            raise ValueError(
                f"{where} gives a spin of {spin:.4g} rad/s; allowed: at most {fastest:.4g} rad/s, as of the touchdowns "
                "that the study simulated; write it in rad/s, or leave it out"
            )


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

    @property
    def answered(self) -> bool:
        """Whether so few ends are not known that the landers at rest stand for all that rest."""
        return float(self.unknown.mean()) <= MOST_UNKNOWN

    @property
    def told(self) -> Mapping[str, Array]:
        """The numbers, or NaN of all landers where too many ends are not known."""
        return self.numbers if self.answered else {name: np.full(len(self.end), np.nan) for name in self.numbers}

    def at_rest(self, fitted: Refits) -> Estimate:
        """Share at rest of the landers of known end, over beds; bounds hold whatever becomes of the others."""
        return fitted.share_of_known(self.rests, ~self.unknown, self.refit)

    def quantiles(self, name: str) -> list[float | None]:
        """Ends and median of the interval of a number of the landers at rest; None where none rests or is told."""
        found = weighted_quantiles(self.told[name], np.ones(len(self.end)), ENDS)
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


def with_scatter(one: Estimate, count: float) -> Estimate:
    """A share over beds, with the scatter of so many independent landers that show it in its interval as well."""
    if one.lower is None or one.upper is None:
        return one
    scatter = normal_quantile() * math.sqrt(one.value * (1.0 - one.value) / count)
    lower, upper = (math.hypot(end - one.value, scatter) for end in (one.lower, one.upper))
    return replace(one, lower=max(one.value - lower, 0.0), upper=min(one.value + upper, 1.0))


def sides_down(folder: StudyFolder, table: JourneyTable, contact: Observation) -> dict[str, Estimate]:
    """Share of the simulated landers at rest on each side, those weighted that met a like contact; or nothing.

    Nothing where a number that was observed is none of the runs', as the others alone would tell another contact.
    """
    runs = DesignRuns.load(folder, JOURNEY_DESIGN)
    first = np.flatnonzero(runs.inputs["touchdown"] == 0.0)
    first = first[np.argsort(runs.inputs["journey"][first])]
    if len(first) != len(table.end) or not any(table.face) or set(contact.outputs) - set(runs.outputs):
        return {}
    outputs = {name: runs.output(name)[first] for name in contact.outputs}
    possible = np.array(runs.outcomes)[first] == (contact.outcome or TouchdownOutcome.CLEAR)
    possible &= table.rests & np.all([np.isfinite(values) for values in outputs.values()], axis=0)
    if possible.sum() < FEWEST_JOURNEYS:
        return {}
    alike = observed_draws(outputs, contact.outputs, contact.errors, possible, np.arange(len(first)))
    own = alike.weights > 1e-6 * alike.weights.max()
    is_outside = alike.p_value is not None and alike.p_value < OUTSIDE
    if is_outside or alike.effective_count < FEWEST_JOURNEYS or len(np.unique(table.bed[own])) < 2:
        return {}
    bed, weights, faces = table.bed[own], alike.weights[own], table.face[own]
    return {
        face: share_estimate((faces == face).astype(float), bed, weights=weights).share
        for face in sorted(set(faces.tolist()))
    }
