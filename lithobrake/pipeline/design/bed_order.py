"""On which bed each run of a study lies, whatever the number of runs."""

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.study import Study
from lithobrake.study.ground_sections import MOST_BEDS
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_INTERVAL


def beds_of_runs(study: Study, count: int) -> list[int]:
    """Number of the bed of each of the first `count` runs; a larger count changes none."""
    if study.bed.bed_count is not None:
        return _in_blocks(study.seed, study.bed.bed_count, count)
    few, many = FEWEST_BEDS_OF_INTERVAL * study.runs_a_bed, MOST_BEDS * study.runs_a_bed
    # Blocks leave every run on its bed however many follow, and at each full block all beds have equally many.
    first = _in_blocks(study.seed, FEWEST_BEDS_OF_INTERVAL, min(count, few))
    growing = [run // study.runs_a_bed for run in range(few, min(count, many))]
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
