"""The forecast from the landers of all branches: chances, numbers, places, what decides, and what is scored.

    python validation/forecast_hera/answers.py [--out FOLDER]

Reads landers.csv, writes forecast.json.

Shares of a branch have a Dirichlet posterior: counts, divided by their design effect, plus one lander spread evenly
over all ends (Perks' prior), so nothing is impossible. A lander's shares are those of its branches times their weights.
Numbers of the landers at rest weigh a branch by its weight times its share at rest; their intervals resample beds
within branches.
"""

import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from branches import LANDERS, SCENARIOS, branches
from forecast import FIRST, HERE, KINDS, TABLE, digest, package_files
from scipy.stats import rankdata

from lithobrake.analysis.highest_density import highest_density
from lithobrake.study.touchdown_model import touchdown_version

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, command_line, origin, read_rows, write_document

ENDS = ("at_rest", "escaped", "partner", "under_way")
GROUNDS = ("soil", "hard")
INPUTS = ("mass_kg", *FIRST)
LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
DRAWS, SEED = 4000, 1
# Of landers on one bed, as `lithobrake plan` assumes it.
CORRELATION = 0.07
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
        """Values of a column."""
        return np.array([row[name] for row in self.rows])

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

    A journey that failed says nothing of the lander, and is left out.
    """
    known = {one.name: (number, one.weight) for number, one in enumerate(branches(lander))}
    own = [
        row for row in rows
        if (row["lander"], row["ground"]) == (lander, ground) and row["branch"] in known and row["end"] in ENDS
    ]  # fmt: skip
    branch = np.array([known[row["branch"]][0] for row in own])
    counts = np.bincount(branch, minlength=len(known))
    weight = np.array([known[row["branch"]][1] for row in own]) / counts[branch]
    return Sample(own, branch, weight / weight.sum())


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


def shares(of: Sample, name: str, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Predictive shares of the categories of a quantity [K], and draws of them [DRAWS, K].

    weights: of the branches, [branch_count].
    """
    category, count = categories(of, name)
    random = np.random.default_rng(SEED)
    mean, draws = np.zeros(count), np.zeros((DRAWS, count))
    for number, weight in enumerate(weights):
        here = (of.branch == number) & (category >= 0)
        counts = np.bincount(category[here], minlength=count) / design_effect(of, here)
        posterior = counts + 1.0 / count
        mean += weight * posterior / posterior.sum()
        draws += weight * random.dirichlet(posterior, DRAWS)
    return mean, draws


def design_effect(of: Sample, here: np.ndarray) -> float:
    """How many landers that share beds count as one: 1 + (landers a bed - 1) times their correlation."""
    beds = of.column("bed")[here]
    each = len(beds) / max(len(np.unique(beds)), 1)
    return 1.0 + max(each - 1.0, 0.0) * CORRELATION


def branch_weights(of: Sample, lander: str, at_rest: bool) -> np.ndarray:
    """Weights of the branches, adding up to 1; at_rest: given that the lander comes to rest."""
    prior = np.array([one.weight for one in branches(lander)])
    if at_rest:
        rests = of.column("end") == "at_rest"
        prior = prior * np.array(
            [
                (rests[of.branch == number].sum() + 0.25) / ((of.branch == number).sum() + 1.0)
                for number in range(len(prior))
            ]
        )
    prior[[not (of.branch == number).any() for number in range(len(prior))]] = 0.0
    return prior / prior.sum()


def estimate(mean: float, draws: np.ndarray) -> dict[str, float]:
    """A share with its interval of 90 %."""
    lower, upper = np.quantile(draws, (0.05, 0.95))
    return {"share": float(mean), "lower": float(lower), "upper": float(upper)}


