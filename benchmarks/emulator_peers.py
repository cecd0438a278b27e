"""How near emulators come to laws that are known: `lithobrake.emulator.fit` beside what else one would take.

    python benchmarks/emulator_peers.py [--cases ..] [--methods ..] [--runs 150 300] [--seeds 5]

fits each method to runs of each case of benchmarks/emulator_truths.py, and adds a row to
benchmarks/results/emulator_peers.csv: the energy distance of its law from the truth at 60 points that were not run,
over that of drawing one of the runs (200 draws each, without the bias of so few), or, of the published cases, the mean
over 200 points of W2**2 between the laws over the variance of the output (4000 draws, 1000 levels). `capture` is the
root mean square error of the chance of capture. Rows that are there are kept, so that one method is measured anew when
its own are taken out (--anew fit).
"""

from collections.abc import Iterator
from functools import cache
from itertools import product

import numpy as np
from emulator_rivals import RIVALS
from emulator_truths import PUBLISHED, TRUTHS, Case
from harness import RESULTS, Row, add_row, command_line, read_rows, timed, write_made

from lithobrake import emulator
from lithobrake.chaos import latin_hypercube

TABLE = RESULTS / "emulator_peers.csv"
OWN, ANY_RUN = "fit", "any run"
LEVELS = (np.arange(1000) + 0.5) / 1000
KINDS = {"case": str, "method": str, "runs": int, "seed": int}
# Laws of outputs are compared where at least a tenth of the runs has some.
MOST_CAPTURED = 0.9
PUBLISHED_RUNS = {
    "bimodal": (400, 800, 1600), "brownian": (500, 1000), "heston": (1000,), "borehole": (750,), "SIR": (500,),
    "SIR, four inputs": (1000,),
}  # fmt: skip


def energy_distance(first: np.ndarray, second: np.ndarray) -> float:
    """Energy distance of two samples [count, output_count], without bias."""

    def within(one: np.ndarray) -> float:
        return float(np.linalg.norm(one[:, None] - one, axis=2).sum() / (len(one) * (len(one) - 1)))

    between = float(np.linalg.norm(first[:, None] - second, axis=2).mean())
    return between - 0.5 * within(first) - 0.5 * within(second)


def w2_error(draws: np.ndarray, truth: np.ndarray) -> float:
    """Mean over points of W2**2 over the variance of the output; [point_count, draw_count] each."""
    gaps = np.quantile(draws, LEVELS, axis=1) - np.quantile(truth, LEVELS, axis=1)
    return float(np.mean(gaps**2) / truth.var())


def with_outputs(draws: np.ndarray, count: int) -> np.ndarray:
    """So many draws that have outputs at each point, again from the first where there are fewer."""
    there = [one[~np.isnan(one[:, 0])] for one in draws]
    return np.stack([one[np.arange(count) % max(len(one), 1)] for one in there])


def any_run(x: np.ndarray, y: np.ndarray, points: np.ndarray, count: int) -> np.ndarray:
    return y[np.random.default_rng(11).integers(len(y), size=(len(points), count))]


def drawn(method: str, case: Case, study: tuple, points: np.ndarray, count: int) -> tuple[np.ndarray, float, float]:
    """Draws of a method [point_count, count, output_count], CPU time of its fit [s], and its error of captures."""
    x, y, group = study
    there, capture = ~np.isnan(y[:, 0]), float("nan")
    if method == OWN:
        model, cpu = timed(lambda: emulator.fit(case.inputs, x, y, groups=group, lower=case.lower))
        if case.capture is not None:
            everywhere = latin_hypercube(case.inputs, 500, seed=992)
            chances = 1.0 - model.outcome_probability(everywhere)[:, model.runs.output_outcome]
            capture = float(np.sqrt(np.mean((chances - case.capture(everywhere)) ** 2)))
            return with_outputs(model.sample(points, 20 * count), count), cpu, capture
        return model.sample(points, count), cpu, capture
    if method == ANY_RUN:
        share = float(np.mean(~there))
        if case.capture is not None:
            chances = case.capture(latin_hypercube(case.inputs, 500, seed=992))
            capture = float(np.sqrt(np.mean((share - chances) ** 2)))
        return any_run(x[there], y[there], points, count), 0.0, capture
    sample, cpu = timed(lambda: RIVALS[method](x[there], y[there], group[there]))
    return sample(points, count, np.random.default_rng(13)), cpu, capture


