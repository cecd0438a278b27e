"""The drawn design: every run has soil, place, azimuth, attitude and bed of its own, and no other run moves them.

One scrambled Sobol sequence gives all numbers but the bed. Run r is its point r, whatever the number of runs, so more
runs later leave every run as it was.

Bed of a run. With a bed_count that is given, runs go through all beds in blocks, once in order and then each time in
another order. Without it beds grow with the runs: the first 120 runs go in such blocks over 12 beds, then each bed is
new for ten runs, and from 600 runs on blocks go over all 60. So the bed of run r follows from r and the seed alone, and
at each multiple of ten runs, from 120 to 600, all beds have ten.
"""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.geometry.attitude import uniform_attitude
from lithobrake.pipeline.runs.designs import design_inputs
from lithobrake.pipeline.runs.place_region import place_region
from lithobrake.study import Study
from lithobrake.study.bed_section import FEWEST_BEDS, MOST_BEDS, RUNS_A_BED
from lithobrake.study.touchdown_model import ORIENTATION, PLACE, given_attitude, medians

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

AZIMUTH = "impact.azimuth_deg"
# Coordinates of the sequence beside the uncertain inputs. All are there in every study, used or not, so that a place or
# an azimuth that is given leaves the others as they were.
DRAWN = ("place x", "place y", "azimuth", "attitude 1", "attitude 2", "attitude 3")
PAIR_COUNT, TWIN_COUNT = 20, 12
# Side runs stand beside the first runs of the sequence, in its order, so that row k of theirs goes with its row k.
SIDE_DESIGNS = ("soil_pairs", "twins")


def sequence_rows(study: Study, count: int | None = None) -> list[dict[str, float]]:
    """All inputs of the first `count` runs (None: of all), by dotted key in the file's units, with what each drew."""
    from lithobrake.chaos import sobol_sequence

    count = count or study.design.run_count
    x = sobol_sequence(coordinates(study), count, hashed_seed(study.seed, "sequence"))
    return rows_at(study, beds_of_runs(study, count), x)


def sequence_row(study: Study, run: int) -> dict[str, float]:
    """All inputs of one run of the sequence, counted from 0: row `run` of sequence_rows, without the rows before it."""
    from lithobrake.chaos import sobol_sequence

    x = sobol_sequence(coordinates(study), 1, hashed_seed(study.seed, "sequence"), skip=run)
    return rows_at(study, beds_of_runs(study, run + 1)[-1:], x)[0]


def coordinates(study: Study) -> "dict[str, Distribution]":
    """What a run takes from its point, but for its bed: the uncertain inputs, then what it draws, with their laws."""
    from lithobrake.chaos import Uniform

    return design_inputs(study) | dict.fromkeys(DRAWN, Uniform(0.0, 1.0))


def rows_at(study: Study, beds: Sequence[int], x: np.ndarray) -> list[dict[str, float]]:
    """All inputs of the runs on these beds [run_count] at these coordinates [run_count, coordinate_count]."""
    inputs, middle, region = design_inputs(study), medians(study), place_region(study)
    rows = []
    for bed, point in zip(beds, x.tolist(), strict=True):
        soil, uniform = dict(zip(inputs, point, strict=False)), dict(zip(DRAWN, point[len(inputs) :], strict=True))
        row = middle | soil | {"bed": float(bed)} | _arrival(study, uniform)
        if region is not None:
            shares = (uniform["place x"], uniform["place y"])
            row |= {
                name: low + share * (high - low) for name, share, (low, high) in zip(PLACE, shares, region, strict=True)
            }
        rows.append(row)
    return rows


