"""What the landings of a study say, or the first ones of its journeys, and the summary that it is a part of."""

from collections.abc import Callable
from dataclasses import replace

from lithobrake.pipeline.answer.drawn_answer import drawn_answer, drawn_headline
from lithobrake.pipeline.answer.run_estimates import FILE as ESTIMATES
from lithobrake.pipeline.answer.site_summary import site_results
from lithobrake.pipeline.answer.summary_parts import bed_results, outputs_of_runs, write_summary_file
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.dispersion import FlightResults, RestResults
from lithobrake.results.json_values import from_json
from lithobrake.results.shares import LandingShares
from lithobrake.results.summary import DrawnResults, Estimates
from lithobrake.vocabulary.quantities import DRAWN_DESIGNS, OUTPUTS, TOUCHDOWN

# Adds what came of the landings to what they say.
Completed = Callable[[Job, DrawnResults, DesignRuns, Estimates], DrawnResults]


def write_results(job: Job, completed: Completed) -> None:
    """Write summary.json: study, results, provenance."""
    side = job.study.design.side_runs
    runs = [DesignRuns.load(job.folder, design) for design in (DRAWN_DESIGNS if side else DRAWN_DESIGNS[:1])]
    distinct = DesignRuns.distinct(runs)
    estimates = from_json(Estimates, job.folder.read_json(ESTIMATES), "estimates")
    results = completed(job, results_of_landings(job, estimates, distinct), runs[0], estimates)
    results = replace(results, answer=tuple(drawn_answer(job.study, results)))
    results = replace(results, headline=tuple(drawn_headline(results)))
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
    )
