"""How often intervals over unknown ground hold the truth, on synthetic grounds whose truth is known.

    python benchmarks/ground_coverage.py [--studies 300]

Each ground has a fraction at rest and a median time: by the size of its grains, by one of two kinds (70 and 30 %), by
both, or one for all. A study has so many grounds with so many journeys on each; times scatter about their median by a
factor of exp(0.5). Or landers that do not rest go on to another patch, on one body whose kinds have known weights, or
on bodies whose weights nobody knows. Two intervals of 90 %: that of the mean over grounds, and that of one more ground,
of which the patches of one body have none. Writes
results/ground_coverage.csv and .json.
"""

from pathlib import Path

import numpy as np
from harness import command_line, origin, write_document, write_rows

from lithobrake.analysis import quantile_estimate, share_estimate
from lithobrake.analysis.ground_spread import median_over_grounds, share_over_grounds

Truth = tuple[np.ndarray, np.ndarray]
COUNTS = ((2, 24), (4, 12), (6, 8), (12, 4), (12, 8), (20, 2), (20, 5), (24, 4))
RESULTS = Path(__file__).parent / "results"


def by_size(chance: np.random.Generator, count: int) -> Truth:
    size = chance.random(count)
    return 1.0 / (1.0 + np.exp(3.0 * size - 3.0)), 13.0 * np.exp(0.7 * size)


def of_two_kinds(chance: np.random.Generator, count: int) -> Truth:
    first = chance.random(count) < 0.7
    return np.where(first, 0.95, 0.6), np.where(first, 13.0, 25.0)


def of_both(chance: np.random.Generator, count: int) -> Truth:
    first, size = chance.random(count) < 0.8, chance.random(count)
    share = np.where(first, 1.0 / (1.0 + np.exp(2.0 * size - 3.0)), 0.7)
    return share, np.where(first, 13.0 * np.exp(0.6 * size), 25.0 * np.exp(0.2 * chance.normal(size=count)))


def of_one(chance: np.random.Generator, count: int) -> Truth:
    del chance
    return np.full(count, 0.8), np.full(count, 15.0)


GROUNDS = {"by size": by_size, "two kinds": of_two_kinds, "both": of_both, "one ground": of_one}
# Fraction at rest after a touchdown and median time there, of two kinds; the first has this weight, or one between.
REST, TIME, WEIGHT, WEIGHTS = np.array([0.9, 0.4]), np.array([13.0, 25.0]), 0.7, (0.2, 0.95)
PATCHED = ("patches of one body", "patches of bodies")