def truth_row(name: str, case: Case, method: str, runs: int, seed: int) -> Row:
    """Energy distance of one fit over that of drawing rows."""
    points, study = latin_hypercube(case.inputs, 60, seed=991), case.study(runs, seed)
    if case.capture is not None:
        points = points[case.capture(points) < MOST_CAPTURED]
    truth = case.conditional(points, 200, seed)
    draws, cpu, capture = drawn(method, case, study, points, 200)
    x, y, _ = study
    there = ~np.isnan(y[:, 0])
    rows = any_run(x[there], y[there], points, 200)
    unit = y[there].std(axis=0)
    own, of_rows = (
        np.mean([energy_distance(a / unit, b / unit) for a, b in zip(one, truth, strict=True)]) for one in (draws, rows)
    )
    return _row(name, method, runs, seed, float(own / of_rows), cpu, capture)


def published_row(name: str, case: Case, method: str, runs: int, seed: int) -> Row:
    """W2 error of one fit."""
    points = latin_hypercube(case.inputs, 200, seed=999)
    draws, cpu, _ = drawn(method, case, case.study(runs, seed), points, 4000)
    return _row(name, method, runs, seed, w2_error(draws[:, :, 0], published_truth(name)), cpu)


@cache
def published_truth(name: str) -> np.ndarray:
    """Outputs of a published case at the points of its rows, [200, 4000]."""
    case = PUBLISHED[name]
    return case.conditional(latin_hypercube(case.inputs, 200, seed=999), 4000, 5)[:, :, 0]


def _row(name: str, method: str, runs: int, seed: int, error: float, cpu: float, capture: float = float("nan")) -> Row:
    return {
        "case": name, "method": method, "runs": runs, "seed": seed, "error": error, "capture": capture, "fit_cpu_s": cpu
    }  # fmt: skip


def _key(row: Row) -> tuple[str, str, int, int]:
    return row["case"], row["method"], row["runs"], row["seed"]


def wanted(cases: list[str], methods: list[str], runs: list[int], seeds: int) -> Iterator[tuple[str, str, int, int]]:
    """Case, method, number of runs and seed of all rows."""
    for name in cases:
        for method, count in product(methods, PUBLISHED_RUNS.get(name, runs)):
            yield from ((name, method, count, seed) for seed in range(seeds))


def measured(name: str, method: str, runs: int, seed: int) -> Row:
    made = published_row if name in PUBLISHED else truth_row
    return made(name, (PUBLISHED | TRUTHS)[name], method, runs, seed)


def main() -> None:
    everything = [ANY_RUN, OWN, *RIVALS]
    options = command_line(
        __doc__, cases=[*TRUTHS, *PUBLISHED], methods=everything, runs=[150, 300], seeds=5, out=TABLE,
        anew=[""],
    ).parse_args()  # fmt: skip
    kept = [row for row in read_rows(options.out, KINDS) if row["method"] not in options.anew]
    options.out.unlink(missing_ok=True)
    for row in kept:
        add_row(options.out, row, 4)
    there = {_key(row) for row in kept}
    for name, method, runs, seed in wanted(options.cases, options.methods, options.runs, options.seeds):
        if (name, method, runs, seed) not in there:
            add_row(options.out, measured(name, method, runs, seed), 4)
    write_made(options.out, f"benchmarks/emulator_peers.py --seeds {options.seeds}")


if __name__ == "__main__":
    main()
