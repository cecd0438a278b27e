"""summary.json of studies of first bounces and of journeys, and its parts."""

import os
import platform
import sys
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from importlib.metadata import version
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL
from lithobrake.campaign import read_records
from lithobrake.pipeline.answer.dispersion_statistics import (
    Rows,
    body_product,
    delivery_results,
    ellipses,
    flight_checks,
    rest_results,
    shares,
    site_results,
)
from lithobrake.pipeline.answer.emulated_ends import Refits, emulated_ends, journey_ends, sample_fates
from lithobrake.pipeline.answer.journey_ends import (
    JourneyTable,
    end_shares,
    journey_rest,
    sky_results,
    soil_shares,
    with_journeys,
)
from lithobrake.pipeline.answer.question_answers import aim_results, limit_state_results
from lithobrake.pipeline.answer.run_answers import described, place_regions, scope, why_no_interval
from lithobrake.pipeline.answer.run_estimates import ESTIMATES_FILE, parts_of_journeys
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.first_bounces.emulator import EMULATOR_FILE
from lithobrake.pipeline.flights import read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.samples import Samples
from lithobrake.results.dispersion import FlightResults, RestResults
from lithobrake.results.model_results import EmulatorResults, EmulatorScores, JointScore, MonteCarlo, OutputScore
from lithobrake.results.run_results import EmulatorShares, LandingShares, Level, OutputRange, ReturnFraction
from lithobrake.results.site_results import BedNumbers
from lithobrake.results.study_files import SUMMARY_FORMAT, results_in
from lithobrake.results.summary import DrawnResults, Estimates, PaperResults, Provenance, RunTimes, Summary
from lithobrake.statements.answers import landing_answer, landing_headline
from lithobrake.statements.touchdowns import disagreement
from lithobrake.study import Study
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.soil import grain
from lithobrake.touchdown.touchdown_model import stored_bed
from lithobrake.vocabulary.file_names import REST_FILE, RUNS_FILE, SAMPLE_FLIGHTS_FILE, SUMMARY_FILE
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import DRAWN_DESIGNS, IMPACT_SPEED, JOURNEY_DESIGN, OUTPUTS, TOUCHDOWN

# Adds what came of the landings to what they say.
Completed = Callable[[Job, DrawnResults, DesignRuns, Estimates], DrawnResults]
PIT_BINS = 10


def summary_dependencies(study: Study) -> dict[str, Any]:
    """What the summary depends on beside the files of the stages before it."""
    return study_tables(study) | {"product": body_product(study)}


def study_tables(study: Study, tables: Any = None) -> dict[str, Any]:
    """The study with the defaults of its method, as the tables of its file; paths of meshes as they were written."""
    dump: dict[str, Any] = _plain(study.model_dump(exclude={"design": study.design.keys_of_the_other_method}))
    for section, key in (("lander", "file"), ("site", "body"), ("site", "kernels"), ("solver", "command")):
        dump[section][key] = (tables or {}).get(section, {}).get(key, dump[section][key])
    return dump


def _plain(value: Any) -> Any:
    """A dumped study as JSON values; a distribution in the form that a study file has."""
    if isinstance(value, dict) and set(value) == {"distribution", "parameters"}:
        return {"distribution": value["distribution"], **value["parameters"]}
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    return [_plain(entry) for entry in value] if isinstance(value, list | tuple) else value


def bed_results(job: Job, name: str) -> BedNumbers:
    """A bed of the study, and how large the first impact asks it to be."""
    from lithobrake.touchdown import smallest_bed

    bed, values = stored_bed(job.folder / name), job.design.medians
    width, depth = smallest_bed(
        lander(job.study, values), grain(values), float(bed.grain_diameter), values[IMPACT_SPEED]
    )  # fmt: skip
    return BedNumbers(
        solid_fraction=float(bed.solid_fraction),
        coordination_number=float(bed.coordination_number),
        surface_height_m=float(bed.surface_height),
        mean_diameter_m=float(bed.grain_diameter),
        smallest_width_m=width,
        smallest_depth_m=depth,
        large_enough=bool(min(bed.width) >= width and bed.surface_height >= depth),
    )


