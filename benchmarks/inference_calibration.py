"""Whether inference from bounces says what is so: simulation-based calibration of two kinds, and how much is learnt.

    python benchmarks/inference_calibration.py [--cases 200]

Emulator: soils are drawn from the prior and bounces by the density of the emulator, which is then exact; the rank of
the true soil among 99 draws of the posterior, and that of its likelihood, must be uniform (chi-square over ten steps).
Simulator: bounces come from synthetic landings, the emulator from 300 runs of them, another one every fifty cases; how
often 90 % intervals held the truth, beside the inverse of a mean law with Gaussian error, as one without scatter would
be made. Last how many bounces halve the uncertainty of each input, by an emulator of weak and of strong soil.
Writes benchmarks/results/inference_calibration.csv, and .json beside it. Source: [Talts-2018]; [Modrak-2023].
"""

import sys
from collections.abc import Iterator
from itertools import chain

import numpy as np
from harness import RESULTS, ROOT, Row, command_line, rounded, write_made, write_rows
from scipy import stats

sys.path.insert(0, str(ROOT / "tests"))
from synthetic_landings import ELEVATION_LIMIT, INPUTS, OUTPUT_NAMES, SPEED_LIMIT, STRONG, WEAK, Truth, random_soils

from lithobrake import emulator
from lithobrake.analysis import LEVEL, Observation, identifiability, infer, posterior
from lithobrake.emulator.training_runs import from_coordinate, to_coordinate

TABLE = RESULTS / "inference_calibration.csv"
COLUMNS = ("kind", "soil", "bounces", "cases", "input", "held", "chi_square_p", "sd_ratio", "effective", "to_halve")
OBSERVED = ("speed_out", "elevation_out", "spin_out")
DRAWS, STEPS, CASES_AN_EMULATOR, POINTS, REFITS = 99, 10, 50, 2048, 10
SOILS = {"weak": WEAK, "strong": STRONG}


def fitted(truth: Truth, seed: int, run_count: int = 300, bed_count: int = 30) -> emulator.Emulator:
    """An emulator of synthetic landings."""
    x, y, outcome, bed = truth.study(run_count, bed_count, seed)
    upper = [SPEED_LIMIT, ELEVATION_LIMIT, np.inf, np.inf]
    return emulator.fit(
        INPUTS, x, y, groups=bed, outcome=outcome, lower=[0.0, 0.0, -np.inf, 0.0], upper=upper,
        riders=["azimuth_out"], output_names=list(OUTPUT_NAMES),
    )  # fmt: skip


def observation(y: np.ndarray, outcome: str) -> Observation:
    """One bounce of an outcome, or with outputs [4]."""
    if outcome != "clear":
        return Observation({}, outcome=outcome)
    return Observation({name: float(y[OUTPUT_NAMES.index(name)]) for name in OBSERVED})


def emulated(
    model: emulator.Emulator, soil: np.ndarray, count: int, random: np.random.Generator, *, on_one_bed: bool = False
) -> list[Observation]:
    """Bounces by the density of the emulator, all with one drawn effect of a bed, or without any."""
    kernels = model.kernels
    outputs = len(kernels.root)
    before = model.bed_effect.before if on_one_bed else np.zeros((outputs, outputs))
    values, vectors = np.linalg.eigh(np.eye(outputs) - before)
    row = random.choice(len(kernels.rows), count, p=model.law.weights / model.law.weights.sum())
    own = kernels.rows[row] + kernels.size * random.standard_normal((count, outputs))
    effect = random.multivariate_normal(np.zeros(outputs), before)
    standard = (effect + own @ (vectors * np.sqrt(values)) @ vectors.T) @ kernels.root.T
    location, scale = model.law.at(model.terms.matrix(soil[None]))
    columns = list(model.runs.modelled)
    y = np.full((count, len(model.output_names)), np.nan)
    bounds = (one[0, columns] for one in (model.runs.lower, model.runs.upper))
    y[:, columns] = from_coordinate(location + scale * standard, *bounds)
    words = random.choice(model.outcome_names, count, p=model.outcome_probability(soil[None])[0])
    return [observation(one, str(word)) for one, word in zip(y, words, strict=True)]


def emulator_rows(name: str, bounces: int, cases: int) -> Iterator[Row]:
    """Ranks of soils where the emulator is the truth, by input; the last row is of the likelihood."""
    model, random = fitted(SOILS[name], 1), np.random.default_rng(5)
    ranks, effective = [], []
    for case, soil in enumerate(random_soils(cases, random)):
        seen = emulated(model, soil, bounces, random)
        found = infer(model, seen, refit_count=0, point_count=POINTS, seed=case)
        draws = found.sample(DRAWS, case)
        of_likelihood = np.sum(
            [model.log_density(one.outputs, np.vstack([soil, draws]), outcome=one.outcome) for one in seen], axis=0
        )
        ranks.append([*(draws < soil).sum(axis=0), (of_likelihood[1:] < of_likelihood[0]).sum()])
        effective.append(found.effective_count)
    for column, key in enumerate([*INPUTS, "likelihood"]):
        counts = np.histogram(np.array(ranks)[:, column], STEPS, (0, DRAWS + 1))[0]
        yield {
            "kind": "emulator", "soil": name, "bounces": bounces, "cases": cases, "input": key,
            "chi_square_p": float(stats.chisquare(counts).pvalue), "effective": float(np.median(effective)),
        }  # fmt: skip


