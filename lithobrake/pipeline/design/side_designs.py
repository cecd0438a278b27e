"""Runs beside the first drawn ones, which tell the effects of soil and of chaos: soil pairs and twins.

Row k of a side design goes with row k of the drawn runs.
"""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.study import Study
from lithobrake.vocabulary.quantities import PLACE, Row

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

PAIR_COUNT, TWIN_COUNT = 20, 12
SIDE_DESIGNS = ("soil_pairs", "twins")


def soil_pairs(study: Study, inputs: "Mapping[str, Distribution]", rows: list[Row]) -> list[Row]:
    """The first runs again on a second soil: all uncertain inputs drawn anew, but bed, place, azimuth and attitude.

    Their differences give the total effect of the soil. Source: [Jansen-1999].
    """
    from lithobrake.chaos import sobol_sequence

    first = rows[:PAIR_COUNT]
    if not inputs:
        return first
    second = sobol_sequence(inputs, len(first), hashed_seed(study.seed, "soil pairs")).tolist()
    return [row | dict(zip(inputs, soil, strict=True)) for row, soil in zip(first, second, strict=True)]


def twins(study: Study, rows: list[Row]) -> list[Row]:
    """The first runs again at places design.twin_shift [m] beside their own: what differs then is chaos."""
    first, shift = rows[:TWIN_COUNT], study.design.twin_shift
    turns = np.random.Generator(np.random.PCG64(hashed_seed(study.seed, "twins"))).random(len(first))
    return [row | _beside(row, shift, 2.0 * math.pi * turn) for row, turn in zip(first, turns, strict=True)]


def _beside(row: Row, shift: float, direction: float) -> Row:
    """A place beside that of a run, toward the middle of the bed: no twin may stand outside of it."""
    step = shift * math.cos(direction), shift * math.sin(direction)
    outward = math.fsum(row[name] * way for name, way in zip(PLACE, step, strict=True)) > 0.0
    return {name: row[name] + (-way if outward else way) for name, way in zip(PLACE, step, strict=True)}
