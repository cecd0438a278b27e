"""What a stochastic expansion is worth beside the default emulator, on synthetic landings with known laws.

    python benchmarks/stochastic_expansion.py [--studies 5]

fits both to that many studies of 300 runs a truth and keeps mean W2**2 / variance of the speed's conditional law, at 30
soils that were not run, in benchmarks/results/stochastic_expansion.csv, and beside it in .json how they were made.
"""

import sys
from dataclasses import dataclass

import numpy as np
from harness import RESULTS, ROOT, Row, command_line, origin, timed, write_document, write_rows

sys.path.insert(0, str(ROOT))

from lithobrake import emulator
from tests.emulator.conditional_errors import DrawnRuns, fitted, law_errors
from tests.synthetic_landings import INPUTS, SPEED_LIMIT, STRONG, WEAK, Truth

TABLE = RESULTS / "stochastic_expansion.csv"
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


def row(name: str, truth: Truth, seed: int) -> Row:
    x, y, _, bed = truth.study(RUNS, BEDS, seed)
    options = {"groups": bed, "lower": 0.0, "upper": SPEED_LIMIT}
    expansion, expansion_time = timed(lambda: emulator.fit_stochastic_expansion(INPUTS, x, y[:, 0], **options))
    model, emulator_time = timed(lambda: fitted(truth, RUNS, BEDS, seed))
    laws = {"expansion": SpeedAlone(expansion, model), "emulator": model, "rows": DrawnRuns(model)}
    return {
        "truth": name, "seed": seed, "runs": RUNS, "degree": expansion.degree, "latent": expansion.latent,
        **{f"{key}_speed_w2": law_errors(truth, law, draw_count=DRAWS)[0] for key, law in laws.items()},
        "expansion_cpu_s": expansion_time, "emulator_cpu_s": emulator_time,
    }  # fmt: skip


def main() -> None:
    studies = command_line(__doc__, studies=5).parse_args().studies
    begin = origin(f"benchmarks/stochastic_expansion.py --studies {studies}")
    rows = []
    for name, truth in (("weak", WEAK), ("strong", STRONG)):
        for seed in range(studies):
            found = row(name, truth, seed)
            rows.append({key: round(one, 4) if isinstance(one, float) else one for key, one in found.items()})
            print(rows[-1], flush=True)
    write_rows(TABLE, rows[0], rows)
    write_document(TABLE.with_suffix(".json"), begin)


if __name__ == "__main__":
    main()
