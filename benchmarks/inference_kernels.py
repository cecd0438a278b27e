"""How wide kernels of the density of an observed bounce should be: coverage of inference from five synthetic landings.

    python benchmarks/inference_kernels.py [--cases 80]

Parts of the normal rule from 0.5, which draws have, to 2, all with the same soils, landings and emulators (300 landings
on 30 beds, another one every ten soils): five landings on beds of their own whose beds are alike, and five on one bed
that has a fifth of the variance of the speed. How often 90 % intervals held the soil, by input.
Writes benchmarks/results/inference_kernels.csv, and .json beside it.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from harness import RESULTS, Row, command_line, rounded, write_made, write_rows
from inference_calibration import INPUTS, REFITS, WEAK, fitted, observation, random_soils

from lithobrake.analysis import LEVEL, Posterior, infer, posterior
from lithobrake.emulator import Emulator, density

TABLE = RESULTS / "inference_kernels.csv"
COLUMNS = ("bed_share", "one_bed", "cases", "kernel", "input", "held", "sd_ratio", "effective")
BOUNCES, CASES_AN_EMULATOR, POINTS, SEED = 5, 10, 1024, 6
KERNELS = (0.5, 1.0, 1.5, 2.0)


def posteriors(bed_share: float, one_bed: bool, cases: int) -> Iterator[tuple[float, np.ndarray, Posterior]]:
    """Kernel, true soil and posterior of every soil and kernel."""
    truth, random = replace(WEAK, rho=bed_share), np.random.default_rng(SEED)
    for case, soil in enumerate(random_soils(cases, random)):
        if case % CASES_AN_EMULATOR == 0:
            fit: Emulator = fitted(truth, 1000 * SEED + case)
        effects = random.standard_normal(BOUNCES)
        if one_bed:
            effects[:] = effects[0]
        found = truth.draw(np.tile(soil, (BOUNCES, 1)), effects, random)
        seen = [observation(y, str(word)) for y, word in zip(found.y, found.outcome, strict=True)]
        seen = [replace(one, bed="one" if one_bed else None) for one in seen]
        for kernel in KERNELS:
            density.DENSITY_FACTOR = kernel
            yield kernel, soil, infer(fit, seen, refit_count=REFITS, point_count=POINTS, seed=case)


def rows(bed_share: float, one_bed: bool, cases: int) -> Iterator[Row]:
    found = list(posteriors(bed_share, one_bed, cases))
    for kernel in KERNELS:
        learnt = [(soil, list(one.learnt().values()), one.effective_count) for of, soil, one in found if of == kernel]
        for column, key in enumerate(INPUTS):
            ends = [(said[column].after, soil[column]) for soil, said, _ in learnt]
            yield rounded({
                "bed_share": bed_share, "one_bed": int(one_bed), "cases": cases, "kernel": kernel, "input": key,
                "held": float(np.mean([after.lower <= value <= after.upper for after, value in ends])),
                "sd_ratio": float(np.sqrt(np.mean([said[column].sd_ratio ** 2 for _, said, _ in learnt]))),
                "effective": float(np.median([effective for _, _, effective in learnt])),
            })  # fmt: skip


def main() -> None:
    cases = command_line(__doc__, cases=80).parse_args().cases
    # Of hundreds of posteriors some would take minutes each.
    posterior.can_walk = lambda: False
    write_rows(TABLE, COLUMNS, [*rows(0.0, False, cases), *rows(0.2, True, cases)])
    write_made(TABLE, f"benchmarks/inference_kernels.py --cases {cases}", cases=cases, level=LEVEL)


if __name__ == "__main__":
    main()
