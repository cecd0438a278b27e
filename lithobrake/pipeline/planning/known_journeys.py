"""Touchdowns of journeys that a ledger knows, and how many journeys go on."""

import tomllib
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.campaign import Record, read_records
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.results.study_files import TOUCHDOWNS
from lithobrake.vocabulary.file_names import RUNS_FILE, STUDY_FILE

if TYPE_CHECKING:
    from lithobrake.pipeline.design.drawn_design import DrawnDesign

NUMBER, TOUCHDOWN = "journey", "touchdown"
# What stays the same over the touchdowns of a journey: its lander, its bed, and its soil where regions have none of
# their own.
SOIL, KEPT = "grain.", ("lander.", "solver.")
# Stands for the moment at which a touchdown will have ended: after all others, as text.
_LATER = "~"


def journeys_under_way(design: "DrawnDesign", folder: StudyFolder, known: Collection[str]) -> int:
    """How many journeys have touchdowns that have ended, and a later one that waits in the ledger.

    known: keys of all runs that have ended.
    """
    path = folder / RUNS_FILE
    if not (design.study.design.run_count and path.is_file()):
        return 0
    every = read_records(path)
    own = touchdown_keys(folder.path, every, set(design.keys), is_current=False)
    waiting = [one for one in every if one.key in own and one.key not in known]
    return len({one.inputs[NUMBER] for one in waiting if one.inputs[TOUCHDOWN] > 0.0})


def touchdown_keys(path: Path, every: Sequence[Record], asked: Collection[str], *, is_current: bool) -> set[str]:
    """Keys of the touchdowns of a study's journeys, which begin with those that are asked for; empty without any.

    is_current: whether touchdowns.csv is of the study as it is; until it is, a touchdown goes on from the one with the
    number before it of the same journey and soil, and ended after that: those of an earlier delivery ended before.
    """
    if is_current:
        return {row["key"] for row in read_rows(path / TOUCHDOWNS, ("key",), AGAIN)}
    last: dict[frozenset[tuple[str, float]], Record] = {}
    found: set[str] = set()
    same = KEPT if _has_soils(path) else (SOIL, *KEPT)
    of_journeys = [record for record in every if NUMBER in record.inputs]
    for record in sorted(of_journeys, key=lambda one: (one.inputs[TOUCHDOWN], one.ended or _LATER)):
        kept = _kept(record, same)
        before = last.get(kept)
        if record.key in asked or (before is not None and _goes_on(before, record)):
            last[kept] = record
            found.add(record.key)
    return found


def _goes_on(before: Record, record: Record) -> bool:
    """Whether a touchdown may be the one after another of its journey."""
    follows = record.inputs[TOUCHDOWN] == before.inputs[TOUCHDOWN] + 1.0
    return follows and before.ended is not None and before.ended <= (record.ended or _LATER)


def _has_soils(path: Path) -> bool:
    """Whether the study of a folder gives regions a soil of their own; not where its copy of the study is no study."""
    try:
        return "soil" in tomllib.loads((path / STUDY_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        # What is wrong with the copy stands in the state of the folder.
        return False


def _kept(record: Record, kept: tuple[str, ...]) -> frozenset[tuple[str, float]]:
    """What the touchdowns of one journey share: the bed, and numbers whose keys begin so."""
    inputs: Mapping[str, float] = record.inputs
    same = (NUMBER, "bed", *(name for name in inputs if name.startswith(kept)))
    return frozenset((name, inputs[name]) for name in same if name in inputs)
