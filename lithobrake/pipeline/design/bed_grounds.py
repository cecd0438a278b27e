"""The ground of each bed of a study as its touchdowns read it, and which bed a lander meets at a place."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.chaos import Uniform
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.arrivals import STEEPEST_DEG, Interval, place_region
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.site import Site
from lithobrake.study.ground_beds import BedGround, grounds, of_ground
from lithobrake.study.quantity import Uncertain
from lithobrake.vocabulary.quantities import GROUND_KIND, GROUND_SIZE, PLACE, Row

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution


@dataclass(frozen=True, eq=False)
class BedGrounds:
    """The grounds of a study; nothing is drawn, met or changed where its file has no [ground].

    inputs: the uncertain inputs of its touchdowns with their laws. bed_count: that there are.
    """

    site: Site
    inputs: "Mapping[str, Distribution]"
    bed_count: int

    @cached_property
    def each(self) -> list[BedGround]:
        """The ground of each bed, by its number; empty where all beds have one."""
        return grounds(self.site.study, self.bed_count)

    def of(self, bed: int, row: Row) -> Row:
        """What a touchdown reads of the ground of a bed; row: with the numbers of [grain] that its lander drew."""
        if self.site.study.ground is None:
            return {}
        ground, found = self.each[bed], {"bed": float(bed)}
        kind = self.site.study.ground.kind[ground.kind]
        for key, value in ({} if kind.grain is None else kind.grain.values()).items():
            name = f"grain.{key}"
            # An uncertain number of the kind stands where its lander stands in that of [grain].
            part = float(self.inputs[name].cdf(np.array(row[name]))) if isinstance(value, Uncertain) else 0.0
            found[name] = float(value.to_chaos().ppf(part)) if isinstance(value, Uncertain) else value
        return found | {GROUND_KIND: float(ground.number), GROUND_SIZE: ground.size}

    def region(self, bed: int) -> tuple[Interval, Interval] | None:
        """The part of a bed in which places are drawn, see place_region."""
        if bed not in self._regions:
            study = self.site.study
            self._regions[bed] = place_region(study if study.ground is None else of_ground(study, self.each[bed]))
        return self._regions[bed]

    def moved(self, row: Row, bed: int) -> Row:
        """The impact point of a run on another bed, as far across it as it was on its own."""
        ends = zip(PLACE, self.region(int(row["bed"])) or (), self.region(bed) or (), strict=False)
        return {name: new[0] + (row[name] - old[0]) / (old[1] - old[0]) * (new[1] - new[0]) for name, old, new in ends}

    @cached_property
    def _regions(self) -> dict[int, tuple[Interval, Interval] | None]:
        return {}

    @property
    def numbers(self) -> dict[str, list[float]]:
        """The kind of ground of each bed, by its place in the file, and the mean diameter of its grains [m]."""
        if self.site.study.ground is None:
            return {}
        return {GROUND_KIND: [float(one.number) for one in self.each], GROUND_SIZE: [one.size for one in self.each]}

    @cached_property
    def laws(self) -> "dict[str, Distribution]":
        """What tells the grounds of the beds apart, with laws over their ranges; empty where they have one."""
        from lithobrake.chaos import LogUniform

        found: dict[str, Distribution] = {}
        for name, values in self.numbers.items():
            low, high = min(values), max(values)
            if low < high:
                found[name] = (LogUniform if name == GROUND_SIZE else Uniform)(low, high)
        return found

    def bed_at(
        self, journey: int, bed: int, first: np.ndarray, place: np.ndarray, bodies: tuple[int, int] = (0, 0)
    ) -> int:
        """The bed that a lander meets at a place [m], [3], whose own bed is that of another place.

        bodies: of the other place and of this one, 0 that of the site, 1 its partner.

        A region that names a kind of ground has a bed of this kind, and ground steeper than soil holds is rock, where
        the study has rock. Where the ground is patchy, patches are the cubes of a grid that is fixed to the body; each
        has one bed for each lander, of a kind by the weights of the lander's body where bodies differ in them.
        """
        ground = self.site.study.ground
        if ground is None:
            return bed
        patch = np.floor(place / ground.patch).astype(int).tolist() if ground.unknown != "everywhere" else []
        here = patch != (np.floor(first / ground.patch).astype(int).tolist() if patch else [])
        here |= bodies[0] != bodies[1] and bool(patch)
        # Regions, and slopes by which ground is rock, are those of the body of the site.
        kinds = None if bodies[1] else self._kinds_at(place)
        if not here and (kinds is None or self.each[bed].kind in kinds):
            return bed
        beds = [number for number, one in enumerate(self.each) if kinds is None or one.kind in kinds]
        there = [*patch, *bodies[1:]] if bodies[1] else patch
        chance = np.random.default_rng(hashed_seed(self.site.study.seed, "patch", journey, *there))
        if ground.unknown == "both" and beds:
            own, present = self.each[bed].weights, sorted({self.each[number].number for number in beds})
            weights = np.array([own[number] for number in present])
            kind = chance.choice(present, p=weights / weights.sum())
            beds = [number for number in beds if self.each[number].number == kind]
        # A kind that no bed has stays what it is.
        return beds[int(chance.integers(len(beds)))] if beds else bed

    def _kinds_at(self, place: np.ndarray) -> set[str] | None:
        """The kinds of ground that a place [m], [3], may have; None for any."""
        study = self.site.study
        assert study.ground is not None
        if study.soil and (named := study.soil.get(self._soils.at(place[None])[0])) and named.ground is not None:
            return {named.ground}
        rock = {name for name, kind in study.ground.kind.items() if kind.rock}
        if rock and self._soils.slope_deg(place) > STEEPEST_DEG:
            return rock
        return None

    @cached_property
    def _soils(self) -> Soils:
        return Soils(self.site)
