"""The beds, the ground and the soils of a study before it runs."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.pipeline.design.arrivals import STEEPEST_DEG, friction_of, smallest_width
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.outdated_files import stage_keys
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.study import Study
from lithobrake.study.checks import narrowest_period
from lithobrake.study.ground_beds import mean_weights, of_ground
from lithobrake.study.ground_checks import LEAST_FRICTION
from lithobrake.touchdown.soil import boulders, grain_sizes
from lithobrake.touchdown.study_keys import by_study_keys
from lithobrake.vocabulary.number_words import HIGH, LOW, MEDIAN, counted, percent
from lithobrake.vocabulary.quantities import ELSEWHERE, GROUND

# Of grains that are larger than the diameter that is told.
LARGE_FRACTION = 0.1
# Beds of a study whose ground is unknown that are priced.
PRICED_BEDS = 6


@dataclass(frozen=True)
class PlannedBeds:
    """Beds of a study: all of them, those that its folder has, those that the library of beds has beside them."""

    total: int
    in_folder: int
    in_library: int

    @property
    def new(self) -> int:
        return self.total - self.in_folder - self.in_library


def planned_beds(study: Study, folder: StudyFolder) -> PlannedBeds:
    """The beds of a study; none where a program of the user's own makes the touchdowns."""
    from lithobrake.touchdown import is_stored

    key, files = stage_keys(study)["bed"], bed_files(study)
    absent = [index for index, file in enumerate(files) if not folder.is_current([file], key)]
    with by_study_keys():
        stored = sum(is_stored(bed_recipe(study, index)) for index in absent)
    return PlannedBeds(len(files), len(files) - len(absent), stored)


@dataclass(frozen=True)
class PlannedTile:
    """Ground that repeats [m]: its widths along x and y, and the least for this lander and these grains.

    At the least no two meet through two images, and no wave of an image meets the first impact.
    """

    width: tuple[float, float]
    smallest: float

    def line(self) -> str:
        along, across = self.width
        return (
            f"Ground: repeats after {along:g} m along x and {across:g} m along y; the smallest tile for this lander "
            f"and these grains is {math.ceil(1e3 * self.smallest) / 1e3:g} m."
        )


def planned_tile(study: Study) -> PlannedTile | None:
    """The tile of a study's ground; None where it does not repeat, or there is none."""
    if not study.has_soil or study.bed.sides == "walls" or study.ground is not None:
        return None
    return PlannedTile(study.bed.width, max(narrowest_period(study), smallest_width(study)))


@dataclass(frozen=True)
class PlannedGrains:
    """Diameters [m]: smallest, largest, their mean, and that which a tenth of the grains exceeds; and how many grains
    there are over a square metre of the bed, from its surface to its floor."""

    smallest: float
    largest: float
    mean: float
    large: float
    count_per_m2: float

    def line(self) -> str:
        return (
            f"Grains: {self.smallest:.3g} to {self.largest:.3g} m in diameter, mean {self.mean:.3g} m; "
            f"{self.count_per_m2:.3g} per m2 of bed, of which {LARGE_FRACTION * self.count_per_m2:.3g} are larger than "
            f"{self.large:.3g} m."
        )


@dataclass(frozen=True)
class PlannedBoulders:
    """How many a bed has in the mean, their diameters [m], the median of the largest one in all beds [m], and the part
    of the ground under them."""

    count: float
    smallest: float
    largest: float
    likely_largest: float
    coverage: float

    def line(self) -> str:
        sizes = f"{self.smallest:.3g} to {self.largest:.3g}" if self.smallest < self.largest else f"{self.largest:.3g}"
        return (
            f"Boulders: {self.count:.3g} in a bed in the mean, {sizes} m in diameter, on {percent(self.coverage)} "
            f"of the ground; the largest of all beds is likely {self.likely_largest:.2g} m."
        )


def planned_boulders(study: Study) -> PlannedBoulders | None:
    """The boulders of a study's beds; None where there are none."""
    rocks = boulders(study) if study.has_soil else None
    if rocks is None:
        return None
    count = rocks.mean_count(math.prod(study.bed.width))
    # Of so many draws half have no boulder beyond this part of the sizes.
    part = 0.5 ** (1.0 / max(count * study.bed_count, 1.0))
    likely = float(rocks.sizes.draw(np.array([part]))[0])
    return PlannedBoulders(count, rocks.sizes.lower, rocks.sizes.upper, likely, rocks.coverage)


def planned_grains(study: Study) -> PlannedGrains | None:
    """The grains of a study's beds; None where they all have one size, or there are none."""
    if not study.has_soil or study.ground is not None:
        return None
    sizes = grain_sizes(study)
    if sizes.lower == sizes.upper:
        return None
    large = float(sizes.draw(np.array([1.0 - LARGE_FRACTION]))[0])
    count = study.bed.grain_count / math.prod(study.bed.width)
    return PlannedGrains(sizes.lower, sizes.upper, sizes.mean_diameter, large, count)


