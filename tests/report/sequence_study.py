"""A study folder of a sequence, made by hand from synthetic landings in the keys that its summary has."""

import csv
import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from lithobrake import emulator
from lithobrake.analysis import mean_estimate, quantile_estimates, regression_terms, share_estimate, variance_shares
from lithobrake.pipeline.explorer_tables import save_explorer, tables_of_refits

from ..synthetic_landings import ELEVATION_LIMIT, INPUTS, OUTPUT_NAMES, SPEED_LIMIT, Truth, returns

KEYS = ("grain.friction", "grain.restitution", "grain.young_modulus", "grain.rolling_friction", "grain.density")
SHOWN = ("speed_out", "elevation_out", "spin_out")
# Of a ball of a kilogram that arrives at the limit of the speed.
BOUND = {"height": 0.0, "across": 1.0, "smallest": 1e-3, "largest": 1e-3, "mass_power": 0.0, "diameter_power": 0.0,
         "impact.speed": SPEED_LIMIT}  # fmt: skip
OUTCOMES = ("clear", "captured", "left_sideways", "time_limit", "outside")
SAMPLE_COUNT = 1000


def write_sequence(
    folder: Path, any_study: dict[str, Any], truth: Truth, run_count: int, bed_count: int, seed: int = 3
) -> dict[str, Any]:
    """Write runs, samples and summary of a study whose landings follow the truth; returns the summary.

    any_study: a summary of a study by the paper's method, of which this one takes what both have.
    """
    inputs = dict(zip(KEYS, INPUTS.values(), strict=True))
    x, y, outcome, bed = truth.study(run_count, bed_count, seed)
    staying = returns(y, outcome)
    model = emulator.fit(
        inputs, x, y, groups=bed if bed_count > 1 else None, outcome=outcome, lower=[0.0, 0.0, -np.inf, 0.0],
        upper=[SPEED_LIMIT, ELEVATION_LIMIT, np.inf, np.inf], riders=["azimuth_out"], output_names=list(OUTPUT_NAMES),
    )  # fmt: skip
    write_runs(folder / "designs" / "sequence.csv", x, y, outcome, bed)
    by_emulator = write_samples_of(model, inputs, folder / "samples.h5")
    save_explorer(folder / "explorer.h5", tables_of_refits(model.refits(5, seed=1), BOUND))
    columns = {name: y[:, OUTPUT_NAMES.index(name)] for name in SHOWN} | {"returns": staying}
    twins = 0.1 * np.random.default_rng(seed).standard_normal(12)
    terms = regression_terms(inputs, x)
    one_bed = "no region was set, so the place is one" if bed_count == 1 else None
    share = share_estimate(staying, bed, terms=terms, emulator=by_emulator, why=one_bed)
    results = any_study["results"]
    kept = {key: results[key] for key in ("beds", "outputs_of_runs", "site", "ellipses", "flights")}
    counts = {word: int((outcome == word).sum()) for word in sorted(set(outcome.tolist()))}
    parts = {
        name: variance_shares(inputs, x, values, bed, soil=KEYS, twins=twins * np.nanstd(values))
        for name, values in columns.items()
    }
    summary = {
        **any_study,
        "study": any_study["study"] | sequence_study(),
        "results": kept | {
            "returns": share.summary(),
            "variance_shares": {name: part and part.summary() for name, part in parts.items()},
            "outputs": {name: estimates(values, bed) for name, values in columns.items()},
            "runs": {"count": run_count, "beds": bed_count, "outcomes": counts, "over_rim": 3,
                     "side_runs": side_runs()},
            "emulator": emulator_record(model),
            "shares": shares_with_intervals(results["shares"]),
            "rest": {"why_no_soil": "impact.speed is no input", "soil": None, "hard": results["rest"]["hard"]},
        },
    }  # fmt: skip
    (folder / "summary.json").write_text(json.dumps(summary, allow_nan=False), encoding="utf-8")
    return summary


def sequence_study() -> dict[str, Any]:
    """What of the study is not as in one by the paper's method."""
    uniform = {"distribution": "uniform", "lower": 0.3, "upper": 0.9}
    soils = {key.removeprefix("grain."): uniform for key in KEYS}
    soils["young_modulus"] = {"distribution": "log_uniform", "lower": 1e6, "upper": 1e8}
    impact = {"azimuth_deg": "random", "orientation": "random", "region": [[-0.1, 0.1], [-0.1, 0.1]], "place": None}
    return {"design": {"method": "sequence", "run_count": 240}, "grain": soils, "impact": impact}


