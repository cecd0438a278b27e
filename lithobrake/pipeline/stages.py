"""The stages of a study in order, by its method, and their keys; each is declared in the room that makes its files."""

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from lithobrake.files.hashing import json_hash, source_hash
from lithobrake.pipeline.answer import stages as answer
from lithobrake.pipeline.emulate import stages as emulate
from lithobrake.pipeline.fly import stages as fly
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper import stages as paper
from lithobrake.pipeline.rest import stages as rest
from lithobrake.pipeline.runs import stages as runs
from lithobrake.pipeline.stage import Stage, same_files
from lithobrake.study import Study


def _write_report(job: Job) -> None:
    from lithobrake.report import write_report

    write_report(job.folder.path, lambda done, total: job.progress(done, total, "figures"))


REPORT = Stage(
    "report",
    "report",
    same_files("report/index.html"),
    _write_report,
    ("summary",),
    parts=("report", "results", "vocabulary"),
)
DRAWN = (
    runs.BED,
    runs.FIRST_LANDING,
    runs.DRAWN_RUNS,
    runs.SIDE_RUNS,
    fly.FLY_RUNS,
    runs.TELLING_LANDING,
    answer.ESTIMATE,
    emulate.EMULATOR,
    emulate.SAMPLE,
    fly.FLY,
    rest.REST,
    rest.AIM,
    answer.SUMMARY,
    REPORT,
)
PAPER = (
    runs.BED,
    paper.MEDIAN_LANDING,
    paper.SCREENING_RUNS,
    paper.SCREEN,
    paper.REFINED_RUNS,
    paper.REFINE,
    paper.TEST_RUNS,
    paper.TEST,
    paper.SAMPLE,
    paper.FLY,
    paper.REST,
    paper.SUMMARY,
    REPORT,
)


def stages_of(study: Study) -> tuple[Stage, ...]:
    """The stages of a study in order, by its method."""
    return PAPER if study.design.method == "paper" else DRAWN


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
        keys[stage.name] = json_hash([stage.name, stage.dependencies(study), source_hash(*stage.parts), before])
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
