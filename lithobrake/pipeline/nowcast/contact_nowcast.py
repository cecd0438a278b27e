"""From a first contact that was observed to the ground under it and the place of rest, by landings made before."""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL, Estimate, Observation, share_estimate
from lithobrake.analysis.observed_draws import ObservedDraws, observed_draws, weighted_quantiles
from lithobrake.files.atomic import write_json, write_rows
from lithobrake.pipeline.answer.dispersion_statistics import place_ellipses
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.mean_miss import offsets
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.inferred_study import DRAWN, read_bounces
from lithobrake.pipeline.journeys.delivered_landers import DeliveredLanders
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.touchdown_emulator import ARRIVAL_TABLES, TouchdownEmulator, why_no_emulator
from lithobrake.pipeline.nowcast.contact_emulator import FirstContacts, contact_bounds, contact_emulator
from lithobrake.pipeline.nowcast.contact_landers import ENDS, ContactLanders, with_known
from lithobrake.pipeline.nowcast.observed_contact import checked_contact, is_record, read_contact
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_folder import REMEDY, FinishedFolder
from lithobrake.statements.nowcast import statement
from lithobrake.study.units import input_units
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.file_names import TOUCHDOWN_EMULATOR_FILE
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    GROUND_KIND,
    GROUND_SIZE,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    JOURNEY_DESIGN,
)

NOWCAST, TABLE, FIGURE = "nowcast.json", "nowcast.csv", "nowcast.png"
# Landers of the prior and contacts of each; landers that are followed to their ends, after the contact and before it.
LANDERS, COPIES = 2000, 50
FOLLOWED = 1000
# Landers that are flown to the ground take a flight each.
FLOWN_LANDERS = 1000
# Simulated journeys that resemble the contact: fewer say nothing of sides.
FEWEST_JOURNEYS = 20.0
COLUMNS = ("sample", "refit", "end", "time_s", "latitude_deg", "longitude_deg", "distance [m]", "from_contact [m]")


@dataclass(frozen=True)
class NowcastStudy:
    """A study of journeys to rest that ran; nothing of it is written but the nowcast."""

    folder: FinishedFolder
    design: DrawnDesign

    @classmethod
    def open(cls, path: Path) -> "NowcastStudy":
        """Read a study's folder. Raises ValueError for a study without journeys to rest or without their emulator."""
        folder = FinishedFolder(path)
        source = folder.source()
        study = with_site_gravity(source.study)
        if not study.journey.count or study.journey.touchdowns is not None:
            raise ValueError(
                f"{path} has no journeys to rest, by which a first contact would tell the place; leave "
                "journey.touchdowns out and run the study again"
            )
        if not (path / TOUCHDOWN_EMULATOR_FILE).is_file():
            asks = "is not finished" if study.journey.emulated_count else "has journey.emulated_count = 0; raise it"
            raise ValueError(f"{path} has no {TOUCHDOWN_EMULATOR_FILE}: the study {asks}; {REMEDY}")
        if why := why_no_emulator(folder.read_json(TOUCHDOWN_EMULATOR_FILE)):
            raise ValueError(f"{path} tells nothing of a first contact. {why} Raise journey.count and run it again.")
        if study.delivery is not None and study.delivery.states is not None:
            raise ValueError(f"{path} delivers landers by a file of states; allowed: a delivery that is drawn")
        # As of an emulator of first touchdowns: a Python function that made them leaves no beds.
        if not all((folder / name).is_file() for name in bed_files(study)):
            study = study.with_function("of the folder's runs")
        return cls(folder, DrawnDesign(study))

    def nowcast(self, observation: Path) -> "Nowcast":
        """What the first contact in a CSV file says. Raises ValueError for what cannot have been observed."""
        contact = read_contact(observation)
        names = self.folder.read_json(TOUCHDOWN_EMULATOR_FILE)["output_names"]
        checked_contact(contact, contact_bounds(names), str(observation))
        emulator = contact_emulator(self.design, self.folder, contact.outputs)
        return Nowcast.of(self, emulator, contact, str(observation))

    def arrivals(self) -> Arrivals:
        """Landers behind those of the study, at their first contacts."""
        if self.design.is_flown:
            return DeliveredLanders.flown(self.design, FLOWN_LANDERS).begin
        return Arrivals.drawn(self.design, len(self.design.rows), LANDERS)

    @cached_property
    def journeys(self) -> JourneyTable:
        return JourneyTable.load(self.folder)


