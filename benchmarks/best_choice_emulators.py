"""The best delivery option by refits of real emulators: whether its set and its own fraction hold the truth.

    python benchmarks/best_choice_emulators.py [--studies 60]

A study is 96 synthetic landings on 12 beds, or 240 on 24, whose beds have a fifth of the variance of the speed; an
emulator is fitted to them, and ten landers of each of fifty refits follow each of twelve options, twelve values of the
input that counts most. At rest counts what returns (tests/synthetic_landings.py); the truth is known from 40 000
landings at each option.
Writes benchmarks/results/best_choice_emulators.csv, and .json beside it.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from best_choice_coverage import LANDERS, REFITS, plain, width
from harness import RESULTS, Row, command_line, rounded, write_made, write_rows
from inference_calibration import STRONG, fitted, random_soils
from synthetic_landings import returns

from lithobrake import emulator
from lithobrake.analysis import LEVEL, best_choice

TABLE = RESULTS / "best_choice_emulators.csv"
COLUMNS = ("beds", "runs", "studies", "set_held", "set_size", "own_held", "own_bias", "own_half_width", "plain_held",
           "plain_bias", "plain_half_width")  # fmt: skip
OPTIONS = np.linspace(0.32, 0.88, 12)
TRUTH = replace(STRONG, rho=0.2)


def soils(option: float, count: int, random: np.random.Generator) -> np.ndarray:
    """Inputs of landers at one option [count, 5]."""
    drawn = random_soils(count, random)
    drawn[:, 0] = option
    return drawn


def truth() -> np.ndarray:
    random, found = np.random.default_rng(1), []
    for option in OPTIONS.tolist():
        x = soils(option, 40_000, random)
        landings = TRUTH.draw(x, random.standard_normal(len(x)), random)
        found.append(returns(landings.y, landings.outcome).mean())
    return np.array(found)


def landers(model: emulator.Emulator, seed: int) -> np.ndarray:
    """Whether landers of refits are at rest [option_count, REFITS, LANDERS], the same landers at all options."""
    met = np.empty((len(OPTIONS), REFITS, LANDERS))
    for number, refit in enumerate(model.refits(REFITS, seed)):
        for place, option in enumerate(OPTIONS.tolist()):
            random = np.random.default_rng([seed, number])
            drawn = refit.draw(soils(option, LANDERS, random), 1, number)
            words = np.array(model.outcome_names)[drawn.outcome[:, 0]]
            met[place, number] = random.random(LANDERS) < returns(drawn.y[:, 0], words)
    return met


def row(beds: int, runs: int, studies: int, fractions: np.ndarray) -> Row:
    found: dict[str, list[float]] = {}
    for number in range(studies):
        met = landers(fitted(TRUTH, 500 + number, runs, beds), number)
        best = best_choice(met, beds, [True] * len(OPTIONS))
        fraction = fractions[best.best]
        numbers = {"set_held": int(fractions.argmax()) in best.not_worse, "set_size": len(best.not_worse)}
        for name, one in (("own", best.own), ("plain", plain(met[best.best], beds))):
            numbers |= {f"{name}_held": one.lower <= fraction <= one.upper, f"{name}_bias": one.value - fraction}
            numbers |= {f"{name}_half_width": width(one)}
        for name, value in numbers.items():
            found.setdefault(name, []).append(float(value))
    means = {name: float(np.mean(one)) for name, one in found.items()}
    return rounded({"beds": beds, "runs": runs, "studies": studies} | means)


def rows(studies: int) -> Iterator[Row]:
    fractions = truth()
    for beds, runs in ((12, 96), (24, 240)):
        yield row(beds, runs, studies, fractions)


def main() -> None:
    studies = command_line(__doc__, studies=60).parse_args().studies
    write_rows(TABLE, COLUMNS, rows(studies))
    facts = {"studies": studies, "level": LEVEL, "fractions": [round(one, 4) for one in truth().tolist()]}
    write_made(TABLE, f"benchmarks/best_choice_emulators.py --studies {studies}", **facts)


if __name__ == "__main__":
    main()
