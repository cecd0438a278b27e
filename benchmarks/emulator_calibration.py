"""What an emulator's numbers are worth where the truth is known: synthetic landings with a weak, a strong, no effect.

    python benchmarks/emulator_calibration.py [--studies 10]

fits emulators to that many synthetic studies a row (three times as many where intervals and findings are counted) and
keeps the figures in benchmarks/results/emulator_calibration.csv, and beside it in .json how they were made.
"""

import sys
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from harness import RESULTS, ROOT, Row, command_line, origin, write_document, write_rows
from scipy import stats

sys.path.insert(0, str(ROOT))

from lithobrake.analysis.confidence import t_quantile
from lithobrake.emulator import Emulator
from tests.emulator.conditional_errors import DrawnRuns, fitted, law_errors
from tests.emulator.test_calibration import fresh_energy_score
from tests.synthetic_landings import NO_SOIL, STRONG, WEAK, Truth, exact_share, random_soils, returns

TABLE = RESULTS / "emulator_calibration.csv"
ERRORS = ("speed_w2", "joint_w2", "share_points", "marginal_w2")
REFITS, DRAWS = 100, 1000


def law_row(name: str, truth: Truth, run_count: int, studies: int) -> Row:
    """Errors of the conditional law beside those of drawing rows, and bands and PIT on beds left out."""
    models = [fitted(truth, run_count, max(12, run_count // 10), seed) for seed in range(studies)]
    errors = np.mean([law_errors(truth, model, draw_count=4000) for model in models], axis=0)
    of_rows = np.mean([law_errors(truth, DrawnRuns(model), draw_count=4000) for model in models], axis=0)
    bands = np.mean([model.scores.band_90 for model in models], axis=0)
    counts = [np.histogram(one.scores.pit[:, 0], bins=10, range=(0.0, 1.0))[0] for one in models]
    return {
        "row": f"law, {name}", "runs": run_count, "studies": studies,
        **dict(zip(ERRORS, errors, strict=True)),
        **{f"rows_{key}": value for key, value in zip(ERRORS, of_rows, strict=True)},
        "speed_ratio": errors[0] / of_rows[0], "band_90_least": bands.min(), "band_90_most": bands.max(),
        "pit_above_01": np.mean([stats.chisquare(one).pvalue > 0.01 for one in counts]),
    }  # fmt: skip


def no_effect_row(run_count: int, studies: int) -> Row:
    """Energy score on fresh landings against rows, and how many studies find no input."""
    scores, found = [], []
    for seed in range(studies):
        model = fitted(NO_SOIL, run_count, max(12, run_count // 10), seed)
        scores.append([fresh_energy_score(one, 20_000) for one in (model, DrawnRuns(model))])
        found.append(any(model.found_inputs().values()))
    of_model, of_rows = np.mean(scores, axis=0)
    return {
        "row": "no effect", "runs": run_count, "studies": studies, "energy_against_rows": of_model / of_rows - 1.0,
        "none_found": 1.0 - np.mean(found),
    }  # fmt: skip


def outputs_of(model: Emulator, count: int, seed: int) -> np.ndarray:
    """Share that returns, and median and 95 % quantile of the speed, of so many draws over all soils [3]."""
    draws = model.draw(random_soils(count, np.random.default_rng(seed)), 1, seed)
    outcome = np.array(model.outcome_names)[draws.outcome[:, 0]]
    share = np.nanmean(returns(draws.y[:, 0], outcome))
    return np.array([share, *np.nanquantile(draws.y[:, 0, 0], [0.5, 0.95])])


def interval_row(run_count: int, bed_count: int, studies: int) -> Row:
    """How often 90 % intervals from refits hold the truth: t with B - 1 degrees of freedom, widened by B / (B - 1)."""
    truth = replace(WEAK, rho=0.1)
    many = replace(truth, capture=0.0).study(300_000, 300_000, 1)[1]
    exact = np.array([exact_share(truth), *np.quantile(many[:, 0], [0.5, 0.95])])
    held = []
    for seed in range(studies):
        model = fitted(truth, run_count, bed_count, seed)
        refits = [outputs_of(refit, DRAWS, k) for k, refit in enumerate(model.refits(REFITS))]
        # What the draws of one refit scatter by themselves is no uncertainty of the emulator.
        luck = np.var([outputs_of(model, DRAWS, k) for k in range(REFITS)], axis=0)
        variance = np.maximum(np.var(refits, axis=0) - luck, 0.0) * bed_count / (bed_count - 1.0)
        half = t_quantile(bed_count - 1) * np.sqrt(variance)
        held.append(np.abs(outputs_of(model, 20_000, 7) - exact) <= half)
    share, median, high = np.mean(held, axis=0)
    return {
        "row": "intervals from refits", "runs": run_count, "beds": bed_count, "studies": studies,
        "share_held": share, "median_held": median, "quantile_95_held": high,
    }  # fmt: skip


def all_rows(studies: int) -> Iterator[Row]:
    for run_count in (150, 300):
        for name, truth in (("weak", WEAK), ("strong", STRONG)):
            yield law_row(name, truth, run_count, studies)
        yield no_effect_row(run_count, 3 * studies)
    for run_count, bed_count in ((144, 12), (240, 24)):
        yield interval_row(run_count, bed_count, 3 * studies)


def main() -> None:
    studies = command_line(__doc__, studies=10).parse_args().studies
    begin = origin(f"benchmarks/emulator_calibration.py --studies {studies}")
    rows = []
    for row in all_rows(studies):
        rows.append({key: round(float(value), 4) if isinstance(value, float) else value for key, value in row.items()})
        print(rows[-1], flush=True)
    write_rows(TABLE, dict.fromkeys(key for row in rows for key in row), rows)
    write_document(TABLE.with_suffix(".json"), begin)


if __name__ == "__main__":
    main()
