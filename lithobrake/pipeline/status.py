"""Where a study is, as another process sees it while the study runs, or after."""

from collections import Counter
from pathlib import Path
from typing import Any

from lithobrake.atomic import lock_holder
from lithobrake.campaign import Record, campaign_began, ledger_tally
from lithobrake.outputs import OUTPUTS
from lithobrake.pipeline.folder import LOCK
from lithobrake.pipeline.notes import NAME, Notes
from lithobrake.pipeline.state import STUDY_FILE, FolderState, grouped, read_state
from lithobrake.results import open_study


def study_status(path: Path) -> list[str]:
    """Return lines that say who is at work on a study, which stages are done, and the state of its runs.

    A folder with only a ledger is that of a campaign. Raises ValueError when it has neither study nor ledger.
    """
    ledger, is_study = path / "runs.sqlite", any((path / name).is_file() for name in (STUDY_FILE, NAME))
    if not (is_study or ledger.is_file()):
        raise ValueError(f"{path} has neither study.toml nor runs.sqlite; name the folder of a study that ran, or runs")
    if not is_study:
        work = "a campaign" if campaign_began(ledger) else "nobody"
        return [f"{path}: {work} is at work", *_runs(path, Notes())]
    # Who is at work is looked at first: a stage that ends in between is then one that is still to come.
    holder = lock_holder(path / LOCK)
    state = read_state(path)
    lines = [_work(path, holder, state), *_files(holder, state)]
    return lines + (_runs(path, state.notes) if ledger.is_file() else [])


def _work(path: Path, holder: dict[str, Any] | None, state: FolderState) -> str:
    if holder:
        stage = (
            f"stage {holder['number']} of {holder['count']}, {holder['stage']}" if "stage" in holder else "beginning"
        )
        return f"{path}: {stage} (process {holder['process']} on {holder['host']})"
    if not (path / "report" / "index.html").is_file():
        return f"{path}: nobody is at work; there is no report yet"
    fits = all(stage.is_current for stage in state.stages)
    return f"{path}: nobody is at work; the report is there" + ("" if fits else ", but not of the files as they are")


def _files(holder: dict[str, Any] | None, state: FolderState) -> list[str]:
    """Which stages are current, and what is the matter with the files of the others."""
    if state.unknown:
        return [state.unknown]
    done = [stage.title for stage in state.stages if stage.is_current and stage.number]
    count = sum(stage.number > 0 for stage in state.stages)
    lines = [f"{len(done)} of {count} stages are current" + (f": {', '.join(done)}" if done else "")]
    others = [stage for stage in state.stages if not stage.is_current]
    if holder:
        # What is at work goes through its stages in order, and writes now what is still to come.
        coming = [stage for stage in others if stage.number >= holder.get("number", 0)]
        others = [stage for stage in others if stage not in coming]
        lines += [f"to come: {', '.join(stage.title for stage in coming)}"] if coming else []
    if others:
        lines.append(f"{grouped(others)}; make them again with: {state.command}")
    if state.edited:
        lines.append(f"{state.edited} was edited since; bring the folder up to date with: {state.command}")
    return lines


def _runs(path: Path, notes: Notes) -> list[str]:
    """Where the runs stand that the study asks for as it is now, and how many others its ledger has."""
    every = open_study(path).ledger
    asked = {key for keys in notes.designs.values() for key in keys}
    # A ledger of which nothing is noted is that of a campaign, or of an earlier format.
    records = [entry for entry in every if entry.key in asked] if notes.stages else every
    state = ledger_tally(records, campaign_began(path / "runs.sqlite"))
    lines = [state.sentence()]
    if len(records) < len(every):
        lines.append(f"{len(every) - len(records)} more runs in the ledger are of earlier settings of the study")
    outcomes = Counter(entry.outcome for entry in records if entry.status == "done")
    if outcomes:
        lines.append("outcomes: " + ", ".join(f"{count} {name}" for name, count in sorted(outcomes.items())))
    for reason, count in _reasons(records).most_common(3):
        lines.append(f"failed: {count} x {reason}")
    spreads = state.spread_lines([name for name in OUTPUTS if name in state.spreads] or sorted(state.spreads))
    return lines + (["mean and standard deviation so far [SI]:", *spreads] if spreads else [])


def _reasons(records: list[Record]) -> "Counter[str]":
    return Counter(entry.reason or "" for entry in records if entry.status == "failed")
