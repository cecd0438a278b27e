"""Which fit of a stochastic model has the best law on published cases, with and without repeated runs.

    python benchmarks/stochastic_cases.py [--studies 5]

fits a bimodal model and geometric Brownian motion ([Zhu-2023]) to that many Latin hypercubes of 480 points, and of 60
points with 8 runs each; benchmarks/results/stochastic_cases.csv has the mean over 200 points of W2**2 between law and
emulated law, over the variance of the output, and beside it in .json how it was made.
"""

import numpy as np
from emulator_peers import w2_error
from emulator_truths import PUBLISHED
from harness import RESULTS, Row, command_line, origin, rounded, write_document, write_rows

from lithobrake import emulator
from lithobrake.chaos import fit_stochastic, latin_hypercube

TABLE = RESULTS / "stochastic_cases.csv"
RUNS, REPEATS, POINTS, DRAWS = 480, 8, 200, 4000


def row(name: str, repeats: int, seed: int) -> Row:
    """Errors of all fits to one design."""
    case = PUBLISHED[name]
    inputs, lower = case.inputs, case.lower if np.isfinite(case.lower) else None
    x = np.repeat(latin_hypercube(inputs, RUNS // repeats, seed=seed), repeats, axis=0)
    y = case.outputs(x, np.random.default_rng(seed))[:, 0]
    points = latin_hypercube(inputs, POINTS, seed=999)
    truth = case.outputs(np.repeat(points, DRAWS, axis=0), np.random.default_rng(998)).reshape(POINTS, DRAWS)
    own = emulator.fit(inputs, x, y[:, None], lower=lower).sample(points, DRAWS)[:, :, 0]
    expansion = emulator.fit_stochastic_expansion(inputs, x, y, lower=lower).sample(points, DRAWS)
    any_run = np.broadcast_to(np.random.default_rng(997).choice(y, DRAWS), truth.shape)
    errors = {"emulator": w2_error(own, truth), "expansion": w2_error(expansion, truth)}
    found: Row = {"case": name, "repeats": repeats, "seed": seed} | errors
    found |= {"any_run": w2_error(any_run, truth), "mean_and_scatter": ""}
    if repeats > 1:
        draws = fit_stochastic(inputs, x, y).sample(np.repeat(points, DRAWS, axis=0), seed=996)
        found["mean_and_scatter"] = w2_error(draws.reshape(truth.shape), truth)
    return rounded(found)


def main() -> None:
    studies = command_line(__doc__, studies=5).parse_args().studies
    begin = origin(f"benchmarks/stochastic_cases.py --studies {studies}")
    rows = [row(case, repeats, seed) for case in PUBLISHED for repeats in (1, REPEATS) for seed in range(studies)]
    write_rows(TABLE, rows[0], rows)
    write_document(TABLE.with_suffix(".json"), begin)


if __name__ == "__main__":
    main()
