"""The speed and spin that no lander leaves with: what energy allows."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.study import Study
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.touchdown_model import stored_bed
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import IMPACT_SPEED, SPIN

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from lithobrake.campaign import Record

# More energy than that of the bound, by what time steps and printed digits are off.
SLACK = 0.01
LEAVES = {"speed_out", "spin_out"}


class EnergyBound(NamedTuple):
    """The most that landers can leave with, [count].

    speed     m/s, of one that does not spin
    gyration  smallest radius of gyration [m]: a lander spins fastest about its easiest axis
    """

    speed: "NDArray[np.float64]"
    gyration: "NDArray[np.float64]"

    def at(self, rows: "slice | NDArray[np.int64]") -> "EnergyBound":
        return EnergyBound(self.speed[rows], self.gyration[rows])

    def spin(self, speed: "NDArray[np.float64] | float" = 0.0) -> "NDArray[np.float64]":
        """Largest angular velocity [rad/s] of landers that leave at a speed [m/s], [count]."""
        left: NDArray[np.float64] = np.sqrt(np.maximum(self.speed**2 - speed**2, 0.0)) / self.gyration
        return left


def energy_bound(
    design: DrawnDesign,
    bed_height: float,
    values: "Mapping[str, NDArray[np.float64]]",
    count: int,
    across: float | None = None,
) -> EnergyBound:
    """Bound of a lander that keeps all its energy and gains what gravity may give it over the bed, [count].

    bed_height: of the highest bed [m]. values: of uncertain inputs, [count] each, by dotted key; all others are as the
    study has them. The bed is at rest and contacts only take energy away: v^2 + I w^2 / m + 2 g h, with h the height of
    the bed, and its fall along the slope: `across` [m] where that is known, else across the box, or where nothing stops
    it as far as it comes within the time limit.
    """
    known = {name: np.full(count, value) for name, value in design.medians.items()} | dict(values)
    spin = sum(known[name] ** 2 for name in SPIN)
    slope, gravity = np.sin(np.radians(known["surface.slope_deg"])), np.abs(known["surface.gravity"])
    # Gravity that points outwards lifts a lander as far as the other makes it fall.
    fallen = farthest(design.study, known[IMPACT_SPEED], gravity * slope) if across is None else across
    gained = gravity * (bed_height + fallen * slope)
    smallest, largest = gyrations(design, known)
    # The spin before counts about the stiffest axis and the spin after about the easiest, so that the bound holds for
    # every attitude.
    return EnergyBound(np.sqrt(known[IMPACT_SPEED] ** 2 + largest * spin + 2.0 * gained), np.sqrt(smallest))


def bound_of_runs(design: DrawnDesign, folder: StudyFolder, runs: DesignRuns) -> EnergyBound:
    """What energy allows each run of a study [run_count]."""
    values = {name: runs.inputs[name] for name in design.medians if name in runs.inputs}
    height, across = height_of_beds(design.study, folder), across_of(design.study, folder)
    return energy_bound(design, height, values, runs.run_count, across)


def runs_beyond(runs: DesignRuns, bound: EnergyBound) -> int:
    """How many runs left with more speed and spin than energy allows."""
    # At the bound of the speed nothing is left for a spin.
    return int((runs.output("spin_out") >= bound.spin(runs.output("speed_out"))).sum())


def farthest(
    study: Study, speed: "NDArray[np.float64] | float", downhill: "NDArray[np.float64] | float"
) -> "NDArray[np.float64] | float":
    """How far [m] a lander comes downhill that impacts at a speed [m/s], by its acceleration [m/s2] along the slope."""
    if study.bed.sides == "walls":
        # No two places of a box are farther apart than its diagonal.
        return float(np.hypot(*study.bed.width))
    limit = _time_limit(study)
    return speed * limit + 0.5 * downhill * limit**2


def _time_limit(study: Study) -> float:
    return study.journey.duration if study.landing.time_limit is None else study.landing.time_limit


def across_of(study: Study, folder: StudyFolder) -> float | None:
    """Longest way of a first touchdown along the ground [m], where no time limit bounds it; None where one does."""
    return None if study.landing.time_limit is not None else DesignRuns.load(folder, "drawn").longest_way


def bound_numbers(design: DrawnDesign, bed_height: float, across: float | None = None) -> dict[str, float]:
    """The numbers of `energy_bound`, for whoever follows the uncertain inputs alone.

    across: as of `energy_bound`. The result has height: of the bed [m]; across: that or the box [m], and time_limit: in
    which a lander comes downhill where there is neither [s], each 0 without the other; smallest, largest: squared radii
    of gyration [m2] at the medians, which go with these powers of mass and diameter; and the medians of whatever the
    bound depends on, by dotted key.
    """
    study, known = design.study, design.medians
    smallest, largest = (float(one[0]) for one in gyrations(design, {key: np.array([known[key]]) for key in known}))
    has_inertia, is_sphere = study.lander.inertia is not None, _is_sphere(study)
    names = (IMPACT_SPEED, *SPIN, "surface.slope_deg", "surface.gravity", "lander.mass", "lander.diameter")
    return {
        "height": bed_height,
        "across": float(farthest(study, 0.0, 0.0)) if across is None else across,
        "time_limit": 0.0 if study.bed.sides == "walls" or across is not None else _time_limit(study),
        "smallest": smallest,
        "largest": largest,
        "mass_power": -1.0 if has_inertia else 0.0,
        "diameter_power": 2.0 if is_sphere and not has_inertia else 0.0,
        **{name: float(known[name]) for name in names if name in known},
    }


def energy_warning(design: DrawnDesign, records: "Sequence[Record]", bed_height: float) -> str | None:
    """What it means that runs left with more energy than they came with and gravity may have given; None without any.

    A model of the user's own may have a source of energy, a spring or a thruster, so nothing is refused. bed_height: of
    the highest bed [m]; 0 where a program of the user's own has a ground of its own.
    """
    left = [one for one in records if one.outcome == TouchdownOutcome.CLEAR and not LEAVES.difference(one.outputs)]
    if not left:
        return None
    inputs = {name: np.array([one.inputs[name] for one in left]) for name in design.medians}
    ways = [math.hypot(one.outputs.get("displacement_x", 0.0), one.outputs.get("displacement_y", 0.0)) for one in left]
    across = max(ways) if design.study.landing.time_limit is None else None
    bound = energy_bound(design, bed_height, inputs, len(left), across)
    speed, spin = (np.array([one.outputs[name] for one in left]) for name in ("speed_out", "spin_out"))
    ratio = (speed**2 + (bound.gyration * spin) ** 2) / np.maximum(bound.speed**2, np.finfo(float).tiny)
    over = ratio > 1.0 + SLACK
    if not over.any():
        return None
    worst = int(np.argmax(ratio))
    speeds = f"{speed[worst]:.3g} m/s after {inputs['impact.speed'][worst]:.3g} m/s"
    return (
        f"{int(over.sum())} of {len(left)} landers that left have more energy than impact and gravity provide, at most "
        f"{ratio[worst]:.3g} times as much ({speeds}): check for a source of energy or a wrong unit"
    )


def height_of_beds(study: Study, folder: StudyFolder) -> float:
    """Height [m] of the highest bed; a program of the user's own tells of none."""
    return max((float(stored_bed(folder / name).surface_height) for name in bed_files(study)), default=0.0)


