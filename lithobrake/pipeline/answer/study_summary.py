"""summary.json: what came out of a study, and where it comes from."""

import os
import platform
import sys
from dataclasses import astuple, replace
from datetime import UTC, datetime
from importlib.metadata import version
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL
from lithobrake.campaign import read_records
from lithobrake.pipeline.answer.dispersion_statistics import (
    body_product,
    delivery_results,
    flight_checks,
    kernel_numbers,
    site_results,
)
from lithobrake.pipeline.answer.emulated_ends import Refits, emulated_ends
from lithobrake.pipeline.answer.expansion_results import expansion_results
from lithobrake.pipeline.answer.followed_landers import followed_results
from lithobrake.pipeline.answer.ground_answers import finer_ground, ground_curve, kind_results, over_grounds
from lithobrake.pipeline.answer.journey_ends import (
    JourneyTable,
    end_shares,
    journey_rest,
    sky_results,
    soil_shares,
    with_journeys,
)
from lithobrake.pipeline.answer.journey_limit_states import all_met
from lithobrake.pipeline.answer.mean_miss import mean_miss
from lithobrake.pipeline.answer.option_answers import aim_results
from lithobrake.pipeline.answer.question_answers import limit_state_results
from lithobrake.pipeline.answer.run_answers import described, output_ranges, scope, why_no_interval
from lithobrake.pipeline.answer.run_estimates import ESTIMATES_FILE, SPLIT, no_return_fraction, parts_of_journeys
from lithobrake.pipeline.answer.sample_results import (
    return_fraction_of_known,
    return_fraction_of_samples,
    sample_results,
)
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.first_touchdown.emulator import EMULATOR_FILE, why_no_emulator
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.dispersion import FlightResults
from lithobrake.results.model_results import EmulatorResults, EmulatorScores, JointScore, OutputScore
from lithobrake.results.run_results import MissingLandings, RunResults, RunShares
from lithobrake.results.site_results import BedNumbers
from lithobrake.results.study_files import SUMMARY_FORMAT, results_in
from lithobrake.results.summary import Estimates, Provenance, Results, RunTimes, Summary
from lithobrake.statements.answers import study_answer, study_headline
from lithobrake.statements.touchdowns import disagreement
from lithobrake.study import Study
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.soil import grain
from lithobrake.touchdown.touchdown_model import stored_bed
from lithobrake.vocabulary.file_names import RUNS_FILE, SUMMARY_FILE
from lithobrake.vocabulary.quantities import (
    DRAWN_DESIGNS,
    IMPACT_SPEED,
    JOURNEY_DESIGN,
    OUTPUTS,
    PAPER_DESIGNS,
    TOUCHDOWN,
)

PIT_BINS = 10


def summary_dependencies(study: Study) -> dict[str, Any]:
    """What the summary depends on beside the files of the stages before it."""
    # What kernels say counts by its numbers: their files change without a word in the study.
    numbers = kernel_numbers(study)
    read = {} if numbers is None else {"kernels": astuple(numbers)}
    return study_tables(study) | {"product": body_product(study)} | read


def study_tables(study: Study, tables: Any = None) -> dict[str, Any]:
    """The study with all defaults, as the tables of its file; paths of meshes as they were written."""
    dump: dict[str, Any] = _plain(study.model_dump())
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


def bed_results(job: Job, number: int, name: str) -> BedNumbers:
    """The bed of a number in a file of the study, and how large the first impact asks it to be."""
    from lithobrake.touchdown import smallest_bed

    bed, values = stored_bed(job.folder / name), job.design.medians
    width, depth = smallest_bed(
        lander(job.study, values), grain(values), float(bed.grain_diameter), values[IMPACT_SPEED]
    )  # fmt: skip
    grounds = job.design.grounds.each
    return BedNumbers(
        ground=grounds[number].kind if grounds else None,
        solid_fraction=float(bed.solid_fraction),
        coordination_number=float(bed.coordination_number),
        surface_height_m=float(bed.surface_height),
        mean_diameter_m=float(bed.grain_diameter),
        smallest_width_m=width,
        smallest_depth_m=depth,
        large_enough=bool(min(bed.width) >= width and bed.surface_height >= depth),
    )


def write_summary_file(job: Job, results: Results, asked: int, runs: DesignRuns) -> None:
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


def write_summary(job: Job) -> None:
    """Write summary.json: study, results, provenance."""
    over = scope(job.study)
    results = _of_landers(job, _without_landers(job)) if job.study.design.run_count else _without_landers(job)
    results = _of_samples(job, results)
    results = replace(
        results,
        emulator=_emulator(job, results),
        limit_states=limit_state_results(job, results.shares.outcomes, results.ends),
        hard_ground=followed_results(job),
    )
    results = replace(results, answer=tuple(study_answer(over, results)))
    results = replace(results, headline=tuple(study_headline(over, results)))
    for part in (results.runs, results.emulator):
        if part is not None and part.warning:
            job.say(part.warning)
    runs = [DesignRuns.load(job.folder, design) for design in _designs(job.study)]
    write_summary_file(job, results, sum(one.run_count for one in runs), DesignRuns.distinct(runs))