def write_runs(path: Path, x: np.ndarray, y: np.ndarray, outcome: np.ndarray, bed: np.ndarray) -> None:
    path.parent.mkdir(exist_ok=True)
    names = [*(f"input:{name}" for name in KEYS), "input:bed", *(f"output:{name}" for name in OUTPUT_NAMES)]
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["key", "outcome", "reason", *names, "output:over_rim"])
        # The three fastest went over the rim in flight.
        over_rim = y[:, 0] >= np.sort(y[np.isfinite(y[:, 0]), 0])[-3]
        for number, (one, outputs) in enumerate(zip(x, y, strict=True)):
            found = np.isfinite(outputs).all()
            cells = [repr(value) if found else "" for value in outputs.tolist()]
            flag = int(over_rim[number]) if found else ""
            table.writerow([f"{number:016x}", outcome[number], "", *one.tolist(), bed[number], *cells, flag])


def write_samples_of(model: emulator.Emulator, inputs: dict[str, Any], path: Path) -> float:
    """Draw the emulator once at each of many soils; the return fraction by it."""
    random = np.random.default_rng(8)
    x = np.column_stack([law.ppf(random.random(SAMPLE_COUNT)) for law in inputs.values()])
    drawn = model.draw(x, 1, seed=4)
    words = np.array(model.outcome_names)[drawn.outcome[:, 0]]
    with h5py.File(path, "w") as file:
        file["inputs"], file["outputs"] = x, drawn.y[:, 0]
        file["outcome"] = np.array([OUTCOMES.index(word) for word in words], dtype=np.uint8)
        file.attrs["input_names"], file.attrs["output_names"] = list(KEYS), list(OUTPUT_NAMES)
        file.attrs["outcomes"] = list(OUTCOMES)
    return float(np.nanmean(returns(drawn.y[:, 0], words)))


def side_runs() -> dict[str, Any]:
    part, deviation = {"share": 0.09, "lower": 0.05, "upper": 0.15}, {"value": 0.01, "lower": 0.008, "upper": 0.014}
    counts = {"soil_pairs": 20, "twins": 12, "twin_shift": 1e-4}
    return counts | {"soil_total_effect": {"speed_out": part}, "chaos_deviation": {"elevation_out": deviation}}


def estimates(values: np.ndarray, bed: np.ndarray) -> dict[str, Any]:
    """Mean, quantiles and spread of one output, with their intervals where there are some."""
    levels, known = (0.05, 0.5, 0.95), values[np.isfinite(values)]
    if len(np.unique(bed)) > 1:
        mean, quantiles = asdict(mean_estimate(values, bed)), map(asdict, quantile_estimates(values, bed, levels))
    else:
        middle, *ends = ({"value": value, "lower": None, "upper": None} for value in
                         (float(known.mean()), *np.quantile(known, levels).tolist()))  # fmt: skip
        mean, quantiles = middle, iter(ends)
    by_level = dict(zip(map("{:g}".format, levels), quantiles, strict=True))
    return {"mean": mean, "quantiles": by_level, "standard_deviation": float(known.std(ddof=1))}


def emulator_record(model: emulator.Emulator) -> dict[str, Any]:
    names = [model.output_names[column] for column in model.runs.modelled]
    scores: dict[str, dict[str, Any]] = {
        name: {
            "crps_skill": float(model.scores.crps_skill[k]),
            "band_90": float(model.scores.band_90[k]),
            "pit": np.histogram(model.scores.pit[:, k], bins=10, range=(0.0, 1.0))[0].tolist(),
        }
        for k, name in enumerate(names)
    }
    scores["joint"] = {"energy_skill": model.scores.gain / model.scores.energy_of_rows}
    found = [name for name, is_found in model.found_inputs().items() if is_found]
    statement, follows = model.statement, model.follows_inputs
    return {"statement": statement, "follows_inputs": follows, "found_inputs": found, "scores": scores}


def shares_with_intervals(shares: dict[str, Any]) -> dict[str, Any]:
    """Shares of the paper's summary, with the intervals that refits give."""
    wide = {key: one | {"lower": one["share"] - 0.03, "upper": one["share"] + 0.03}
            for key, one in shares.items() if isinstance(one, dict) and one["count"]}  # fmt: skip
    return shares | wide
