"""Where a study is, as another process sees it while the study runs, or after."""

import math
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from lithobrake.campaign import RunStatus, Tally, campaign_began, ledger_tally
from lithobrake.files.atomic import lock_holder
from lithobrake.pipeline.commands.running_estimates import (
    JourneysStatus,
    RunningEstimates,
    journeys_status,
    running_estimates,
)
from lithobrake.pipeline.folder_state import FolderState, StageState, grouped, read_state
from lithobrake.pipeline.planning.known_journeys import touchdown_keys
from lithobrake.pipeline.study_folder import LOCK, NAME, FileState, Notes, StudyFolder
from lithobrake.results import open_study
from lithobrake.results.study_files import JOURNEYS
from lithobrake.vocabulary.file_names import RUNS_FILE, STUDY_FILE
from lithobrake.vocabulary.quantities import OUTPUTS


@dataclass(frozen=True)
class RunsStatus:
    """The runs that a study asks for as it is now.

    others: how many more its ledger has. rare: how many of the ledger's only a limit state asks for, by its name.
    outcomes: how often each came. reasons: why runs failed, and how often. estimates: what they say so far, of a
    drawn runs; None for another study, and before enough have ended. journeys: None for a study without them.
    """

    tally: Tally
    others: int
    rare: dict[str, int]
    outcomes: "Counter[str]"
    reasons: "Counter[str]"
    estimates: RunningEstimates | None
    journeys: JourneysStatus | None = None

    def lines(self) -> list[str]:
        lines = [*(self.journeys.lines() if self.journeys else []), self.tally.sentence()]
        lines += [
            f"{count} more runs in the ledger are landings of lithobrake rare: {name}"
            for name, count in self.rare.items()
        ]
        if self.others:
            lines.append(f"{self.others} more runs in the ledger are of earlier settings of the study")
        if self.outcomes:
            lines.append("outcomes: " + ", ".join(f"{count} {name}" for name, count in sorted(self.outcomes.items())))
        lines += [f"failed: {count} x {reason}" for reason, count in self.reasons.most_common(3)]
        found = self.tally.spreads
        spreads = self.tally.spread_lines([name for name in OUTPUTS if name in found] or sorted(found))
        lines += ["mean and standard deviation so far [SI]:", *spreads] if spreads else []
        estimates = self.estimates.lines() if self.estimates else []
        return lines + (["first touchdowns:", *estimates] if self.journeys and estimates else estimates)

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON values; rate [runs/s] and time left [s] are None where nobody knows them."""
        state = self.tally
        return {
            "total": state.total,
            "done": state.done,
            "running": state.running,
            "failed": state.failed,
            "of_earlier_settings": self.others,
            "of_rare": self.rare,
            "rate": _finite(state.rate),
            "seconds_left": _finite(state.time_left),
            "outcomes": dict(sorted(self.outcomes.items())),
            "reasons": dict(self.reasons),
            "spreads": {
                name: {"count": one.count, "mean": one.mean, "std": _finite(one.std)}
                for name, one in state.spreads.items()
            },
            "estimates": self.estimates and self.estimates.to_json(),
            "journeys": self.journeys and self.journeys.to_json(),
        }


@dataclass(frozen=True)
class StudyStatus:
    """Where a study stands.

    at_work: who is, and at which stage, as the lock of its folder says; None for nobody. campaign_began: when the
    campaign did whose ledger this is, where the folder is none of a study. state: of its files; None likewise. runs:
    None before there is a ledger.
    """

    folder: Path
    at_work: dict[str, Any] | None
    campaign_began: str | None
    state: FolderState | None
    runs: RunsStatus | None

    def lines(self) -> list[str]:
        runs = self.runs.lines() if self.runs else []
        if self.state is None:
            return [f"{self.folder}: {'a campaign is running' if self.campaign_began else 'not running'}", *runs]
        return [_work(self.folder, self.at_work, self.state), *_files(self.at_work, self.state), *runs]

    def to_json(self) -> dict[str, Any]:
        state = self.state
        stages = [] if state is None else [_at_work(stage, self.at_work) for stage in state.stages if stage.number]
        return {
            "folder": str(self.folder),
            "at_work": self.at_work,
            "campaign_began": self.campaign_began,
            "stages": [
                {"name": stage.name, "title": stage.title, "is_current": stage.is_current, "files": stage.files}
                for stage in stages
            ],
            "edited": None if state is None or state.edited is None else str(state.edited),
            "unknown": None if state is None else state.unknown or None,
            "runs": self.runs and self.runs.to_json(),
        }


def study_status(path: Path) -> StudyStatus:
    """Status of a study: running process, stages that are current, and counts of its runs.

    A folder with only a ledger is that of a campaign. Raises ValueError when it has neither study nor ledger.
    """
    ledger, is_study = path / RUNS_FILE, any((path / name).is_file() for name in (STUDY_FILE, NAME))
    if not (is_study or ledger.is_file()):
        raise ValueError(f"{path} has neither study.toml nor runs.sqlite; name the folder of a study that ran, or runs")
    if not is_study:
        return StudyStatus(path, None, campaign_began(ledger), None, _runs(path, Notes(), {}, has_journeys=False))
    # Who is at work is looked at first: a stage that ends in between is then one that is still to come.
    holder = lock_holder(path / LOCK)
    state = read_state(path)
    if not ledger.is_file():
        return StudyStatus(path, holder, None, state, None)
    runs = _runs(path, state.notes, _flown(path, state), has_journeys=_has_journeys(state))
    # The tables of journeys are written when all have ended; until then the process at work notes in its lock how many
    # have.
    said = (holder or {}).get("journeys")
    if runs.journeys is not None and said is not None:
        runs = replace(runs, journeys=replace(runs.journeys, said=str(said)))
    return StudyStatus(path, holder, None, state, runs)


def _at_work(stage: StageState, holder: dict[str, Any] | None) -> StageState:
    """A stage as it is while a process is at it: files that nothing is noted of yet are its own."""
    if holder is None or holder.get("number") != stage.number:
        return stage
    own: dict[str, FileState] = {
        name: FileState.NEW if state is FileState.FOREIGN else state for name, state in stage.files.items()
    }
    return replace(stage, files=own)


def _work(path: Path, holder: dict[str, Any] | None, state: FolderState) -> str:
    if holder:
        stage = (
            f"stage {holder['number']} of {holder['count']}, {holder['stage']}" if "stage" in holder else "beginning"
        )
        return f"{path}: {stage} (process {holder['process']} on {holder['host']})"
    if not (path / "report" / "index.html").is_file():
        return f"{path}: not running; there is no report yet"
    fits = all(stage.is_current for stage in state.stages)
    return f"{path}: not running; the report is there" + ("" if fits else ", but its files have changed since")


def _files(holder: dict[str, Any] | None, state: FolderState) -> list[str]:
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


def _has_journeys(state: FolderState) -> bool:
    """Whether the journeys of the study have all ended, and their tables are of the study as it is."""
    return any(stage.is_current and JOURNEYS in stage.files for stage in state.stages)


def _runs(path: Path, notes: Notes, flown: dict[str, float], *, has_journeys: bool) -> RunsStatus:
    """Where the runs stand that the study asks for as it is now, and how many others its ledger has.

    has_journeys: whether the tables of its journeys are current.
    """
    every = open_study(path).ledger
    asked = {key for keys in notes.designs.values() for key in keys}
    asked |= touchdown_keys(path, every, asked, is_current=has_journeys)
    # A ledger of which nothing is noted is that of a campaign, or of an earlier format.
    records = [entry for entry in every if entry.key in asked] if notes.stages else every
    others = {entry.key for entry in every} - {entry.key for entry in records}
    rare = {name: len(others.intersection(keys)) for name, keys in notes.rare.items()}
    # Those beside the drawn runs are at places and soils of its runs, and say nothing new.
    drawn = set(notes.designs.get("drawn", ()))
    return RunsStatus(
        tally=ledger_tally(records, campaign_began(path / RUNS_FILE)),
        others=len(others.difference(*notes.rare.values())),
        rare={name: count for name, count in rare.items() if count},
        outcomes=Counter(entry.outcome or "" for entry in records if entry.status == RunStatus.DONE),
        reasons=Counter(entry.reason or "" for entry in records if entry.status == RunStatus.FAILED),
        journeys=journeys_status(path, records, len(drawn), is_current=has_journeys),
        estimates=running_estimates([entry for entry in records if entry.key in drawn], flown),
    )


def _flown(path: Path, state: FolderState) -> dict[str, float]:
    """Which share of its flights each drawn run returns in, by key; none before they have flown."""
    # Fractions of an earlier setting would be attributed to the runs of the present one.
    if not any(stage.name == "fly_runs" and stage.is_current for stage in state.stages):
        return {}
    from lithobrake.pipeline.answer.run_answers import read_shares

    return read_shares(StudyFolder.only_read(path))


def _finite(number: float) -> float | None:
    return number if math.isfinite(number) else None