def _arrival(study: Study, uniform: dict[str, float]) -> dict[str, float]:
    """Azimuth and attitude of a run, as far as the study has them drawn or given, not uncertain by another law."""
    first, second, third = (uniform[name] for name in DRAWN[3:])
    drawn = study.impact.orientation == "random"
    attitude = uniform_attitude(first, second, third) if drawn else given_attitude(study, first, second)
    row = dict(zip(ORIENTATION, (attitude / np.linalg.norm(attitude)).tolist(), strict=True))
    return row | ({AZIMUTH: 360.0 * uniform["azimuth"]} if study.impact.azimuth_deg == "random" else {})


def beds_of_runs(study: Study, count: int) -> list[int]:
    """Number of the bed of each of the first `count` runs; a larger count changes none."""
    if study.bed.bed_count is not None:
        return _in_blocks(study.seed, study.bed.bed_count, count)
    few, many = FEWEST_BEDS * RUNS_A_BED, MOST_BEDS * RUNS_A_BED
    first = _in_blocks(study.seed, FEWEST_BEDS, min(count, few))
    growing = [run // RUNS_A_BED for run in range(few, min(count, many))]
    # A bed is as new as any other, so the order in which they were filled so far says nothing.
    return first + growing + _in_blocks(study.seed, MOST_BEDS, count - many)


def _in_blocks(seed: int, bed_count: int, count: int) -> list[int]:
    """Beds in permuted blocks; the first block in order, so that few runs take the first beds."""
    blocks = range(1, -(-count // bed_count))
    orders = [
        np.random.Generator(np.random.PCG64(hashed_seed(seed, "beds of runs", bed_count, block))).permutation(bed_count)
        for block in blocks
    ]
    return [int(bed) for order in (range(bed_count), *orders) for bed in order][: max(count, 0)]


def side_rows(study: Study, design: str) -> list[dict[str, float]]:
    """All inputs of the runs of a side design; row k goes with run k of the sequence."""
    return soil_pairs(study) if design == "soil_pairs" else twins(study)


def soil_pairs(study: Study) -> list[dict[str, float]]:
    """The first runs again on a second soil: all uncertain inputs drawn anew, but bed, place, azimuth and attitude.

    Their differences give the total effect of the soil. Source: [Jansen-1999].
    """
    from lithobrake.chaos import sobol_sequence

    inputs = {name: law for name, law in design_inputs(study).items() if name not in (*PLACE, AZIMUTH)}
    rows = sequence_rows(study, min(PAIR_COUNT, study.design.run_count))
    if not inputs:
        return rows
    second = sobol_sequence(inputs, len(rows), hashed_seed(study.seed, "soil pairs")).tolist()
    return [row | dict(zip(inputs, soil, strict=True)) for row, soil in zip(rows, second, strict=True)]


def twins(study: Study) -> list[dict[str, float]]:
    """The first runs again at places design.twin_shift [m] beside their own: what differs then is chaos."""
    rows = sequence_rows(study, min(TWIN_COUNT, study.design.run_count))
    turns = np.random.Generator(np.random.PCG64(hashed_seed(study.seed, "twins"))).random(len(rows))
    return [
        row | _beside(row, study.design.twin_shift, 2.0 * math.pi * turn) for row, turn in zip(rows, turns, strict=True)
    ]


def _beside(row: dict[str, float], shift: float, direction: float) -> dict[str, float]:
    """A place beside that of a run, toward the middle of the bed: no twin may stand outside of it."""
    step = shift * math.cos(direction), shift * math.sin(direction)
    outward = math.fsum(row[name] * way for name, way in zip(PLACE, step, strict=True)) > 0.0
    return {name: row[name] + (-way if outward else way) for name, way in zip(PLACE, step, strict=True)}


def design_rows(study: Study, design: str) -> list[dict[str, float]]:
    """All inputs of the runs of a design of the sequence."""
    return sequence_rows(study) if design == "sequence" else side_rows(study, design)


def inputs_of(rows: Sequence[Mapping[str, float]], names: Sequence[str]) -> np.ndarray:
    """These inputs of runs in columns, shape [run_count, len(names)]."""
    return np.array([[row[name] for name in names] for row in rows])
