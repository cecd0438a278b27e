"""The study file: what a user writes. Every key has its unit, range and default in its section, and nowhere else.

A `MaybeUncertain` key takes a number, or a table with a distribution. `lithobrake new` writes these very lines.
"""

import re
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BaseModel, Field, PrivateAttr, model_validator

from lithobrake.study import design_sections, ground_sections, impact_sections
from lithobrake.study.delivery_sections import (
    SURFACE_KEYS,
    DeliverySection,
    JourneySection,
    arrival_key,
    delivered_tables,
    journey_tables,
)
from lithobrake.study.ground_kinds import GroundSection, ground_tables
from lithobrake.study.lander_section import CentreSection, LanderSection
from lithobrake.study.quantity import Scalar, Section, Uncertain, Whole, median
from lithobrake.study.site_kernels import kernel_values
from lithobrake.vocabulary.file_names import STUDY_FILE
from lithobrake.vocabulary.quantities import PLACE


class Study(Section):
    """A checked study: all tables of a study file."""

    title: str = ""
    """Title of the study, one line."""
    # JSON numbers are doubles to most readers, exact up to 2**53.
    seed: Annotated[int, Whole("", at_least=0, at_most=2**53)] = 1
    """Seed of all random numbers of the study."""
    bed: ground_sections.BedSection
    grain: ground_sections.GrainSection
    ground: GroundSection | None = None
    soil: dict[str, ground_sections.SoilSection] = Field(default={})
    lander: LanderSection
    delivery: DeliverySection | None = None
    impact: impact_sections.ImpactSection
    surface: impact_sections.SurfaceSection = impact_sections.SurfaceSection()
    contact: impact_sections.ContactSection = impact_sections.ContactSection()
    landing: impact_sections.LandingSection = impact_sections.LandingSection()
    journey: JourneySection
    solver: design_sections.SolverSection = design_sections.SolverSection()
    campaign: design_sections.CampaignSection = design_sections.CampaignSection()
    design: design_sections.DesignSection = design_sections.DesignSection()
    expansion: design_sections.ExpansionSection | None = None
    monte_carlo: design_sections.MonteCarloSection = design_sections.MonteCarloSection()
    site: impact_sections.SiteSection = impact_sections.SiteSection()
    flight: impact_sections.FlightSection = impact_sections.FlightSection()
    hard_ground: impact_sections.HardGroundSection = impact_sections.HardGroundSection()
    limit_states: design_sections.LimitStatesSection = design_sections.LimitStatesSection()
    aim: design_sections.AimSection = design_sections.AimSection()
    sky: design_sections.SkySection = design_sections.SkySection()
    _function: str | None = PrivateAttr(default=None)
    _site_gravity: float | None = PrivateAttr(default=None)
    _file: str = PrivateAttr(default=STUDY_FILE)

    @model_validator(mode="before")
    @classmethod
    def _filled(cls, tables: Any) -> Any:
        """Fill in what follows from other tables; all that is wrong is left for the sections to refuse."""
        if not isinstance(tables, Mapping):
            return tables
        filled = dict(journey_tables(delivered_tables(tables)))
        if isinstance(impact := filled.get("impact"), Mapping) and impact.get("pointing_error_deg") is not None:
            # An error of pointing is about an attitude that is given, and a random one has none.
            filled["impact"] = {"orientation": (1.0, 0.0, 0.0, 0.0), **impact}
        return ground_tables(filled)

    def with_function(self, identity: str | None) -> "Study":
        """The same study, its touchdowns made by a Python function of this identity in place of the soil."""
        # The section models are frozen, and a private attribute is no key of the file: neither schema nor template
        # shows it.
        study = self.model_copy()
        study._function = identity
        return study

    def of_file(self, name: str) -> "Study":
        """The same study, whose file has this name in messages."""
        study = self.model_copy()
        study._file = name
        return study

    def said(self, problem: str) -> str:
        """A problem after the name of the study file, each key as the file has it."""
        return f"{self._file}: {self.as_written(problem)}"

    def as_written(self, text: str) -> str:
        """A text with each key as the study file has it: delivery.speed for impact.speed."""
        for key, own in self._given_elsewhere().items():
            # What stands in quotation marks is a value of the file.
            text = re.sub(rf'(?<![\w."]){re.escape(own)}(?![\w."])', key, text)
        return text

    def _given_elsewhere(self) -> dict[str, str]:
        """The keys that stand for others, with these; not those that are given in both places and contradict."""
        given = {} if self.journey.count != self.design.run_count else {"journey.count": "design.run_count"}
        if self.delivery is not None:
            for key in SURFACE_KEYS:
                value, own = getattr(self.delivery, key), arrival_key(f"delivery.{key}")
                if value is not None and value == getattr(getattr(self, own.partition(".")[0]), key):
                    given[f"delivery.{key}"] = own
        return given

    def under_site_gravity(self, gravity: float) -> "Study":
        """The same study, whose beds and medians have the acceleration [m/s2] of the site, inward."""
        study = self.model_copy(update={"surface": self.surface.model_copy(update={"gravity": gravity})})
        study._site_gravity = gravity
        return study

    def with_run_count(self, run_count: int) -> "Study":
        """The same study with so many drawn runs; those of a smaller count stay as they are."""
        # The most runs follow from the count of the file, and stay.
        most = None if self.design.half_width is None else self.design.most_runs
        counts = {"run_count": run_count, "largest_run_count": most}
        return self.model_copy(update={"design": self.design.model_copy(update=counts)})

    def on_soil(self, region: str) -> "Study":
        """The same study with the soil of one of its regions for [grain]."""
        return self.model_copy(update={"grain": self.grain.model_copy(update=self.soil[region].grain.values())})

    @property
    def function(self) -> str | None:
        """Identity of the Python function that makes the touchdowns; no key of the file, but part of the run."""
        return self._function

    @property
    def has_soil(self) -> bool:
        """Whether this program's own soil makes the touchdowns, and not a program or function of the user's own."""
        return self.solver.command is None and self.function is None

    @property
    def has_local_ground(self) -> bool:
        """Whether every touchdown has the acceleration and the slope of where it is."""
        return self._site_gravity is not None or self.surface.gravity == "site"

    @property
    def bed_count(self) -> int:
        """How many beds are landed on."""
        if self.bed.bed_count is not None:
            return self.bed.bed_count
        if not self.design.run_count:
            return 1
        return ground_sections.default_bed_count(self.design.run_count, self.runs_a_bed)

    @property
    def runs_a_bed(self) -> int:
        """How many landers each bed of a study has where its file does not say how many beds there are."""
        is_first = self.journey.touchdowns == 1
        return ground_sections.LANDINGS_A_BED if is_first else ground_sections.JOURNEYS_A_BED

    @property
    def sample_count(self) -> int:
        return self.monte_carlo.sample_count or 0

    def touchdown_values(self) -> dict[str, Scalar]:
        """Every scalar that the touchdown reads, by dotted key, in the units of the file; absent ones are left out."""
        values: dict[str, Scalar] = {}
        for section in ("grain", "lander", "impact", "surface", "solver"):
            values |= _scalars(section, getattr(self, section))
        # What a run is given is the attitude that it draws with that error.
        values.pop("impact.pointing_error_deg", None)
        if self.impact.region is None and self.impact.place is None:
            # Every run has a place, drawn over the bed in place of this.
            values |= dict.fromkeys(PLACE, 0.0)
        return values

    def touchdown_medians(self) -> dict[str, float]:
        """The same, uncertain ones at their median."""
        return {name: median(value) for name, value in self.touchdown_values().items()}

    def site_values(self) -> dict[str, Scalar]:
        """Every scalar that only the flight reads, by dotted key, those of kernels among them.

        Raises ValueError or ImportError where the kernels do not tell any more what they did when the study was read.
        """
        read = {f"site.{key}": value for key, value in kernel_values(self.site).items()}
        return _scalars("site", self.site) | read


def _scalars(path: str, section: BaseModel) -> dict[str, Scalar]:
    values: dict[str, Scalar] = {}
    for name in type(section).model_fields:
        value = getattr(section, name)
        if isinstance(value, float | Uncertain):
            values[f"{path}.{name}"] = value
        elif isinstance(value, impact_sections.PlaceSection | CentreSection):
            values |= _scalars(f"{path}.{name}", value)
        elif isinstance(value, dict):
            for key, entry in value.items():
                of_table = isinstance(entry, BaseModel)
                values |= _scalars(f"{path}.{name}.{key}", entry) if of_table else {f"{path}.{name}.{key}": entry}
    return values
