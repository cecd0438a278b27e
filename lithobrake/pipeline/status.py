"""Where a study is, as another process sees it while the study runs, or after."""

from collections import Counter
from pathlib import Path

from lithobrake.atomic import lock_holder
from lithobrake.campaign import Record, campaign_began, ledger_tally, read_records
from lithobrake.pipeline.folder import LOCK
from lithobrake.study import OUTPUTS


def study_status(path: Path) -> list[str]:
    """Say who is at work on a study and at which stage, and where its runs stand, in lines.

    A folder that has a ledger alone is that of a campaign. Raises ValueError when it has neither study nor ledger.
    """
    ledger, has_study = path / "runs.sqlite", (path / "study.toml").is_file()
    if not (has_study or ledger.is_file()):
        raise ValueError(f"{path} has neither study.toml nor runs.sqlite; name the folder of a study that ran, or runs")
    lines = [_work(path) if has_study else f"{path}: {'a campaign' if campaign_began(ledger) else 'nobody'} is at work"]
    return lines + (_runs(ledger) if ledger.is_file() else [])


def _work(path: Path) -> str:
    holder = lock_holder(path / LOCK)
    if holder is None:
        finished = (path / "report" / "index.html").is_file()
        return f"{path}: nobody is at work; {'the report is there' if finished else 'there is no report yet'}"
    stage = f"stage {holder['number']} of {holder['count']}, {holder['stage']}" if "stage" in holder else "beginning"
    return f"{path}: {stage} (process {holder['process']} on {holder['host']})"


def _runs(path: Path) -> list[str]:
    records = read_records(path)
    state = ledger_tally(records, campaign_began(path))
    lines = [state.sentence()]
    outcomes = Counter(entry.outcome for entry in records if entry.status == "done")
    if outcomes:
        lines.append("outcomes: " + ", ".join(f"{count} {name}" for name, count in sorted(outcomes.items())))
    for reason, count in _reasons(records).most_common(3):
        lines.append(f"failed: {count} x {reason}")
    spreads = state.spread_lines([name for name in OUTPUTS if name in state.spreads] or sorted(state.spreads))
    return lines + (["mean and standard deviation so far [SI]:", *spreads] if spreads else [])


def _reasons(records: list[Record]) -> "Counter[str]":
    return Counter(entry.reason or "" for entry in records if entry.status == "failed")
