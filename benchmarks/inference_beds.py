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
from harness import RESULTS, Row, command_line, rounded, write_made, write_rows
from inference_calibration import DRAWS, INPUTS, REFITS, SOILS, STEPS, emulated, fitted, observation, random_soils
from scipy import stats

from lithobrake.analysis import LEVEL, Observation, bed_shares, infer, posterior
from lithobrake.emulator import Emulator

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
    for soil in soils:
        for bed_share in BED_SHARES:
            for bounces, one_bed in ((5, True), (5, False), (1, False)):
                yield Setting("simulator", soil, bed_share, bounces, one_bed)
        yield Setting("emulator", soil, 0.2, 5, True)


def landed(setting: Setting, soil: np.ndarray, random: np.random.Generator) -> list[Observation]:
    count = setting.bounces
    effects = np.repeat(random.standard_normal(), count) if setting.one_bed else random.standard_normal(count)
    truth = replace(SOILS[setting.soil], rho=setting.bed_share)
    found = truth.draw(np.tile(soil, (count, 1)), effects, random)
    return [observation(y, str(word)) for y, word in zip(found.y, found.outcome, strict=True)]


class Case(NamedTuple):
    """One soil, by input: whether its intervals held it, its ranks, what is left of the deviations; points of weight,
    and the share of the bed that the emulator's runs show.
    """

    held: list[bool]
    ranks: list[int]
    ratios: list[float]
    effective: float
    found_share: float


def cases(given: tuple[Setting, int]) -> tuple[Setting, list[Case]]:
    setting, number = given
    # Of thousands of posteriors some would take minutes each.
    posterior.can_walk = lambda: False
    random = np.random.default_rng([7, number, round(100 * setting.bed_share), setting.bounces, setting.one_bed])
    model = fitted(replace(SOILS[setting.soil], rho=setting.bed_share), 100 + number)
    found_share = bed_shares(model)["speed_out"]
    return setting, [
        Case(*judged(setting, model, soil, random), found_share) for soil in random_soils(CASES_AN_EMULATOR, random)
    ]


def judged(
    setting: Setting, model: Emulator, soil: np.ndarray, random: np.random.Generator
) -> tuple[list[bool], list[int], list[float], float]:
    """What the posterior of one soil says of it, as the first entries of Case."""
    is_simulator = setting.kind == "simulator"
    seen = (
        landed(setting, soil, random)
        if is_simulator
        else emulated(model, soil, setting.bounces, random, on_one_bed=True)
    )
    seen = [replace(one, bed="one" if setting.one_bed else None) for one in seen]
    seed = int(random.integers(2**31))
    found = infer(model, seen, refit_count=REFITS if is_simulator else 0, point_count=POINTS, seed=seed)
    learnt = found.learnt().values()
    held = [one.after.lower <= value <= one.after.upper for one, value in zip(learnt, soil, strict=True)]
    ranks = (found.sample(DRAWS, seed) < soil).sum(axis=0).tolist()
    return held, ranks, [one.sd_ratio for one in learnt], found.effective_count


def rows(setting: Setting, found: list[Case]) -> Iterator[Row]:
    for column, key in enumerate(INPUTS):
        counts = np.histogram([one.ranks[column] for one in found], STEPS, (0, DRAWS + 1))[0]
        yield rounded({
            **setting._asdict(), "one_bed": int(setting.one_bed), "cases": len(found), "input": key,
            "held": float(np.mean([one.held[column] for one in found])),
            "chi_square_p": float(stats.chisquare(counts).pvalue),
            "sd_ratio": float(np.sqrt(np.mean([one.ratios[column] ** 2 for one in found]))),
            "effective": float(np.median([one.effective for one in found])),
            "found_share": float(np.mean([one.found_share for one in found])),
        })  # fmt: skip


def main() -> None:
    given = command_line(__doc__, cases=200, workers=4, soils=["weak"]).parse_args()
    of_setting: dict[Setting, list[Case]] = {setting: [] for setting in settings(given.soils)}
    work = [(setting, number) for number in range(given.cases // CASES_AN_EMULATOR) for setting in of_setting]
    with Pool(given.workers) as pool:
        for setting, found in pool.imap_unordered(cases, work):
            of_setting[setting] += found
            done = [row for one, all_found in of_setting.items() if all_found for row in rows(one, all_found)]
            write_rows(TABLE, COLUMNS, done)
            command = f"benchmarks/inference_beds.py --cases {given.cases} --soils {' '.join(given.soils)}"
            finished = min(map(len, of_setting.values()))
            write_made(TABLE, command, finished_cases=finished, level=LEVEL, points=POINTS, refits=REFITS)


if __name__ == "__main__":
    main()