def outputs_of_runs(runs: DesignRuns) -> dict[str, OutputRange]:
    """What else the touchdowns gave, over distinct runs: median, smallest and largest."""
    table = {}
    for name in ("contact_duration", "penetration", "peak_acceleration", "energy_lost"):
        known = np.isfinite(runs.output(name))
        values = runs.output(name)[~np.isnan(runs.output(name))]
        if len(values):
            table[name] = OutputRange(
                float(np.median(values)), float(values.min()), float(values.max()), TOUCHDOWN[name].units,
                described(known, runs.outcomes),
            )  # fmt: skip
    return table


def write_summary_file(job: Job, results: DrawnResults | PaperResults, asked: int, runs: DesignRuns) -> None:
    """Write summary.json. Times, host, folders and versions stand in provenance only; asked, runs: as provenance."""
    summary = Summary(SUMMARY_FORMAT, study_tables(job.study, job.tables), results, provenance(job, asked, runs))
    job.folder.write_json(SUMMARY_FILE, summary.to_json())


def provenance(job: Job, asked: int, runs: DesignRuns) -> Provenance:
    """Where it all comes from; asked: runs of all designs, of which `runs` are the distinct ones."""
    ledger, keys = job.folder / RUNS_FILE, set(runs.keys)
    records = [one for one in (read_records(ledger) if ledger.is_file() else []) if one.key in keys]
    packages = ("lithobrake", "numpy", "scipy", "numba", "scikit-learn", "h5py")
    wall = [one.wall_s or 0.0 for one in records]
    return Provenance(
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        folder=str(job.folder.path),
        host=platform.node(),
        system=platform.platform(),
        cores=os.cpu_count(),
        python=sys.version.split()[0],
        packages={name: version(name) for name in packages},
        wall_s=job.folder.wall_times(),
        runs=RunTimes(
            asked, runs.run_count, sum(wall), sum(one.cpu_s or 0.0 for one in records), max(wall, default=0.0)
        ),
    )


def write_results(job: Job, completed: Completed) -> None:
    """Write summary.json: study, results, provenance."""
    side = job.study.design.side_runs
    runs = [DesignRuns.load(job.folder, design) for design in (DRAWN_DESIGNS if side else DRAWN_DESIGNS[:1])]
    distinct = DesignRuns.distinct(runs)
    estimates = results_in(Estimates, job.folder.read_json(ESTIMATES_FILE), "estimates")
    results = completed(job, results_of_landings(job, estimates, distinct), runs[0], estimates)
    results = replace(results, answer=tuple(landing_answer(scope(job.study), results)))
    results = replace(results, headline=tuple(landing_headline(results)))
    for part in (results.runs, results.emulator):
        if part is not None and part.warning:
            job.say(part.warning)
    write_summary_file(job, results, sum(one.run_count for one in runs), distinct)


def results_of_landings(job: Job, estimates: Estimates, distinct: DesignRuns) -> DrawnResults:
    """What the landings say, or the first ones of journeys."""
    return DrawnResults(
        units={name: TOUCHDOWN[name].units for name in OUTPUTS},
        beds=tuple(bed_results(job, name) for name in bed_files(job.study)),
        returns=estimates.returns,
        shares=LandingShares(**vars(estimates.shares), emulator=None),
        flights=FlightResults(estimates.flights, None),
        variance_shares=estimates.variance_shares,
        outputs=estimates.outputs,
        runs=estimates.runs,
        outputs_of_runs=outputs_of_runs(distinct),
        site=site_results(job.site),
        monte_carlo=None,
        ellipses=None,
        without_scatter=None,
        rest=RestResults(None, {}, None, None, None),
        limit_states={},
        aim=None,
        emulator=None,
        answer=(),
        headline=(),
        sides=estimates.sides,
        end_variance_shares={},
        sky={},
        soils={},
    )