def _designs(study: Study) -> tuple[str, ...]:
    """The designs with all landings of a study."""
    landers = (JOURNEY_DESIGN, *_side_designs(study)) if study.design.run_count else ()
    return (*landers, *(PAPER_DESIGNS if study.expansion else ()))


def _side_designs(study: Study) -> tuple[str, ...]:
    return DRAWN_DESIGNS[1:] if study.design.side_runs else ()


def _without_landers(job: Job) -> Results:
    """The results of a study that draws no lander."""
    study, why = job.study, why_no_interval(job.study)
    expansion = expansion_results(job) if study.expansion else None
    return Results(
        answer=(),
        headline=(),
        units={name: TOUCHDOWN[name].units for name in OUTPUTS},
        beds=tuple(bed_results(job, *one) for one in enumerate(bed_files(study))),
        site=site_results(job.site),
        ends={},
        journeys=0,
        touchdowns=0,
        rest=None,
        delivery=None,
        returns=no_return_fraction(study),
        shares=RunShares(0, 0, LEVEL, why, {}),
        flights=FlightResults(checks=flight_checks(job) if study.sample_count else None),
        variance_shares=dict.fromkeys(SPLIT),
        end_variance_shares={},
        outputs={},
        runs=RunResults(0, 0, {}, MissingLandings(0, 0.0, {}), None, 0, None, None),
        outputs_of_runs={},
        sides={},
        over_grounds=None,
        finer_ground=None,
        ground_curve=None,
        grounds={},
        soils={},
        sky={},
        limit_states={},
        emulator=None,
        emulated=None,
        hard_ground={},
        aim=None,
        samples=None,
        expansion=expansion,
    )


def _of_landers(job: Job, found: Results) -> Results:
    """The results with what the first touchdowns of the landers say, and how their journeys ended."""
    study, folder = job.study, job.folder
    runs, table = DesignRuns.load(folder, "drawn"), JourneyTable.load(folder)
    touchdowns = DesignRuns.load(folder, JOURNEY_DESIGN)
    estimates = results_in(Estimates, folder.read_json(ESTIMATES_FILE), "estimates")
    plain = end_shares(study, table)
    emulated, ends = emulated_ends(job, table, plain) if study.journey.emulated_count else (None, plain)
    # A lander that is flown to the ground may miss it: the first touchdowns are of those that do not.
    journeys = runs.inputs["journey"].astype(int)
    landed = table.taken(journeys)
    met = {name: one[journeys] for name, one in all_met(study, folder, table).items()}
    distinct = DesignRuns.distinct([runs, *(DesignRuns.load(folder, design) for design in _side_designs(study))])
    return replace(
        found,
        ends=ends,
        journeys=len(table.end),
        touchdowns=table.touchdowns,
        rest=replace(journey_rest(study, table), miss=mean_miss(job, table)),
        delivery=delivery_results(job, runs, len(table.end)),
        returns=estimates.returns,
        shares=estimates.shares,
        flights=replace(found.flights, impacts=estimates.flights),
        variance_shares=estimates.variance_shares,
        end_variance_shares=parts_of_journeys(job, runs, landed, met),
        outputs=estimates.outputs,
        runs=estimates.runs,
        outputs_of_runs=output_ranges(distinct),
        sides=with_journeys(study, dict(estimates.sides), runs, touchdowns, landed),
        over_grounds=over_grounds(job.design, table),
        finer_ground=finer_ground(job.design, table),
        ground_curve=ground_curve(job.design, table),
        grounds=kind_results(job.design, table),
        soils=soil_shares(job, table),
        sky=sky_results(study, folder, table),
        emulated=emulated,
        aim=aim_results(study, folder, Refits.of_journeys(study, table)),
    )


def _of_samples(job: Job, found: Results) -> Results:
    """The results with what became of the samples; of a study without landers these are its answer."""
    if not job.study.sample_count:
        return found
    samples = sample_results(job)
    returns = found.returns
    if not found.journeys:
        returns = return_fraction_of_samples(job, samples.shares)
    elif job.study.expansion is None:
        returns = replace(returns, emulator=return_fraction_of_known(samples.shares))
    return replace(found, samples=samples, returns=returns)


def _emulator(job: Job, found: Results) -> EmulatorResults | None:
    """What the emulator is worth on beds left out, and whether it agrees with the runs; None where there is none."""
    from lithobrake.emulator import load

    if not found.journeys or why_no_emulator(job.folder.read_json(EMULATOR_FILE)):
        return None
    runs, model = DesignRuns.load(job.folder, "drawn"), load(job.folder / EMULATOR_FILE)
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
        warning=disagreement(found.returns),
    )
