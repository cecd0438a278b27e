"""From a first contact that was observed to the ground under it and the place of rest, by landings made before."""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL, Estimate, Observation
from lithobrake.analysis.observed_draws import FEWEST, ObservedDraws, observed_draws, weighted_quantiles
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
from lithobrake.pipeline.nowcast.contact_landers import (
    ENDS,
    ContactLanders,
    checked_known,
    sides_down,
    with_known,
    with_scatter,
)
from lithobrake.pipeline.nowcast.observed_contact import checked_contact, is_record, read_contact
from lithobrake.pipeline.sequential_sampling import grown
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_folder import REMEDY, FinishedFolder
from lithobrake.statements.nowcast import statement
from lithobrake.study.units import input_units
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.file_names import TOUCHDOWN_EMULATOR_FILE
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    GROUND_KIND,
    GROUND_SIZE,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
)

NOWCAST, TABLE, FIGURE = "nowcast.json", "nowcast.csv", "nowcast.png"
# Landers of the prior and contacts of each; landers that are followed to their ends, after the contact and before it.
LANDERS, COPIES = 2000, 50
FOLLOWED = 1000
# Landers that are flown to the ground take a flight each.
FLOWN_LANDERS = 1000
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
        return cls(folder, grown(DrawnDesign(study), folder))

    def nowcast(self, observation: Path) -> "Nowcast":
        """What the first contact in a CSV file says. Raises ValueError for what cannot have been observed."""
        contact = read_contact(observation)
        names = self.folder.read_json(TOUCHDOWN_EMULATOR_FILE)["output_names"]
        checked_contact(contact, contact_bounds(names), str(observation))
        checked_known(contact.known, self.folder, str(observation))
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
    """What a first contact says: contacts of the prior with weights, and landers followed from some of them.

    used: what the weights follow from: of a captured lander its outcome alone, as the emulator has no law of the rest.
    """

    study: NowcastStudy
    contact: Observation
    used: Observation
    contacts: FirstContacts
    draws: ObservedDraws

    @classmethod
    def of(
        cls,
        study: NowcastStudy,
        emulator: TouchdownEmulator,
        contact: Observation,
        where: str,
    ) -> "Nowcast":
        """Weigh first contacts by an observed one.

        where: the file of the contact, for messages.
        """
        begin = with_known(study.arrivals(), contact.known, where)
        contacts = FirstContacts.drawn(emulator, begin, COPIES)
        contacts.refuse_beyond(where)
        is_captured = contact.outcome == TouchdownOutcome.CAPTURED
        used = replace(contact, outputs={}, errors={}) if is_captured else contact
        possible = contacts.ended_as(used.outcome)
        draws = observed_draws(contacts.outputs, used.outputs, used.errors, possible, contacts.lander)
        return cls(study, contact, used, contacts, draws)

    @cached_property
    def before(self) -> ContactLanders:
        """Landers followed from all first contacts."""
        count = len(self.contacts.lander)
        every = np.linspace(0, count - 1, min(FOLLOWED, count)).astype(np.int64)
        nothing = replace(self.used, outputs={}, errors={})
        return ContactLanders.of(self.contacts, every, nothing, "before the first contact")

    @cached_property
    def after(self) -> ContactLanders:
        """Landers followed from first contacts as often as those are likely."""
        return ContactLanders.of(self.contacts, self.draws.taken(FOLLOWED, 1), self.used, "after the first contact")

    def values(self, name: str) -> Array:
        """An input of each first contact [contact_count]."""
        column = self.contacts.x.get(name)
        values: Array = (self.contacts.begin.column(name) if column is None else column)[self.contacts.lander]
        return values

    @cached_property
    def fitted(self) -> Refits:
        """Beds and journeys that intervals hold over."""
        return Refits.of_journeys(self.study.design.study, self.study.journeys)

    def listed(self, one: Estimate) -> list[float | None]:
        """Ends and value of a share of the followed landers, which are worth as many as the draws."""
        return _listed(with_scatter(one, self.draws.effective_count))

    def kinds(self) -> dict[str, dict[str, Any]]:
        """The probability of each kind of ground before and after; empty for a study of one ground."""
        ground = self.study.design.study.ground
        if ground is None:
            return {}
        kind = self.values(GROUND_KIND)
        before = np.bincount(kind.astype(int), minlength=len(ground.kind)) / len(kind)
        own, every = kind[self.after.contact], np.ones(len(self.after.contact), dtype=bool)
        shares = (self.fitted.share(own == number, every, self.after.refit) for number in range(len(ground.kind)))
        return {
            name: {"before": float(before[number]), "after": self.listed(one)}
            for number, (name, one) in enumerate(zip(ground.kind, shares, strict=True))
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
            found[name] = {
                "unit": "m" if name == GROUND_SIZE else units.get(name, ""),
                "before": weighted_quantiles(values, even, ENDS),
                "after": self.draws.quantiles(values, ENDS),
                "sd_ratio": spread[0] / spread[1],
                "prior": values[places].tolist(),
                "points": values[self.draws.taken(DRAWN, 2)].tolist(),
            }
        return found

    def rest(self) -> dict[str, Any]:
        """Whether, when and where the lander rests, before and after."""
        after, site = self.after, self.study.design.site
        there = (after.numbers[f"{name}_deg"][after.rests] for name in ("latitude", "longitude"))
        ellipse = place_ellipses(site, *there) if after.answered and after.rests.sum() > 2 else None
        numbers = {}
        for name in ("time_s", "distance", "from_contact"):
            numbers[name.replace("distance", "distance_m").replace("contact", "contact_m")] = {
                "before": self.before.quantiles(name),
                "after": after.quantiles(name),
            }
        sides = sides_down(self.study.folder, self.study.journeys, self.used)
        return {
            "at_rest": {
                "before": self.before.at_rest(self.fitted).value,
                "after": self.listed(after.at_rest(self.fitted)),
            },
            "unknown": float(after.unknown.mean()),
            **numbers,
            "ellipse": None if ellipse is None else _ellipse(ellipse),
            "sides": {side: _listed(one) for side, one in sides.items()},
        }

    def content(self) -> dict[str, Any]:
        """What nowcast.json holds: nothing of ground and rest where the draws do not stand for the contact."""
        told = self.draws.is_reliable
        found = {
            "observed": dict(self.contact.outputs),
            "errors": dict(self.contact.errors),
            "known": dict(self.contact.known),
            "outcome": self.contact.outcome,
            "not_used": sorted(set(self.contact.outputs) - set(self.used.outputs)),
            "level": LEVEL,
            "contacts": len(self.contacts.lander),
            "landers": len(np.unique(self.contacts.lander)),
            "beyond": float((self.contacts.beyond != "").mean()),
            "beyond_input": self.contacts.beyond_input(),
            "effective_count": self.draws.effective_count,
            "fewest": FEWEST,
            "kernel_width": self.draws.width,
            "predictive_p_value": self.draws.p_value,
            "is_reliable": self.draws.is_reliable,
            "beds": len(np.unique(self.study.journeys.bed)),
            "journeys": len(self.study.journeys.end),
            "ground": self.kinds() if told else {},
            "inputs": self.inputs() if told else {},
            "rest": self.rest() if told else None,
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


def nowcast_study(folder: Path, observation: Path, progress: Progress = silent) -> dict[str, Any]:
    """Nowcast from a first contact, and write nowcast.json, nowcast.csv and a picture into the folder of the study.

    Without an answer the table and the picture of another contact go, as they would stand for this one.
    progress: called with the fraction that is done and what is done next.
    """
    from lithobrake.report.figures.nowcast_figure import write_nowcast_figure

    progress(0.0, "drawing first contacts")
    found = NowcastStudy.open(folder).nowcast(observation)
    if found.draws.is_reliable:
        # What content() asks for, one after the other.
        for done, name in ((0.2, "before"), (0.55, "after")):
            progress(done, f"following landers from {name} the contact")
            getattr(found, name)
    progress(0.9, "summing up")
    content = found.content()
    write_json(folder / NOWCAST, content)
    if not content["is_reliable"]:
        for name in (TABLE, FIGURE):
            (folder / name).unlink(missing_ok=True)
        return content
    write_rows(folder / TABLE, COLUMNS, found.after.rows())
    ways = partial(offsets, found.study.design.site)
    write_nowcast_figure(content, found.before.told, found.after.told, ways, folder / FIGURE)
    return content
