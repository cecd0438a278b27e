"""How many touchdowns a study asks for, and how many time steps these and its beds will take."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.chaos import smolyak_count
from lithobrake.pipeline.design.dependencies import touchdown_keys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.design.side_designs import SIDE_DESIGNS
from lithobrake.pipeline.expansion.expansions import kept_inputs, points, replicate_count
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.pipeline.runs.landings import drawn_rows, landing_values
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.touchdown.lander_bodies import add_lander
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.touchdown_model import landing
from lithobrake.vocabulary.file_names import SCREENING_FILE
from lithobrake.vocabulary.quantities import PAPER_DESIGNS, Row

if TYPE_CHECKING:
    from lithobrake.dem import ConvexHull
    from lithobrake.touchdown import BedRecipe, Lander, Landing

# Designs with more runs are not gone through run by run: that would take longer than a second or two.
MOST_NAMED = 10_000
# Grains that are made to learn the shape of all.
GRAIN_COUNT = 12
# Landings that are looked at to learn how long all take in the mean.
LANDING_COUNT = 40
RAIN_FRACTION = 0.31  # of the rain is bounding spheres
SOLID_FRACTION = 0.6  # of a settled bed
FALLS = 1.4  # until poured grains lie, in the time that the highest falls
# Steps that a bed settles for, over the fewest that its criteria of rest ask for: and what each layer of grains adds.
SETTLING, SETTLING_OF_LAYERS = 3.9, 0.84
# Until a lander is clear, in the time in which it crosses itself and a grain at the speed of impact: the first, and
# what the square of the depth over the lander's size adds, up to DEEP, since a floor gives back what grains do not.
CROSSINGS, CROSSINGS_OF_DEPTH, DEEP = 2.0, 2.2, 2.0
OUTGOING = 0.5  # speed of a lander that leaves, over that of its impact
HELD_CROSSINGS = 0.4  # likewise, where it comes too slowly to leave and is soon captured
# Simulated time of a journey's touchdowns together, in time constants of toppling, sqrt(smallest edge / gravity): hops
# over the bed and rocking (24 journeys of a CubeSat on Dimorphos: mean 18, 5 to 32).
TOPPLINGS = 18.0
# Fewest steps in which a period of a grain is settled through (settling.run_quietly).
STEPS_PER_PERIOD = 40.0


@dataclass(frozen=True)
class PlannedRuns:
    """Distinct touchdowns of a study in which so many inputs are kept after the screening.

    A touchdown that several designs share counts for the first of them. known: keys of those that have ended already.
    drawn, side: first touchdowns of drawn landers, and their side runs; drawn_new: first ones that have not ended.
    """

    kept_count: int
    screening: int
    refined: int
    test: int
    known: frozenset[str]
    drawn: int = 0
    side: int = 0
    drawn_new: int = 0

    @property
    def total(self) -> int:
        return self.screening + self.refined + self.test + self.drawn + self.side

    @property
    def new(self) -> int:
        return self.total - len(self.known)

    def beside(self, landers: "PlannedRuns") -> "PlannedRuns":
        """The runs of the expansion beside those of drawn landers."""
        of_landers = {"drawn": landers.drawn, "side": landers.side, "drawn_new": landers.drawn_new}
        return replace(self, known=self.known | landers.known, **of_landers)


def possible_runs(drawn: DrawnDesign, folder: StudyFolder, screened: bool, known: Iterable[str]) -> list[PlannedRuns]:
    """The touchdowns with the inputs that the screening keeps; before it, those with one input and with all of them.

    Of drawn landers those of their count; with a half width that is not met yet, also the most that there may be.

    screened: the folder has the screening of this study. known: keys of runs that have ended.
    """
    study, inputs, ended = drawn.study, tuple(drawn.inputs), set(known)
    if study.expansion is None:
        return _possible_drawn(drawn, ended)
    if screened:
        from lithobrake.chaos import load

        choices = [kept_inputs(study, load(folder / SCREENING_FILE))]
    else:
        choices = [inputs[:1], inputs] if len(inputs) > 1 else [inputs]
    found = [_planned(drawn, kept, ended) for kept in choices]
    if not study.design.run_count:
        return found
    # The most landers go with the most inputs that may be kept.
    of_landers = _possible_drawn(drawn, ended)
    return [found[0].beside(of_landers[0]), found[-1].beside(of_landers[-1])]


def planned_rows(drawn: DrawnDesign, kept_count: int, most: int) -> list[Row]:
    """All inputs of up to `most` of the touchdowns, drawn by chance."""
    study = drawn.study
    if study.design.run_count:
        return drawn.rows[:most]
    points_of_runs = _planned_points(drawn, kept_count, most).tolist()
    return [
        draw(study, drawn.medians | dict(zip(drawn.inputs, row, strict=True)), study.seed, drawn.region)
        for row in points_of_runs
    ]


def _planned_points(drawn: DrawnDesign, kept_count: int, most: int) -> np.ndarray:
    """Up to `most` of the points at which touchdowns are made, drawn by chance, shape [point_count, input_count]."""
    from lithobrake.analysis import sample_inputs

    kept = tuple(drawn.inputs)[:kept_count]
    parts = [points(drawn, one, kept) for one in PAPER_DESIGNS if _point_count(drawn, one, kept_count) <= MOST_NAMED]
    if not parts:
        return sample_inputs(drawn.inputs, most, seed=0)
    # A fixed seed: the same plan whenever it is asked for.
    return np.random.default_rng(0).permutation(np.concatenate(parts))[:most]


def _possible_drawn(drawn: DrawnDesign, ended: set[str]) -> list[PlannedRuns]:
    """The runs that are drawn, and the most that the half width may ask for where that is not known yet."""
    fewest, most = _planned_drawn(drawn, ended), drawn.study.design.most_runs
    if not fewest.new or most == drawn.study.design.run_count:
        return [fewest]
    return [fewest, _planned_drawn(drawn.with_run_count(most), ended)]


def _planned_drawn(drawn: DrawnDesign, ended: set[str]) -> PlannedRuns:
    side = SIDE_DESIGNS if drawn.study.design.side_runs else ()
    keys = set(drawn.keys)
    side_keys = {key for design in side for key in touchdown_keys(drawn.study, drawn.rows_of(design), 0)} - keys
    known = frozenset((keys | side_keys) & ended)
    counts = {"drawn": len(keys), "side": len(side_keys), "drawn_new": len(keys - ended)}
    return PlannedRuns(len(drawn.inputs), 0, 0, 0, known, **counts)


def _planned(drawn: DrawnDesign, kept: Sequence[str], ended: set[str]) -> PlannedRuns:
    study, seen = drawn.study, set[str]()
    counts = dict.fromkeys(PAPER_DESIGNS, 0)
    for design in PAPER_DESIGNS:
        replicates = range(replicate_count(study, design))
        counts[design] = len(replicates) * _point_count(drawn, design, len(kept))
        if counts[design] > MOST_NAMED:
            continue
        x = points(drawn, design, kept)
        keys = {
            key for replicate in replicates for key in touchdown_keys(study, drawn_rows(drawn, x, replicate), replicate)
        } - seen
        counts[design] = len(keys)
        seen |= keys
    test = counts["test_kept"] + counts["test_all"]
    return PlannedRuns(len(kept), counts["screening"], counts["refined"], test, frozenset(seen & ended))


def _point_count(drawn: DrawnDesign, design: str, kept_count: int) -> int:
    """Points of a design, counted without making them."""
    section = drawn.study.expansion
    assert section is not None
    if design.startswith("test"):
        return section.test_count
    if section.points != "smolyak":
        return int(getattr(section, f"{design}_count"))
    input_count = kept_count if design == "refined" else len(drawn.inputs)
    return smolyak_count(input_count, getattr(section, f"{design}_level"))


@dataclass(frozen=True)
class ExpectedSoil:
    """A bed that has yet to be poured, and landings on it.

    grains: some, of all sizes. landings: some of those that the study makes, after the one that is shown.
    """

    recipe: "BedRecipe"
    grains: "tuple[ConvexHull, ...]"
    landings: "tuple[tuple[Lander, Landing], ...]"

    @classmethod
    def of(cls, design: DrawnDesign, kept_count: int, bed: int = 0) -> "ExpectedSoil":
        """The bed of a number."""
        from lithobrake.touchdown.grains import make_grain

        study, recipe = design.study, bed_recipe(design.study, bed)
        generator = np.random.default_rng(recipe.seed)
        diameters = recipe.sizes.draw((np.arange(GRAIN_COUNT) + 0.5) / GRAIN_COUNT).tolist()
        grains = tuple(make_grain(generator, recipe.cloud_point_count, size) for size in diameters)
        # The landing that is shown comes first, as it has a time of its own in the plan.
        drawn = [landing_values(design), *planned_rows(design, kept_count, LANDING_COUNT)]
        return cls(recipe, grains, tuple((lander(study, one), landing(study, one)) for one in drawn))

    @property
    def diameter(self) -> float:
        """Mean diameter of the grains [m], of the spheres of equal volume."""
        return float(np.mean([math.cbrt(6.0 / math.pi * grain.volume) for grain in self.grains]))

    @property
    def depth(self) -> float:
        """Depth [m]."""
        volume = self.recipe.grain_count * float(np.mean([grain.volume for grain in self.grains]))
        return volume / (SOLID_FRACTION * math.prod(self.recipe.width))

    def pour_steps(self) -> float:
        from lithobrake.touchdown.pouring import FALL_STEPS

        recipe = self.recipe
        spheres = recipe.grain_count * float(np.mean([4.0 * grain.bounding_radius**3 for grain in self.grains]))
        height = math.pi / 3.0 * spheres / (RAIN_FRACTION * math.prod(recipe.width))
        contact = self._shortest_contact(math.sqrt(2.0 * height * recipe.pour_gravity))
        steps = (
            math.sqrt(2.0 * height / recipe.pour_gravity) / contact * min(FALL_STEPS, recipe.contact.steps_per_contact)
        )
        settling = SETTLING + SETTLING_OF_LAYERS * self.depth / self.diameter
        return FALLS * steps + settling * STEPS_PER_PERIOD * self._settling_periods()

    def _settling_periods(self) -> float:
        """The fewest periods of a grain in which it can settle; touchdown/pouring.py has the parts."""
        from lithobrake.touchdown import pouring, settling

        recipe, local = self.recipe, math.hypot(*self.recipe.gravity)
        rung = min(pouring.RUNG * local, recipe.pour_gravity)
        lowered = max(rung / local - 1.0, settling.RAMP_LEFT)
        periods = settling.RAMP_PERIODS * math.log(lowered / settling.RAMP_LEFT)
        toppling = pouring.TOPPLING_TIMES * math.sqrt(self.diameter / rung)
        period = settling.rest_period(recipe.material, self.diameter, rung)
        periods += max(toppling / period, settling.PERIODS_RELAXED)
        return periods + pouring.PERIODS_LOOSENED + settling.PERIODS_RELAXED + settling.PERIODS_HELD

    def landing_steps(self, lander: "Lander", landing: "Landing") -> float:
        """Steps of a touchdown, were they common to all contacts and so many in the shortest as the landing asks for.

        The bed is expected to take on the material at once.
        """
        lasting = min(self.touchdown_time(lander, landing), landing.time_limit)
        return lasting * landing.contact.steps_per_contact / self._shortest_contact(landing.speed, lander, landing)

    def near_grains(self, lander: "Lander", landing: "Landing") -> float:
        """Grains so near to a lander on the middle of the bed that none of them is ever held."""
        from lithobrake.touchdown.simulation import moving_reach

        reach = moving_reach(self.diameter, lander, landing)
        beside = min(math.pi * reach**2 / math.prod(self.recipe.width), 1.0)
        return self.recipe.grain_count * beside * min(reach / self.depth, 1.0)

    def touchdown_time(self, lander: "Lander", landing: "Landing") -> float:
        """Time [s] until the outcome of a touchdown is known, were there no limit."""
        from lithobrake.touchdown.outcome_judge import CAPTURED_APEX

        rise = -landing.gravity[2] * CAPTURED_APEX * lander.smallest_edge
        leaves = 0.5 * (OUTGOING * landing.speed) ** 2 > rise
        size = 2.0 * lander.shape.bounding_radius
        crossings = CROSSINGS + CROSSINGS_OF_DEPTH * min(self.depth / size, DEEP) ** 2
        return (crossings if leaves else HELD_CROSSINGS) * (size + self.diameter) / landing.speed

    def journey_steps(self, lander: "Lander", landing: "Landing") -> float:
        """Periods of a grain at rest that all grains go through in the touchdowns of a journey."""
        from lithobrake.touchdown import settling

        gravity = math.hypot(*landing.gravity)
        time = TOPPLINGS * math.sqrt(lander.smallest_edge / gravity)
        period = settling.rest_period(landing.grain, self.diameter, gravity)
        return self.recipe.grain_count * min(time, landing.time_limit) / period

    def _shortest_contact(
        self, speed: float, lander: "Lander | None" = None, landing: "Landing | None" = None
    ) -> float:  # fmt: skip
        """Duration [s] of the shortest collision at a speed [m/s] in the box, with a lander in it or without."""
        recipe = self.recipe
        rock, contact = (recipe.material, recipe.contact) if landing is None else (landing.grain, landing.contact)
        world = contact.world(recipe.gravity)
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rock)
        for grain in self.grains:
            world.add_body(grain, rock, (0.0, 0.0, 0.0))
        if lander is not None:
            add_lander(world, lander, np.zeros(3), np.zeros(3), (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        return world.shortest_contact(speed)
