"""How often bounds of subset simulation hold where a model draws chance that no input stands for, or beds differ.

    python benchmarks/subset_with_chance.py [--seeds 200]

The margin is linear in standard normal inputs, in noise that is drawn anew at each evaluation, as by a program that
takes the seed of its run, and in an effect of the bed, drawn once a simulation: failure has probability 1e-3 over all
of them. Chains do not know the noise, so they move less than where it is an input, and keep their bed.
Writes benchmarks/results/subset_with_chance.csv, and .json beside it.
"""

import math
from collections.abc import Iterator

import numpy as np
from harness import RESULTS, Row, command_line, write_made, write_rows
from scipy import stats

from lithobrake.analysis import LEVEL, SubsetResult, subset_simulation

TABLE = RESULTS / "subset_with_chance.csv"
COLUMNS = ("noise_share", "bed_share", "beds", "points_per_level", "seeds", "held", "bias", "scatter", "told", "width")
EXACT, DIMENSION = 1e-3, 12
# Parts of the variance that are noise and the bed's, and number of beds; then points at each level.
CHANCES = [(share, 0.0, 1) for share in (0.0, 0.05, 0.15, 0.35, 0.75)]
CASES = [(*chance, points) for chance in CHANCES for points in (500, 1000)]
CASES += [(0.0, share, beds, 500) for share in (0.0, 0.05, 0.2) for beds in (12, 24, 48)]


def one(noise_share: float, bed_share: float, bed_count: int, points_per_level: int, seed: int) -> SubsetResult:
    """Subset simulation of a margin of which noise and the bed, which the last input picks, have these shares."""
    random = np.random.default_rng([seed, 1])
    effect = math.sqrt(bed_share) * random.standard_normal(bed_count)

    def beds(points: np.ndarray) -> np.ndarray:
        return np.minimum(stats.norm.cdf(points[:, -1]) * bed_count, bed_count - 1.0).astype(int)

    def margin(points: np.ndarray) -> np.ndarray:
        of_inputs = points[:, :5].sum(axis=1) * math.sqrt((1.0 - noise_share - bed_share) / 5.0)
        chance = math.sqrt(noise_share) * random.standard_normal(len(points)) + effect[beds(points)]
        return stats.norm.isf(EXACT) - of_inputs - chance

    options = {"points_per_level": points_per_level, "kept": [DIMENSION - 1], "groups": beds, "seed": seed}
    return subset_simulation(margin, DIMENSION, **options)


def rows(count: int) -> Iterator[Row]:
    """A row a case, over so many seeds."""
    for case in CASES:
        found = [one(*case, seed) for seed in range(count)]
        told = [each.probability for each in found]
        probability = np.array([each.value for each in told])
        numbers = {
            "held": np.mean([each.lower <= EXACT <= each.upper for each in told]),
            "bias": probability.mean() / EXACT - 1.0,
            "scatter": probability.std() / EXACT,
            "told": np.median([each.coefficient_of_variation for each in found]),
            "width": np.median([each.upper / each.lower if each.lower else math.inf for each in told]),
        }
        row = dict(zip(COLUMNS, (*case, count), strict=False))
        yield row | {key: round(float(value), 3) for key, value in numbers.items()}


def main() -> None:
    count = command_line(__doc__, seeds=200).parse_args().seeds
    write_rows(TABLE, COLUMNS, rows(count))
    write_made(TABLE, f"benchmarks/subset_with_chance.py --seeds {count}", seeds=count, level=LEVEL)


if __name__ == "__main__":
    main()