def hops(
    chance: np.random.Generator, first: np.ndarray, second: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Whether landers rest and when, nan where they do not, after one touchdown or two on these kinds of ground."""
    at_once = chance.random(len(first)) < REST[first]
    rests = at_once | (chance.random(len(first)) < REST[second])
    time = TIME[first] * np.exp(0.5 * chance.normal(size=len(first)))
    time += np.where(at_once, 0.0, TIME[second] * np.exp(0.5 * chance.normal(size=len(first))))
    return rests, np.where(rests, time, np.nan)


def weights(chance: np.random.Generator, name: str, count: int) -> np.ndarray:
    """Weight of the first kind on so many bodies."""
    return np.full(count, WEIGHT) if name == PATCHED[0] else chance.uniform(*WEIGHTS, count)


def patched_study(
    chance: np.random.Generator, name: str, grounds: int, each: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """What landers do on beds of two kinds, and the first bed of each, which stands for a body of its own or not."""
    own = weights(chance, name, grounds)
    kind, bed = (chance.random(grounds) >= own).astype(int), np.repeat(np.arange(grounds), each)
    second = kind[chance.integers(grounds, size=len(bed))]
    # On a body of its own a kind is met by the body's weights, if any bed has it.
    if name == PATCHED[1] and 0 < kind.sum() < grounds:
        second = (chance.random(len(bed)) >= own[bed]).astype(int)
    return *hops(chance, kind[bed], second), bed


def patched_truth(chance: np.random.Generator, name: str, bodies: int, landers: int) -> Truth:
    """Fraction at rest and median time on so many bodies, of so many landers each."""
    share, time = [], []
    for weight in weights(chance, name, bodies):
        rests, y = hops(chance, *(chance.random((2, landers)) >= weight).astype(int))
        share.append(rests.mean())
        time.append(np.nanmedian(y))
    return np.array(share), np.array(time)


def patched_row(name: str, grounds: int, each: int, studies: int) -> dict[str, object]:
    """The same as `row` of bodies of patches."""
    chance = np.random.default_rng([grounds, each, len(GROUNDS) + PATCHED.index(name)])
    rests, y = hops(chance, *(chance.random((2, 400_000)) >= weights(chance, name, 400_000)).astype(int))
    mean_share, median_of_all = rests.mean(), np.nanmedian(y)
    bodies = patched_truth(chance, name, 400, 4000)
    held: dict[str, list[float]] = {"share_mean": [], "share_ground": [], "time_mean": [], "time_ground": []}
    for _ in range(studies):
        rests, y, bed = patched_study(chance, name, grounds, each)
        several = name == PATCHED[1]
        found = {
            "share_mean": (share_estimate(rests.astype(float), bed).share, mean_share),
            "share_ground": (share_over_grounds(rests.astype(float), bed), bodies[0]) if several else None,
            "time_mean": (quantile_estimate(y, bed, 0.5), median_of_all),
            "time_ground": (median_over_grounds(y, bed), bodies[1]) if several else None,
        }
        for key, one in found.items():
            if one is not None and one[0].lower is not None and one[0].upper is not None:
                held[key].append(float(np.mean((one[1] >= one[0].lower) & (one[1] <= one[0].upper))))
    return counted(name, grounds, each, studies, held)


def counted(name: str, grounds: int, each: int, studies: int, held: dict[str, list[float]]) -> dict[str, object]:
    found: dict[str, object] = {"ground": name, "grounds": grounds, "journeys_each": each, "studies": studies}
    for key, values in held.items():
        found |= {f"{key}_held": round(float(np.mean(values)), 3) if values else "", f"{key}_known": len(values)}
    return found


def row(name: str, grounds: int, each: int, studies: int) -> dict[str, object]:
    """How often each interval holds, and its width, over so many studies."""
    chance, draw = np.random.default_rng([grounds, each, list(GROUNDS).index(name)]), GROUNDS[name]
    whole = draw(chance, 200_000)
    mean_share = float(whole[0].mean())
    held: dict[str, list[float]] = {"share_mean": [], "share_ground": [], "time_mean": [], "time_ground": []}
    time_of_all = whole[1] * np.exp(0.5 * chance.normal(size=len(whole[1])))
    rests_of_all = chance.random(len(whole[0])) < whole[0]
    median_of_all = float(np.median(time_of_all[rests_of_all]))
    for _ in range(studies):
        share, time = draw(chance, grounds)
        bed = np.repeat(np.arange(grounds), each)
        rests = chance.random(len(bed)) < share[bed]
        y = np.where(rests, time[bed] * np.exp(0.5 * chance.normal(size=len(bed))), np.nan)
        more = draw(chance, 400)
        for key, one, truth in (
            ("share_mean", share_estimate(rests.astype(float), bed).share, np.array([mean_share])),
            ("share_ground", share_over_grounds(rests.astype(float), bed), more[0]),
            ("time_mean", quantile_estimate(y, bed, 0.5), np.array([median_of_all])),
            ("time_ground", median_over_grounds(y, bed), more[1]),
        ):
            if one.lower is not None and one.upper is not None:
                held[key].append(float(np.mean((truth >= one.lower) & (truth <= one.upper))))
    return counted(name, grounds, each, studies, held)


def main() -> None:
    studies = command_line(__doc__, studies=300).parse_args().studies
    rows = [row(name, *counts, studies) for name in GROUNDS for counts in COUNTS]
    rows += [patched_row(name, *counts, studies) for name in PATCHED for counts in COUNTS]
    write_rows(RESULTS / "ground_coverage.csv", rows[0], rows)
    held = {
        key: [end(float(str(one[f"{key}_held"])) for one in rows if one[f"{key}_held"] != "") for end in (min, max)]
        for key in ("share_mean", "share_ground", "time_mean", "time_ground")
    }
    write_document(RESULTS / "ground_coverage.json", {**origin("benchmarks/ground_coverage.py"), "held": held})


if __name__ == "__main__":
    main()
