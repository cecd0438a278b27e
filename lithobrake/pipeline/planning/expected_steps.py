"""How many time steps a bed and a touchdown will take, told before either is made.

What follows from the study is worked out as the engine does it: the shortest contact, from which a step follows, the
time of a fall, the period of a grain at rest. What cannot be known beforehand, how long grains take to come to rest and
a lander to leave, is a multiple of these that was measured (benchmarks/plan_estimate.json).
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.planning.planned_runs import planned_rows
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.pipeline.runs.shown_landing import landing_values
from lithobrake.study.touchdown_model import lander, landing

if TYPE_CHECKING:
    from lithobrake.dem import ConvexHull
    from lithobrake.touchdown import BedRecipe, Lander, Landing

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
class ExpectedSoil:
    """A bed that has yet to be poured, and landings on it.

    grains: some, of all sizes. landings: some of those that the study makes, after the one that is shown.
    """

    recipe: "BedRecipe"
    grains: "tuple[ConvexHull, ...]"
    landings: "tuple[tuple[Lander, Landing], ...]"

    @classmethod
    def of(cls, design: DrawnDesign, kept_count: int) -> "ExpectedSoil":
        """That of a study in which so many inputs are kept."""
        from lithobrake.touchdown.grains import make_grain

        study, recipe = design.study, bed_recipe(design.study, 0)
        generator = np.random.default_rng(recipe.seed)
        diameters = recipe.sizes.draw((np.arange(GRAIN_COUNT) + 0.5) / GRAIN_COUNT).tolist()
        grains = tuple(make_grain(generator, recipe.cloud_point_count, size) for size in diameters)
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
        """Steps to pour and settle it."""
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
            world.add_body(
                lander.shape, lander.own_material, (0.0, 0.0, 0.0), mass=lander.mass, inertia=lander.inertia,
                parts=lander.parts, centre_of_mass=lander.centre_of_mass,
            )  # fmt: skip
        return world.shortest_contact(speed)
