"""The forecast from the landers of all branches: chances, numbers, places, what decides, and what is scored.

    python validation/forecast_hera/answers.py --out FOLDER

Reads landers.csv and runs.json of the folder, writes forecast.json; the last step but one of forecast.py.

Shares of a branch have a Dirichlet posterior: counts, divided by their design effect, plus one lander spread evenly
over all ends (Perks' prior), so nothing is impossible. A lander's shares are those of its branches times their weights.
Numbers of the landers at rest weigh a branch by its weight times its share at rest; their intervals resample beds
within branches.
"""

import hashlib
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import hard_ground
import numpy as np
from branches import LANDERS, SCENARIOS, branches
from harness import Row, command_line, origin, read_document, read_rows, write_document
from landers import FIRST, KINDS, RUNS, TABLE
from places import regions, semi_axes
from samples import BINS, CELLS, ENDS, FACES, GROUNDS, Sample, categories, effective_counts, sample, those_down
from scipy.stats import rankdata

import lithobrake
from lithobrake.touchdown.touchdown_model import touchdown_version

HERE = Path(__file__).parent
# The forecast that stands on the assumptions alone.
FIRST_EDITION = HERE / "editions" / "2026-11-26"
FORECAST = "forecast.json"
# What decides, beside the package, how the landers of a study file come down.
SCRIPTS = ("assumptions.py", "branches.py", "descent.py", "grounds.py", "landers.py")
INPUTS = ("mass_kg", *FIRST)
LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
DRAWS, SEED = 4000, 1
# Groups of landers on unknown ground, by their column.
GROUPS = {"by_ground": "kind", "by_law": "law"}
# Of landers on one bed, as `lithobrake plan` assumes it.
CORRELATION = 0.07