@dataclass(frozen=True)
class Nowcast:
    """What a first contact says: contacts of the prior with weights, and landers followed from some of them."""

    study: NowcastStudy
    contact: Observation
    contacts: FirstContacts
    draws: ObservedDraws
    before: ContactLanders
    after: ContactLanders

    @classmethod
    def of(
        cls,
        study: NowcastStudy,
        emulator: TouchdownEmulator,
        contact: Observation,
        where: str,
    ) -> "Nowcast":
        """Weigh first contacts by an observed one, and follow landers from those that are likely.

        where: the file of the contact, for messages.
        """
        begin = with_known(study.arrivals(), contact.known, where)
        contacts = FirstContacts.drawn(emulator, begin, COPIES)
        if not len(contacts.lander):
            name = contacts.beyond[0]
            low, high = emulator.ranges[name]
            raise ValueError(f"{where}: {name} lies outside what the study simulated; allowed: {low:.4g} to {high:.4g}")
        possible = contacts.ended_as(contact.outcome)
        draws = observed_draws(contacts.outputs, contact.outputs, contact.errors, possible, contacts.lander)
        every = np.linspace(0, len(contacts.lander) - 1, min(FOLLOWED, len(contacts.lander))).astype(np.int64)
        nothing = replace(contact, outputs={}, errors={})
        before = ContactLanders.of(contacts, every, nothing, "before the first contact")
        after = ContactLanders.of(contacts, draws.taken(FOLLOWED, 1), contact, "after the first contact")
        return cls(study, contact, contacts, draws, before, after)

    def values(self, name: str) -> Array:
        """An input of each first contact [contact_count]."""
        column = self.contacts.x.get(name)
        values: Array = (self.contacts.begin.column(name) if column is None else column)[self.contacts.lander]
        return values

    @cached_property
    def fitted(self) -> Refits:
        """Beds and journeys that intervals hold over."""
        return Refits.of_journeys(self.study.design.study, self.study.journeys)

    def share(self, met: np.ndarray, least: np.ndarray | None = None) -> Estimate:
        """Share of the followed landers that have met an event, over beds; least: those that have for certain."""
        every = np.ones(len(met), dtype=bool)
        one = self.fitted.share(met, every, self.after.refit)
        if least is not None:
            one = replace(one, lower=self.fitted.share(least, every, self.after.refit).lower)
        return one if self.draws.is_reliable else Estimate(one.value, None, None)

    def kinds(self) -> dict[str, dict[str, Any]]:
        """The probability of each kind of ground before and after; empty for a study of one ground."""
        ground = self.study.design.study.ground
        if ground is None:
            return {}
        kind = self.values(GROUND_KIND)
        before = np.bincount(kind.astype(int), minlength=len(ground.kind)) / len(kind)
        own = kind[self.after.contact]
        return {
            name: {"before": float(before[number]), "after": _listed(self.share(own == number))}
            for number, name in enumerate(ground.kind)
        }

    def inputs(self) -> dict[str, dict[str, Any]]:
        """Each input of the ground and of the lander that varies, before and after."""
        units, laws = input_units(), self.contacts.emulator.refits[0].runs.inputs
        names = [name for name in self.contacts.emulator.plain_inputs if not name.startswith(ARRIVAL_TABLES)]
        names += [name for name in (IMPACT_SPEED, IMPACT_INCIDENCE) if name in self.contacts.x]
        found = {}
        for name in names:
            values = self.values(name)
            if name == GROUND_KIND or np.ptp(values) == 0.0:
                continue
            even = np.full(len(values), 1.0 / len(values))
            germ = laws[name].germ(values)
            spread = [float(np.sqrt(np.cov(germ, aweights=one, ddof=0))) for one in (self.draws.weights, even)]
            places = np.linspace(0, len(values) - 1, DRAWN).astype(np.int64)
            after = self.draws.quantiles(values, ENDS)
            found[name] = {
                "unit": "m" if name == GROUND_SIZE else units.get(name, ""),
                "before": weighted_quantiles(values, even, ENDS),
                "after": after if self.draws.is_reliable else [None, after[1], None],
                "sd_ratio": spread[0] / spread[1],
                "prior": values[places].tolist(),
                "points": values[self.draws.taken(DRAWN, 2)].tolist(),
            }
        return found

    def rest(self) -> dict[str, Any]:
        """Whether, when and where the lander rests, before and after."""
        after, site = self.after, self.study.design.site
        there = (after.numbers[f"{name}_deg"][after.rests] for name in ("latitude", "longitude"))
        ellipse = place_ellipses(site, *there) if after.rests.sum() > 2 else None
        numbers = {}
        for name in ("time_s", "distance", "from_contact"):
            middle = after.quantiles(name)
            numbers[name.replace("distance", "distance_m").replace("contact", "contact_m")] = {
                "before": self.before.quantiles(name),
                "after": middle if self.draws.is_reliable else [None, middle[1], None],
            }
        known = ~self.before.unknown
        return {
            "at_rest": {
                "before": float(self.before.rests.sum() / max(known.sum(), 1)),
                "after": _listed(self.share(after.rests | after.unknown, after.rests)),
            },
            "unknown": float(after.unknown.mean()),
            **numbers,
            "ellipse": None if ellipse is None else _ellipse(ellipse),
            "sides": self.sides(),
        }

    def sides(self) -> dict[str, list[float | None]]:
        """Share of the simulated landers at rest on each side, those weighted that met a like contact; or nothing."""
        table, runs = self.study.journeys, DesignRuns.load(self.study.folder, JOURNEY_DESIGN)
        first = np.flatnonzero(runs.inputs["touchdown"] == 0.0)
        first = first[np.argsort(runs.inputs["journey"][first])]
        if len(first) != len(table.end) or not any(table.face):
            return {}
        outputs = {name: runs.output(name)[first] for name in self.contact.outputs if name in runs.outputs}
        possible = np.array(runs.outcomes)[first] == (self.contact.outcome or TouchdownOutcome.CLEAR)
        possible &= table.rests & np.all([np.isfinite(values) for values in outputs.values()], axis=0)
        if possible.sum() < FEWEST_JOURNEYS:
            return {}
        observed = {name: self.contact.outputs[name] for name in outputs}
        alike = observed_draws(outputs, observed, self.contact.errors, possible, np.arange(len(first)))
        own = alike.weights > 1e-6 * alike.weights.max()
        if alike.effective_count < FEWEST_JOURNEYS or len(np.unique(table.bed[own])) < 2:
            return {}
        bed, weights, faces = table.bed[own], alike.weights[own], table.face[own]
        return {
            face: _listed(share_estimate((faces == face).astype(float), bed, weights=weights).share)
            for face in sorted(set(faces.tolist()))
        }

    def content(self) -> dict[str, Any]:
        """What nowcast.json holds."""
        found = {
            "observed": dict(self.contact.outputs),
            "errors": dict(self.contact.errors),
            "known": dict(self.contact.known),
            "outcome": self.contact.outcome,
            "level": LEVEL,
            "contacts": len(self.contacts.lander),
            "beyond": float((self.contacts.beyond != "").mean()),
            "effective_count": self.draws.effective_count,
            "kernel_width": self.draws.width,
            "predictive_p_value": self.draws.p_value,
            "is_reliable": self.draws.is_reliable,
            "beds": len(np.unique(self.study.journeys.bed)),
            "journeys": len(self.study.journeys.end),
            "ground": self.kinds(),
            "inputs": self.inputs(),
            "rest": self.rest(),
        }
        return {"statement": statement(found), **found}


