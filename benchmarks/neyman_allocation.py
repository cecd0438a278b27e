"""Would runs at soils where failure is least sure narrow the interval of its probability by enough?

    python benchmarks/neyman_allocation.py [--emulators 20] [--repeats 40]

Synthetic landings whose soil explains 0.06 (weak) or 0.34 (strong) of the variance of the rebound speed, on beds with a
twentieth of the rest; failure: faster than a limit that 0.1, 0.05 or 0.02 of all landings pass. An emulator from 240
runs on 24 beds gives the probability of failure at each soil. 240 runs more on 24 new beds are then made in two ways:
equal     a Sobol sequence of soils, and `share_estimate` with the regression on the inputs that a study takes off
Neyman    ten strata of equal weight by the emulator's probability s, runs by the mean of sqrt(s (1 - s)) in each and a
          tenth of them even; the mean over strata
gain: variance of the first over that of the second, over 800 repeats in all (0.07 of luck); exact: the same
with strata by the true probabilities. whole: with the 240 runs of the first stage counted, which nobody chose.
Writes benchmarks/results/neyman_allocation.csv, and .json beside it.
"""

import sys
from collections.abc import Iterator

import numpy as np
from harness import RESULTS, ROOT, Row, command_line, rounded, write_made, write_rows

sys.path.insert(0, str(ROOT / "tests"))
from synthetic_landings import INPUTS, OUTPUT_NAMES, SPEED_LIMIT, STRONG, WEAK, Truth, random_soils

from lithobrake import emulator
from lithobrake.analysis import regression_terms, share_estimate
from lithobrake.chaos import sobol_sequence

TABLE = RESULTS / "neyman_allocation.csv"
COLUMNS = ("soil", "probability", "gain", "exact", "whole", "bias_equal", "bias_neyman", "sd_equal", "emulators")
PROBABILITIES = (0.1, 0.05, 0.02)
RUNS, BEDS, STRATA, OF_PRIOR = 240, 24, 10, 0.1
POOL, DRAWS = 2000, 300
SPEED = OUTPUT_NAMES.index("speed_out")


def speeds(truth: Truth, x: np.ndarray, bed: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Outgoing speeds [run_count] of landings on beds [run_count], 0 where captured."""
    landed = truth.draw(x, random.standard_normal(int(bed.max()) + 1)[bed], random)
    return np.nan_to_num(landed.left[:, SPEED])


def beds_of(count: int, random: np.random.Generator) -> np.ndarray:
    """Beds of runs [count], in permuted blocks."""
    return np.concatenate([random.permutation(BEDS) for _ in range(-(-count // BEDS))])[:count]


def strata_of(chance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stratum of each soil of the pool, and runs in each stratum [STRATA], by probabilities of failure [POOL]."""
    stratum = np.empty(len(chance), dtype=int)
    stratum[np.argsort(chance, kind="stable")] = np.arange(len(chance)) * STRATA // len(chance)
    spread = np.sqrt(chance * (1.0 - chance))
    wanted = np.array([spread[stratum == one].mean() for one in range(STRATA)])
    part = OF_PRIOR / STRATA + (1.0 - OF_PRIOR) * wanted / wanted.sum()
    # Whole numbers that sum to all runs, two at least.
    ends = np.round(np.cumsum(part) * RUNS).astype(int)
    return stratum, np.maximum(np.diff(ends, prepend=0), 2)


def by_strata(truth: Truth, limit: float, pool: np.ndarray, chance: np.ndarray, random: np.random.Generator) -> float:
    """Probability of failure from runs allocated by these probabilities of failure at the pool."""
    stratum, counts = strata_of(chance)
    chosen = np.concatenate(
        [random.choice(np.flatnonzero(stratum == one), count) for one, count in enumerate(counts.tolist())]
    )
    failed = speeds(truth, pool[chosen], beds_of(len(chosen), random), random) > limit
    own = np.repeat(np.arange(STRATA), counts)
    return float(np.mean([failed[own == one].mean() for one in range(STRATA)]))


def one_emulator(truth: Truth, limits: list[float], exact: np.ndarray, seed: int, repeats: int) -> np.ndarray:
    """Estimates by equal runs, by Neyman's, and by Neyman's with true probabilities: [limit_count, 3, repeats]."""
    random = np.random.default_rng([seed, 2])
    x, y, _, bed = truth.study(RUNS, BEDS, seed)
    model = emulator.fit(
        INPUTS, x, y[:, [SPEED]], groups=bed, lower=0.0, upper=SPEED_LIMIT, output_names=["speed_out"],
        outcome=np.where(np.isnan(y[:, SPEED]), "captured", "clear"),
    )  # fmt: skip
    pool = sobol_sequence(INPUTS, POOL, seed=17)
    drawn = np.nan_to_num(model.sample(pool, DRAWS, seed)[:, :, 0])
    found = np.empty((len(limits), 3, repeats))
    for repeat in range(repeats):
        soils, beds = sobol_sequence(INPUTS, RUNS, seed=1000 * seed + repeat), beds_of(RUNS, random)
        left, terms = speeds(truth, soils, beds, random), regression_terms(INPUTS, soils)
        for place, limit in enumerate(limits):
            found[place, 0, repeat] = share_estimate((left > limit).astype(float), beds, terms=terms).share.value
            # An emulator that has no such landing at a soil still knows it only to its draws.
            seen = np.clip((drawn > limit).mean(axis=1), 0.5 / DRAWS, 1.0 - 0.5 / DRAWS)
            found[place, 1, repeat] = by_strata(truth, limit, pool, seen, random)
            found[place, 2, repeat] = by_strata(truth, limit, pool, exact[place], random)
    return found


def rows(name: str, truth: Truth, emulators: int, repeats: int) -> Iterator[Row]:
    random = np.random.default_rng(7)
    soils = random_soils(1_000_000, random)
    limits = np.quantile(speeds(truth, soils, np.arange(len(soils)), random), 1.0 - np.array(PROBABILITIES)).tolist()
    pool = np.repeat(sobol_sequence(INPUTS, POOL, seed=17), DRAWS * 5, axis=0)
    left = speeds(truth, pool, np.arange(len(pool)), random).reshape(POOL, -1)
    exact = np.array([(left > limit).mean(axis=1) for limit in limits])
    found = np.array([one_emulator(truth, limits, exact, seed, repeats) for seed in range(emulators)])
    for place, probability in enumerate(PROBABILITIES):
        # About the mean of each emulator, so that what differs between emulators is not counted as luck.
        equal, neyman, best = (found[:, place, way].var(axis=1, ddof=1).mean() for way in range(3))
        errors = found[:, place].mean(axis=(0, 2)) - probability
        # Half the runs stay equal: weights by variance are the best that the two halves can have.
        whole = (1.0 / neyman + 1.0 / equal) / (2.0 / equal)
        yield {
            "soil": name, "probability": probability, "gain": equal / neyman, "exact": equal / best, "whole": whole,
            "bias_equal": errors[0], "bias_neyman": errors[1], "sd_equal": float(np.sqrt(equal)),
            "emulators": emulators,
        }  # fmt: skip


def main() -> None:
    asked = command_line(__doc__, emulators=20, repeats=40).parse_args()
    soils = {"weak": WEAK, "strong": STRONG}
    found = (row for name, truth in soils.items() for row in rows(name, truth, asked.emulators, asked.repeats))
    write_rows(TABLE, COLUMNS, map(rounded, found))
    command = f"benchmarks/neyman_allocation.py --emulators {asked.emulators} --repeats {asked.repeats}"
    write_made(TABLE, command, repeats=asked.repeats)


if __name__ == "__main__":
    main()
