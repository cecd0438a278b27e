"""The landers that an answer is about: those of one spacecraft on one ground, and the bins in which they are scored."""

from typing import Any, NamedTuple

import numpy as np
from branches import branches

Row = dict[str, Any]
ENDS = ("at_rest", "escaped", "partner", "under_way")
GROUNDS = ("soil", "hard")
# What is scored of a lander at rest: lower edges of the bins; the last one is open.
BINS: dict[str, tuple[float, ...]] = {
    "time_min": (0, 10, 20, 40, 80, 160, 320, 640),
    "contacts": (1, 2, 3, 5, 9, 17),
    "first_speed_ratio": (0, 1e-9, 0.1, 0.2, 0.3, 0.4, 0.6),
}
FACES = ("+x", "-x", "+y", "-y", "+z", "-z")
SECTORS, BANDS = 8, 3  # of longitude, and of the sine of latitude: cells of equal area on a ball
CELLS = f"{BANDS} bands of sin(latitude) from the south, in each {SECTORS} sectors of longitude from -180 deg eastward"


class Sample(NamedTuple):
    """Landers of one spacecraft on one kind of ground, [count] each: rows, branch, weight."""

    rows: list[Row]
    branch: np.ndarray
    weight: np.ndarray

    def column(self, name: str) -> np.ndarray:
        return np.array([row[name] for row in self.rows])

    @property
    def factor(self) -> np.ndarray:
        """Landers of its branch that each stands for; 1 where none was weighted (weights.py)."""
        return np.array([row.get("factor", 1.0) for row in self.rows])

    @property
    def beds(self) -> np.ndarray:
        """Bed of each, by a number that no other branch has."""
        return self.column("bed") + 1000 * self.branch

    def where(self, chosen: np.ndarray) -> "Sample":
        """The chosen landers, booleans [count]."""
        rows = [row for row, one in zip(self.rows, chosen, strict=True) if one]
        return Sample(rows, self.branch[chosen], self.weight[chosen])


def sample(rows: list[Row], lander: str, ground: str) -> Sample:
    """The landers of one spacecraft on a ground, each with its part of the weight of its branch.

    A journey that failed says nothing of the lander, and is left out. Rows may have a `factor`, the landers of their
    branch that they stand for, and a `branch_weight` other than that of the branch.
    """
    known = {one.name: (number, one.weight) for number, one in enumerate(branches(lander))}
    own = [
        row for row in rows
        if (row["lander"], row["ground"]) == (lander, ground) and row["branch"] in known and row["end"] in ENDS
    ]  # fmt: skip
    branch = np.array([known[row["branch"]][0] for row in own])
    factor = np.array([row.get("factor", 1.0) for row in own])
    sums = np.bincount(branch, factor, minlength=len(known))[branch]
    of_branch = np.array([row.get("branch_weight", known[row["branch"]][1]) for row in own])
    weight = np.divide(of_branch * factor, sums, out=np.zeros(len(own)), where=sums > 0.0)
    return Sample(own, branch, weight / weight.sum())


def effective_counts(of: Sample, category: np.ndarray, count: int) -> np.ndarray:
    """Landers in each category [count], of so many as all of them stand for: their number where none is weighted."""
    factor = of.factor
    total = factor.sum()
    if total == 0.0:
        return np.zeros(count)
    return np.bincount(category, factor, minlength=count) * total / (factor @ factor)


def categories(of: Sample, name: str) -> tuple[np.ndarray, int]:
    """Which category each lander is in, and how many there are."""
    if name == "end":
        return np.array([ENDS.index(end) for end in of.column("end")]), len(ENDS)
    if name == "face":
        return np.array([FACES.index(face) if face in FACES else -1 for face in of.column("face")]), len(FACES)
    if name == "cell":
        return cells(of.column("latitude_deg"), of.column("longitude_deg")), SECTORS * BANDS
    values = of.column("time_s") / 60.0 if name == "time_min" else of.column(name)
    return np.searchsorted(BINS[name], values, side="right") - 1, len(BINS[name])


def cells(latitude_deg: np.ndarray, longitude_deg: np.ndarray) -> np.ndarray:
    """Cell of each place: bands from south to north, in each the sectors eastward from longitude -180."""
    band = np.floor((np.sin(np.radians(latitude_deg)) + 1.0) * 0.5 * BANDS).clip(0, BANDS - 1)
    sector = np.floor((longitude_deg + 180.0) / 360.0 * SECTORS) % SECTORS
    return (band * SECTORS + sector).astype(int)


def those_down(of: Sample) -> Sample:
    """Those that touch down on Dimorphos."""
    return of.where(np.isfinite(of.column("speed")))
