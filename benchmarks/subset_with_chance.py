"""How often bounds of subset simulation hold where a model draws chance of its own, which no input stands for.

    python benchmarks/subset_with_chance.py [--seeds 200]

The margin is linear in standard normal inputs and in noise that is drawn anew at each evaluation, as by a program that
takes the seed of its run: failure has probability 1e-3 whatever the part of the noise. Chains do not know the noise, so
they move less than where it is an input.
Writes benchmarks/results/subset_with_chance.csv, and .json beside it.
"""

import argparse
import csv
import json
import math
import time
from pathlib import Path

import numpy as np
from origin import origin
from scipy import stats

from lithobrake.analysis import SubsetResult, subset_simulation

RESULTS = Path(__file__).parent / "results" / "subset_with_chance.csv"
COLUMNS = ("noise_share", "points_per_level", "seeds", "held", "bias", "scatter", "told")
EXACT, DIMENSION = 1e-3, 12
NOISE_SHARES = (0.0, 0.05, 0.15, 0.35, 0.75)


def one(noise_share: float, points_per_level: int, seed: int) -> SubsetResult:
    """Subset simulation of a margin of which noise has this share of the variance; the last input is kept."""
    random = np.random.default_rng([seed, 1])

    def margin(points: np.ndarray) -> np.ndarray:
        of_inputs = points[:, :5].sum(axis=1) * math.sqrt((1.0 - noise_share) / 5.0)
        return stats.norm.isf(EXACT) - of_inputs - math.sqrt(noise_share) * random.standard_normal(len(points))

    return subset_simulation(margin, DIMENSION, points_per_level=points_per_level, kept=[DIMENSION - 1], seed=seed)


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=200)
    count, begin = parser.parse_args().seeds, time.process_time()
    with RESULTS.open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for share in NOISE_SHARES:
            for points in (500, 1000):
                found = [one(share, points, seed) for seed in range(count)]
                probability = np.array([each.probability for each in found])
                numbers = {
                    "held": np.mean([each.lower <= EXACT <= each.upper for each in found]),
                    "bias": probability.mean() / EXACT - 1.0,
                    "scatter": probability.std() / EXACT,
                    "told": np.mean([each.coefficient_of_variation for each in found]),
                }
                row = {"noise_share": share, "points_per_level": points, "seeds": count}
                writer.writerow(row | {key: round(float(value), 3) for key, value in numbers.items()})
    facts = {"seeds": count, "level": 0.9, "cpu_s": round(time.process_time() - begin), "table": RESULTS.name}
    facts |= origin(f"benchmarks/subset_with_chance.py --seeds {count}")
    RESULTS.with_suffix(".json").write_text(json.dumps(facts, indent=1) + "\n")


if __name__ == "__main__":
    main()
