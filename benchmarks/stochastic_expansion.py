"""What a stochastic expansion is worth beside the default emulator, on synthetic landings with known laws.

    python benchmarks/stochastic_expansion.py [--studies 5]

fits both to that many studies of 300 runs a truth and keeps mean W2**2 / variance of the speed's conditional law, at 30
soils that were not run, in benchmarks/results/stochastic_expansion.csv, and beside it in .json how they were made.
"""

import argparse
import csv
import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from origin import origin

sys.path.insert(0, str(Path(__file__).parents[1]))

from lithobrake import emulator
from tests.emulator.conditional_errors import DrawnRuns, fitted, law_errors
from tests.synthetic_landings import INPUTS, SPEED_LIMIT, STRONG, WEAK, Truth

RESULTS = Path(__file__).parent / "results" / "stochastic_expansion.csv"
RUNS, BEDS, DRAWS = 300, 30, 4000


@dataclass(frozen=True)
class SpeedAlone:
    """Draws of an expansion of the speed in the shape of an emulator's: the other outputs are those of the emulator."""

    expansion: emulator.StochasticExpansion
    others: emulator.Emulator

    def sample(self, x: np.ndarray, count: int, seed: int = 0) -> np.ndarray:
        """Draw outputs [point_count, count, output_count], all of them of landers that leave."""
        y = np.nan_to_num(self.others.sample(x, count, seed))
        y[:, :, 0] = self.expansion.sample(x, count, seed)
        return y


def row(name: str, truth: Truth, seed: int) -> dict[str, Any]:
    """Errors of both, and of drawing runs, after fits to one study."""
    x, y, _, bed = truth.study(RUNS, BEDS, seed)
    begin = time.process_time()
    expansion = emulator.fit_stochastic_expansion(INPUTS, x, y[:, 0], groups=bed, lower=0.0, upper=SPEED_LIMIT)
    middle = time.process_time()
    model = fitted(truth, RUNS, BEDS, seed)
    end = time.process_time()
    laws = {"expansion": SpeedAlone(expansion, model), "emulator": model, "rows": DrawnRuns(model)}
    return {
        "truth": name, "seed": seed, "runs": RUNS, "degree": expansion.degree, "latent": expansion.latent,
        **{f"{key}_speed_w2": law_errors(truth, law, draw_count=DRAWS)[0] for key, law in laws.items()},
        "expansion_cpu_s": middle - begin, "emulator_cpu_s": end - middle,
    }  # fmt: skip


def main() -> None:
    """Make all rows and write them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--studies", type=int, default=5)
    studies = parser.parse_args().studies
    begin = origin(f"benchmarks/stochastic_expansion.py --studies {studies}")
    rows = []
    for name, truth in (("weak", WEAK), ("strong", STRONG)):
        for seed in range(studies):
            found = row(name, truth, seed)
            rows.append({key: round(one, 4) if isinstance(one, float) else one for key, one in found.items()})
            print(rows[-1], flush=True)
    with open(RESULTS, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    RESULTS.with_suffix(".json").write_text(json.dumps(begin, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