def shares(of: Sample, name: str, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Predictive shares of the categories of a quantity [K], and draws of them [DRAWS, K].

    weights: of the branches, [branch_count].
    """
    category, count = categories(of, name)
    random = np.random.default_rng(SEED)
    mean, draws = np.zeros(count), np.zeros((DRAWS, count))
    for number, weight in enumerate(weights):
        here = (of.branch == number) & (category >= 0)
        counts = effective_counts(of.where(here), category[here], count) / design_effect(of, here)
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
    prior = np.bincount(of.branch, of.weight, minlength=len(branches(lander)))
    if at_rest:
        rests = (of.column("end") == "at_rest").astype(int)
        for number in range(len(prior)):
            here = of.branch == number
            moving, resting = effective_counts(of.where(here), rests[here], 2)
            prior[number] *= (resting + 0.25) / (moving + resting + 1.0)
    return prior / prior.sum()


def estimate(mean: float, draws: np.ndarray) -> dict[str, float]:
    """A share with its interval of 90 %."""
    lower, upper = np.quantile(draws, (0.05, 0.95))
    return {"share": float(mean), "lower": float(lower), "upper": float(upper)}


def quantiles(values: np.ndarray, weight: np.ndarray) -> np.ndarray:
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
        # As random.choice draws them, which takes ten times as long.
        chosen = np.concatenate([one[random.integers(len(one), size=len(one))] for one in by_branch])
        rows = np.concatenate([members[one] for one in chosen])
        medians.append(quantiles(values[rows], of.weight[rows])[2])
    lower, upper = np.quantile(medians, (0.05, 0.95))
    levels = {
        f"q{round(100 * level):02d}": float(one)
        for level, one in zip(LEVELS, quantiles(values, of.weight), strict=True)
    }
    return levels | {"median_lower": float(lower), "median_upper": float(upper)}


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


def touched_down(of: Sample) -> dict[str, int]:
    """How many landers touched down on Dimorphos, and how many of these came to rest there."""
    ends = those_down(of).column("end")
    return {"landers": len(ends), "at_rest": int((ends == "at_rest").sum())}


def by_branch(of: Sample, lander: str) -> list[dict[str, Any]]:
    found, weights = [], branch_weights(of, lander, at_rest=False)
    for number_, branch in enumerate(branches(lander)):
        only = np.zeros(len(branches(lander)))
        only[number_] = 1.0
        if weights[number_] == 0.0:
            continue
        mean, draws = shares(of, "end", only)
        found.append({
            "branch": branch.name, "weight": float(weights[number_]), "landers": int((of.branch == number_).sum()),
            **{end: estimate(mean[k], draws[:, k]) for k, end in enumerate(ENDS)},
        })  # fmt: skip
    return found


def by_group(of: Sample, column: str) -> list[dict[str, Any]]:
    """Ends and numbers of the landers on each kind of ground or by each law of restitution, whatever their branch."""
    found, column_values = [], of.column(column)
    for name in dict.fromkeys(column_values):
        own = of.where(column_values == name)
        category, count = categories(own, "end")
        beds = len(np.unique(own.beds))
        effect = 1.0 + (len(own.rows) / beds - 1.0) * CORRELATION
        counts = np.bincount(category, own.weight, minlength=count)
        posterior = counts / counts.sum() * own.weight.sum() ** 2 / (own.weight @ own.weight) / effect + 1.0 / count
        draws = np.random.default_rng(SEED).dirichlet(posterior, DRAWS)
        resting = own.where(own.column("end") == "at_rest")
        found.append({
            "name": str(name), "share": float(own.weight.sum()), "landers": len(own.rows), "beds": beds,
            "at_rest": estimate(float(posterior[0] / posterior.sum()), draws[:, 0]),
            **{key: number(resting, key) for key in ("time_s", "contacts", "distance", "first_speed_ratio")},
        })  # fmt: skip
    return found


def is_weighted(rows: list[Row]) -> bool:
    return any("factor" in row for row in rows)


def answer(rows: list[Row], lander: str, ground: str, axes: np.ndarray | None = None) -> dict[str, Any]:
    """All answers of a lander on a ground; axes: semi-axes of Dimorphos [m], [3], where not the assumed ones."""
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
        "regions": regions(resting, semi_axes() if axes is None else axes) if ground == "soil" else [],
        "by_branch": by_branch(of, lander),
        **{name: by_group(of, key) for name, key in GROUPS.items() if ground == "soil" and of.rows[0].get(key)},
        "what_decides": what_decides(of) if ground == "soil" and not is_weighted(rows) else [],
        "scored": scored,
    }


def digest(*paths: Path) -> str:
    """SHA-256 of files one after the other."""
    found = hashlib.sha256()
    for path in paths:
        found.update(path.read_bytes())
    return found.hexdigest()


def package_files() -> list[Path]:
    """All that makes a study, in the order of their paths."""
    return sorted(Path(lithobrake.__file__).parent.rglob("*.py"))


def write_answers(out: Path) -> dict[str, Any]:
    """Write the forecast beside its landers, and return it; the code is that by which the landers were made."""
    rows = read_rows(out / TABLE, KINDS)
    code = read_document(out / RUNS)["code_sha256"]
    document = {
        "made": time.strftime("%Y-%m-%d"),
        "sha256": {
            "studies": {name: digest(SCENARIOS / f"{name}.toml") for name in LANDERS},
            "branches": digest(*(HERE / name for name in SCRIPTS), Path(hard_ground.__file__)),
            "code": code, "results": digest(out / TABLE),
        },
        "touchdown_version": touchdown_version(),
        "bins": {name: list(edges) for name, edges in BINS.items()} | {
            "end": list(ENDS), "face": list(FACES), "cell": CELLS,
        },
        "landers": {name: {ground: answer(rows, name, ground) for ground in GROUNDS} for name in LANDERS},
        **origin("validation/forecast_hera/answers.py"),
    }  # fmt: skip
    write_document(out / FORECAST, document)
    return document


def main() -> None:
    write_answers(command_line(__doc__, out=Path).parse_args().out)


if __name__ == "__main__":
    main()
