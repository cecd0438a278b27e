"""How alike landers on one bed end, by the studies made so far: the law of the correlation of a study to come.

    python benchmarks/bed_correlation.py

Every study of journeys whose ends and beds are kept here: those of validation/planned_width_runs.json and of
showcase/mission. The fraction that does not rest differs between beds by a beta law, so the count on a bed is
beta-binomial. How likely a study makes each correlation is averaged over its fraction (Jeffreys' prior). Correlations
of studies follow a beta law, too; its mean is as likely anywhere from 0 to 0.5, and its two parameters together on a
logarithmic scale from 1 to 100. Told: the correlation of one study more, what 99 of 100 stay below, and both without
the one study that says most of large ones. Writes results/bed_correlation.csv, a row a study, and .json. Sources:
[Skellam-1948] (beta-binomial law).
"""

import numpy as np
from harness import (
    RESULTS,
    ROOT,
    Row,
    command_line,
    origin,
    read_document,
    read_rows,
    rounded,
    write_document,
    write_rows,
)
from scipy import special, stats

from lithobrake.vocabulary.constants import LARGEST_CORRELATION

TABLE = RESULTS / "bed_correlation.csv"
CORRELATIONS = np.concatenate([[1e-6], np.linspace(0.005, 0.995, 199)])
# Fractions that do not rest in equal steps of the angle whose squared sine they are: so Jeffreys' prior has them.
FRACTIONS = np.sin(0.5 * np.pi * (np.arange(200) + 0.5) / 200) ** 2
MEANS, SIZES = np.linspace(0.005, 0.495, 50), np.geomspace(1.0, 100.0, 13)
STEPS = (np.arange(1000) + 0.5) / 1000
SHOWN = (0.0, 0.07, 0.3, 0.5)
QUANTILES = (0.5, 0.95, 0.99)


def studies() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Landers that do not rest and all landers, both by bed [bed_count], of each study of journeys."""
    kept = read_document(ROOT / "validation" / "planned_width_runs.json")
    # First touchdowns are shares of flights, and not landers that rest or do not.
    ends = {name: (one["values"], one["bed"]) for name, one in kept.items() if not name.startswith("first bounce")}
    rows = read_rows(ROOT / "showcase" / "mission" / "journeys.csv", {}, str)
    ends["mission"] = [float(row["end"] == "at_rest") for row in rows], [int(row["bed"]) for row in rows]
    return {name: counted(np.array(values, dtype=float), np.array(bed)) for name, (values, bed) in ends.items()}


def counted(rests: np.ndarray, bed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    places = np.unique(bed, return_inverse=True)[1]
    return np.bincount(places, weights=1.0 - rests), np.bincount(places)


def likelihood(failed: np.ndarray, landers: np.ndarray) -> np.ndarray:
    """How likely the counts on beds [bed_count] make each of CORRELATIONS, over that of the likeliest."""
    size = ((1.0 - CORRELATIONS) / CORRELATIONS)[:, None, None]
    first, second = FRACTIONS[:, None] * size, (1.0 - FRACTIONS[:, None]) * size
    logarithm = special.betaln(first + failed, second + landers - failed) - special.betaln(first, second)
    by_fraction = logarithm.sum(axis=2)
    found = np.exp(by_fraction - by_fraction.max()).mean(axis=1)
    return np.asarray(found / found.max())


def of_one_more(likelihoods: list[np.ndarray]) -> Row:
    """Mean and quantiles of the correlation of one study more, and how often it exceeds what limits hold for."""
    laws = [(mean * size, (1.0 - mean) * size) for mean in MEANS for size in SIZES]
    drawn = np.array([stats.beta.ppf(STEPS, *law) for law in laws])
    by_law = sum(np.log(np.interp(drawn, CORRELATIONS, one).mean(axis=1)) for one in likelihoods)
    weights = np.exp(by_law - np.max(by_law))
    weights = np.repeat(weights / weights.sum() / len(STEPS), len(STEPS))
    order = np.argsort(drawn.ravel())
    values, sums = drawn.ravel()[order], np.cumsum(weights[order])
    found = {f"quantile_{level:g}": float(values[np.searchsorted(sums, level)]) for level in QUANTILES}
    return rounded(
        {"studies": len(likelihoods), "mean": float(weights @ drawn.ravel())} | found
        | {"above_limit": float(weights @ (drawn.ravel() > LARGEST_CORRELATION))}
    )  # fmt: skip


def main() -> None:
    command_line(__doc__).parse_args()
    rows, each = [], {}
    for name, (failed, landers) in studies().items():
        each[name] = likelihood(failed, landers)
        row = {"study": name, "landers": int(landers.sum()), "beds": len(landers), "not_at_rest": int(failed.sum())}
        row |= {"likeliest": float(CORRELATIONS[each[name].argmax()])}
        rows.append(row | {f"likelihood_{one:g}": float(np.interp(one, CORRELATIONS, each[name])) for one in SHOWN})
    write_rows(TABLE, rows[0], map(rounded, rows))
    differ = [each[row["study"]] for row in rows if row["not_at_rest"]]
    boldest = max(rows, key=lambda row: float(row["likelihood_0.5"] - row["likelihood_0"]))["study"]
    found = {
        "all": of_one_more([*each.values()]), "some_rest_and_some_do_not": of_one_more(differ),
        "without_the_study_of_the_largest": of_one_more([one for name, one in each.items() if name != boldest]),
    }  # fmt: skip
    limit = {"study_of_the_largest": boldest, "limits_hold_up_to": LARGEST_CORRELATION}
    write_document(TABLE.with_suffix(".json"), {**origin("benchmarks/bed_correlation.py"), **found, **limit})


if __name__ == "__main__":
    main()
