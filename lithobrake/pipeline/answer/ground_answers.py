"""How journeys ended over the grounds that a study allows, and on each kind of them."""

import numpy as np

from lithobrake.analysis.ground_spread import median_over_grounds, share_over_grounds
from lithobrake.analysis.output_estimates import quantile_estimate
from lithobrake.analysis.smooth_curve import curve_sizes, median_curve, share_curve
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_share, face_shares
from lithobrake.pipeline.answer.run_answers import is_on_one_ground, why_no_interval
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.results.ground_results import FinerGround, GroundBed, GroundCurve, GroundKindResults, OverGrounds
from lithobrake.results.run_results import CountedShare
from lithobrake.study.ground_beds import BedGround, finer_share, finest, mean_weights
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import MEDIAN

# Beds of fewer grounds show no curve.
FEWEST_OF_CURVE = 6
# Sizes of grains that differ by less than this part are one.
SAME_SIZE = 1e-9


def over_grounds(design: DrawnDesign, table: JourneyTable) -> OverGrounds | None:
    """What one of the grounds would give, or one of the bodies where these are patchy too; None where there is one."""
    rests = table.rests
    if not is_on_one_ground(design.study) or not len(table.end):
        return None
    why, lost = why_no_interval(design.study), table.unknown
    asked = table.taken(np.flatnonzero(rests | lost))
    return OverGrounds(
        at_rest=share_over_grounds(table.told(rests), table.bed, why=why),
        time_s=median_over_grounds(table.of_rest("time_s"), table.bed, why=why, missing=lost),
        distance_m=median_over_grounds(table.of_rest("distance"), table.bed, why=why, missing=lost),
        faces={
            str(face): share_over_grounds(asked.told(asked.face == face), asked.bed, why=why)
            for face in (np.unique(table.face[rests]) if table.has_sides else ())
        },
    )


def finer_ground(design: DrawnDesign, table: JourneyTable) -> FinerGround | None:
    """Ground finer than any bed, and the journeys on the finest beds, which stand for it; None where there is none."""
    study = design.study
    if study.ground is None or (share := finer_share(study)) == 0.0:
        return None
    size = np.array([one.size for one in design.grounds.each])
    here = table.taken(np.flatnonzero(np.isclose(size[table.bed], finest(study), rtol=SAME_SIZE, atol=0.0)))
    if not len(here.end):
        return FinerGround(finest(study), share)
    return FinerGround(finest(study), share, len(here.end), *_conditional(here, why_no_interval(study)))


def _conditional(here: JourneyTable, why: str | None) -> tuple[CountedShare, Estimate, Estimate]:
    """Of journeys on some of the grounds: fraction at rest, median time to rest and distance of those at rest."""
    time, distance = (
        quantile_estimate(here.of_rest(name), here.bed, MEDIAN, why=why, missing=here.unknown)
        for name in ("time_s", "distance")
    )
    return end_share(here.told(here.rests), here.bed, why), time, distance


def ground_curve(design: DrawnDesign, table: JourneyTable) -> GroundCurve | None:
    """How journeys end against the size of the grains; None where it is one, or nobody rests."""
    rests = table.rests
    if design.study.ground is None or not rests.any():
        return None
    size, seed = np.array([one.size for one in design.grounds.each])[table.bed], design.study.seed
    if size.min() == size.max() or len(np.unique(table.bed)) < FEWEST_OF_CURVE:
        return None
    # Opposite sides together: of most landers they are alike.
    axis = np.char.lstrip(table.face.astype(str), "+-")
    names = np.unique(axis[rests]) if table.has_sides else ()
    # The sizes of the curve are those of all beds, also where nobody rests on some.
    curves = {
        str(name): share_curve(np.where(rests, axis == name, np.nan), size, table.bed, seed, table.unknown)
        for name in names
    }
    return GroundCurve(
        grain_size_m=tuple(curve_sizes(size).tolist()),
        at_rest=tuple(share_curve(table.told(rests), size, table.bed, seed, table.unknown)),
        time_s=tuple(median_curve(table.of_rest("time_s"), size, table.bed, seed, table.unknown)),
        axes={name: tuple(one) for name, one in curves.items()},
        beds=tuple(_bed(design.grounds.each[bed], table.taken(table.bed == bed)) for bed in np.unique(table.bed)),
    )


def _bed(ground: BedGround, table: JourneyTable) -> GroundBed:
    """The journeys on a bed of this ground."""
    rests = table.rests
    time = float(np.median(table.numbers["time_s"][rests])) if rests.any() else None
    known = rests if table.unknown.all() else rests[~table.unknown]
    return GroundBed(ground.kind, ground.size, len(rests), float(known.mean()), time)


def kind_results(design: DrawnDesign, table: JourneyTable) -> dict[str, GroundKindResults]:
    """By kind, in the order of the study file; empty for a study of one ground."""
    if design.study.ground is None:
        return {}
    why, found, weights = why_no_interval(design.study), {}, mean_weights(design.study)
    kinds, sizes = (np.array([getattr(one, name) for one in design.grounds.each]) for name in ("kind", "size"))
    for name in design.study.ground.kind:
        own, beds = kinds[table.bed] == name, np.flatnonzero(kinds == name)
        here = table.taken(np.flatnonzero(own))
        if not len(here.end):
            continue
        at_rest, time, distance = _conditional(here, why)
        found[name] = GroundKindResults(
            weight=weights[name],
            beds=len(np.unique(here.bed)),
            journeys=len(here.end),
            grain_size_m=(float(sizes[beds].min()), float(sizes[beds].max())),
            at_rest=at_rest,
            time_s=time,
            distance_m=distance,
            faces=face_shares(here, why),
        )
    return found
