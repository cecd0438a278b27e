"""summary.json of a sequence: what its runs and its emulator say, with intervals that hold for beds not yet poured."""

from typing import Any

import numpy as np

from lithobrake.pipeline.answer.aim_results import aim_results
from lithobrake.pipeline.answer.dispersion_statistics import Rows, ellipses, rest_results, shares
from lithobrake.pipeline.answer.limit_states import limit_state_results
from lithobrake.pipeline.answer.missing_landings import described
from lithobrake.pipeline.answer.run_estimates import FILE as ESTIMATES
from lithobrake.pipeline.answer.shares_over_refits import Refits, journey_ends, sample_fates
from lithobrake.pipeline.answer.site_summary import site_results
from lithobrake.pipeline.answer.statements import drawn_answer, drawn_headline, limit_statement
from lithobrake.pipeline.answer.summary_parts import (
    bed_results,
    monte_carlo_results,
    outputs_of_runs,
    provenance,
    study_tables,
)
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.emulate.fitted_emulator import FILE as EMULATOR
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.fly.flights import read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.site import Site
from lithobrake.results.study_results import SUMMARY_FORMAT
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import DRAWN_DESIGNS, OUTPUTS, TOUCHDOWN

PIT_BINS = 10


def write_drawn_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance. Times, host, folders and versions stand in provenance only."""
    side = job.study.design.side_runs
    runs = [DesignRuns.load(job.folder, design) for design in (DRAWN_DESIGNS if side else DRAWN_DESIGNS[:1])]
    distinct, estimates = DesignRuns.distinct(runs), job.folder.read_json(ESTIMATES)
    results: dict[str, Any] = {
        "units": {name: TOUCHDOWN[name].units for name in OUTPUTS},
        "beds": [bed_results(job, name) for name in bed_files(job.study)],
        **estimates,
        "outputs_of_runs": outputs_of_runs(distinct),
        "site": site_results(job.site),
        **_dispersion(job, estimates),
    }
    results["limit_states"] = _limit_states(job, results["shares"])
    results["aim"] = aim_results(job.study, job.folder, _refits(estimates))
    results["emulator"] = _emulator(job, runs[0], results)
    results["answer"] = drawn_answer(job.study, results)
    results["headline"] = drawn_headline(job.study, results)
    for warning in (results["runs"]["warning"], results["emulator"]["warning"]):
        if warning:
            job.say(warning)
    job.folder.write_json(
        "summary.json",
        {
            "format_version": SUMMARY_FORMAT,
            "study": study_tables(job.study, job.tables),
            "results": results,
            "provenance": provenance(job, sum(one.run_count for one in runs), distinct),
        },
    )


def _limit_states(job: Job, shares: dict[str, Any]) -> dict[str, Any]:
    """What the study file asks for, by name, each with a sentence."""
    holds = job.site.holds
    found = limit_state_results(job.study, job.folder, read_table(job.folder, "flights.csv"), shares, holds=holds)
    return {name: one | {"statement": limit_statement(name, one)} for name, one in found.items()}


def _ended(estimates: dict[str, Any]) -> dict[str, int]:
    """How many runs ended in each way, without those that failed."""
    return {name: count for name, count in estimates["runs"]["outcomes"].items() if name in list(TouchdownOutcome)}


def _refits(estimates: dict[str, Any]) -> Refits:
    """What the emulator was fitted to."""
    return Refits(estimates["runs"]["beds"], sum(_ended(estimates).values()), estimates["returns"]["why"])


def _dispersion(job: Job, estimates: dict[str, Any]) -> dict[str, Any]:
    """What became of the samples of the emulator, with intervals from refits, beside what the runs say."""
    study, samples, flights = job.study, Samples.load(job.folder), read_table(job.folder, "flights.csv")
    holds, refits = Site(study).holds, _refits(estimates)
    table = _emulator_shares(samples, flights, _ended(estimates), refits, holds=holds)
    known = table["sample_count"] - table["missing"]["count"]
    rest = rest_results(job)
    if rest["soil"] is not None:
        rows = [row for row in read_table(job.folder, "rest.csv") if row["ground"] == "soil"]
        refits.put_intervals(rest["soil"], np.array([int(row["sample"]) for row in rows]), journey_ends(rows))
    spread = monte_carlo_results(samples)
    return {
        "returns": estimates["returns"] | {"emulator": table["returns"]["count"] / known if known else None},
        "shares": estimates["shares"] | {"emulator": table},
        # Its outputs are those of the runs, of which results.outputs speaks.
        "monte_carlo": {key: spread[key] for key in ("sample_count", "leaving_count")},
        "flights": estimates["flights"] | job.folder.read_json("flights.json"),
        "ellipses": ellipses(study, flights, FlightStatus.IMPACT),
        "without_scatter": None,
        "rest": rest,
    }


def _emulator_shares(
    samples: Samples, flights: Rows, ended: dict[str, int], refits: Refits, *, holds: bool
) -> dict[str, Any]:
    """What became of the samples of the emulator, as shares of all that were looked at; ended: runs by outcome."""
    table = shares(samples, flights, ended, holds=holds)
    for entry in table.values():
        if isinstance(entry, dict):
            entry.pop("upper_limit", None)
    refits.put_intervals(table, np.arange(table["sample_count"]), sample_fates(samples, flights, holds=holds))
    refits.widen_what_no_run_met(table, ended)
    return table


def _emulator(job: Job, runs: DesignRuns, results: dict[str, Any]) -> dict[str, Any]:
    """What the emulator is worth on beds left out, and whether it agrees with the runs."""
    from lithobrake.emulator import load

    model = load(job.folder / EMULATOR)
    scores, modelled = model.scores, [model.output_names[column] for column in model.runs.modelled]
    table: dict[str, Any] = {"joint": {"energy_skill": scores.gain / scores.energy_of_rows}}
    for column, name in enumerate(modelled):
        table[name] = {
            "crps_skill": float(scores.crps_skill[column]),
            "band_90": float(scores.band_90[column]),
            "pit": np.histogram(scores.pit[:, column], PIT_BINS, (0.0, 1.0))[0].tolist(),
        }
    return {
        "of": described(runs.has_outputs, runs.outcomes),
        "statement": model.statement_on("beds"),
        "follows_inputs": model.follows_inputs,
        "found_inputs": [name for name, found in model.found_inputs().items() if found],
        "scores": table,
        "warning": _disagreement(results["returns"]),
    }


def _disagreement(returns: dict[str, Any]) -> str | None:
    """That runs and emulator disagree, in a sentence; None where they agree, or no interval says how far they may."""
    if (
        returns["lower"] is None
        or returns["emulator"] is None
        or returns["lower"] <= returns["emulator"] <= returns["upper"]
    ):
        return None
    return (
        f"The emulator gives a share of {100 * returns['emulator']:.1f} %, outside the interval of the runs "
        f"({100 * returns['lower']:.1f} to {100 * returns['upper']:.1f} %): do not trust what rests on it (flights, "
        "ellipses, rest), and make more runs"
    )
