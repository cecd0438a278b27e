"""The stages of a study in order; each reads the files of those before it and writes its own."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from lithobrake.files.hashing import json_hash, source_hash
from lithobrake.pipeline.answer.drawn_summary import write_drawn_summary
from lithobrake.pipeline.answer.run_estimates import estimate
from lithobrake.pipeline.emulate.emulator_samples import draw_emulator_samples
from lithobrake.pipeline.emulate.explorer_tables import FILE as EXPLORER
from lithobrake.pipeline.emulate.explorer_tables import write_explorer
from lithobrake.pipeline.emulate.fitted_emulator import fit_emulator
from lithobrake.pipeline.fly.flight_paths import FILE as PATHS_FILE
from lithobrake.pipeline.fly.flights import flight_reads, fly_expansion_samples, fly_samples
from lithobrake.pipeline.fly.run_flights import fly_runs, run_flight_reads
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper.expansion_samples import draw_samples
from lithobrake.pipeline.paper.expansion_tables import write_expansion_explorer
from lithobrake.pipeline.paper.expansions import fit_refined, fit_screening, score_all
from lithobrake.pipeline.paper.paper_runs import make_refined_runs, make_screening_runs, make_test_runs
from lithobrake.pipeline.paper.paper_summary import summary_reads, write_summary
from lithobrake.pipeline.rest.aiming import aim_files, aim_reads, follow_aims
from lithobrake.pipeline.rest.journeys import FILES as REST_FILES
from lithobrake.pipeline.rest.journeys import follow_samples, rest_files, rest_reads
from lithobrake.pipeline.runs.beds import bed_files, bed_reads, pour_beds
from lithobrake.pipeline.runs.designs import design_reads
from lithobrake.pipeline.runs.drawn_design import SIDE_DESIGNS, beds_of_runs
from lithobrake.pipeline.runs.making_runs import make_drawn_runs, make_side_runs
from lithobrake.pipeline.runs.place_region import place_region
from lithobrake.pipeline.runs.run_table import file_of
from lithobrake.pipeline.runs.shown_landing import (
    land_once,
    land_tellingly,
    landing_files,
    landing_reads,
    telling_files,
)
from lithobrake.study import Study


@dataclass(frozen=True)
class Stage:
    """A step of a study.

    files: what it writes. reads: what of the study it depends on, as JSON values. after: stages whose files it reads.
    parts: parts of the package whose code decides what it writes.
    """

    name: str
    title: str
    files: Callable[[Study], list[str]]
    reads: Callable[[Study], Any]
    after: tuple[str, ...]
    parts: tuple[str, ...]
    make: Callable[[Job], None]


def _design(*names: str) -> Callable[[Study], Any]:
    return lambda study: [study.design.model_dump()[name] for name in names]


def _files(*names: str) -> Callable[[Study], list[str]]:
    return lambda study: list(names)


def _screening_runs(study: Study) -> Any:
    return [design_reads(study), study.seed, *_design(*_SCREENING_RUNS)(study)]


def _drawn_runs(study: Study) -> Any:
    count = study.design.run_count
    return [design_reads(study), place_region(study), study.seed, count, beds_of_runs(study, count)]


def _side_runs(study: Study) -> Any:
    return [study.design.side_runs, study.design.twin_shift]


def _side_files(study: Study) -> list[str]:
    return [file_of(design) for design in SIDE_DESIGNS] if study.design.side_runs else []


def _sample(study: Study) -> Any:
    return study.monte_carlo.model_dump()


def _nothing(study: Study) -> Any:
    return None


def _emulate(job: Job) -> None:
    fit_emulator(job)
    write_explorer(job)


def _sample_expansion(job: Job) -> None:
    draw_samples(job)
    write_expansion_explorer(job)


def _write_report(job: Job) -> None:
    from lithobrake.report import write_report

    write_report(job.folder.path, lambda done, total: job.progress(done, total, "figures"))


RUNS = ("pipeline", "chaos", "vocabulary/quantities.py", "geometry/attitude.py")
FIT = ("pipeline", "chaos", "analysis", "vocabulary/quantities.py")
EMULATE = (*FIT, "emulator")
SUM_UP = (*FIT, "results/telling_numbers.py")
FLY = ("pipeline", "smallbody", "geometry", "vocabulary/quantities.py")
# The points of one design are best for the degree that is fitted to them.
_SCREENING_RUNS = ("points", "replicate_count", "screening_level", "screening_count", "screening_degree")
_REFINED_RUNS = _design("refined_level", "refined_count", "refined_degree", "kept_share", "kept_outputs")
_FIT, _TEST = _design("fit"), _design("test_count")

FLIGHT_FILES = ("flights.csv", "flights.json", "body.obj", PATHS_FILE)

BED = Stage("bed", "bed", bed_files, bed_reads, (), (), pour_beds)
REPORT = Stage(
    "report",
    "report",
    _files("report/index.html"),
    _nothing,
    ("summary",),
    ("report", "results", "vocabulary/quantities.py"),
    _write_report,
)
PAPER = (
    BED,
    Stage("landing", "median landing", landing_files, landing_reads, ("bed",), (), land_once),
    Stage(
        "screening_runs",
        "screening runs",
        _files(file_of("screening")),
        _screening_runs,
        ("bed",),
        FIT,
        make_screening_runs,
    ),
    Stage("screen", "screening", _files("screening.json"), _FIT, ("screening_runs",), FIT, fit_screening),
    Stage(
        "refined_runs", "refined runs", _files(file_of("refined")), _REFINED_RUNS, ("screen",), FIT, make_refined_runs
    ),
    Stage("refine", "refinement", _files("refined.json"), _nothing, ("refined_runs",), FIT, fit_refined),
    Stage(
        "test_runs",
        "test runs",
        _files(file_of("test_kept"), file_of("test_all")),
        _TEST,
        ("refined_runs",),
        FIT,
        make_test_runs,
    ),
    Stage("test", "scores", _files("scores.json"), _nothing, ("refine", "test_runs"), FIT, score_all),
    Stage("sample", "samples", _files("samples.h5", EXPLORER), _sample, ("refine", "test"), FIT, _sample_expansion),
    Stage(
        "fly",
        "flights",
        _files(*FLIGHT_FILES, "flights_without_scatter.csv"),
        flight_reads,
        ("sample",),
        FLY,
        fly_expansion_samples,
    ),
    Stage("rest", "bounces until rest", _files(*REST_FILES), rest_reads, ("fly",), FLY, follow_samples),
    Stage("summary", "summary", _files("summary.json"), summary_reads, ("landing", "rest"), SUM_UP, write_summary),
    REPORT,
)

SEQUENCE = (
    BED,
    Stage("landing", "first landing", landing_files, landing_reads, ("bed",), (), land_once),
    Stage("runs", "runs", _files(file_of("sequence")), _drawn_runs, ("bed",), RUNS, make_drawn_runs),
    Stage("side_runs", "side runs", _side_files, _side_runs, ("runs",), RUNS, make_side_runs),
    Stage(
        "fly_runs",
        "flights of the runs",
        _files("run_flights.csv", "run_impacts.csv"),
        run_flight_reads,
        ("side_runs",),
        FLY,
        fly_runs,
    ),
    Stage("telling_landing", "telling landing", telling_files, _nothing, ("runs",), (), land_tellingly),
    Stage("estimate", "estimates", _files("estimates.json"), _nothing, ("fly_runs",), FIT, estimate),
    Stage("emulator", "emulator", _files("emulator.json", EXPLORER), _nothing, ("runs",), EMULATE, _emulate),
    Stage("sample", "samples", _files("samples.h5"), _sample, ("emulator",), EMULATE, draw_emulator_samples),
    Stage("fly", "flights", _files(*FLIGHT_FILES), flight_reads, ("sample",), FLY, fly_samples),
    Stage("rest", "bounces until rest", rest_files, rest_reads, ("fly",), FLY, follow_samples),
    Stage("aim", "aims", aim_files, aim_reads, ("fly",), (*FLY, "analysis", "emulator"), follow_aims),
    Stage(
        "summary",
        "summary",
        _files("summary.json"),
        summary_reads,
        ("landing", "telling_landing", "estimate", "rest", "aim"),
        (*SUM_UP, "emulator"),
        write_drawn_summary,
    ),
    REPORT,
)


def stages_of(study: Study) -> tuple[Stage, ...]:
    """The stages of a study in order, by its method."""
    return PAPER if study.design.method == "paper" else SEQUENCE


def stages_until(study: Study, until: str) -> tuple[Stage, ...]:
    """The stages of a study up to and including one.

    Raises ValueError for a stage that the method of the study does not have.
    """
    stages, method = stages_of(study), study.design.method
    names = [stage.name for stage in stages]
    if until in names:
        return stages[: names.index(until) + 1]
    raise ValueError(
        f'"{until}" is no stage of a study with design.method = "{method}"; allowed: {", ".join(names)}; '
        "run all of it with: lithobrake run"
    )


def stage_keys(study: Study) -> dict[str, str]:
    """The key of each stage: what it reads of the study, its code, and the keys of the stages before it."""
    keys: dict[str, str] = {}
    for stage in stages_of(study):
        before = [keys[name] for name in stage.after]
        keys[stage.name] = json_hash([stage.name, stage.reads(study), source_hash(*stage.parts), before])
    return keys


def setting(study: Study) -> dict[str, dict[str, Any]]:
    """The stages of a study as its folder notes them, so that whoever reads its files need not know how they are made.

    By name: title, key, and the files that it writes.
    """
    keys = stage_keys(study)
    return {
        stage.name: {"title": stage.title, "key": keys[stage.name], "files": stage.files(study)}
        for stage in stages_of(study)
    }


def make(job: Job, until: str, note: Callable[..., None]) -> None:
    """Make every missing or outdated file of the stages up to and including `until`.

    note: notes for other processes which stage is being made.
    """
    keys, stages = stage_keys(job.study), stages_until(job.study, until)
    kept: list[str] = []
    for number, stage in enumerate(stages, start=1):
        note(stage=stage.title, number=number, count=len(stages))
        job.shown.begin(stage.title, number, len(stages))
        files = stage.files(job.study)
        wanted = tuple(name for name in files if not job.folder.is_current([name], keys[stage.name]))
        if not wanted:
            kept += [stage.title] if files else []
            continue
        if kept:
            job.say(f"still good, and kept: {', '.join(kept)}")
            kept = []
        if set(wanted) < set(files):
            job.say(f"{stage.title}: {len(files) - len(wanted)} of {len(files)} files are still good, and kept")
        started = time.perf_counter()
        stage.make(replace(job, wanted=wanted))
        job.folder.note(stage.name, files, keys[stage.name], time.perf_counter() - started)