def write_drawn_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance."""
    write_results(job, _with_samples)


def _with_samples(job: Job, found: DrawnResults, runs: DesignRuns, estimates: Estimates) -> DrawnResults:
    """What the landings say, and what became of the samples of the emulator."""
    study, holds, refits = job.study, job.site.holds, _refits(estimates)
    samples, flights = Samples.load(job.folder), read_table(job.folder, SAMPLE_FLIGHTS_FILE)
    table = _emulator_shares(samples, flights, estimates, refits, holds=holds)
    known = table.sample_count - table.outcomes["missing"].count
    returns = replace(found.returns, emulator=table.outcomes["returns"].count / known if known else None)
    shares = replace(found.shares, emulator=table)
    return replace(
        found,
        returns=returns,
        shares=shares,
        flights=replace(found.flights, checks=flight_checks(job)),
        # Its outputs are those of the runs, of which results.outputs speaks.
        monte_carlo=MonteCarlo(len(samples.leaves), int(samples.leaves.sum())),
        ellipses=ellipses(job.site, flights, FlightStatus.IMPACT),
        regions=place_regions(found.site, flights, FlightStatus.IMPACT),
        rest=_rest(job, refits),
        limit_states=limit_state_results(study, job.folder, flights, shares.outcomes, holds=holds),
        aim=aim_results(study, job.folder, refits),
        emulator=_emulator(job, runs, returns),
    )


def _ended(estimates: Estimates) -> dict[str, int]:
    """How many runs ended in each way, without those that failed."""
    return {name: count for name, count in estimates.runs.outcomes.items() if name in list(TouchdownOutcome)}


def _refits(estimates: Estimates) -> Refits:
    """What the emulator was fitted to."""
    return Refits(estimates.runs.beds, sum(_ended(estimates).values()), estimates.returns.why)


def _rest(job: Job, refits: Refits) -> RestResults:
    """What became of the samples that were followed, on the soil with intervals from refits."""
    rest = rest_results(job)
    if rest.soil is None:
        return rest
    rows = [row for row in read_table(job.folder, REST_FILE) if row["ground"] == "soil"]
    sample = np.array([int(row["sample"]) for row in rows])
    counts = refits.with_intervals(rest.soil.counts, sample, journey_ends(rows))
    return replace(rest, soil=rest.soil.with_counts(counts, Level(LEVEL, refits.why)))


def _emulator_shares(
    samples: Samples, flights: Rows, estimates: Estimates, refits: Refits, *, holds: bool
) -> EmulatorShares:
    """What became of the samples of the emulator, as shares of all that were looked at, with intervals from refits."""
    found = shares(samples, flights, holds=holds)
    fates = sample_fates(samples, flights, holds=holds)
    counts = refits.with_intervals(found.outcomes, np.arange(found.sample_count), fates)
    counts = refits.widened(counts, _ended(estimates))
    return EmulatorShares(found.sample_count, found.flight_count, counts, LEVEL, refits.why)


def _emulator(job: Job, runs: DesignRuns, returns: ReturnFraction) -> EmulatorResults:
    """What the emulator is worth on beds left out, and whether it agrees with the runs."""
    from lithobrake.emulator import load

    model = load(job.folder / EMULATOR_FILE)
    scores, modelled = model.scores, [model.output_names[column] for column in model.runs.modelled]
    table = {}
    for column, name in enumerate(modelled):
        pit = np.histogram(scores.pit[:, column], PIT_BINS, (0.0, 1.0))[0]
        table[name] = OutputScore(
            float(scores.crps_skill[column]), float(scores.band_90[column]), tuple(pit.tolist())
        )  # fmt: skip
    return EmulatorResults(
        of=described(runs.has_outputs, runs.outcomes),
        statement=model.statement_on("beds"),
        follows_inputs=model.follows_inputs,
        found_inputs=tuple(name for name, found in model.found_inputs().items() if found),
        scores=EmulatorScores(JointScore(scores.gain / scores.energy_of_rows), table),
        warning=disagreement(returns),
    )


def write_journey_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance."""
    write_results(job, _with_journeys)


def _with_journeys(job: Job, found: DrawnResults, runs: DesignRuns, estimates: Estimates) -> DrawnResults:
    """What the first touchdowns say, and how the journeys ended."""
    table = JourneyTable.load(job.folder)
    emulated, ends = emulated_ends(job, table, end_shares(job.study, table))
    # A lander that is flown to the ground may miss it: the first touchdowns are of those that do not.
    landed = table.taken(runs.inputs["journey"].astype(int))
    touchdowns = DesignRuns.load(job.folder, JOURNEY_DESIGN)
    fitted = Refits(len(np.unique(table.bed)), table.touchdowns, why_no_interval(job.study))
    return replace(
        found,
        aim=aim_results(job.study, job.folder, fitted),
        rest=journey_rest(job.study, table),
        ends=ends,
        sky=sky_results(job.study, job.folder, table),
        delivery=delivery_results(job, runs, len(table.end)),
        journeys=len(table.end),
        touchdowns=table.touchdowns,
        emulated=emulated,
        soils=soil_shares(job, table),
        sides=with_journeys(job.study, dict(found.sides), runs, touchdowns, landed),
        end_variance_shares=parts_of_journeys(job, runs, landed),
    )
