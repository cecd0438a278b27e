"""What landers of one number have in common in two studies, and the refusal of studies of which that does not hold."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.vocabulary.number_words import counted
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, ORIENTATION, PLACE

# What the runs of a pair have in common, with what a reader calls it; a study has the columns of what it draws.
COMMON = {
    "bed": "bed",
    **dict.fromkeys(PLACE, "impact point"),
    IMPACT_AZIMUTH: "azimuth",
    **dict.fromkeys(ORIENTATION, "attitude"),
}
# The two names that a sentence has for the studies.
FIRST, SECOND = "A", "B"


@dataclass(frozen=True)
class SharedNumbers:
    """Numbers of the landers of a study that those of another must share.

    name: of the study in messages; touchdowns: that its journeys have at most, None: to rest; columns of COMMON
    [run_count], NaN for a lander that never touched down.
    """

    name: str
    touchdowns: int | None
    columns: Mapping[str, np.ndarray]

    @classmethod
    def of_design(cls, design: DrawnDesign, name: str) -> "SharedNumbers":
        """Those of a study that has not run yet."""
        rows, count = design.rows, len(design.beds)
        number = np.array([int(row["journey"]) for row in rows])
        columns = {
            one: values_by_lander(np.array([row[one] for row in rows]), number, count)
            for one in COMMON
            if one in rows[0]
        }
        return cls(name, design.study.journey.touchdowns, columns)

    @property
    def run_count(self) -> int:
        """How many landers there are."""
        return len(self.columns["bed"])


def values_by_lander(values: np.ndarray, number: np.ndarray, count: int) -> np.ndarray:
    """Values of the first touchdowns of the landers of these numbers as [count], NaN for all others."""
    placed = np.full(count, np.nan)
    placed[number] = values
    return placed


def pair_count(one: SharedNumbers, two: SharedNumbers) -> int:
    """How many pairs there are. Raises ValueError where the landers of one number differ in what they must share."""
    limits = [each.touchdowns for each in (one, two)]
    if limits[0] != limits[1]:
        ways = ["to rest" if limit is None else f"for {counted(limit, 'touchdown')}" for limit in limits]
        said = " and ".join(f"{each.name} follows landers {way}" for each, way in zip((one, two), ways, strict=True))
        raise ValueError(f"{said}; compare studies with the same journey.touchdowns")
    count = min(one.run_count, two.run_count)
    for name, words in COMMON.items():
        if (name in one.columns) != (name in two.columns):
            raise _unlike(one, two, f"only one of them draws the {words} of each run")
        if name not in one.columns:
            continue
        a, b = (each.columns[name][:count] for each in (one, two))
        unlike = np.flatnonzero((a != b) & np.isfinite(a) & np.isfinite(b))
        if len(unlike):
            run = unlike[0]
            said = f"run {run} has {words} {a[run]:g} in {FIRST} and {b[run]:g} in {SECOND} ({name})"
            raise _unlike(one, two, said)
    return count


def _unlike(one: SharedNumbers, two: SharedNumbers, reason: str) -> ValueError:
    return ValueError(
        f"{one.name} ({FIRST}) and {two.name} ({SECOND}) cannot be paired: {reason}; give both the same seed, "
        "bed.bed_count, bed.width and uncertain inputs (their ranges may differ and be narrow), so that run r of "
        "both lands on the same bed at the same impact point"
    )