def simulator_rows(name: str, bounces: int, cases: int) -> Iterator[Row]:
    """How often 90 % intervals of the soil held the truth, where bounces are synthetic landings."""
    truth, random = SOILS[name], np.random.default_rng(6)
    held, ratios, effective, mean_held = [], [], [], []
    for case, soil in enumerate(random_soils(cases, random)):
        if case % CASES_AN_EMULATOR == 0:
            model = fitted(truth, 100 + case)
        landings = truth.draw(np.tile(soil, (bounces, 1)), random.standard_normal(bounces), random)
        seen = [observation(y, str(word)) for y, word in zip(landings.y, landings.outcome, strict=True)]
        found = infer(model, seen, refit_count=REFITS, point_count=POINTS, seed=case)
        learnt = found.learnt().values()
        held.append([one.after.lower <= value <= one.after.upper for one, value in zip(learnt, soil, strict=True)])
        ratios.append([one.sd_ratio for one in learnt])
        effective.append(found.effective_count)
        if bounces == 1 and landings.outcome[0] == "clear":
            mean_held.append(inverse_of_the_mean(model, landings.y[0], soil, case))
    for kind, rows in (("simulator", held), ("simulator, inverse of the mean law", mean_held)):
        for column, key in enumerate(INPUTS if rows else ()):
            yield {
                "kind": kind, "soil": name, "bounces": bounces, "cases": len(rows), "input": key,
                "held": float(np.mean(np.array(rows)[:, column])),
            } | ({"sd_ratio": float(np.sqrt(np.mean(np.square(ratios)[:, column]))),
                  "effective": float(np.median(effective))} if kind == "simulator" else {})  # fmt: skip


def inverse_of_the_mean(model: emulator.Emulator, y: np.ndarray, soil: np.ndarray, seed: int) -> list[bool]:
    """Whether intervals hold that a mean law with an error of its own, of a tenth, gives: no scatter of landings."""
    x = random_soils(4096, np.random.default_rng(seed))
    terms = model.terms.matrix(x)
    centre = model.law.at(terms)[0]
    columns = [model.output_names.index(name) for name in OBSERVED]
    lower, upper = model.runs.lower[0, columns], model.runs.upper[0, columns]
    seen = to_coordinate(y[columns], lower, upper)
    error = 0.1 * model.runs.coordinates.std(axis=0)
    logarithms = -0.5 * (((centre - seen) / error) ** 2).sum(axis=1)
    weights = np.exp(logarithms - logarithms.max())
    ends = []
    for values in x.T:
        order = np.argsort(values)
        steps = np.cumsum(weights[order]) / weights.sum()
        ends.append(np.interp([0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL], steps, values[order]))
    return [bool(low <= value <= high) for (low, high), value in zip(ends, soil, strict=True)]


def information_rows(name: str, outputs: tuple[str, ...]) -> Iterator[Row]:
    """How many bounces would halve the uncertainty of each input, with these outputs seen without error."""
    seen = " and ".join(outputs)
    for key, one in identifiability(fitted(SOILS[name], 1), outputs).items():
        yield {"kind": f"to halve, {seen}", "soil": name, "input": key, "to_halve": one.bounces}
        for count, ratio in one.sd_ratio.items():
            yield {"kind": f"to halve, {seen}", "soil": name, "input": key, "bounces": count, "sd_ratio": ratio}


def main() -> None:
    parser = command_line(__doc__, cases=200)
    parser.add_argument("--bounces", type=int, nargs="+", default=[1], help="of the simulator; five take ten minutes")
    given = parser.parse_args()
    cases, bounce_counts = given.cases, given.bounces
    # Of hundreds of posteriors some would take minutes each.
    posterior.can_walk = lambda: False
    parts = (
        *(emulator_rows(name, 1, cases) for name in SOILS),
        emulator_rows("strong", 5, cases),
        *(information_rows(name, outputs) for name in SOILS for outputs in (OBSERVED, OBSERVED[:1])),
        *(simulator_rows(name, bounces, cases) for bounces in bounce_counts for name in SOILS),
    )
    write_rows(TABLE, COLUMNS, map(rounded, chain.from_iterable(parts)))
    write_made(TABLE, f"benchmarks/inference_calibration.py --cases {cases}", cases=cases, level=LEVEL)


if __name__ == "__main__":
    main()
