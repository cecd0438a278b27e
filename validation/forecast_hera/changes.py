"""What a measurement changed in the forecast: differences over the same landers with and without its weights.

Intervals of 90 % resample beds within branches; both forecasts of a difference have the same beds.
"""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from answers import SEED, quantiles
from branches import SCENARIOS
from harness import Row, study_tables
from measurements import Measurement
from samples import FACES, Sample, sample
from weights import effective_numbers, weighted

RESAMPLES = 500
TOGETHER = "all together"
# A share of 90 % from so few landers has a standard error of 5 percentage points.
FEWEST = 36.0
MEDIAN = 2  # of the levels of answers.quantiles


def broad_sides(lander: str) -> tuple[str, ...]:
    """The two largest faces of a lander: those across its shortest edge."""
    axis = "xyz"[int(np.argmin(study_tables(SCENARIOS / f"{lander}.toml")["lander"]["edges"]))]
    return tuple(face for face in FACES if face.endswith(axis))


def bed_counts(of: Sample, seed: int = SEED) -> np.ndarray:
    """How often each lander is in a resample of as many beds of its branch, [RESAMPLES, count]."""
    random, beds = np.random.default_rng(seed), of.beds
    counts = np.zeros((RESAMPLES, len(beds)))
    for number in np.unique(of.branch):
        names, place = np.unique(beds[of.branch == number], return_inverse=True)
        drawn = random.multinomial(len(names), np.full(len(names), 1.0 / len(names)), RESAMPLES)
        counts[:, of.branch == number] = drawn[:, place]
    return counts


def figures(of: Sample, counts: np.ndarray, sides: tuple[str, ...]) -> np.ndarray:
    """Fraction at rest, then of those at rest: median time [s], fraction on a broad side, mean place [m], [6].

    counts: of each lander, [count].
    """
    size = int(of.branch.max()) + 1
    sums = np.bincount(of.branch, of.weight, minlength=size)
    drawn = np.bincount(of.branch, of.weight * counts, minlength=size)
    # A branch whose weighty landers are all left out of a resample has no part in it.
    share = np.divide(sums, drawn, out=np.zeros(size), where=drawn > 0.0)
    weight = of.weight * counts * share[of.branch]
    rests = of.column("end") == "at_rest"
    resting, total = weight[rests], weight[rests].sum()
    time = quantiles(of.column("time_s")[rests], resting)[MEDIAN]
    side = resting[np.isin(of.column("face")[rests], sides)].sum() / total
    place = [resting @ of.column(f"position_{axis}")[rests] / total for axis in "xyz"]
    return np.array([total / weight.sum(), time, side, *place])


def change(before: Sequence[Row], after: Sequence[Row], lander: str) -> dict[str, dict[str, float]]:
    """Differences of the figures of the same landers on soil with other weights, each with its interval.

    shift_m: of the mean place of rest, a length; its interval is along its direction.
    """
    old, new = (sample(list(rows), lander, "soil") for rows in (before, after))
    sides = broad_sides(lander)
    one = np.ones(len(old.rows))
    found = figures(new, one, sides) - figures(old, one, sides)
    draws = np.array([figures(new, drawn, sides) - figures(old, drawn, sides) for drawn in bed_counts(old)])
    return differences(found, draws)


def apart(before: Sequence[Row], after: Sequence[Row], lander: str) -> dict[str, dict[str, float]]:
    """Differences of the figures of other landers on soil, after less before: the beds of each scatter by themselves.

    shift_m: of the mean place of rest; its interval is along its direction.
    """
    sides, found, draws = broad_sides(lander), [], []
    for number, rows in enumerate((before, after)):
        of = sample(list(rows), lander, "soil")
        found.append(figures(of, np.ones(len(of.rows)), sides))
        draws.append(np.array([figures(of, counts, sides) for counts in bed_counts(of, SEED + number)]))
    return differences(found[1] - found[0], draws[1] - draws[0])


def differences(found: np.ndarray, draws: np.ndarray) -> dict[str, dict[str, float]]:
    """Differences of figures [6] with intervals of 90 % from resamples [RESAMPLES, 6]."""
    length = float(np.linalg.norm(found[3:]))
    along = draws[:, 3:] @ (found[3:] / length) if length > 0.0 else np.zeros(RESAMPLES)
    columns = {
        "at_rest": (found[0], draws[:, 0]), "time_s": (found[1], draws[:, 1]),
        "broad_side": (found[2], draws[:, 2]), "shift_m": (length, along),
    }  # fmt: skip
    return {
        name: {
            "value": float(value),
            "lower": float(np.quantile(drawn, 0.05)),
            "upper": float(np.quantile(drawn, 0.95)),
        }
        for name, (value, drawn) in columns.items()
    }


def changes(rows: Sequence[Row], lander: str, measurements: Iterable[Measurement]) -> list[dict[str, Any]]:
    """What each measurement that concerns a lander changed alone, and what all of several did together.

    rows: of landers simulated without any. note: why there are no differences, where there are none.
    """
    own = [one for one in measurements if one.lander in ("", lander)]
    before = weighted(rows, lander, ())
    found = [{"measurement": one.words, "lander": lander, **changed_by(rows, before, lander, [one])} for one in own]
    used = [one for one in own if one.is_used]
    if len(used) > 1:
        found.append({"measurement": TOGETHER, "lander": lander, **changed_by(rows, before, lander, used)})
    return found


def changed_by(
    rows: Sequence[Row], before: Sequence[Row], lander: str, measurements: Sequence[Measurement]
) -> dict[str, Any]:
    """Effective number of the landers under some measurements, and the differences that they make; or a note."""
    if not any(one.is_used for one in measurements):
        return {"note": "no input of the landings follows from it"}
    try:
        after = weighted(rows, lander, measurements)
    except ValueError as error:
        return {"note": str(error).partition(";")[0]}
    number = effective_numbers(after, lander)["soil"]
    if number < FEWEST:
        return {"effective": number, "note": "the landers of the first edition stand for too few"}
    return {"effective": number, **change(before, after, lander)}
