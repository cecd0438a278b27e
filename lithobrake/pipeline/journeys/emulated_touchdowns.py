"""Touchdowns by the emulator of all touchdowns."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.arrivals import FLATTEST_DEG, ground_inputs
from lithobrake.pipeline.design.lander_attitude import attitude_inputs_of
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.touchdown_emulator import GRAVITY, SLOPE, TouchdownEmulator
from lithobrake.smallbody.touchdown import Answers, ImpactStates
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, IMPACT_INCIDENCE, IMPACT_SPEED, ORIENTATION

# Bounds the tilt of the ground that a lander meets.
FRICTION = "grain.friction"


@dataclass
class EmulatedTouchdowns:
    """The emulator asked about the touchdowns of landers; each keeps its soil and its refit.

    title: of the landers, which names their random numbers. beyond: the input of an impact that the emulator does not
    know, the last one of each lander, "" where there was none.
    """

    emulator: TouchdownEmulator
    begin: Arrivals
    title: str
    beyond: np.ndarray = field(init=False)
    soil: dict[str, np.ndarray] = field(init=False)

    def __post_init__(self) -> None:
        # As wide as the longest name of OF_TOUCHDOWN: NumPy cuts longer ones without notice.
        self.beyond = np.full(len(self.begin.rows), "", dtype="<U24")
        names = [name for name in self.emulator.plain_inputs if name not in self.emulator.ranges]
        self.soil = {name: self.begin.column(name) for name in (*names, FRICTION)}

    def answers(self, impacts: ImpactStates) -> Answers:
        """Draw how each touchdown ends; nothing is known of those beyond the ranges of the emulator."""
        which, number = impacts.lander, int(impacts.number[0])
        soil = {name: values[which] for name, values in self.soil.items()} | self._patches(impacts) | self._met(impacts)
        # The emulator reads the size of the acceleration and the slope, for which any azimuth will do.
        ground = [
            ground_inputs(one, 0.0, friction)
            for one, friction in zip(impacts.acceleration, soil[FRICTION], strict=True)
        ]
        inputs = soil | {
            IMPACT_SPEED: impacts.speed,
            IMPACT_INCIDENCE: np.minimum(impacts.incidence_deg, FLATTEST_DEG),
            GRAVITY: np.array([one[GRAVITY] for one in ground]),
            SLOPE: np.array([one[SLOPE] for one in ground]),
            **self._attitude(which, number),
        }
        beyond = self.emulator.beyond(inputs)
        self.beyond[which] = np.where(beyond == "", self.beyond[which], beyond)
        seed = hashed_seed(self.emulator.design.study.seed, self.title, number)
        return self.emulator.answers(inputs, impacts.local_spin, self.begin.refit[which], seed)

    def _patches(self, impacts: ImpactStates) -> dict[str, np.ndarray]:
        """What landers read of the ground of other patches than their first, [count] each; nothing of one ground."""
        design, begin = self.emulator.design, self.begin
        if design.study.ground is None:
            return {}
        own = {name: values[impacts.lander] for name, values in self._own_soils.items()}
        rows = []
        for place, lander in enumerate(impacts.lander.tolist()):
            first, bodies = int(begin.rows[lander]["bed"]), (int(begin.ground[lander]), int(impacts.ground[place]))
            there = begin.origin[lander], impacts.position[place]
            bed = design.grounds.bed_at(int(begin.number[lander]), first, *there, bodies)
            mine = {name: float(values[place]) for name, values in own.items()}
            rows.append(mine | design.grounds.of(bed, mine))
        return {name: np.array([row[name] for row in rows]) for name in self.soil if name in rows[0]}

    def _met(self, impacts: ImpactStates) -> dict[str, np.ndarray]:
        """Soils of the regions that landers touch down in; nothing where all ground is what a lander met first."""
        design, which = self.emulator.design, impacts.lander
        if not design.study.soil:
            return {}
        own, laws = (
            {name: values[which] for name, values in self._own_soils.items()},
            self.emulator.refits[0].runs.inputs,
        )
        met, there = {name: values.copy() for name, values in own.items()}, np.flatnonzero(impacts.ground == 0)
        # Regions are of the body of the site alone.
        own = {name: values[there] for name, values in own.items()}
        for name, values in self._soils.met(self.begin.number[which[there]], own, impacts.position[there]).items():
            met[name][there] = values
        # A law without an end has one in the emulator.
        return {name: np.clip(values, *laws[name].support) if name in laws else values for name, values in met.items()}

    @cached_property
    def _soils(self) -> Soils:
        return Soils(self.emulator.design.site)

    @cached_property
    def _own_soils(self) -> dict[str, np.ndarray]:
        """The grains that each lander draws for the ground outside of all regions, [lander_count]."""
        return self.emulator.design.own_soils(self.begin.number)

    def _attitude(self, which: np.ndarray, number: int) -> dict[str, np.ndarray]:
        """Terms of the attitudes of some landers: as delivered at the first touchdown, any attitude at later ones.

        A lander that has bounced tumbles for minutes before it comes down again.
        """
        terms = self.emulator.terms
        if terms is None:
            return {}
        if number == 0:
            delivered = {name: self.begin.column(name)[which] for name in (*ORIENTATION, IMPACT_AZIMUTH)}
            return attitude_inputs_of(terms, delivered)
        # Drawn for all landers, so that the numbers of one do not depend on which others are still under way.
        random = np.random.default_rng(hashed_seed(self.emulator.design.study.seed, self.title, "attitudes", number))
        return self.emulator.attitude_of(Rotation.random(len(self.begin.rows), rng=random)[which])
