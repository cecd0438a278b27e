"""Which files of a study an edit of its file or of the code outdates, by the keys of stages; making them again."""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from lithobrake.files.reading import json_hash, source_hash
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.stages import STAGES, stages_until
from lithobrake.study import Study


def stage_keys(study: Study) -> dict[str, str]:
    """The key of each stage: what it reads of the study, its code, and the keys of the stages before it.

    A stage that writes nothing of this study outdates nothing by itself.
    """
    keys: dict[str, str] = {}
    for stage in STAGES:
        # The keys of the stages before stand for their files, so that none has to be read to know what an edit
        # outdates.
        before = [keys[name] for name in stage.after]
        own = [stage.dependencies(study), source_hash(*stage.parts)] if stage.files(study) else []
        keys[stage.name] = json_hash([stage.name, *own, before])
    return keys


def setting(study: Study) -> dict[str, dict[str, Any]]:
    """The stages of a study as its folder notes them, so that whoever reads its files need not know how they are made.

    By name: title, key, and the files that it writes.
    """
    keys = stage_keys(study)
    return {
        stage.name: {"title": stage.title, "key": keys[stage.name], "files": stage.files(study)} for stage in STAGES
    }


def make(job: Job, until: str, note: Callable[..., None]) -> None:
    """Make every missing or outdated file of the stages up to and including `until`.

    Stages that write nothing of this study do not count. note: notes for other processes which stage is being made.
    """
    keys, stages = stage_keys(job.study), [one for one in stages_until(job.study, until) if one.files(job.study)]
    kept: list[str] = []
    for number, stage in enumerate(stages, start=1):
        of_stage = partial(note, stage=stage.title, number=number, count=len(stages))
        of_stage()
        job.shown.begin(stage.title, number, len(stages))
        files = stage.files(job.study)
        # File by file: of a thousand beds one that is missing is poured alone.
        wanted = tuple(name for name in files if not job.folder.is_current([name], keys[stage.name]))
        if not wanted:
            kept.append(stage.title)
            continue
        if kept:
            job.say(f"still good, and kept: {', '.join(kept)}")
            kept = []
        if set(wanted) < set(files):
            job.say(f"{stage.title}: {len(files) - len(wanted)} of {len(files)} files are still good, and kept")
        started = time.perf_counter()
        stage.make(replace(job, wanted=wanted, note=of_stage))
        job.folder.note(stage.name, files, keys[stage.name], time.perf_counter() - started)