def quantiles(values: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Weighted quantiles at LEVELS."""
    order = np.argsort(values)
    share = np.cumsum(weight[order]) - 0.5 * weight[order]
    return np.interp(LEVELS, share / weight.sum(), values[order])


def number(of: Sample, name: str) -> dict[str, Any]:
    """Quantiles of a number of the landers at rest, and those of its median over beds drawn anew."""
    values = of.column(name)
    random, medians = np.random.default_rng(SEED), []
    beds = of.beds
    unique = np.unique(beds)
    members = {one: np.flatnonzero(beds == one) for one in unique}
    by_branch = [unique[unique // 1000 == one] for one in np.unique(unique // 1000)]
    for _ in range(1000):
        chosen = np.concatenate([random.choice(one, len(one)) for one in by_branch])
        rows = np.concatenate([members[one] for one in chosen])
        medians.append(quantiles(values[rows], of.weight[rows])[2])
    lower, upper = np.quantile(medians, (0.05, 0.95))
    levels = {
        f"q{round(100 * level):02d}": float(one)
        for level, one in zip(LEVELS, quantiles(values, of.weight), strict=True)
    }
    return levels | {"median_lower": float(lower), "median_upper": float(upper)}


def regions(of: Sample) -> list[dict[str, Any]]:
    """Smallest regions that hold half and 95 % of the landers at rest, of as many of each branch as it weighs."""
    random = np.random.default_rng(SEED)
    size = int((1.0 / of.weight.max()) * of.weight.sum())
    rows = random.choice(len(of.rows), size, replace=False, p=of.weight / of.weight.sum())
    points = np.array([[of.rows[row][f"position_{axis}"] for axis in "xyz"] for row in rows])
    found = highest_density(points)
    return [
        {"share": one.share, "area_m2": one.area_m2, "largest_extent_m": one.largest_extent_m,
         "outlines": [np.round(line, 2).tolist() for line in one.outlines]}
        for one in found.regions
    ]  # fmt: skip


def what_decides(of: Sample) -> list[dict[str, Any]]:
    """How each uncertain number goes with the end, the time to rest and the first rebound of landers that touch down.

    Rank correlations, within branches; their intervals resample beds.
    """
    landed = those_down(of)
    rests = landed.column("end") == "at_rest"
    known = {"time_s": rests, "first_speed_ratio": np.ones_like(rests)}
    found = []
    for name in INPUTS:
        values = landed.column(name)
        lower, upper = (values < np.median(values)), (values >= np.median(values))
        found.append(
            {
                "input": name, "landers": len(values),
                "at_rest_lower_half": float(rests[lower].mean()), "at_rest_upper_half": float(rests[upper].mean()),
                **{key: rank_correlation(landed.where(one), name, key) for key, one in known.items()},
            }
        )  # fmt: skip
    return found


def rank_correlation(of: Sample, one: str, other: str) -> dict[str, float]:
    """Spearman's correlation of two columns, ranked within branches, with an interval of 90 %."""
    ranks, random = [within(of.column(name), of.branch) for name in (one, other)], np.random.default_rng(SEED)
    beds = of.beds
    members = [np.flatnonzero(beds == bed) for bed in np.unique(beds)]
    draws = []
    for _ in range(500):
        rows = np.concatenate([members[k] for k in random.integers(len(members), size=len(members))])
        draws.append(np.corrcoef(ranks[0][rows], ranks[1][rows])[0, 1])
    lower, upper = np.quantile(draws, (0.05, 0.95))
    return {"value": float(np.corrcoef(*ranks)[0, 1]), "lower": float(lower), "upper": float(upper)}


def within(values: np.ndarray, branch: np.ndarray) -> np.ndarray:
    """Ranks of values among those of their branch, less their mean, over how many there are."""
    found = np.zeros(len(values))
    for one in np.unique(branch):
        here = branch == one
        found[here] = (rankdata(values[here]) - 0.5 * (here.sum() + 1.0)) / here.sum()
    return found


def those_down(of: Sample) -> Sample:
    """Those that touch down on Dimorphos."""
    return of.where(np.isfinite(of.column("speed")))


def touched_down(of: Sample) -> dict[str, int]:
    """How many landers touched down on Dimorphos, and how many of these came to rest there."""
    ends = those_down(of).column("end")
    return {"landers": len(ends), "at_rest": int((ends == "at_rest").sum())}


def by_branch(of: Sample, lander: str) -> list[dict[str, Any]]:
    """Ends of each branch."""
    found = []
    for number_, branch in enumerate(branches(lander)):
        only = np.zeros(len(branches(lander)))
        only[number_] = 1.0
        if not (of.branch == number_).any():
            continue
        mean, draws = shares(of, "end", only)
        found.append({
            "branch": branch.name, "weight": branch.weight, "landers": int((of.branch == number_).sum()),
            **{end: estimate(mean[k], draws[:, k]) for k, end in enumerate(ENDS)},
        })  # fmt: skip
    return found


def answer(rows: list[Row], lander: str, ground: str) -> dict[str, Any]:
    """All answers of one lander on one ground."""
    of = sample(rows, lander, ground)
    mean, draws = shares(of, "end", branch_weights(of, lander, at_rest=False))
    resting = of.where(of.column("end") == "at_rest")
    given = branch_weights(of, lander, at_rest=True)
    scored = {"end": [float(one) for one in mean]}
    for name in (*BINS, "cell", *(("face",) if ground == "soil" else ())):
        scored[name] = [float(one) for one in shares(resting, name, given)[0]]
    return {
        "landers": len(of.rows),
        "touched_down": touched_down(of),
        "ends": {end: estimate(mean[k], draws[:, k]) for k, end in enumerate(ENDS)},
        "at_rest": {name: number(resting, name) for name in ("time_s", "contacts", "distance", "first_speed_ratio")},
        "regions": regions(resting),
        "by_branch": by_branch(of, lander),
        "what_decides": what_decides(of) if ground == "soil" else [],
        "scored": scored,
    }


def main() -> None:
    """Write the forecast."""
    options = command_line(__doc__, out=HERE).parse_args()
    rows = read_rows(options.out / TABLE, KINDS)
    document = {
        "made": time.strftime("%Y-%m-%d"),
        "sha256": {
            "studies": {name: digest(SCENARIOS / f"{name}.toml") for name in LANDERS},
            "branches": digest(HERE / "branches.py", HERE / "descent.py", HERE / "grounds.py"),
            "code": digest(*package_files()), "results": digest(options.out / TABLE),
        },
        "touchdown_version": touchdown_version(),
        "bins": {name: list(edges) for name, edges in BINS.items()} | {
            "end": list(ENDS), "face": list(FACES), "cell": CELLS,
        },
        "landers": {name: {ground: answer(rows, name, ground) for ground in GROUNDS} for name in LANDERS},
        **origin("validation/forecast_hera/answers.py"),
    }  # fmt: skip
    write_document(options.out / "forecast.json", document)


if __name__ == "__main__":
    main()