def _is_sphere(study: Study) -> bool:
    """Whether the lander is a sphere alone: the one shape whose size may be uncertain."""
    return study.lander.diameter is not None and not study.lander.part


def gyrations(
    design: DrawnDesign, values: "Mapping[str, NDArray[np.float64]]"
) -> "tuple[NDArray[np.float64], NDArray[np.float64]]":
    """Smallest and largest principal moment of inertia over the mass [m2], [count] each."""
    section, mass = design.study.lander, values["lander.mass"]
    if section.inertia is None and _is_sphere(design.study):
        # Two fifths of the squared radius, of a homogeneous ball.
        return 0.1 * values["lander.diameter"] ** 2, 0.1 * values["lander.diameter"] ** 2
    body = lander(design.study, design.medians)
    if section.inertia is not None:
        own = np.linalg.eigvalsh(body.body.inertia)
        return own[0] / mass, own[-1] / mass
    if not body.parts:
        own = np.linalg.eigvalsh(body.shape.inertia_per_density) / body.shape.volume
        return np.full(len(mass), own[0]), np.full(len(mass), own[-1])
    # What is uncertain of the mass is that of the main shape.
    masses, place = np.unique(mass, return_inverse=True)
    moments = np.array([np.linalg.eigvalsh(replace(body, mass=float(one)).body.inertia) / one for one in masses])
    return moments[place, 0], moments[place, -1]