def is_first_contact(folder: Path, observation: Path) -> bool:
    """Whether a file is a nowcast's: a record, or one bounce of a study of journeys to rest that has their emulator."""
    if is_record(observation):
        return True
    if not (folder / TOUCHDOWN_EMULATOR_FILE).is_file() or len(read_bounces(observation)) > 1:
        return False
    study, content = FinishedFolder(folder).source().study, FinishedFolder(folder).read_json(TOUCHDOWN_EMULATOR_FILE)
    return bool(study.journey.count) and study.journey.touchdowns is None and why_no_emulator(content) is None


def _listed(one: Estimate) -> list[float | None]:
    return [one.lower, one.value, one.upper]


def _ellipse(found: Any) -> dict[str, Any]:
    middle = {"latitude_deg": found.latitude_deg, "longitude_deg": found.longitude_deg}
    axes = {f"{one.share:g}": list(one.semi_axes_m) for one in found.shares}
    return middle | {"heading_deg": found.heading_deg, "semi_axes_m": axes}


def nowcast_study(folder: Path, observation: Path) -> dict[str, Any]:
    """Nowcast from a first contact, and write nowcast.json, nowcast.csv and a picture into the folder of the study."""
    from lithobrake.report.figures.nowcast_figure import write_nowcast_figure

    found = NowcastStudy.open(folder).nowcast(observation)
    content = found.content()
    write_json(folder / NOWCAST, content)
    write_rows(folder / TABLE, COLUMNS, found.after.rows())
    ways = partial(offsets, found.study.design.site)
    write_nowcast_figure(content, found.before.numbers, found.after.numbers, ways, folder / FIGURE)
    return content