@dataclass(frozen=True)
class PlannedKind:
    """The beds of a kind of ground. sizes: mean diameters of their grains [m]; grains: in a bed; widths: after which
    one repeats [m]; journey_s: CPU time of the touchdowns of a journey there [s], None where nobody knows."""

    kind: str
    probability: float
    beds: int
    sizes: tuple[float, float]
    grains: tuple[int, int]
    widths: tuple[float, float]
    journey_s: tuple[float, float] | None

    def line(self) -> str:
        low, high = self.sizes
        sizes = f"{low:.3g} m" if low == high else f"{low:.3g} to {high:.3g} m"
        few, many = self.grains
        count = f"{few}" if few == many else f"{few} to {many}"
        narrow, wide = self.widths
        widths = f"{narrow:.3g} m" if narrow == wide else f"{narrow:.3g} to {wide:.3g} m"
        cost = (
            "" if self.journey_s is None else f"; a journey costs {self.journey_s[0]:.2g} to {self.journey_s[1]:.2g} s"
        )
        return (
            f"Ground {self.kind}: {percent(self.probability)}, {counted(self.beds, 'bed')} of {count} grains of "
            f"{sizes}, which {'repeat' if self.beds > 1 else 'repeats'} after {widths}{cost}."
        )


def planned_kinds(design: DrawnDesign, price: Callable[[int], tuple[float, float] | None]) -> tuple[PlannedKind, ...]:
    """The kinds of ground of a study, those that have a bed; none of a study of one ground.

    price: CPU time [s] of a journey on the bed of a number.
    """
    study, found = design.study, []
    if study.ground is None or not study.has_soil:
        return ()
    weights = mean_weights(study)
    for name in study.ground.kind:
        beds = [number for number, one in enumerate(design.grounds.each) if one.kind == name]
        made = [of_ground(study, design.grounds.each[number]).bed for number in beds]
        if not made:
            continue
        sizes = [design.grounds.each[number].size for number in beds]
        middle = beds[int(np.argsort(sizes)[len(sizes) // 2])]
        grains, widths = [one.grain_count for one in made], [one.width[0] for one in made]
        ends = ((min(sizes), max(sizes)), (min(grains), max(grains)), (min(widths), max(widths)))
        found.append(PlannedKind(name, weights[name], len(beds), *ends, price(middle)))
    return tuple(found)


def beds_of_all_sizes(design: DrawnDesign) -> list[int]:
    """Some beds, by the size of their grains, of which each stands for as many others; the first of one ground.

    What a bed costs rises steeply as its grains become fine, so that no one of them costs what all do in the mean.
    """
    if not design.grounds.each:
        return [0]
    order = np.argsort([one.size for one in design.grounds.each], kind="stable")
    count = min(PRICED_BEDS, len(order))
    return order[(np.arange(count) * len(order) + len(order) // 2) // count].tolist()


@dataclass(frozen=True)
class PlannedGround:
    """Gravity and rotation together [m/s2], below 0 outward, and slope [deg] of the beds of first touchdowns.

    gravity: that of which one in twenty has less, the median, and that of which one in twenty has more. slope_deg: the
    median, and that of which one in twenty has more. steeper: part of them that lies steeper than soil holds, so that
    the bed is tilted less. roughness_deg: of the ground at the lander's scale, 0 for flat facets.
    """

    gravity: tuple[float, float, float]
    slope_deg: tuple[float, float]
    steeper: float
    roughness_deg: float

    def line(self) -> str:
        low, middle, high = self.gravity
        median, most = self.slope_deg
        rough = f", with a roughness of {self.roughness_deg:g} deg rms" if self.roughness_deg else ""
        capped = (
            f"; {percent(self.steeper)} lie steeper than soil holds, and their beds are tilted up to "
            f"{STEEPEST_DEG:g} deg"
            if self.steeper >= 0.005
            else ""
        )
        return (
            f"First touchdowns: {middle:.2g} m/s2 in the median, {low:.2g} to {high:.2g} for nine in ten; slope "
            f"{median:.0f} deg in the median, 95th percentile {most:.0f} deg{rough}{capped}."
        )


def planned_ground(design: DrawnDesign) -> PlannedGround | None:
    """The ground of the first touchdowns; None where the study gives it, or draws no lander."""
    study = design.study
    if not study.has_local_ground or not study.design.run_count:
        return None
    strength, slope = np.array([[row[name] for name in GROUND[:2]] for row in design.rows]).T
    held = [min(STEEPEST_DEG, math.degrees(math.atan(friction_of(row) / LEAST_FRICTION))) for row in design.rows]
    low, middle, high = np.quantile(strength, [LOW, MEDIAN, HIGH]).tolist()
    median, most = np.quantile(slope, [MEDIAN, HIGH]).tolist()
    # A tilt that was cut at the limit equals it but for the rounding of degrees and radians.
    steeper = float(np.mean(slope > np.array(held) - 1e-9))
    return PlannedGround((low, middle, high), (median, most), steeper, study.site.roughness_deg or 0.0)


@dataclass(frozen=True)
class PlannedSoils:
    """area_shares: of the surface, by region in the order of the file and ELSEWHERE. aim: region of the aim point."""

    area_shares: Mapping[str, float]
    aim: str

    def line(self) -> str:
        shares = [f"{name} {percent(share, 1)}" for name, share in self.area_shares.items()]
        where = "outside of these regions, on [grain]" if self.aim == ELSEWHERE else f"in {self.aim}"
        return f"Soils: {', '.join(shares)} of the surface; the aim point is {where}."


def planned_soils(site: Site) -> PlannedSoils | None:
    """The soils of a study; None where it has one."""
    if not site.study.soil:
        return None
    soils, place = Soils(site), (site.medians["latitude_deg"], site.medians["longitude_deg"])
    (aim,) = soils.at(site.body.shape.surface_point(*place)[None])
    return PlannedSoils(soils.area_shares(), aim)
