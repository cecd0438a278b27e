"""Whether inference from several bounces says what is so, on one bed and on beds of their own.

    python benchmarks/inference_beds.py [--cases 200] [--workers 4] [--soils weak]

A soil is drawn from the prior, and one or five synthetic landings on it, on one bed or each on its own, for three
shares that the bed has of the variance of the speed. The emulator comes from 300 landings on 30 beds, another one every
ten soils. How often 90 % intervals held the soil, and the rank of the soil among 99 draws of the posterior, which must
be uniform (chi-square over ten steps). Kind "emulator": the emulator is the truth; a bed's effect is drawn, and five
bounces on it, with as large a share of the bed as its runs have. Points are weighted alone: no walkers follow.
Writes benchmarks/results/inference_beds.csv, and .json beside it. Source: [Talts-2018]; [Modrak-2023].
"""

from collections.abc import Iterator
from dataclasses import replace
from multiprocessing import Pool
from typing import NamedTuple

import numpy as np
from harness import RESULTS, Row, command_line, rounded, table, write_made
from inference_calibration import DRAWS, INPUTS, OBSERVED, REFITS, SOILS, STEPS, fitted, observation, random_soils
from scipy import stats

from lithobrake.analysis import LEVEL, Observation, bed_shares, infer, inference
from lithobrake.emulator import Emulator
from lithobrake.emulator.coordinates import from_coordinate
from lithobrake.emulator.residual_rows import smoothed

TABLE = RESULTS / "inference_beds.csv"
COLUMNS = ("kind", "soil", "bed_share", "bounces", "one_bed", "cases", "input", "held", "chi_square_p", "sd_ratio",
           "effective", "found_share")  # fmt: skip
CASES_AN_EMULATOR, POINTS = 10, 1024
BED_SHARES = (0.0, 0.05, 0.2)


class Setting(NamedTuple):
    """One row of the design: of the emulator itself, or of landings whose bed has a share of the variance."""

    kind: str
    soil: str
    bed_share: float
    bounces: int
    one_bed: bool


def settings(soils: list[str]) -> Iterator[Setting]:
    """All of them, the longest first."""
    for soil in soils:
        for bed_share in BED_SHARES:
            for bounces, one_bed in ((5, True), (5, False), (1, False)):
                yield Setting("simulator", soil, bed_share, bounces, one_bed)
        yield Setting("emulator", soil, 0.2, 5, True)


def landed(setting: Setting, soil: np.ndarray, random: np.random.Generator) -> list[Observation]:
    """Synthetic landings on one soil."""
    count = setting.bounces
    effects = np.repeat(random.standard_normal(), count) if setting.one_bed else random.standard_normal(count)
    truth = replace(SOILS[setting.soil], rho=setting.bed_share)
    found = truth.draw(np.tile(soil, (count, 1)), effects, random)
    return [observation(y, str(word)) for y, word in zip(found.y, found.outcome, strict=True)]


def emulated(model: Emulator, soil: np.ndarray, count: int, random: np.random.Generator) -> list[Observation]:
    """Bounces of the emulator itself on one bed, whose effect is drawn."""
    kernels, before = model.kernels, model.bed_effect.before
    values, vectors = np.linalg.eigh(np.eye(len(before)) - before)
    row = random.choice(len(kernels.rows), count, p=model.law.weights / model.law.weights.sum())
    size = kernels.size / np.sqrt(1.0 - kernels.size**2)
    own = smoothed(kernels.whitened[row], size, np.eye(len(before)), random)
    effect = random.multivariate_normal(np.zeros(len(before)), before)
    whitened = effect + own @ (vectors * np.sqrt(values)) @ vectors.T
    location, scale = model.law.at(model.terms.matrix(soil[None]))
    columns = list(model.runs.modelled)
    y = np.full((count, len(model.output_names)), np.nan)
    y[:, columns] = from_coordinate(
        location + scale * (whitened @ kernels.root.T), model.runs.lower[0, columns], model.runs.upper[0, columns]
    )
    words = random.choice(model.outcome_names, count, p=model.outcome_probability(soil[None])[0])
    return [observation(values, str(word)) for values, word in zip(y, words, strict=True)]


def rows(given: tuple[Setting, int]) -> list[Row]:
    """What one setting gives, a row for each input."""
    setting, cases = given
    # Of a few hundred posteriors some would take minutes each.
    inference.can_walk = lambda: False
    random = np.random.default_rng([7, round(100 * setting.bed_share), setting.bounces, setting.one_bed])
    held, ranks, ratios, effective, shares = [], [], [], [], []
    for case, soil in enumerate(random_soils(cases, random)):
        if case % CASES_AN_EMULATOR == 0:
            model = fitted(replace(SOILS[setting.soil], rho=setting.bed_share), 100 + case)
            shares.append(bed_shares(model)["speed_out"])
        seen = (
            landed(setting, soil, random)
            if setting.kind == "simulator"
            else emulated(model, soil, setting.bounces, random)
        )
        seen = [replace(one, bed="one" if setting.one_bed else None) for one in seen]
        refits = REFITS if setting.kind == "simulator" else 0
        found = infer(model, seen, refit_count=refits, point_count=POINTS, seed=case)
        learnt = found.learnt().values()
        held.append([one.after.lower <= value <= one.after.upper for one, value in zip(learnt, soil, strict=True)])
        ratios.append([one.sd_ratio for one in learnt])
        ranks.append((found.sample(DRAWS, case) < soil).sum(axis=0))
        effective.append(found.effective_count)
    return [
        {
            **setting._asdict(), "one_bed": int(setting.one_bed), "cases": cases, "input": key,
            "held": float(np.mean(np.array(held)[:, column])),
            "chi_square_p": float(
                stats.chisquare(np.histogram(np.array(ranks)[:, column], STEPS, (0, DRAWS + 1))[0]).pvalue
            ),
            "sd_ratio": float(np.sqrt(np.mean(np.square(ratios)[:, column]))),
            "effective": float(np.median(effective)), "found_share": float(np.mean(shares)),
        }
        for column, key in enumerate(INPUTS)
    ]  # fmt: skip


def main() -> None:
    """Measure and write, a setting as it comes."""
    given = command_line(__doc__, cases=200, workers=4, soils=["weak"]).parse_args()
    work = [(setting, given.cases) for setting in settings(given.soils)]
    with table(TABLE, COLUMNS) as add, Pool(given.workers) as pool:
        for found in pool.imap(rows, work, 1):
            for row in found:
                add(rounded(row))
                print(row, flush=True)
    command = f"benchmarks/inference_beds.py --cases {given.cases} --soils {' '.join(given.soils)}"
    write_made(TABLE, command, cases=given.cases, level=LEVEL, points=POINTS, refits=REFITS, observed=list(OBSERVED))


if __name__ == "__main__":
    main()
